//! Bodies in cells of a grid, in which those beside each other are found.

use crate::contacts::bodies::Bodies;
use crate::vector::Vector;
use rayon::prelude::*;
use std::ops::Range;

/// Cells along an edge of a tile. Bodies of a tile stand together, so that most pairs are of
/// one block.
const TILE: usize = 8;

/// Fewest bodies of a block, but for the last.
const BLOCK: usize = 192;

/// Sorts bodies into cells and reorders them by cell; answers for each new place the old.
pub(crate) fn sort_into_cells(bodies: &mut Bodies, skin: f64) -> (Cells, Vec<u32>) {
    let cells = Cells::around(bodies, skin);
    let own: Vec<u32> = bodies
        .place
        .par_iter()
        .map(|place| cells.of(place))
        .collect();
    let mut start = vec![0_u32; cells.count() + 1];
    for &cell in &own {
        start[cell as usize + 1] += 1;
    }
    for cell in 0..cells.count() {
        start[cell + 1] += start[cell];
    }
    let mut next = start.clone();
    let mut order = vec![0_u32; own.len()];
    for (old, &cell) in own.iter().enumerate() {
        let place = &mut next[cell as usize];
        order[*place as usize] = old as u32;
        *place += 1;
    }
    bodies.reordered(&order);
    (Cells { start, ..cells }, order)
}

/// A grid of cells; the bodies of a cell are contiguous.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    low: Vector,
    /// Of a cell along each axis; m.
    size: Vector,
    number: [usize; 3],
    /// Along which axes the last cell is beside the first.
    round: [bool; 3],
    start: Vec<u32>,
}

/// Cells per body at most: where few bodies are far apart cells grow.
const MOST_CELLS: usize = 8;

impl Cells {
    fn around(bodies: &Bodies, skin: f64) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut radius = 0.0_f64;
        for place in &bodies.place {
            for axis in 0..3 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
            radius = radius.max(place[3]);
        }
        if bodies.len() == 0 {
            (low, high) = ([0.0; 3], [0.0; 3]);
        }
        let mut size = (2.0 * radius + skin).max(f64::MIN_POSITIVE);
        let most = (MOST_CELLS * bodies.len() + 64) as f64;
        let ends = [0, 1, 2].map(|axis| bodies.periods.ends(axis));
        for (axis, ends) in ends.into_iter().enumerate() {
            if let Some(ends) = ends {
                [low[axis], high[axis]] = ends;
            }
        }
        let round = ends.map(|own| own.is_some());
        loop {
            let number = [0, 1, 2].map(|axis| {
                let whole = ((high[axis] - low[axis]) / size).floor();
                match round[axis] {
                    true => whole.max(1.0),
                    false => whole + 1.0,
                }
            });
            if number.iter().product::<f64>() <= most {
                // Cells of a periodic axis fill it.
                let size = [0, 1, 2].map(|axis| match round[axis] {
                    true => (high[axis] - low[axis]) / number[axis],
                    false => size,
                });
                return Self {
                    low,
                    size,
                    number: number.map(|each| each as usize),
                    round,
                    start: Vec::new(),
                };
            }
            size *= 1.5;
        }
    }

    fn tiles(&self) -> [usize; 3] {
        self.number.map(|own| own.div_ceil(TILE))
    }

    fn count(&self) -> usize {
        self.tiles().iter().product::<usize>() * TILE * TILE * TILE
    }

    /// Coordinates of the cell of a place.
    fn coordinates(&self, place: &[f64; 4]) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let at = (place[axis] - self.low[axis]) / self.size[axis];
            let number = self.number[axis];
            match self.round[axis] {
                // Spheres of a clump may be beyond an end.
                true => (at.floor() as i64).rem_euclid(number as i64) as usize,
                false => (at as usize).min(number - 1),
            }
        })
    }

    /// The cells beside one along an axis, and itself, each once: beyond the number of cells they
    /// begin anew.
    fn beside(&self, axis: usize, at: usize) -> Range<usize> {
        let number = self.number[axis];
        match self.round[axis] {
            true if number <= 3 => 0..number,
            true => at + number - 1..at + number + 2,
            false => at.saturating_sub(1)..(at + 2).min(number),
        }
    }

    /// Number of a cell: tile by tile.
    fn number_of(&self, [i, j, k]: [usize; 3]) -> usize {
        let [_, ty, tz] = self.tiles();
        let tile = ((i / TILE) * ty + j / TILE) * tz + k / TILE;
        ((tile * TILE + k % TILE) * TILE + j % TILE) * TILE + i % TILE
    }

    fn of(&self, place: &[f64; 4]) -> u32 {
        self.number_of(self.coordinates(place)) as u32
    }

    /// Calls `with` for every body of the cells around a place that stands behind `body`.
    pub(crate) fn later_neighbours(
        &self,
        body: usize,
        place: &[f64; 4],
        mut with: impl FnMut(usize),
    ) {
        let at = self.coordinates(place);
        let range = |axis: usize| self.beside(axis, at[axis]);
        let within = |axis: usize, own: usize| {
            let mut own = own;
            while own >= self.number[axis] {
                own -= self.number[axis];
            }
            own
        };
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let cell = self.number_of([within(0, i), within(1, j), within(2, k)]);
                    let (from, to) = (self.start[cell] as usize, self.start[cell + 1] as usize);
                    for other in from.max(body + 1)..to {
                        with(other);
                    }
                }
            }
        }
    }

    /// Bodies in blocks of whole tiles.
    pub(crate) fn blocks(&self, count: usize) -> Vec<Range<usize>> {
        let mut blocks = Vec::new();
        let mut from = 0;
        for tile in 1..=self.count() / (TILE * TILE * TILE) {
            let to = self.start[tile * TILE * TILE * TILE] as usize;
            if to - from >= BLOCK {
                blocks.push(from..to);
                from = to;
            }
        }
        if from < count {
            blocks.push(from..count);
        }
        blocks
    }
}
