//! Walls: where they are, what they are made of, how they move.

use crate::shape::surface::{Closest, Facet, Shape};
use crate::vector::{
    Rotation, UNTURNED, Vector, add, cross, dot, length, plus_scaled, scaled, subtract, turn_about,
    turned, turned_back,
};

/// A wall of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Name, for people.
    pub name: String,
    /// Material, by its number in the scene.
    pub material: usize,
    /// Its surface at rest.
    pub shape: Shape,
    /// How it moves.
    pub motion: Motion,
}

impl Wall {
    /// The largest speed of its points; of an endless plane without its rotation; m/s.
    pub fn largest_speed(&self) -> f64 {
        let pivot = self.motion.rotation.map_or([0.0; 3], |own| own.point);
        let reach = self.shape.reach(pivot);
        let reach = if reach.is_finite() { reach } else { 0.0 };
        self.motion.largest_speed(reach)
    }
}

/// Motion of a wall. Parts add up.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Motion {
    /// Steady velocity; m/s.
    pub velocity: Vector,
    /// A vibration A sin(2π f t).
    pub vibration: Option<Vibration>,
    /// A rotation.
    pub rotation: Option<Turning>,
    /// Velocity of the surface while the wall stays, of a conveyor belt; m/s. Its part
    /// along the surface acts.
    pub surface_velocity: Vector,
}

/// A vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vibration {
    /// Amplitude and direction; m.
    pub amplitude: Vector,
    /// Frequency; Hz.
    pub frequency: f64,
}

/// A steady rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// A point of the axis; m.
    pub point: Vector,
    /// Direction of the axis; length 1.
    pub axis: Vector,
    /// Angular velocity; rad/s.
    pub angular_velocity: f64,
}

/// Where a wall is at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    shift: Vector,
    turn: Rotation,
    pivot: Vector,
    /// Velocity of the pivot; m/s.
    velocity: Vector,
    spin: Vector,
    surface: Vector,
}

impl Motion {
    /// Whether the wall stays where it is (its surface may run).
    pub fn stays(&self) -> bool {
        self.velocity == [0.0; 3] && self.vibration.is_none() && self.rotation.is_none()
    }

    /// Where the wall is at a time: a point x of it at rest is at q x q⁻¹ + t, with the
    /// rotation q and the shift t (m).
    ///
    /// * `time`: s
    pub fn pose(&self, time: f64) -> (Rotation, Vector) {
        let placed = self.at(time);
        (placed.turn, placed.outward([0.0; 3]))
    }

    pub(crate) fn at(&self, time: f64) -> Placed {
        let mut placed = Placed {
            shift: scaled(self.velocity, time),
            turn: UNTURNED,
            pivot: [0.0; 3],
            velocity: self.velocity,
            spin: [0.0; 3],
            surface: self.surface_velocity,
        };
        if let Some(vibration) = self.vibration {
            let rate = 2.0 * std::f64::consts::PI * vibration.frequency;
            let (s, c) = (rate * time).sin_cos();
            placed.shift = plus_scaled(placed.shift, vibration.amplitude, s);
            placed.velocity = plus_scaled(placed.velocity, vibration.amplitude, rate * c);
        }
        if let Some(turning) = self.rotation {
            placed.turn = turn_about(turning.axis, turning.angular_velocity * time);
            placed.pivot = turning.point;
            placed.spin = scaled(turning.axis, turning.angular_velocity);
        }
        placed
    }

    /// The largest speed of a point of the wall that is within `reach` of the pivot; m/s.
    fn largest_speed(&self, reach: f64) -> f64 {
        let vibration = self.vibration.map_or(0.0, |own| {
            2.0 * std::f64::consts::PI * own.frequency.abs() * length(own.amplitude)
        });
        let rotation = self
            .rotation
            .map_or(0.0, |own| own.angular_velocity.abs() * reach);
        length(self.velocity) + vibration + rotation
    }
}

impl Placed {
    /// A point of space in the wall's own frame.
    pub(crate) fn inward(&self, place: Vector) -> Vector {
        let from = subtract(subtract(place, self.shift), self.pivot);
        add(turned_back(self.turn, from), self.pivot)
    }

    /// A direction of the wall's own frame in space.
    pub(crate) fn turned(&self, direction: Vector) -> Vector {
        turned(self.turn, direction)
    }

    pub(crate) fn outward(&self, place: Vector) -> Vector {
        let from = subtract(place, self.pivot);
        add(add(turned(self.turn, from), self.pivot), self.shift)
    }

    /// The plane through a closest point as it was, with its point closest to a place then.
    pub(crate) fn carried(&self, closest: &Closest, before: &Self, place: Vector) -> Closest {
        let normal = before.turned(turned_back(self.turn, closest.normal));
        let point = before.outward(self.inward(closest.point));
        let distance = dot(subtract(point, place), normal);
        Closest {
            point: plus_scaled(place, normal, distance),
            normal,
            distance,
            inside: true,
        }
    }

    /// Velocity of the wall's surface at a point of space, with a normal there; m/s.
    pub(crate) fn velocity_at(&self, place: Vector, normal: Vector) -> Vector {
        let arm = subtract(subtract(place, self.shift), self.pivot);
        let running = plus_scaled(self.surface, normal, -dot(self.surface, normal));
        add(add(self.velocity, cross(self.spin, arm)), running)
    }
}

impl Facet {
    /// The closest point of the facet as it is placed.
    #[inline]
    pub(crate) fn closest(&self, placed: Option<&Placed>, place: Vector) -> Closest {
        let Some(placed) = placed else {
            return self.closest_at_rest(place);
        };
        let own = self.closest_at_rest(placed.inward(place));
        Closest {
            point: placed.outward(own.point),
            normal: turned(placed.turn, own.normal),
            ..own
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::surface::Plate;

    fn close(a: Vector, b: Vector) {
        assert!(length(subtract(a, b)) < 1e-12, "{a:?} {b:?}");
    }

    #[test]
    fn closed_form_a_turning_plate_and_a_belt() {
        let motion = Motion {
            rotation: Some(Turning {
                point: [0.0; 3],
                axis: [0.0, 0.0, 1.0],
                angular_velocity: 2.0,
            }),
            surface_velocity: [1.0, 0.0, 5.0],
            ..Motion::default()
        };
        // A quarter turn: the plate along x stands along y.
        let placed = motion.at(std::f64::consts::FRAC_PI_4);
        let plate = Facet::Plate(Plate {
            corner: [0.0, 0.0, -1.0],
            edges: [[2.0, 0.0, 0.0], [0.0, 0.0, 2.0]],
        });
        let found = plate.closest(Some(&placed), [0.5, 1.0, 0.0]);
        close(found.point, [0.0, 1.0, 0.0]);
        close(found.normal, [-1.0, 0.0, 0.0]);
        // Its velocity there, and of the belt what runs along a floor.
        close(
            placed.velocity_at([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            [-1.0, 0.0, 0.0],
        );
    }
}
