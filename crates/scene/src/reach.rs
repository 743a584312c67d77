//! Whether a fruit can get from one place of a scene to another at all.

use crate::contacts::wall_contacts::WallState;
use crate::scene::{Scene, Sink};
use crate::shape::mesh::bounds;
use crate::vector::{Vector, add, length, scaled, subtract};
use std::collections::BinaryHeap;

/// So much of its radius a fruit may be pressed together where it slips through; 1.
const PRESSED: f64 = 0.1;
/// Cells of the grid over the radius, where there are not too many of them; 1.
const FINE: f64 = 0.125;
/// Coarser ones tell nothing; 1.
const COARSE: f64 = 0.5;
/// Cells of a grid at most.
const MOST: f64 = 1e6;
/// Room around everything, over the radius; 1.
const AROUND: f64 = 4.0;

/// Whether a sphere of a radius can be moved from any of some places to any sink between the
/// walls that stay; `None` where the scene is too large to tell, or repeats.
///
/// Cells of a grid count as free where any of their points may be, so that "no" is certain,
/// and gaps a little narrower than the sphere pass for wide enough: "yes" is not. Walls that
/// move, and gravity, are left out.
pub fn reaches_a_sink(scene: &Scene, radius: f64, starts: &[Vector]) -> Option<bool> {
    let walls = scene.walls.iter().filter(|wall| wall.motion.stays());
    let standing = Scene {
        walls: walls.cloned().collect(),
        ..Scene::default()
    };
    let corners = standing.walls.iter().flat_map(|wall| wall.shape.corners());
    // Around the walls everything is free: who gets there gets to every sink beyond.
    let (low, high) = bounds(corners.chain(starts.iter().copied()));
    let margin = [AROUND * radius; 3];
    let (low, size) = (
        subtract(low, margin),
        add(subtract(high, low), scaled(margin, 2.0)),
    );
    let volume = size.iter().product::<f64>();
    let cell = (FINE * radius).max((volume / MOST).cbrt());
    let fine = cell <= COARSE * radius;
    if !fine || starts.is_empty() || scene.periods().repeat() {
        return None;
    }
    let grid = Grid {
        low,
        cell,
        count: size.map(|own| (own / cell).ceil() as usize),
        beyond: scene.sinks.iter().any(|own| {
            (0..3).any(|axis| own.low[axis] < low[axis] || own.high[axis] > low[axis] + size[axis])
        }),
    };
    Some(grid.search(&WallState::new(&standing), radius, starts, &scene.sinks))
}

/// Cells in a box.
struct Grid {
    low: Vector,
    cell: f64,
    count: [usize; 3],
    /// Whether a sink reaches out of it.
    beyond: bool,
}

impl Grid {
    /// From the cells of some places to that of a sink, those first that are closest to one.
    fn search(&self, walls: &WallState, radius: f64, starts: &[Vector], sinks: &[Sink]) -> bool {
        // The centre may be anywhere in its cell.
        let corner = 0.5 * 3.0_f64.sqrt() * self.cell;
        let room = (1.0 - PRESSED) * radius - corner;
        let mut near = Vec::new();
        let mut free = |place: Vector| {
            near.clear();
            walls.find_near(place, room, &mut near);
            near.is_empty()
        };
        let away = |place: Vector| {
            let each = sinks.iter().map(|own| distance(own, place));
            each.fold(f64::INFINITY, f64::min)
        };
        let mut seen = vec![false; self.count.iter().product()];
        let mut waiting = BinaryHeap::new();
        for start in starts {
            waiting.push((0_u64, self.number(*start)));
        }
        while let Some((_, number)) = waiting.pop() {
            if std::mem::replace(&mut seen[number], true) {
                continue;
            }
            let place = self.middle(number);
            if !free(place) {
                continue;
            }
            if away(place) <= corner || self.beyond && self.on_the_rim(number) {
                return true;
            }
            let mut stride = 1;
            for axis in 0..3 {
                let at = number / stride % self.count[axis];
                let before = (at > 0).then(|| number - stride);
                let after = (at + 1 < self.count[axis]).then(|| number + stride);
                for next in before.into_iter().chain(after) {
                    if !seen[next] {
                        // Bits of numbers above zero are in their order.
                        let far = away(self.middle(next));
                        waiting.push((u64::MAX - far.to_bits(), next));
                    }
                }
                stride *= self.count[axis];
            }
        }
        false
    }

