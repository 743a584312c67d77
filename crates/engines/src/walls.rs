//! Shapes of walls in the terms of engines: regions for LAMMPS, triangles for LIGGGHTS.

use crate::deck::{sides, triple};
use windfall_scene::shape::surface::{Plate, Shape};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, cross, dot, length, scaled, subtract};

/// The surface of a wall as a region of space.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Everything on one side of a plane.
    Plane {
        /// A point of it; m.
        point: Vector,
        /// Towards the inside; length 1.
        normal: Vector,
    },
    /// A block of which only some faces are there.
    Block {
        /// Lowest corner; m.
        low: Vector,
        /// Highest corner; m.
        high: Vector,
        /// Whether a face is left out: low and high x, low and high y, low and high z.
        open: [bool; 6],
        /// How it is turned.
        tilt: Option<Tilt>,
    },
    /// The side of a cylinder.
    Cylinder {
        /// Its axis: 0, 1 or 2.
        axis: usize,
        /// A point of the axis; m.
        centre: Vector,
        /// Radius; m.
        radius: f64,
        /// Both ends along the axis; m.
        ends: [f64; 2],
        /// How it is turned.
        tilt: Option<Tilt>,
    },
}

/// A turn about an axis through a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// A point of the axis; m.
    pub point: Vector,
    /// Direction of the axis; length 1.
    pub axis: Vector,
    /// Angle; rad.
    pub angle: f64,
}

/// Cosines below which directions are at right angles, and sizes that count as zero over
/// those beside them; 1.
const FLAT: f64 = 1e-9;

/// A wall as a region.
///
/// # Errors
/// Why it cannot be one.
pub fn region_of(wall: &Wall) -> Result<Region, String> {
    match &wall.shape {
        Shape::Plane { point, normal } => Ok(Region::Plane {
            point: *point,
            normal: *normal,
        }),
        Shape::Plates(plates) => match &plates[..] {
            [plate] => of_plate(plate),
            plates => of_box(plates).ok_or_else(|| {
                "plates that are not the sides of one box along the axes".to_owned()
            }),
        },
        Shape::Cylinder { start, end, radius } => Ok(of_cylinder(*start, *end, *radius)),
        Shape::Mesh { .. } => Err("a mesh of triangles".to_owned()),
    }
}

impl Region {
    /// How it is turned.
    pub fn tilt(&self) -> Option<Tilt> {
        match self {
            Self::Plane { .. } => None,
            Self::Block { tilt, .. } | Self::Cylinder { tilt, .. } => *tilt,
        }
    }

    /// Its words in a deck for LAMMPS, without its motion.
    pub fn words(&self) -> String {
        match self {
            Self::Plane { point, normal } => {
                format!("plane {} {} side in", triple(*point), triple(*normal))
            }
            Self::Block {
                low, high, open, ..
            } => {
                let open = open.iter().enumerate().filter(|(_, open)| **open);
                let open: String = open
                    .map(|(face, _)| format!(" open {}", face + 1))
                    .collect();
                format!("block {}{open}", sides(*low, *high))
            }
            Self::Cylinder {
                axis,
                centre,
                radius,
                ends: [low, high],
                ..
            } => {
                let across = (0..3).filter(|other| other != axis);
                let across: String = across.map(|other| format!("{} ", centre[other])).collect();
                let axis = ["x", "y", "z"][*axis];
                format!("cylinder {axis} {across}{radius} {low} {high} open 1 open 2")
            }
        }
    }
}

/// A surface as triangles, for LIGGGHTS; endless planes are its primitives.
///
/// # Errors
/// Why it cannot be triangles.
pub fn triangles_of(shape: &Shape) -> Result<Vec<[Vector; 3]>, String> {
    match shape {
        Shape::Plates(plates) => Ok(plates.iter().flat_map(halves).collect()),
        Shape::Mesh { triangles } => Ok(triangles.clone()),
        Shape::Plane { .. } => Err("no mesh".to_owned()),
        Shape::Cylinder { .. } => {
            Err("a cylinder: as a mesh it would have edges that fruit touch twice".to_owned())
        }
    }
}

/// A plate as two triangles.
fn halves(plate: &Plate) -> [[Vector; 3]; 2] {
    let [a, b, c, d] = plate.corners();
    [[a, b, d], [a, d, c]]
}

