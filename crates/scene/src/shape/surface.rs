//! Surfaces of walls: all that is known of each kind is here.

use crate::vector::{
    Vector, add, any_normal, cross, dot, length, plus_scaled, scaled, subtract, unit,
};

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

/// Faces around a cylinder.
const SIDES: usize = 48;
/// Width of the rectangle that stands for an endless plane, over that of the rest of the
/// scene; 1.
const PLANE_REACH: f64 = 1.15;

/// A surface as faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Vertices; m.
    pub vertices: Vec<Vector>,
    /// Numbers of the vertices of each face, in turn.
    pub faces: Vec<u32>,
    /// Vertices of each face: 3 or 4.
    pub corners: usize,
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

    /// Points that it lies around, and how far from them it reaches; m. Infinitely far for a
    /// plane.
    pub fn skeleton(&self) -> (Vec<Vector>, f64) {
        match self {
            Self::Plane { point, .. } => (vec![*point], f64::INFINITY),
            Self::Plates(plates) => (plates.iter().flat_map(Plate::corners).collect(), 0.0),
            Self::Cylinder { start, end, radius } => (vec![*start, *end], *radius),
            Self::Mesh { triangles } => (triangles.as_flattened().to_vec(), 0.0),
        }
    }

    /// The surface as faces; of an endless plane a rectangle.
    ///
    /// * `around`: lowest and highest corner of the box that the rectangle reaches around; m
    pub fn faces(&self, around: [Vector; 2]) -> Faces {
        let (vertices, faces, corners) = match self {
            Self::Plane { point, normal } => {
                (rectangle(*point, *normal, around), vec![0, 1, 2, 3], 4)
            }
            Self::Plates(plates) => {
                let first = (0..plates.len() as u32).map(|own| 4 * own);
                let faces = first.flat_map(|first| [0, 1, 3, 2].map(|own| first + own));
                (self.skeleton().0, faces.collect(), 4)
            }
            Self::Cylinder { start, end, radius } => {
                let along = unit(subtract(*end, *start)).unwrap_or([0.0, 0.0, 1.0]);
                let a = any_normal(along);
                let b = cross(along, a);
                let vertices = (0..SIDES).flat_map(|side| {
                    let angle = std::f64::consts::TAU * side as f64 / SIDES as f64;
                    let out = scaled(a, radius * angle.cos());
                    let out = plus_scaled(out, b, radius * angle.sin());
                    [add(*start, out), add(*end, out)]
                });
                let all = 2 * SIDES as u32;
                let faces = (0..SIDES as u32).flat_map(|side| {
                    let own = 2 * side;
                    [own, own + 1, (own + 3) % all, (own + 2) % all]
                });
                (vertices.collect(), faces.collect(), 4)
            }
            Self::Mesh { triangles } => {
                let count = 3 * triangles.len() as u32;
                (self.skeleton().0, (0..count).collect(), 3)
            }
        };
        Faces {
            vertices,
            faces,
            corners,
        }
    }

    /// What a curved surface is called: R* on it depends on its radius.
    pub fn curved(&self) -> Option<&'static str> {
        match self {
            Self::Cylinder { .. } => Some("cylinder"),
            Self::Plane { .. } | Self::Plates(_) | Self::Mesh { .. } => None,
        }
    }

    /// Corners of the box around it; none of a plane, which has no end.
    pub fn corners(&self) -> Vec<Vector> {
        match self.skeleton() {
            (_, f64::INFINITY) => Vec::new(),
            (points, 0.0) => points,
            (points, reach) => {
                let both = |own: Vector| [own.map(|at| at - reach), own.map(|at| at + reach)];
                points.into_iter().flat_map(both).collect()
            }
        }
    }
}

/// A rectangle of a plane that reaches around a box.
fn rectangle(point: Vector, normal: Vector, [low, high]: [Vector; 2]) -> Vec<Vector> {
    let middle = scaled(add(low, high), 0.5);
    let foot = plus_scaled(middle, normal, -dot(subtract(middle, point), normal));
    let a = any_normal(normal);
    let sides = [a, cross(normal, a)].map(|axis| {
        let width: f64 = (0..3).map(|k| ((high[k] - low[k]) * axis[k]).abs()).sum();
        scaled(axis, 0.5 * PLANE_REACH * width.max(f64::MIN_POSITIVE))
    });
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(s, t)| plus_scaled(plus_scaled(foot, sides[0], s), sides[1], t);
    corners.map(corner).to_vec()
}

