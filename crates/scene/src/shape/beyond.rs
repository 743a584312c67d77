//! Walls beyond the ends of a periodic scene: what fruit near an end touch across it.
//!
//! A wall is continued by copies of its parts, a whole number of periods away, as far as fruit
//! reach. They are parts of the same wall, so that a contact goes over from one to the next
//! with what it remembers.

use crate::periods::Periods;
use crate::shape::motion::{Axis, How, Motion, Move};
use crate::shape::surface::{Facet, Plate};
use crate::shape::wall::Wall;
use crate::vector::{Vector, add, dot, length, plus_scaled, subtract};

/// Cosines below which directions are at right angles, and parts of a period that do not
/// count; 1.
const FLAT: f64 = 1e-9;

/// Copies of a part at most: each is looked at where fruit are near.
const MOST_IMAGES: f64 = 100.0;

/// Why a wall cannot be continued along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unrepeatable {
    /// The axis: 0, 1 or 2.
    pub axis: usize,
    /// Why, and what to do.
    pub problem: &'static str,
}

/// The parts of a wall, and behind them what continues them beyond the ends.
///
/// * `reach`: how far beyond the ends fruit may touch walls; m
///
/// # Errors
/// It is not the same wall one period on.
pub(crate) fn continued(
    wall: &Wall,
    periods: &Periods,
    reach: f64,
) -> Result<Vec<Facet>, Unrepeatable> {
    let mut facets = wall.shape.facets();
    for axis in 0..3 {
        let Some([low, high]) = periods.ends(axis) else {
            continue;
        };
        let along = Along {
            axis,
            period: high - low,
            zone: [low - reach, high + reach],
            travel: travel(&wall.motion, axis),
            turns: wall.motion.axis(),
        };
        for number in 0..facets.len() {
            along.extend(&mut facets, number)?;
        }
    }
    Ok(facets)
}

/// An axis along which a wall is continued.
struct Along {
    axis: usize,
    /// m.
    period: f64,
    /// Where fruit may touch walls; m.
    zone: [f64; 2],
    /// How far the wall moves along the axis; m.
    travel: [f64; 2],
    /// The axis that it turns about.
    turns: Option<Axis>,
}

impl Along {
    /// Continues one part.
    fn extend(&self, facets: &mut Vec<Facet>, number: usize) -> Result<(), Unrepeatable> {
        let refused = |problem| {
            let axis = self.axis;
            Err(Unrepeatable { axis, problem })
        };
        let own = facets[number];
        if let Facet::Plane { normal, .. } = own {
            return match () {
                () if normal[self.axis].abs() > FLAT => refused(
                    "an endless plane must be parallel to a periodic axis: for a floor that slopes \
                     along it, tilt `gravity` instead",
                ),
                () if !self.turns_alike() => refused(TURNS),
                () => Ok(()),
            };
        }
        let images = self.images(&own);
        if images[0] >= 0.0 && images[1] <= 0.0 {
            return Ok(());
        }
        if !self.turns_alike() {
            return refused(TURNS);
        }
        if !self.travel.iter().all(|own| own.is_finite()) {
            return refused(
                "it moves along this axis without end: use `belt` for a surface that runs, or limit \
                 the time of its motion ([[moves]])",
            );
        }
        if let Some(longer) = self.stretched(&own) {
            facets[number] = longer;
            return Ok(());
        }
        if images[1] - images[0] > MOST_IMAGES {
            return refused(
                "it is longer than a hundred periods, or moves so far: draw a piece of it that is \
                 about as long as the period",
            );
        }
        for image in images[0] as i64..=images[1] as i64 {
            if image != 0 {
                facets.push(self.shifted(own, image as f64 * self.period));
            }
        }
        Ok(())
    }

    /// Whether a turn does the same to a wall one period on: about an axis along this one.
    fn turns_alike(&self) -> bool {
        let along = |own: Axis| own.direction[self.axis].abs() >= 1.0 - FLAT;
        self.turns.is_none_or(along)
    }

    /// The first and the last image of a part that fruit may touch at some time, in periods.
    fn images(&self, facet: &Facet) -> [f64; 2] {
        let [low, high] = extent(facet, self.axis, self.turns);
        let [from, to] = [low + self.travel[0], high + self.travel[1]];
        [
            ((self.zone[0] - to) / self.period).ceil(),
            ((self.zone[1] - from) / self.period).floor(),
        ]
    }