/// The axis along which a vector goes, if it goes along one.
fn axis_of(own: Vector) -> Option<usize> {
    let size = length(own);
    (0..3).find(|&axis| (0..3).all(|other| other == axis || own[other].abs() <= FLAT * size))
}

/// Which axis a plate stands across, and its lowest and highest corner.
fn along_axes(plate: &Plate) -> Option<(usize, Vector, Vector)> {
    let [a, b] = plate.edges.map(axis_of);
    let (a, b) = (a?, b?);
    if a == b {
        return None;
    }
    let corners = plate.corners();
    let reach = |axis: usize, pick: fn(f64, f64) -> f64| {
        let all = corners.iter().map(|own| own[axis]);
        all.reduce(pick).unwrap_or(0.0)
    };
    let low = [0, 1, 2].map(|axis| reach(axis, f64::min));
    let high = [0, 1, 2].map(|axis| reach(axis, f64::max));
    Some((3 - a - b, low, high))
}

fn of_plate(plate: &Plate) -> Result<Region, String> {
    let [a, b] = plate.edges;
    let thick = length(a).max(length(b));
    if let Some((axis, low, mut high)) = along_axes(plate) {
        high[axis] = low[axis] + thick;
        let mut open = [true; 6];
        open[2 * axis] = false;
        return Ok(Region::Block {
            low,
            high,
            open,
            tilt: None,
        });
    }
    if dot(a, b).abs() > FLAT * length(a) * length(b) {
        return Err("a plate whose edges are not at right angles".to_owned());
    }
    let along = [a, b].map(|own| scaled(own, 1.0 / length(own)));
    let corner = plate.corner;
    let size = [length(a), length(b), thick];
    Ok(Region::Block {
        low: corner,
        high: [0, 1, 2].map(|axis| corner[axis] + size[axis]),
        open: [true, true, true, true, false, true],
        tilt: tilt_of([along[0], along[1], cross(along[0], along[1])], corner),
    })
}

/// The turn that takes the axes to three directions.
fn tilt_of([x, y, z]: [Vector; 3], point: Vector) -> Option<Tilt> {
    // As a quaternion, whose largest part is taken first: Shepperd (1978).
    let trace = x[0] + y[1] + z[2];
    let squares = [
        1.0 + trace,
        1.0 + 2.0 * x[0] - trace,
        1.0 + 2.0 * y[1] - trace,
        1.0 + 2.0 * z[2] - trace,
    ];
    let largest = (0..4).max_by(|&a, &b| squares[a].total_cmp(&squares[b]))?;
    let q = match largest {
        0 => [squares[0], y[2] - z[1], z[0] - x[2], x[1] - y[0]],
        1 => [y[2] - z[1], squares[1], x[1] + y[0], z[0] + x[2]],
        2 => [z[0] - x[2], x[1] + y[0], squares[2], y[2] + z[1]],
        _ => [x[1] - y[0], z[0] + x[2], y[2] + z[1], squares[3]],
    };
    let direction = [q[1], q[2], q[3]];
    let sine = length(direction);
    (sine > 0.0).then(|| Tilt {
        point,
        axis: scaled(direction, 1.0 / sine),
        angle: 2.0 * sine.atan2(q[0]),
    })
}

/// Sides of a box along the axes, each at most once.
fn of_box(plates: &[Plate]) -> Option<Region> {
    let sides: Vec<_> = plates.iter().map(along_axes).collect::<Option<_>>()?;
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for (_, from, to) in &sides {
        for axis in 0..3 {
            low[axis] = low[axis].min(from[axis]);
            high[axis] = high[axis].max(to[axis]);
        }
    }
    let mut open = [true; 6];
    for (across, from, to) in &sides {
        let whole = |axis: usize| {
            let part = FLAT * (high[axis] - low[axis]);
            (from[axis] - low[axis]).abs() <= part && (to[axis] - high[axis]).abs() <= part
        };
        let end = match (
            from[*across] == low[*across],
            from[*across] == high[*across],
        ) {
            (true, false) => 0,
            (false, true) => 1,
            _ => return None,
        };
        let face = &mut open[2 * across + end];
        if !(0..3).all(|axis| axis == *across || whole(axis)) || !*face {
            return None;
        }
        *face = false;
    }
    Some(Region::Block {
        low,
        high,
        open,
        tilt: None,
    })
}

