//! Walls: where they are, what they are made of, how they move.

use crate::vector::{
    Rotation, UNTURNED, Vector, add, any_normal, cross, dot, length, plus_scaled, scaled, subtract,
    turn_about, turned, turned_back,
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

/// The surface of a wall. All but planes are felt from both sides.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An endless plane with everything on one side of it.
    Plane {
        /// A point of it; m.
        point: Vector,
        /// Towards the free side; length 1.
        normal: Vector,
    },
    /// Parallelograms.
    Plates(Vec<Plate>),
    /// The side of a circular cylinder, open at both ends.
    Cylinder {
        /// Centre of one end; m.
        start: Vector,
        /// Centre of the other; m.
        end: Vector,
        /// Radius; m.
        radius: f64,
    },
    /// Triangles.
    Mesh {
        /// Corners of each; m.
        triangles: Vec<[Vector; 3]>,
    },
}

/// A parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// A corner; m.
    pub corner: Vector,
    /// Edges from it; m.
    pub edges: [Vector; 2],
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
    #[must_use]
    pub fn stays(&self) -> bool {
        self.velocity == [0.0; 3] && self.vibration.is_none() && self.rotation.is_none()
    }

    /// Where the wall is at a time: a point x of it at rest is at q x q⁻¹ + t, with the
    /// rotation q and the shift t (m).
    ///
    /// * `time`: s
    #[must_use]
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
    pub(crate) fn largest_speed(&self, reach: f64) -> f64 {
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

    /// Velocity of the wall's surface at a point of space, with a normal there; m/s.
    pub(crate) fn velocity_at(&self, place: Vector, normal: Vector) -> Vector {
        let arm = subtract(subtract(place, self.shift), self.pivot);
        let running = plus_scaled(self.surface, normal, -dot(self.surface, normal));
        add(add(self.velocity, cross(self.spin, arm)), running)
    }
}

/// A part of a wall's surface that has a closest point of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Facet {
    Plane {
        point: Vector,
        normal: Vector,
    },
    Plate(Plate),
    Cylinder {
        start: Vector,
        along: Vector,
        radius: f64,
    },
    Triangle([Vector; 3]),
}

/// The point of a facet that is closest to a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// Where; m.
    pub point: Vector,
    /// From the place to the surface: length 1.
    pub normal: Vector,
    /// Distance; m. Negative behind a plane.
    pub distance: f64,
    /// Whether the point lies inside the facet, not on its edge.
    pub inside: bool,
}

impl Shape {
    pub(crate) fn facets(&self) -> Vec<Facet> {
        match self {
            Self::Plane { point, normal } => vec![Facet::Plane {
                point: *point,
                normal: *normal,
            }],
            Self::Plates(plates) => plates.iter().copied().map(Facet::Plate).collect(),
            Self::Cylinder { start, end, radius } => vec![Facet::Cylinder {
                start: *start,
                along: subtract(*end, *start),
                radius: *radius,
            }],
            Self::Mesh { triangles } => triangles.iter().copied().map(Facet::Triangle).collect(),
        }
    }

    /// The largest distance of its points from a pivot; m. Infinite for planes.
    pub(crate) fn reach(&self, pivot: Vector) -> f64 {
        let from = |point: Vector| length(subtract(point, pivot));
        match self {
            Self::Plane { .. } => f64::INFINITY,
            Self::Plates(plates) => {
                let corners = plates.iter().flat_map(Plate::corners);
                corners.map(from).fold(0.0, f64::max)
            }
            Self::Cylinder { start, end, radius } => from(*start).max(from(*end)) + radius,
            Self::Mesh { triangles } => triangles
                .iter()
                .flatten()
                .copied()
                .map(from)
                .fold(0.0, f64::max),
        }
    }
}

