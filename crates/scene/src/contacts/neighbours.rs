//! Which fruit may touch before the neighbour list is rebuilt: pairs within a skin.

use crate::contacts::bodies::Bodies;
use crate::contacts::cells::Cells;
use crate::contacts::store::NONE;
use rayon::prelude::*;
use std::ops::Range;

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