    fn on_the_rim(&self, number: usize) -> bool {
        let [nx, ny, nz] = self.count;
        let at = [number % nx, number / nx % ny, number / (nx * ny)];
        let ends = at.into_iter().zip([nx, ny, nz]);
        ends.into_iter()
            .any(|(own, count)| own == 0 || own + 1 == count)
    }

    fn number(&self, place: Vector) -> usize {
        let at = |axis: usize| {
            let own = ((place[axis] - self.low[axis]) / self.cell).max(0.0) as usize;
            own.min(self.count[axis] - 1)
        };
        at(0) + self.count[0] * (at(1) + self.count[1] * at(2))
    }

    fn middle(&self, number: usize) -> Vector {
        let [nx, ny, _] = self.count;
        let at = [number % nx, number / nx % ny, number / (nx * ny)];
        [0, 1, 2].map(|axis| self.low[axis] + self.cell * (at[axis] as f64 + 0.5))
    }
}

/// From a place to a sink; m.
fn distance(sink: &Sink, place: Vector) -> f64 {
    let off = [0, 1, 2].map(|axis| {
        let at = place[axis];
        (sink.low[axis] - at).max(at - sink.high[axis]).max(0.0)
    });
    length(off)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::motion::{How, Motion};
    use crate::shape::surface::{Plate, Shape};
    use crate::shape::wall::Wall;

    /// A closed box of 1 m with a square hole in its floor, above a sink.
    fn hopper(hole: f64) -> Scene {
        let plate = |corner, a, b| Plate {
            corner,
            edges: [a, b],
        };
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let rest = 0.5 * (1.0 - hole);
        let floor = [
            plate([0.0; 3], scaled(x, rest), y),
            plate([1.0 - rest, 0.0, 0.0], scaled(x, rest), y),
            plate([rest, 0.0, 0.0], scaled(x, hole), scaled(y, rest)),
            plate([rest, 1.0 - rest, 0.0], scaled(x, hole), scaled(y, rest)),
        ];
        let sides = [
            plate([0.0; 3], x, z),
            plate(y, x, z),
            plate([0.0; 3], y, z),
            plate(x, y, z),
            plate(z, x, y),
        ];
        Scene {
            walls: vec![Wall {
                name: "hopper".to_owned(),
                material: 0,
                shape: Shape::Plates(floor.into_iter().chain(sides).collect()),
                motion: Motion::default(),
            }],
            sinks: vec![Sink {
                name: "out".to_owned(),
                low: [0.0, 0.0, -1.0],
                high: [1.0, 1.0, -0.9],
            }],
            ..Scene::default()
        }
    }

    #[test]
    fn a_hole_lets_through_what_is_smaller() {
        let place = [[0.2, 0.2, 0.8]];
        let of = |hole: f64| reaches_a_sink(&hopper(hole), 0.05, &place);
        assert_eq!(of(0.12), Some(true));
        // Much narrower than 0.1 m.
        assert_eq!(of(0.06), Some(false));
        let mut open = hopper(0.06);
        open.walls[0].motion = Motion::always([How::Velocity([0.0, 0.0, 0.1])]);
        assert_eq!(reaches_a_sink(&open, 0.05, &place), Some(true));
        // From outside it is free.
        assert_eq!(
            reaches_a_sink(&hopper(0.06), 0.05, &[[1.2, 0.5, 0.5]]),
            Some(true)
        );
        // Too large to tell.
        assert_eq!(reaches_a_sink(&hopper(0.12), 1e-3, &place), None);
    }
}