impl Plate {
    /// Its corners; m.
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

#[inline(always)]
fn closest_of_plane(point: Vector, normal: Vector, place: Vector) -> Closest {
    let distance = dot(subtract(place, point), normal);
    Closest {
        point: plus_scaled(place, normal, -distance),
        normal: scaled(normal, -1.0),
        distance,
        inside: true,
    }
}

/// Places looked at along each edge of a plate, around and along a cylinder.
const PLACES: usize = 12;

impl Facet {
    /// The closest point of the facet where its wall is at rest.
    #[inline(always)]
    pub(crate) fn closest_at_rest(&self, place: Vector) -> Closest {
        // Of a plane it is known before others are told apart: in registers, not in memory.
        match *self {
            Self::Plane { point, normal } => closest_of_plane(point, normal, place),
            _ => self.closest_of_other(place),
        }
    }

    fn closest_of_other(&self, place: Vector) -> Closest {
        match *self {
            Self::Plane { point, normal } => closest_of_plane(point, normal, place),
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
    /// Places all over it, with the normals there; none of a plane, which has no end.
    pub(crate) fn places(&self) -> Vec<(Vector, Vector)> {
        let shares = || (0..PLACES).map(|place| (place as f64 + 0.5) / PLACES as f64);
        let mut all = Vec::new();
        match *self {
            Self::Plane { .. } => {}
            Self::Plate(Plate { corner, edges }) => {
                let across = cross(edges[0], edges[1]);
                let normal = scaled(across, 1.0 / length(across));
                for s in shares() {
                    let from = plus_scaled(corner, edges[0], s);
                    all.extend(shares().map(|t| (plus_scaled(from, edges[1], t), normal)));
                }
            }
            Self::Cylinder {
                start,
                along,
                radius,
            } => {
                let out = any_normal(along);
                let other = scaled(cross(along, out), 1.0 / length(along));
                for turn in shares() {
                    let (s, c) = (std::f64::consts::TAU * turn).sin_cos();
                    let normal = plus_scaled(scaled(out, c), other, s);
                    let from = plus_scaled(start, normal, radius);
                    all.extend(shares().map(|t| (plus_scaled(from, along, t), normal)));
                }
            }
            Self::Triangle([a, b, c]) => {
                let across = cross(subtract(b, a), subtract(c, a));
                let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
                all.push((middle, scaled(across, 1.0 / length(across))));
            }
        }
        all
    }

    /// Whether its normal is the same all over it.
    pub(crate) fn is_flat(&self) -> bool {
        !matches!(self, Self::Cylinder { .. })
    }

    /// R* of a fruit on it; m. Edges count as flat.
    pub(crate) fn effective_radius(&self, radius: f64, centre: Vector) -> f64 {
        match *self {
            Self::Plane { .. } | Self::Plate(_) | Self::Triangle(_) => radius,
            Self::Cylinder {
                start,
                along,
                radius: tube,
            } => {
                let from = subtract(centre, start);
                let out = plus_scaled(from, along, -dot(from, along) / dot(along, along));
                // Of a sphere against a cylinder, by the mean of the two curvatures.
                let sign = if length(out) < tube { -1.0 } else { 1.0 };
                1.0 / (1.0 / radius + sign * 0.5 / tube)
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
            let found = plate.closest_at_rest(place);
            close(found.point, point);
            assert_eq!(found.inside, inside);
            close(plus_scaled(place, found.normal, found.distance), point);
        }
    }

    #[test]
    fn closed_form_closest_points_of_a_triangle_and_a_tube() {
        let triangle = Facet::Triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        close(
            triangle.closest_at_rest([0.2, 0.2, 1.0]).point,
            [0.2, 0.2, 0.0],
        );
        close(
            triangle.closest_at_rest([1.0, 1.0, 1.0]).point,
            [0.5, 0.5, 0.0],
        );
        close(triangle.closest_at_rest([-1.0, -1.0, 1.0]).point, [0.0; 3]);
        let tube = Facet::Cylinder {
            start: [0.0; 3],
            along: [0.0, 0.0, 2.0],
            radius: 1.0,
        };
        close(tube.closest_at_rest([0.5, 0.0, 1.0]).point, [1.0, 0.0, 1.0]);
        close(tube.closest_at_rest([3.0, 0.0, 5.0]).point, [1.0, 0.0, 2.0]);
        assert!((tube.closest_at_rest([0.5, 0.0, 1.0]).distance - 0.5).abs() < 1e-15);
    }
}
