//! Walls of a scene as faces, for pictures and other programs.

use serde::{Deserialize, Serialize};
use windfall_scene::scene::Scene;
use windfall_scene::shape::surface::{Faces, Shape};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, add, dot, length, plus_scaled, scaled, subtract};

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
    pub fn middle(&self) -> Vector {
        scaled(add(self.low, self.high), 0.5)
    }

    /// Its diagonal; m.
    pub fn diagonal(&self) -> f64 {
        length(subtract(self.high, self.low))
    }

    pub fn corners(&self) -> Vec<Vector> {
        let corner = |number: usize| {
            std::array::from_fn(|k| match number >> k & 1 {
                0 => self.low[k],
                _ => self.high[k],
            })
        };
        (0..8).map(corner).collect()
    }

    /// Whether a point lies inside the box widened by `beyond` (m) on every side.
    pub fn holds(&self, point: Vector, beyond: f64) -> bool {
        (0..3).all(|k| point[k] >= self.low[k] - beyond && point[k] <= self.high[k] + beyond)
    }
}

/// Points that are followed one by one.
const MOST_POINTS: usize = 1 << 16;

/// The walls of a scene as faces, and the box around all that has an end: walls at rest, and
/// the places at which fruit come; along a periodic axis from end to end.
pub fn geometry_of(scene: &Scene) -> (Vec<WallGeometry>, Bounds) {
    let mut points: Vec<Vector> = Vec::new();
    for fruit in &scene.fruit {
        for side in [-fruit.radius, fruit.radius] {
            points.push(fruit.place.map(|own| own + side));
        }
    }
    for wall in &scene.walls {
        if let Shape::Plane { point, normal } = wall.shape {
            // Every plane doubles the points: of many their box is enough.
            if points.len() > MOST_POINTS {
                points = Bounds::around(points).corners();
            }
            // What falls on it lies on it in the end.
            let feet = points.iter().map(|own| {
                let height = dot(subtract(*own, point), normal);
                plus_scaled(*own, normal, -height)
            });
            points = points.iter().copied().chain(feet).collect();
        } else {
            points.extend(wall.shape.faces([[0.0; 3]; 2]).vertices);
        }
    }
    let mut bounds = Bounds::around(points);
    for (axis, ends) in scene.periodic.iter().enumerate() {
        // Fruit come everywhere between the ends.
        if let Some([low, high]) = ends {
            bounds.low[axis] = bounds.low[axis].min(*low);
            bounds.high[axis] = bounds.high[axis].max(*high);
        }
    }
    let walls = scene.walls.iter();
    let walls = walls.map(|wall| geometry(scene, wall, &bounds)).collect();
    (walls, bounds)
}

fn geometry(scene: &Scene, wall: &Wall, bounds: &Bounds) -> WallGeometry {
    let Faces {
        vertices,
        faces,
        corners,
    } = wall.shape.faces([bounds.low, bounds.high]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_scene::vector::{cross, unit};

    fn area(shape: &Shape) -> f64 {
        let Faces {
            vertices,
            faces,
            corners,
        } = shape.faces([[0.0; 3]; 2]);
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
        // A prism of 48 sides: its girth is 2 n r sin(π/n).
        let girth = 48.0 * (std::f64::consts::PI / 48.0).sin();
        assert!((area(&cylinder) - girth).abs() < 1e-12);
        let plate = windfall_scene::shape::surface::Plate {
            corner: [0.0; 3],
            edges: [[2.0, 0.0, 0.0], [0.5, 3.0, 0.0]],
        };
        assert!((area(&Shape::Plates(vec![plate; 2])) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn closed_form_the_rectangle_for_a_plane_lies_on_it_around_the_scene() {
        let bounds = Bounds::around([[0.0; 3], [1.0, 2.0, 2.0]]);
        assert!((bounds.diagonal() - 3.0).abs() < 1e-15);
        let normal = unit([1.0, 0.0, 2.0]).unwrap();
        let point = [0.0, 0.0, -1.0];
        let plane = Shape::Plane { point, normal };
        let vertices = plane.faces([bounds.low, bounds.high]).vertices;
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

    #[test]
    fn closed_form_a_box_around_hundreds_of_planes() {
        let plane = |number: usize| Wall {
            name: "floor".into(),
            material: 0,
            shape: Shape::Plane {
                point: [0.0, 0.0, -(number as f64)],
                normal: [0.0, 0.0, 1.0],
            },
            motion: windfall_scene::shape::motion::Motion::default(),
        };
        let scene = Scene {
            materials: vec!["steel".into()],
            fruit: vec![windfall_scene::scene::Fruit::sphere(
                0, 0.5, 1000.0, [0.0; 3],
            )],
            walls: (0..300).map(plane).collect(),
            ..Scene::default()
        };
        let (walls, bounds) = geometry_of(&scene);
        assert_eq!(walls.len(), 300);
        assert_eq!((bounds.low, bounds.high), ([-0.5, -0.5, -299.0], [0.5; 3]));
    }
}