    /// A part that goes along the axis for a period or more as one without a seam.
    fn stretched(&self, facet: &Facet) -> Option<Facet> {
        let axis = self.axis;
        let from = self.zone[0] - self.travel[1];
        let to = self.zone[1] - self.travel[0];
        let goes_along = |own: Vector| {
            let size = length(own);
            let beside = (0..3).filter(|other| *other != axis);
            own[axis].abs() >= self.period * (1.0 - FLAT)
                && beside
                    .map(|other| own[other].abs())
                    .all(|own| own <= FLAT * size)
        };
        let longer = |mut corner: Vector, mut edge: Vector| {
            let rises = edge[axis] > 0.0;
            corner[axis] = if rises { from } else { to };
            edge[axis] = if rises { to - from } else { from - to };
            (corner, edge)
        };
        match *facet {
            Facet::Plate(Plate { corner, edges }) => {
                let first = (0..2).find(|own| goes_along(edges[*own]))?;
                if edges[1 - first][axis].abs() > FLAT * length(edges[1 - first]) {
                    return None;
                }
                let (corner, edge) = longer(corner, edges[first]);
                let mut edges = edges;
                edges[first] = edge;
                Some(Facet::Plate(Plate { corner, edges }))
            }
            Facet::Cylinder {
                start,
                along,
                radius,
            } if goes_along(along) => {
                let (start, along) = longer(start, along);
                Some(Facet::Cylinder {
                    start,
                    along,
                    radius,
                })
            }
            _ => None,
        }
    }

    fn shifted(&self, facet: Facet, by: f64) -> Facet {
        let mut shift = [0.0; 3];
        shift[self.axis] = by;
        match facet {
            Facet::Plane { point, normal } => Facet::Plane {
                point: add(point, shift),
                normal,
            },
            Facet::Plate(Plate { corner, edges }) => Facet::Plate(Plate {
                corner: add(corner, shift),
                edges,
            }),
            Facet::Cylinder {
                start,
                along,
                radius,
            } => Facet::Cylinder {
                start: add(start, shift),
                along,
                radius,
            },
            Facet::Triangle(corners) => Facet::Triangle(corners.map(|own| add(own, shift))),
        }
    }
}

const TURNS: &str = "it turns about an axis that is not parallel to this one, and its parts beyond \
                     the end would turn about other places: move it away from the ends, or make \
                     the period longer";

/// From where to where a part reaches along an axis, in every position as its wall turns; m.
fn extent(facet: &Facet, axis: usize, turns: Option<Axis>) -> [f64; 2] {
    let (points, around) = match *facet {
        Facet::Plane { .. } => return [f64::NEG_INFINITY, f64::INFINITY],
        Facet::Plate(own) => (own.corners().to_vec(), 0.0),
        Facet::Cylinder {
            start,
            along,
            radius,
        } => (vec![start, add(start, along)], radius),
        Facet::Triangle(corners) => (corners.to_vec(), 0.0),
    };
    let ends = points.into_iter().map(|own| match turns {
        None => [own[axis] - around, own[axis] + around],
        Some(Axis { point, direction }) => {
            let from = subtract(own, point);
            let high = dot(from, direction);
            let out = length(plus_scaled(from, direction, -high)) + around;
            let middle = point[axis] + high * direction[axis];
            let most = out * (1.0 - direction[axis].powi(2)).max(0.0).sqrt();
            let most = most + around * direction[axis].abs();
            [middle - most, middle + most]
        }
    });
    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], own| {
        [low.min(own[0]), high.max(own[1])]
    })
}

/// How far a wall is shifted along an axis at least and at most; m.
fn travel(motion: &Motion, axis: usize) -> [f64; 2] {
    let all = motion.moves.iter().map(|own| travel_of(own, axis));
    all.fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
}

fn travel_of(own: &Move, axis: usize) -> [f64; 2] {
    match &own.how {
        How::Velocity(velocity) if velocity[axis] != 0.0 => {
            let lasts = match own.when.from.is_finite() {
                true => own.when.whole(),
                false => own.when.until,
            };
            let way = velocity[axis] * lasts;
            [way.min(0.0), way.max(0.0)]
        }
        How::Vibration { amplitude, .. } => [-amplitude[axis].abs(), amplitude[axis].abs()],
        How::Path(path) => path.shift[axis].range(),
        How::Velocity(_) | How::Rotation { .. } | How::Belt(_) => [0.0; 2],
    }
}
