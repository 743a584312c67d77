//! Walls of a scene as faces, for pictures and other programs.

use serde::{Deserialize, Serialize};
use windfall_scene::scene::Scene;
use windfall_scene::shape::wall::{Shape, Wall};
use windfall_scene::vector::{
    Vector, add, cross, dot, length, plus_scaled, scaled, subtract, unit,
};

/// Faces around a cylinder.
const SIDES: usize = 48;

/// Width of the rectangle that stands for an endless plane, over that of the rest of the
/// scene; 1.
const PLANE_REACH: f64 = 1.15;

/// A wall as faces, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct WallGeometry {
    /// What it is.
    pub about: WallAbout,
    /// Its vertices; m.
    pub vertices: Vec<[f32; 3]>,
    /// Numbers of the vertices of each face, in turn.
    pub faces: Vec<u32>,
}

/// A wall without its faces.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct WallAbout {
    /// Name.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Whether it moves.
    pub moves: bool,
    /// Whether it stands for an endless plane.
    pub endless: bool,
    /// Vertices of each face: 3 or 4.
    pub corners: usize,
    /// Number of its vertices.
    pub vertices: usize,
    /// Number of its faces.
    pub faces: usize,
}

/// A box of space; m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct Bounds {
    /// Its lowest corner.
    #[schema(value_type = (f64, f64, f64))]
    pub low: [f64; 3],
    /// Its highest corner.
    #[schema(value_type = (f64, f64, f64))]
    pub high: [f64; 3],
}

impl Bounds {
    /// The smallest box around points; one of no size at the origin where there are none.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vector>) -> Self {
        let empty = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (low, high) = points.into_iter().fold(empty, |(low, high), point| {
            (
                std::array::from_fn(|k| low[k].min(point[k])),
                std::array::from_fn(|k| high[k].max(point[k])),
            )
        });
        match low.iter().chain(&high).all(|end| end.is_finite()) {
            true => Self { low, high },
            false => Self {
                low: [0.0; 3],
                high: [0.0; 3],
            },
        }
    }

    /// Its middle; m.
    #[must_use]
    pub fn middle(&self) -> Vector {
        scaled(add(self.low, self.high), 0.5)
    }

    /// Its diagonal; m.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        length(subtract(self.high, self.low))
    }

    /// Its width along a direction of length 1; m.
    #[must_use]
    pub fn width(&self, along: Vector) -> f64 {
        let sides = subtract(self.high, self.low);
        (0..3).map(|k| (sides[k] * along[k]).abs()).sum()
    }

    /// Whether a point lies inside the box widened by `beyond` (m) on every side.
    #[must_use]
    pub fn holds(&self, point: Vector, beyond: f64) -> bool {
        (0..3).all(|k| point[k] >= self.low[k] - beyond && point[k] <= self.high[k] + beyond)
    }
}

/// The walls of a scene as faces, and the box around all that has an end: walls at rest, and
/// the places at which fruit come.
#[must_use]
pub fn geometry_of(scene: &Scene) -> (Vec<WallGeometry>, Bounds) {
    let mut points: Vec<Vector> = Vec::new();
    for fruit in &scene.fruit {
        for side in [-fruit.radius, fruit.radius] {
            points.push(fruit.place.map(|own| own + side));
        }
    }
    for wall in &scene.walls {
        if let Shape::Plane { point, normal } = wall.shape {
            // What falls on it lies on it in the end.
            let feet = points.iter().map(|own| {
                let height = dot(subtract(*own, point), normal);
                plus_scaled(*own, normal, -height)
            });
            points = points.iter().copied().chain(feet).collect();
        } else {
            points.extend(faces_of(&wall.shape, None).0);
        }
    }
    let bounds = Bounds::around(points);
    let walls = scene.walls.iter();
    let walls = walls.map(|wall| geometry(scene, wall, &bounds)).collect();
    (walls, bounds)
}

fn geometry(scene: &Scene, wall: &Wall, bounds: &Bounds) -> WallGeometry {
    let (vertices, faces, corners) = faces_of(&wall.shape, Some(bounds));
    WallGeometry {
        about: WallAbout {
            name: wall.name.clone(),
            material: scene.materials[wall.material].clone(),
            moves: !wall.motion.stays(),
            endless: matches!(wall.shape, Shape::Plane { .. }),
            corners,
            vertices: vertices.len(),
            faces: faces.len() / corners,
        },
        vertices: vertices.iter().map(|own| own.map(|x| x as f32)).collect(),
        faces,
    }
}

