//! Whether the fruit of a scene have room between its walls where they come in, and whether
//! two walls lie on each other.

use crate::contacts::wall_contacts::WallState;
use crate::scene::Scene;
use crate::shape::surface::{Facet, Shape};
use crate::shape::wall::Wall;
use crate::vector::{Vector, cross, dot, length, plus_scaled, subtract};

/// A fruit that comes in where a wall is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InWall {
    /// The fruit, by its place in the scene.
    pub fruit: usize,
    /// The wall, by its number.
    pub wall: usize,
    /// By how much it overlaps; m.
    pub overlap: f64,
}

/// Two walls that lie on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubled {
    /// The walls, by their numbers.
    pub walls: [usize; 2],
    /// A place where they do; m.
    pub place: Vector,
}

/// Overlap over the radius that fruit may have where they come in; 1.
const ROOM: f64 = 0.01;

/// The first fruit that comes in where a wall is at that time.
pub fn first_in_wall(scene: &Scene) -> Option<InWall> {
    let mut walls = WallState::new(scene);
    let periods = scene.periods();
    let mut near = Vec::new();
    scene.fruit.iter().enumerate().find_map(|(number, fruit)| {
        walls.move_to(&scene.walls, fruit.time, 0.0);
        near.clear();
        let room = (1.0 - ROOM) * fruit.radius;
        let place = periods.wrapped(fruit.place);
        walls.find_near(place, room, &mut near);
        let overlaps = |&facet: &u32| {
            let distance = walls.closest(facet, place).distance;
            (distance < room).then(|| InWall {
                fruit: number,
                wall: walls.facets[facet as usize].0 as usize,
                overlap: fruit.radius - distance,
            })
        };
        let found = near.iter().filter_map(overlaps);
        found.max_by(|a, b| a.overlap.total_cmp(&b.overlap))
    })
}

/// Walls closer than this part of the smallest radius lie on each other, 1, ...
const APART: f64 = 0.01;
/// ... where the angle of their normals has a sine below this.
const PARALLEL: f64 = 0.01;

/// The first two walls that lie on each other at the beginning: a fruit there would feel
/// both, as if the wall were twice as stiff.
///
/// Plates and cylinders are looked at in a grid of places, meshes in the middle of each
/// triangle: walls that overlap by less than that are not found. Faces that no fruit can
/// touch, as where two solid parts are joined, do not count.
pub fn first_doubled(scene: &Scene) -> Option<Doubled> {
    let radii = scene.fruit.iter().map(|fruit| fruit.radius);
    let smallest = radii.fold(f64::INFINITY, f64::min);
    if !smallest.is_finite() {
        return None;
    }
    let mut walls = WallState::new(scene);
    walls.move_to(&scene.walls, 0.0, 0.0);
    let mut near = Vec::new();
    for (number, wall) in scene.walls.iter().enumerate() {
        for (place, normal) in wall.shape.facets().iter().flat_map(Facet::places) {
            // From a little above: the other must lie as far below.
            let height = 0.25 * smallest;
            let (place, normal) = walls.moved(number, place, normal);
            let above = plus_scaled(place, normal, height);
            near.clear();
            walls.find_near(above, 2.0 * height, &mut near);
            let mut double = None;
            for &facet in &near {
                let other = walls.facets[facet as usize].0 as usize;
                let found = walls.closest(facet, above);
                let close = (found.distance.abs() - height).abs() < APART * smallest;
                let along = length(cross(found.normal, normal)) < PARALLEL;
                let there = length(subtract(found.point, place)) < APART * smallest;
                if other != number && found.inside && close && along && there {
                    double = Some(other);
                }
            }
            if let Some(other) = double
                && touchable(&walls, place, normal, smallest)
            {
                return Some(Doubled {
                    walls: [number.min(other), number.max(other)],
                    place,
                });
            }
        }
    }
    doubled_planes(&scene.walls, APART * smallest)
}

/// Whether a sphere has room on either side of a place of a wall.
fn touchable(walls: &WallState, place: Vector, normal: Vector, radius: f64) -> bool {
    [radius, -radius].into_iter().any(|side| {
        let mut near = Vec::new();
        let centre = plus_scaled(place, normal, side);
        walls.find_near(centre, (1.0 - TIGHT) * radius, &mut near);
        near.is_empty()
    })
}