impl Plate {
    /// Its corners; m.
    #[must_use]
    pub fn corners(&self) -> [Vector; 4] {
        let [a, b] = self.edges;
        let corner = self.corner;
        [
            corner,
            add(corner, a),
            add(corner, b),
            add(add(corner, a), b),
        ]
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

    #[inline]
    fn closest_at_rest(&self, place: Vector) -> Closest {
        match *self {
            Self::Plane { point, normal } => {
                let distance = dot(subtract(place, point), normal);
                Closest {
                    point: plus_scaled(place, normal, -distance),
                    normal: scaled(normal, -1.0),
                    distance,
                    inside: true,
                }
            }
            Self::Plate(Plate { corner, edges }) => {
                let (u, v) = along_edges(subtract(place, corner), edges);
                let (s, t, inside) = into_unit_square(u, v, subtract(place, corner), edges);
                let point = plus_scaled(plus_scaled(corner, edges[0], s), edges[1], t);
                towards(place, point, inside, cross(edges[0], edges[1]))
            }
            Self::Cylinder {
                start,
                along,
                radius,
            } => {
                let from = subtract(place, start);
                let share = dot(from, along) / dot(along, along);
                let inside = (0.0..=1.0).contains(&share);
                let axis = plus_scaled(start, along, share.clamp(0.0, 1.0));
                let out = subtract(from, scaled(along, share));
                let size = length(out);
                // On the axis every direction is as good.
                let direction = match size > 0.0 {
                    true => scaled(out, 1.0 / size),
                    false => any_normal(along),
                };
                towards(
                    place,
                    plus_scaled(axis, direction, radius),
                    inside,
                    direction,
                )
            }
            Self::Triangle(corners) => {
                let (point, inside) = closest_of_triangle(place, corners);
                let [a, b, c] = corners;
                towards(place, point, inside, cross(subtract(b, a), subtract(c, a)))
            }
        }
    }
}

/// The direction to a point; along `otherwise` where it is the place itself.
fn towards(place: Vector, point: Vector, inside: bool, otherwise: Vector) -> Closest {
    let to = subtract(point, place);
    let distance = length(to);
    let normal = match distance > 0.0 {
        true => scaled(to, 1.0 / distance),
        false => scaled(otherwise, 1.0 / length(otherwise)),
    };
    Closest {
        point,
        normal,
        distance,
        inside,
    }
}

/// Coordinates along two edges of the foot of a place on their plane.
fn along_edges(from: Vector, [a, b]: [Vector; 2]) -> (f64, f64) {
    let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
    let (ra, rb) = (dot(from, a), dot(from, b));
    let determinant = aa * bb - ab * ab;
    (
        (bb * ra - ab * rb) / determinant,
        (aa * rb - ab * ra) / determinant,
    )
}

/// The closest point of a parallelogram in coordinates of its edges, and whether it is inside.
fn into_unit_square(u: f64, v: f64, from: Vector, edges: [Vector; 2]) -> (f64, f64, bool) {
    if (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v) {
        return (u, v, true);
    }
    // On an edge: the best of the four.
    let [a, b] = edges;
    let mut best = (0.0, 0.0, f64::INFINITY);
    for (start, edge, other) in [(0.0, a, b), (1.0, a, b), (0.0, b, a), (1.0, b, a)] {
        let own = plus_scaled(from, other, -start);
        let share = (dot(own, edge) / dot(edge, edge)).clamp(0.0, 1.0);
        let off = plus_scaled(own, edge, -share);
        let square = dot(off, off);
        if square < best.2 {
            let along_first = edge == a && other == b;
            best = match along_first {
                true => (share, start, square),
                false => (start, share, square),
            };
        }
    }
    (best.0, best.1, false)
}

/// The closest point of a triangle, and whether it is inside.
///
/// # Source
/// Ericson (2005), Real-Time Collision Detection, section 5.1.5 (regions of Voronoi).
fn closest_of_triangle(p: Vector, [a, b, c]: [Vector; 3]) -> (Vector, bool) {
    let (ab, ac, ap) = (subtract(b, a), subtract(c, a), subtract(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, false);
    }
    let bp = subtract(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, false);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (plus_scaled(a, ab, d1 / (d1 - d3)), false);
    }
    let cp = subtract(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, false);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (plus_scaled(a, ac, d2 / (d2 - d6)), false);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (plus_scaled(b, subtract(c, b), share), false);
    }
    let whole = va + vb + vc;
    let point = plus_scaled(plus_scaled(a, ab, vb / whole), ac, vc / whole);
    (point, true)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Vector, b: Vector) {
        assert!(length(subtract(a, b)) < 1e-12, "{a:?} {b:?}");
    }

    #[test]
    fn closed_form_closest_points_of_a_plate() {
        let plate = Facet::Plate(Plate {
            corner: [0.0; 3],
            edges: [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        });
        for (place, point, inside) in [
            ([0.5, 0.5, 3.0], [0.5, 0.5, 0.0], true),
            ([3.0, 0.5, 1.0], [2.0, 0.5, 0.0], false),
            ([3.0, 2.0, -1.0], [2.0, 1.0, 0.0], false),
            ([1.5, -2.0, 0.0], [1.5, 0.0, 0.0], false),
        ] {
            let found = plate.closest(None, place);
            close(found.point, point);
            assert_eq!(found.inside, inside);
            close(plus_scaled(place, found.normal, found.distance), point);
        }
    }

    #[test]
    fn closed_form_closest_points_of_a_triangle_and_a_tube() {
        let triangle = Facet::Triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        close(
            triangle.closest(None, [0.2, 0.2, 1.0]).point,
            [0.2, 0.2, 0.0],
        );
        close(
            triangle.closest(None, [1.0, 1.0, 1.0]).point,
            [0.5, 0.5, 0.0],
        );
        close(triangle.closest(None, [-1.0, -1.0, 1.0]).point, [0.0; 3]);
        let tube = Facet::Cylinder {
            start: [0.0; 3],
            along: [0.0, 0.0, 2.0],
            radius: 1.0,
        };
        close(tube.closest(None, [0.5, 0.0, 1.0]).point, [1.0, 0.0, 1.0]);
        close(tube.closest(None, [3.0, 0.0, 5.0]).point, [1.0, 0.0, 2.0]);
        assert!((tube.closest(None, [0.5, 0.0, 1.0]).distance - 0.5).abs() < 1e-15);
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
