//! Where a wall is at a time, and how it moves.

use crate::shape::surface::{Closest, Facet};
use crate::vector::{
    Rotation, Vector, add, cross, dot, plus_scaled, subtract, turned, turned_back,
};

/// Where a wall is at a time, and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub shift: Vector,
    pub turn: Rotation,
    /// A point of the axis at rest; m.
    pub pivot: Vector,
    /// Velocity of the pivot; m/s.
    pub velocity: Vector,
    /// Angular velocity; rad/s.
    pub spin: Vector,
    /// Velocity of its surface besides; m/s.
    pub surface: Vector,
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
    #[inline(always)]
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
    use crate::shape::motion::{Axis, How, Motion};
    use crate::shape::surface::Plate;
    use crate::vector::length;

    fn close(a: Vector, b: Vector) {
        assert!(length(subtract(a, b)) < 1e-12, "{a:?} {b:?}");
    }

    #[test]
    fn closed_form_a_turning_plate_and_a_belt() {
        let motion = Motion::always([
            How::Rotation {
                about: Axis {
                    point: [0.0; 3],
                    direction: [0.0, 0.0, 1.0],
                },
                angular_velocity: 2.0,
            },
            How::Belt([1.0, 0.0, 5.0]),
        ]);
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
