//! Which fruit may touch before the list is made anew: cells, and pairs within a skin.

use crate::vector::{Rotation, Vector};
use crate::wall_contacts::WallContact;
use rayon::prelude::*;
use std::ops::Range;

/// Fruit that are in the scene, in an order in which neighbours stand close together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// Place, m, and radius, m.
    pub place: Vec<[f64; 4]>,
    /// Velocity half a step ago, m/s; 1/mass; angular velocity, rad/s; 1/moment of inertia.
    pub motion: Vec<[f64; 8]>,
    /// Orientation.
    pub turn: Vec<Rotation>,
    /// Number of the fruit in the scene.
    pub fruit: Vec<u32>,
    /// Its material.
    pub material: Vec<u32>,
    /// Contacts with walls.
    pub walls: Vec<Vec<WallContact>>,
}

impl Bodies {
    pub(crate) fn len(&self) -> usize {
        self.place.len()
    }

    /// In another order: body `order[n]` becomes body n.
    fn reordered(&mut self, order: &[u32]) {
        fn picked<T: Copy>(from: &[T], order: &[u32]) -> Vec<T> {
            order.iter().map(|&old| from[old as usize]).collect()
        }
        self.place = picked(&self.place, order);
        self.motion = picked(&self.motion, order);
        self.turn = picked(&self.turn, order);
        self.fruit = picked(&self.fruit, order);
        self.material = picked(&self.material, order);
        let mut old = std::mem::take(&mut self.walls);
        self.walls = order
            .iter()
            .map(|&place| std::mem::take(&mut old[place as usize]))
            .collect();
    }
}

/// Bodies whose pairs one task works through.
pub(crate) const BLOCK: usize = 128;

/// No contact.
pub(crate) const NONE: u32 = u32::MAX;

/// Marks an entry seen from its second body.
pub(crate) const SECOND: u32 = 1 << 31;

/// Pairs that may touch, ordered by blocks of first bodies, within a block by interaction.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairTable {
    pub first: Vec<u32>,
    pub second: Vec<u32>,
    /// The contact of each pair in its block's contacts of that interaction, or [`NONE`].
    pub slot: Vec<u32>,
    /// What each block holds: interactions and their entries.
    pub blocks: Vec<Vec<(usize, Range<usize>)>>,
    /// Entries of each body, those in which it is second marked by [`SECOND`].
    pub adjacent: Vec<u32>,
    /// Where those of each body begin.
    pub adjacent_start: Vec<u32>,
}

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

/// A grid of cells; bodies of a cell stand one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    low: Vector,
    size: f64,
    number: [usize; 3],
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
        loop {
            let number = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / size).floor() + 1.0);
            if number.iter().product::<f64>() <= most {
                let number = number.map(|each| each as usize);
                return Self {
                    low,
                    size,
                    number,
                    start: Vec::new(),
                };
            }
            size *= 1.5;
        }
    }

    fn count(&self) -> usize {
        self.number.iter().product()
    }

    fn of(&self, place: &[f64; 4]) -> u32 {
        let [i, j, k] = [0, 1, 2].map(|axis| {
            let cell = ((place[axis] - self.low[axis]) / self.size) as usize;
            cell.min(self.number[axis] - 1)
        });
        ((k * self.number[1] + j) * self.number[0] + i) as u32
    }

    /// Calls `with` for every body of the cells around a place, in their order, that
    /// stands behind `body`.
    fn later_neighbours(&self, body: usize, place: &[f64; 4], mut with: impl FnMut(usize)) {
        let cell = self.of(place) as usize;
        let [nx, ny, nz] = self.number;
        let (i, j, k) = (cell % nx, cell / nx % ny, cell / (nx * ny));
        // Cells with a lower number hold earlier bodies.
        for kk in k..(k + 2).min(nz) {
            for jj in j.saturating_sub(1)..(j + 2).min(ny) {
                let row = (kk * ny + jj) * nx;
                let (from, to) = (row + i.saturating_sub(1), row + (i + 1).min(nx - 1));
                let range = self.start[from] as usize..self.start[to + 1] as usize;
                for other in range.start.max(body + 1)..range.end {
                    with(other);
                }
            }
        }
    }
}

impl PairTable {
    /// Every pair closer than its radii and the skin.
    ///
    /// * `interaction`: number of the interaction of two materials
    pub(crate) fn build(
        bodies: &Bodies,
        cells: &Cells,
        skin: f64,
        interactions: usize,
        interaction: impl Fn(u32, u32) -> usize + Sync,
    ) -> Self {
        let count = bodies.len();
        let blocks: Vec<Vec<Vec<(u32, u32)>>> = (0..count.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let mut own = vec![Vec::new(); interactions];
                for first in block * BLOCK..((block + 1) * BLOCK).min(count) {
                    let a = &bodies.place[first];
                    cells.later_neighbours(first, a, |second| {
                        let b = &bodies.place[second];
                        let reach = a[3] + b[3] + skin;
                        let (x, y, z) = (b[0] - a[0], b[1] - a[1], b[2] - a[2]);
                        if x * x + y * y + z * z < reach * reach {
                            let pair = (bodies.material[first], bodies.material[second]);
                            own[interaction(pair.0, pair.1)].push((first as u32, second as u32));
                        }
                    });
                }
                own
            })
            .collect();
        let mut table = Self::default();
        for block in blocks {
            let mut parts = Vec::new();
            for (interaction, pairs) in block.into_iter().enumerate() {
                let start = table.first.len();
                for (first, second) in pairs {
                    table.first.push(first);
                    table.second.push(second);
                }
                if table.first.len() > start {
                    parts.push((interaction, start..table.first.len()));
                }
            }
            table.blocks.push(parts);
        }
        table.slot = vec![NONE; table.first.len()];
        table.adjoin(count);
        table
    }

    fn adjoin(&mut self, count: usize) {
        let mut start = vec![0_u32; count + 1];
        for &body in self.first.iter().chain(&self.second) {
            start[body as usize + 1] += 1;
        }
        for body in 0..count {
            start[body + 1] += start[body];
        }
        let mut next = start.clone();
        self.adjacent = vec![0; 2 * self.first.len()];
        for entry in 0..self.first.len() {
            for (body, mark) in [(self.first[entry], 0), (self.second[entry], SECOND)] {
                let place = &mut next[body as usize];
                self.adjacent[*place as usize] = entry as u32 | mark;
                *place += 1;
            }
        }
        self.adjacent_start = start;
    }

    /// The entries of a body.
    #[inline(always)]
    pub(crate) fn of(&self, body: usize) -> &[u32] {
        &self.adjacent[self.adjacent_start[body] as usize..self.adjacent_start[body + 1] as usize]
    }

    /// The entry of two bodies.
    pub(crate) fn find(&self, first: u32, second: u32) -> Option<usize> {
        let entries = self.of(first as usize).iter();
        let entries = entries.map(|entry| (entry & !SECOND) as usize);
        entries
            .into_iter()
            .find(|&entry| self.first[entry] == first && self.second[entry] == second)
    }
}
