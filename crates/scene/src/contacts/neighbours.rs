//! Which fruit may touch before the neighbour list is rebuilt: cells, and pairs within a skin.

use crate::contacts::store::NONE;
use crate::contacts::wall_contacts::Lifted;
use crate::line::{HalfLine, Line};
use crate::periods::Periods;
use crate::vector::{Rotation, Vector, length};
use rayon::prelude::*;
use std::ops::Range;

/// Fruit that are in the scene, in an order in which neighbours stand close together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// Place, m, and radius, m.
    pub place: Vec<HalfLine>,
    /// Velocity half a step ago, m/s; 1/mass; angular velocity, rad/s; 1/moment of inertia.
    pub motion: Vec<Line>,
    /// Orientation.
    pub turn: Vec<Rotation>,
    /// Number of the fruit in the scene.
    pub fruit: Vec<u32>,
    pub material: Vec<u32>,
    /// The clump that a sphere belongs to, by its number among the clumps, or [`NONE`].
    pub clump: Vec<u32>,
    /// Its number in its clump.
    pub sphere: Vec<u32>,
    /// Where in its clump: from the centre, in the clump's own axes; m.
    pub offset: Vec<Vector>,
    /// Contacts with walls, while the list is rebuilt.
    pub lifted: Vec<Vec<Lifted>>,
    /// Along which axes bodies have images.
    pub periods: Periods,
}

impl Bodies {
    pub(crate) fn len(&self) -> usize {
        self.place.len()
    }

    /// Where in its clump a body is, if it belongs to one; m.
    pub(crate) fn offset_of(&self, body: usize) -> Option<Vector> {
        self.from(0).offset_of(body)
    }

    /// How far two bodies overlap; m.
    pub(crate) fn overlap(&self, pair: [u32; 2]) -> f64 {
        self.from(0).overlap(pair)
    }

    /// From a body on.
    pub(crate) fn from(&self, first: usize) -> BodiesFrom<'_> {
        let all = BodiesFrom {
            place: &self.place,
            motion: &self.motion,
            turn: &self.turn,
            fruit: &self.fruit,
            clump: &self.clump,
            offset: &self.offset,
            periods: &self.periods,
        };
        all.from(first)
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
        self.clump = picked(&self.clump, order);
        self.sphere = picked(&self.sphere, order);
        self.offset = picked(&self.offset, order);
        let mut old = std::mem::take(&mut self.lifted);
        self.lifted = order
            .iter()
            .map(|&place| std::mem::take(&mut old[place as usize]))
            .collect();
    }
}

/// Bodies from the first of a block on, by their numbers in it: see [`Bodies`].
#[derive(Clone, Copy)]
pub(crate) struct BodiesFrom<'a> {
    pub place: &'a [HalfLine],
    pub motion: &'a [Line],
    pub turn: &'a [Rotation],
    pub fruit: &'a [u32],
    pub clump: &'a [u32],
    pub offset: &'a [Vector],
    pub periods: &'a Periods,
}

impl<'a> BodiesFrom<'a> {
    /// From a later body on.
    pub(crate) fn from(&self, first: usize) -> BodiesFrom<'a> {
        BodiesFrom {
            place: &self.place[first..],
            motion: &self.motion[first..],
            turn: &self.turn[first..],
            fruit: &self.fruit[first..],
            clump: &self.clump[first..],
            offset: &self.offset[first..],
            periods: self.periods,
        }
    }

    /// Where in its clump a body is, if it belongs to one; m.
    pub(crate) fn offset_of(&self, body: usize) -> Option<Vector> {
        (self.clump[body] != NONE).then(|| self.offset[body])
    }

    /// How far two bodies overlap; m.
    pub(crate) fn overlap(&self, pair: [u32; 2]) -> f64 {
        let [a, b] = pair.map(|body| self.place[body as usize][3]);
        a + b - length(self.between(pair))
    }

    /// From one body to another, or to the nearest of its images; m.
    #[inline(always)]
    pub(crate) fn between(&self, pair: [u32; 2]) -> Vector {
        let [a, b] = pair.map(|body| &self.place[body as usize]);
        self.periods
            .nearest([b[0] - a[0], b[1] - a[1], b[2] - a[2]])
    }
}

/// Cells along an edge of a tile. Bodies of a tile stand together, so that most pairs are of
/// one block.
const TILE: usize = 8;

/// Fewest bodies of a block, but for the last.
const BLOCK: usize = 192;

/// Pairs of first bodies of a block by interaction, and those of clumps.
type BlockPairs = (Vec<Vec<(u32, u32)>>, Vec<[u32; 2]>);