/// So much of its radius a sphere may lack room; 1.
const TIGHT: f64 = 0.1;

/// Planes have no end, and no places to look at: two of them are compared as a whole.
fn doubled_planes(walls: &[Wall], apart: f64) -> Option<Doubled> {
    let planes = walls.iter().enumerate().filter_map(|(number, wall)| {
        let Shape::Plane { point, normal } = wall.shape else {
            return None;
        };
        Some((number, point, normal))
    });
    let planes: Vec<(usize, Vector, Vector)> = planes.collect();
    for (place, &(first, point, normal)) in planes.iter().enumerate() {
        for &(second, other, across) in &planes[place + 1..] {
            let along = length(cross(normal, across)) < PARALLEL * PARALLEL;
            if along && dot(subtract(other, point), normal).abs() < apart {
                return Some(Doubled {
                    walls: [first, second],
                    place: point,
                });
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Fruit;
    use crate::shape::motion::{How, Motion};
    use crate::shape::surface::Plate;

    fn scene(shapes: Vec<Shape>) -> Scene {
        let wall = |shape| Wall {
            name: "wall".to_owned(),
            material: 0,
            shape,
            motion: Motion::default(),
        };
        Scene {
            walls: shapes.into_iter().map(wall).collect(),
            fruit: vec![Fruit::sphere(0, 0.04, 840.0, [0.5, 0.5, 0.5])],
            ..Scene::default()
        }
    }

    /// A level plate of 1 m at a height.
    fn level(height: f64) -> Plate {
        Plate {
            corner: [0.0, 0.0, height],
            edges: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }

    #[test]
    fn walls_on_each_other_are_found_where_fruit_can_touch_them() {
        let plates = |heights: &[f64]| Shape::Plates(heights.iter().copied().map(level).collect());
        let found = |shapes| first_doubled(&scene(shapes)).map(|own| own.walls);
        assert_eq!(found(vec![plates(&[0.0]), plates(&[1e-4])]), Some([0, 1]));
        assert_eq!(found(vec![plates(&[0.0]), plates(&[1e-2])]), None);
        // Two slabs of 10 mm, one on the other.
        assert_eq!(
            found(vec![plates(&[0.0, 0.01]), plates(&[0.01, 0.02])]),
            None
        );
        let plane = |height: f64, up: f64| Shape::Plane {
            point: [3.0, 3.0, height],
            normal: [0.0, 0.0, up],
        };
        assert_eq!(
            found(vec![plane(0.0, 1.0), plates(&[1.0, 0.0])]),
            Some([0, 1])
        );
        assert_eq!(found(vec![plane(0.0, 1.0), plane(1e-5, 1.0)]), Some([0, 1]));
        assert_eq!(found(vec![plane(0.0, 1.0), plane(2.0, -1.0)]), None);
        let tube = |radius: f64| Shape::Cylinder {
            start: [0.0; 3],
            end: [0.0, 0.0, 1.0],
            radius,
        };
        assert_eq!(found(vec![tube(0.3), tube(0.3001)]), Some([0, 1]));
        assert_eq!(found(vec![tube(0.3), tube(0.35), plates(&[0.0])]), None);
    }

    #[test]
    fn fruit_in_walls_are_found_when_they_come() {
        let mut own = scene(vec![Shape::Plates(vec![level(0.0)])]);
        assert_eq!(first_in_wall(&own), None);
        own.fruit[0].place[2] = 0.03;
        let found = first_in_wall(&own).map(|own| (own.fruit, own.wall));
        assert_eq!(found, Some((0, 0)));
        // Touching is well; a wall that has moved there by then is not.
        own.fruit[0].place[2] = 0.0399;
        assert_eq!(first_in_wall(&own), None);
        own.walls[0].motion = Motion::always([How::Velocity([0.0, 0.0, 0.1])]);
        assert_eq!(first_in_wall(&own), None);
        own.fruit[0].time = 0.2;
        assert!(first_in_wall(&own).is_some_and(|own| (own.overlap - 0.0201).abs() < 1e-12));
    }
}