fn of_cylinder(start: Vector, end: Vector, radius: f64) -> Region {
    let along = subtract(end, start);
    if let Some(axis) = axis_of(along) {
        let ends = [start[axis].min(end[axis]), start[axis].max(end[axis])];
        return Region::Cylinder {
            axis,
            centre: start,
            radius,
            ends,
            tilt: None,
        };
    }
    let z = scaled(along, 1.0 / length(along));
    let least = match z[0].abs() <= z[1].abs() {
        true => [1.0, 0.0, 0.0],
        false => [0.0, 1.0, 0.0],
    };
    let x = cross(least, z);
    let x = scaled(x, 1.0 / length(x));
    Region::Cylinder {
        axis: 2,
        centre: start,
        radius,
        ends: [start[2], start[2] + length(along)],
        tilt: tilt_of([x, cross(z, x), z], start),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_scene::vector::{add, turn_about, turned};

    fn wall(shape: Shape) -> Wall {
        Wall {
            name: "wall".into(),
            material: 0,
            shape,
            motion: windfall_scene::shape::motion::Motion::default(),
        }
    }

    #[test]
    fn plates_and_boxes_keep_their_corners() {
        let flat = Plate {
            corner: [1.0, 2.0, 3.0],
            edges: [[0.0, -2.0, 0.0], [1.0, 0.0, 0.0]],
        };
        let Ok(Region::Block {
            low,
            high,
            open,
            tilt,
        }) = region_of(&wall(Shape::Plates(vec![flat])))
        else {
            panic!("no block");
        };
        assert_eq!((low, high, tilt), ([1.0, 0.0, 3.0], [2.0, 2.0, 5.0], None));
        assert_eq!(open, [true, true, true, true, false, true]);
        // A box without its bottom and top, one plate of another size, one skew.
        let side = |corner: Vector, edges| Plate { corner, edges };
        let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]);
        let mut plates = vec![
            side([0.0; 3], [y, z]),
            side(x, [y, z]),
            side([0.0; 3], [x, z]),
            side(y, [x, z]),
        ];
        let Ok(Region::Block { high, open, .. }) = region_of(&wall(Shape::Plates(plates.clone())))
        else {
            panic!("no block");
        };
        assert_eq!(high, [2.0, 1.0, 3.0]);
        assert_eq!(open, [false, false, false, false, true, true]);
        plates[0].edges[1] = [0.0, 0.0, 1.0];
        assert!(region_of(&wall(Shape::Plates(plates))).is_err());
        let skew = side([0.0; 3], [x, [1.0, 1.0, 0.5]]);
        assert!(region_of(&wall(Shape::Plates(vec![skew]))).is_err());
    }

    #[test]
    fn tilted_plates_and_cylinders_come_out_where_they_are() {
        for (a, b) in [
            ([1.0, 0.0, 0.5], [0.0, 2.0, 0.0]),
            ([-1.0, 0.0, 0.01], [0.0, 1.0, 0.0]),
            ([0.3, 0.4, 1.2], [-0.4, 0.3, 0.0]),
            ([0.0, -1.0, -1.0], [-2.0, 1.0, -1.0]),
        ] {
            let plate = Plate {
                corner: [0.1, 0.2, 0.3],
                edges: [a, b],
            };
            let region = region_of(&wall(Shape::Plates(vec![plate])));
            let Ok(Region::Block {
                low, high, tilt, ..
            }) = region
            else {
                panic!("no block");
            };
            let tilt = tilt.unwrap();
            let turn = turn_about(tilt.axis, tilt.angle);
            let out = |own: Vector| add(tilt.point, turned(turn, subtract(own, tilt.point)));
            for (found, wanted) in [
                (out([high[0], low[1], low[2]]), add(plate.corner, a)),
                (out([low[0], high[1], low[2]]), add(plate.corner, b)),
            ] {
                assert!(
                    length(subtract(found, wanted)) < 1e-12,
                    "{found:?} {wanted:?}"
                );
            }
        }
        let (start, end) = ([0.1, 0.2, 0.3], [1.1, -0.4, 0.9]);
        let shape = Shape::Cylinder {
            start,
            end,
            radius: 0.2,
        };
        let Ok(Region::Cylinder { ends, tilt, .. }) = region_of(&wall(shape)) else {
            panic!("no cylinder");
        };
        let tilt = tilt.unwrap();
        let up = turned(
            turn_about(tilt.axis, tilt.angle),
            [0.0, 0.0, ends[1] - ends[0]],
        );
        assert!(length(subtract(add(start, up), end)) < 1e-12);
    }
}