/// Vertices, faces, and vertices of each face.
///
/// * `bounds`: what the rectangle for an endless plane is to reach around
fn faces_of(shape: &Shape, bounds: Option<&Bounds>) -> (Vec<Vector>, Vec<u32>, usize) {
    match shape {
        Shape::Plane { point, normal } => {
            let middle = bounds.map_or(*point, Bounds::middle);
            let height = dot(subtract(middle, *point), *normal);
            let foot = plus_scaled(middle, *normal, -height);
            let (a, b) = across(*normal);
            let half = [a, b].map(|axis| {
                let width = bounds.map_or(1.0, |own| own.width(axis));
                0.5 * PLANE_REACH * width.max(f64::MIN_POSITIVE)
            });
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let corners = corners.map(|(s, t)| {
                let along = plus_scaled(foot, a, s * half[0]);
                plus_scaled(along, b, t * half[1])
            });
            (corners.to_vec(), vec![0, 1, 2, 3], 4)
        }
        Shape::Plates(plates) => {
            let mut vertices = Vec::new();
            let mut faces = Vec::new();
            for plate in plates {
                let first = vertices.len() as u32;
                vertices.extend(plate.corners());
                faces.extend([0, 1, 3, 2].map(|own| first + own));
            }
            (vertices, faces, 4)
        }
        Shape::Cylinder { start, end, radius } => {
            let along = unit(subtract(*end, *start)).unwrap_or([0.0, 0.0, 1.0]);
            let (a, b) = across(along);
            let mut vertices = Vec::new();
            for side in 0..SIDES {
                let angle = std::f64::consts::TAU * side as f64 / SIDES as f64;
                let out = plus_scaled(scaled(a, radius * angle.cos()), b, radius * angle.sin());
                vertices.extend([add(*start, out), add(*end, out)]);
            }
            let all = 2 * SIDES as u32;
            let faces = (0..SIDES as u32).flat_map(|side| {
                let own = 2 * side;
                [own, own + 1, (own + 3) % all, (own + 2) % all]
            });
            (vertices, faces.collect(), 4)
        }
        Shape::Mesh { triangles } => {
            let vertices: Vec<Vector> = triangles.iter().flatten().copied().collect();
            let faces = (0..vertices.len() as u32).collect();
            (vertices, faces, 3)
        }
    }
}

/// Two directions across a direction of length 1.
fn across(along: Vector) -> (Vector, Vector) {
    let least = (0..3).min_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs()));
    let mut axis = [0.0; 3];
    axis[least.unwrap_or(0)] = 1.0;
    let a = unit(cross(along, axis)).unwrap_or([1.0, 0.0, 0.0]);
    (a, cross(along, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(vertices: &[Vector], faces: &[u32], corners: usize) -> f64 {
        let at = |own: u32| vertices[own as usize];
        let face = |own: &[u32]| {
            let fan = (1..corners - 1).map(|k| {
                let edges = [k, k + 1].map(|k| subtract(at(own[k]), at(own[0])));
                0.5 * length(cross(edges[0], edges[1]))
            });
            fan.sum::<f64>()
        };
        faces.chunks_exact(corners).map(face).sum()
    }

    #[test]
    fn closed_form_areas_of_faces() {
        let cylinder = Shape::Cylinder {
            start: [0.1, 0.2, 0.3],
            end: [1.1, 0.2, 0.3],
            radius: 0.5,
        };
        let (vertices, faces, corners) = faces_of(&cylinder, None);
        // A prism of 48 sides: its girth is 2 n r sin(π/n).
        let girth = 48.0 * (std::f64::consts::PI / 48.0).sin();
        assert!((area(&vertices, &faces, corners) - girth).abs() < 1e-12);
        let plate = windfall_scene::shape::wall::Plate {
            corner: [0.0; 3],
            edges: [[2.0, 0.0, 0.0], [0.5, 3.0, 0.0]],
        };
        let (vertices, faces, corners) = faces_of(&Shape::Plates(vec![plate; 2]), None);
        assert!((area(&vertices, &faces, corners) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn closed_form_the_rectangle_for_a_plane_lies_on_it_around_the_scene() {
        let bounds = Bounds::around([[0.0; 3], [1.0, 2.0, 2.0]]);
        assert!((bounds.diagonal() - 3.0).abs() < 1e-15);
        let normal = unit([1.0, 0.0, 2.0]).unwrap();
        let point = [0.0, 0.0, -1.0];
        let (vertices, _, _) = faces_of(&Shape::Plane { point, normal }, Some(&bounds));
        for vertex in &vertices {
            assert!(dot(subtract(*vertex, point), normal).abs() < 1e-12);
        }
        let (a, b) = (
            subtract(vertices[1], vertices[0]),
            subtract(vertices[3], vertices[0]),
        );
        // Along the slope 1 · 2/√5 + 2 · 1/√5, across it 2.
        let slope = 1.15 * 4.0 / 5.0_f64.sqrt();
        assert!((length(a) - slope).abs() < 1e-12 && (length(b) - 2.3).abs() < 1e-12);
        assert!(dot(a, b).abs() < 1e-12);
    }
}