/// Pairs that may touch, ordered by blocks of first bodies, within a block by interaction.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairTable {
    pub first: Vec<u32>,
    pub second: Vec<u32>,
    /// What each block holds: interactions and their entries.
    pub blocks: Vec<Vec<(usize, Range<usize>)>>,
    /// Bodies of each block.
    pub bounds: Vec<Range<usize>>,
    /// The last block that pairs of each block reach.
    pub last: Vec<usize>,
    /// Where the entries of each first body begin, in an order of their own.
    own_start: Vec<u32>,
    own: Vec<u32>,
    /// Pairs of which one belongs to a clump: these are no entries.
    pub of_clumps: Vec<[u32; 2]>,
    /// For each entry its number among those of its block that reach into another, or [`NONE`].
    pub out: Vec<u32>,
    /// Where those of each block begin.
    out_start: Vec<usize>,
    /// The ones in which each body is second, and where those of each begin.
    incoming: Vec<u32>,
    incoming_start: Vec<u32>,
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
    fn later_neighbours(&self, body: usize, place: &[f64; 4], mut with: impl FnMut(usize)) {
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
    fn blocks(&self, count: usize) -> Vec<Range<usize>> {
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

impl PairTable {
    /// Every pair closer than its radii and the skin.
    ///
    /// * `foreign`: fruit that another rank follows, by number; a pair is with the one that has
    ///   the lower number
    /// * `interaction`: number of the interaction of two materials
    pub(crate) fn build(
        bodies: &Bodies,
        cells: &Cells,
        skin: f64,
        interactions: usize,
        foreign: &[bool],
        interaction: impl Fn(u32, u32) -> usize + Sync,
    ) -> Self {
        let count = bodies.len();
        let bounds = cells.blocks(count);
        let blocks: Vec<BlockPairs> = bounds
            .par_iter()
            .map(|block| {
                let mut own = vec![Vec::new(); interactions];
                let mut of_clumps = Vec::new();
                for first in block.clone() {
                    let a = &bodies.place[first];
                    cells.later_neighbours(first, a, |second| {
                        let b = &bodies.place[second];
                        let reach = a[3] + b[3] + skin;
                        let between = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
                        let [x, y, z] = bodies.periods.nearest(between);
                        if x * x + y * y + z * z < reach * reach {
                            let lower = bodies.fruit[first].min(bodies.fruit[second]);
                            if foreign.get(lower as usize).is_some_and(|own| *own) {
                                return;
                            }
                            let clumps = (bodies.clump[first], bodies.clump[second]);
                            if clumps != (NONE, NONE) {
                                if clumps.0 != clumps.1 {
                                    of_clumps.push([first as u32, second as u32]);
                                }
                                return;
                            }
                            let pair = (bodies.material[first], bodies.material[second]);
                            own[interaction(pair.0, pair.1)].push((first as u32, second as u32));
                        }
                    });
                }
                (own, of_clumps)
            })
            .collect();
        let mut table = Self::default();
        for (block, of_clumps) in blocks {
            table.of_clumps.extend(of_clumps);
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
        table.bounds = bounds;
        table.adjoin(count);
        table
    }

    /// How many bodies there are.
    pub(crate) fn bodies(&self) -> usize {
        self.bounds.last().map_or(0, |block| block.end)
    }

    /// The block of a body.
    pub(crate) fn block_of(&self, body: usize) -> usize {
        self.bounds.partition_point(|block| block.end <= body)
    }

    fn adjoin(&mut self, count: usize) {
        let all = 0..self.first.len() as u32;
        let first = &self.first;
        (self.own_start, self.own) = listed(count, all.clone(), |entry| first[entry as usize]);
        let mut block = vec![0_u32; count];
        for (number, bodies) in self.bounds.iter().enumerate() {
            block[bodies.clone()].fill(number as u32);
        }
        let mut foreign = Vec::new();
        self.out = vec![NONE; self.first.len()];
        self.out_start = vec![0; self.bounds.len() + 1];
        self.last = (0..self.bounds.len()).collect();
        for entry in all {
            let pair = [self.first[entry as usize], self.second[entry as usize]];
            let [one, other] = pair.map(|body| block[body as usize]);
            if one != other {
                let outs = &mut self.out_start[one as usize + 1];
                self.out[entry as usize] = *outs as u32;
                *outs += 1;
                let last = &mut self.last[one as usize];
                *last = (*last).max(other as usize);
                foreign.push(pair[1]);
            }
        }
        for block in 0..self.bounds.len() {
            self.out_start[block + 1] += self.out_start[block];
        }
        let numbers = 0..foreign.len() as u32;
        (self.incoming_start, self.incoming) =
            listed(count, numbers, |number| foreign[number as usize]);
    }

    /// How far two bodies of which the first is in a block may have come together; m.
    ///
    /// * `ways`: the two largest of the bodies of each block; m
    pub(crate) fn approach(&self, block: usize, ways: &[[f64; 2]]) -> f64 {
        let [own, second] = ways[block];
        let others = ways[block + 1..=self.last[block]].iter();
        let other = others.fold(second, |most, [own, _]| most.max(*own));
        // With room for what is rounded.
        (own + other) * (1.0 + 1e-9)
    }

    /// How many entries of two blocks there are before a block.
    pub(crate) fn outs_before(&self, block: usize) -> usize {
        self.out_start[block]
    }

    /// How many bodies some blocks have.
    pub(crate) fn bodies_of(&self, blocks: Range<usize>) -> usize {
        self.bounds[blocks].iter().map(Range::len).sum()
    }

    /// Entries of other blocks in which some bodies are second, by their number; and where those of
    /// each begin.
    pub(crate) fn incoming(&self, first: usize, count: usize) -> (&[u32], &[u32]) {
        (&self.incoming, &self.incoming_start[first..=first + count])
    }

    /// The entry of two bodies.
    pub(crate) fn find(&self, first: u32, second: u32) -> Option<usize> {
        let (from, to) = (
            self.own_start[first as usize],
            self.own_start[first as usize + 1],
        );
        let entries = self.own[from as usize..to as usize].iter();
        let mut entries = entries.map(|&entry| entry as usize);
        entries.find(|&entry| self.second[entry] == second)
    }
}

/// Entries in the order of what they belong to, and where those of each begin.
fn listed(
    count: usize,
    entries: impl Iterator<Item = u32> + Clone,
    of: impl Fn(u32) -> u32,
) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0_u32; count + 1];
    for entry in entries.clone() {
        start[of(entry) as usize + 1] += 1;
    }
    for body in 0..count {
        start[body + 1] += start[body];
    }
    let mut next = start.clone();
    let mut list = vec![0; start[count] as usize];
    for entry in entries {
        let place = &mut next[of(entry) as usize];
        list[*place as usize] = entry;
        *place += 1;
    }
    (start, list)
}
