//! Steps of all blocks: forces of pairs, and where they take the bodies.
//!
//! Pairs stand with the block of their first body, and second bodies stand behind. So the bodies
//! of a block may move as soon as its own pairs and those of the blocks before it are done:
//! no later pair asks where they were. Blocks go through a step in waves, the bodies of one
//! wave together with the pairs of the next, while what they need is still near the processor.
//!
//! For the same reason a second step may follow the first one at a distance: pairs of a block
//! need no more than that all bodies which they know have made the step before. What contacts
//! and bodies remember then comes from memory once for several steps.

use crate::contact::{Moment, Outcome};
use crate::gather::{BlockBodies, Gather, Loads, Sums, Swept};
use crate::interaction::Interaction;
use crate::neighbours::{BodiesFrom, PairTable};
use crate::pair_contacts::{PairContacts, Part};
use crate::react::Clock;
use crate::simulation::Simulation;
use crate::store::Load;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of a wave for each thread, where there are several: enough that none waits long for
/// the others.
const WAVE: usize = 8;

/// A step on its way through the blocks.
struct Front {
    clock: Clock,
    /// Blocks whose pairs are done, and whose bodies move next; and the wave behind these.
    moving: Range<usize>,
    pushing: Range<usize>,
    /// Loads on the bodies of either.
    behind: Vec<Load>,
    ahead: Vec<Load>,
    swept: Swept,
}

impl Simulation {
    /// All blocks some steps on, one of which begins at each time; what each step brought
    /// about.
    pub(crate) fn sweep(&mut self, clocks: &[Clock], with_energy: bool) -> Vec<Swept> {
        let wave = match rayon::current_num_threads() {
            1 => 1,
            threads => WAVE * threads,
        };
        let loads = self.loads.iter_mut().map(std::mem::take);
        let front = |(&clock, [behind, ahead]): (&Clock, Loads)| Front {
            clock,
            moving: 0..0,
            pushing: 0..0,
            behind,
            ahead,
            swept: Swept::default(),
        };
        let mut fronts: Vec<Front> = clocks.iter().zip(loads).map(front).collect();
        while let Some(waves) = self.next_waves(&mut fronts, wave) {
            self.work_through(&mut fronts, waves, with_energy);
        }
        let mut all = Vec::with_capacity(fronts.len());
        for (own, front) in self.loads.iter_mut().zip(fronts) {
            *own = [front.behind, front.ahead];
            all.push(front.swept);
        }
        all
    }

    /// What each step works at next; how many tasks that are, or `None` at the end.
    fn next_waves(&self, fronts: &mut [Front], wave: usize) -> Option<usize> {
        let blocks = self.table.bounds.len();
        // Blocks whose bodies have all made the step before.
        let mut ready = blocks;
        let mut tasks = 0;
        for front in fronts {
            front.moving = std::mem::take(&mut front.pushing);
            std::mem::swap(&mut front.behind, &mut front.ahead);
            let start = front.moving.end;
            let most = start..(start + wave).min(blocks);
            let may = most.take_while(|block| ready == blocks || self.table.last[*block] < ready);
            front.pushing = start..start + may.count();
            let bodies = self.table.bodies_of(front.pushing.clone());
            front.ahead.resize(bodies, [0.0; 8]);
            tasks += front.moving.len() + front.pushing.len();
            ready = front.moving.start;
        }
        (tasks > 0).then_some(tasks)
    }

    /// A wave of each step.
    fn work_through(&mut self, fronts: &mut [Front], count: usize, with_energy: bool) {
        let (table, surfaces) = (&self.table, &self.surfaces);
        let mut place = Cut::of(&mut self.bodies.place);
        let mut motion = Cut::of(&mut self.bodies.motion);
        let mut turn = Cut::of(&mut self.bodies.turn);
        let mut near = Cut::of(&mut self.near);
        let mut wall_contacts = Cut::of(&mut self.wall_contacts);
        let mut contacts = Cut::of(&mut self.contacts);
        let mut out = Cut::of(&mut self.out);
        let begin = |block: usize| {
            table
                .bounds
                .get(block)
                .map_or(table.bodies(), |own| own.start)
        };
        let parts_of = |bodies: &Range<usize>| {
            let [start, end] = [bodies.start, bodies.end].map(|body| self.near_start[body]);
            start as usize..end as usize
        };
        let mut gathers: Vec<Gather> = Vec::with_capacity(fronts.len());
        let mut tasks = Vec::with_capacity(count);
        // The last step is the first in the order of blocks.
        let before = fronts.iter().map(|front| front.moving.start);
        let next: Vec<usize> = std::iter::once(table.bounds.len()).chain(before).collect();
        let mut out_base = 0;
        for (number, front) in fronts.iter_mut().enumerate().rev() {
            let now = Moment {
                fruit: &self.scene.fruit,
                clock: front.clock,
            };
            let outs = [front.pushing.start, front.pushing.end].map(|own| table.outs_before(own));
            gathers.push(Gather {
                now,
                table,
                out: out.take(out_base..outs[0]),
                out_base,
                scene: &self.scene,
                surfaces,
                numbers: &self.numbers,
                walls: &self.walls,
                near_start: &self.near_start,
                bodies: (&self.bodies.fruit, &self.bodies.material),
                clumps: (&self.bodies.clump, &self.bodies.offset),
                clump_loads: &self.clump_loads,
                listed: &self.listed,
                with_energy,
            });
            let mut loads = Cut::of(&mut front.behind);
            for block in front.moving.clone() {
                let bodies = table.bounds[block].clone();
                let own = BlockBodies {
                    start: bodies.start,
                    place: place.take(bodies.clone()),
                    motion: motion.take(bodies.clone()),
                    turn: turn.take(bodies.clone()),
                    loads: loads.next(bodies.len()),
                    near: near.take(parts_of(&bodies)),
                    wall_contacts: &mut wall_contacts.take(block..block + 1)[0],
                };
                tasks.push((number, Task::Bodies(own)));
            }
            // Those that stay where they are in this wave.
            let still = begin(front.pushing.start)..begin(next[number]);
            let bodies = BodiesFrom {
                place: place.take(still.clone()),
                motion: motion.take(still.clone()),
                turn: turn.take(still.clone()),
                fruit: &self.bodies.fruit[still.clone()],
                clump: &self.bodies.clump[still.clone()],
                offset: &self.bodies.offset[still.clone()],
            };
            let mut loads = Cut::of(&mut front.ahead);
            for block in front.pushing.clone() {
                let own = table.bounds[block].clone();
                let outs = [block, block + 1].map(|own| table.outs_before(own));
                let own = BlockPairs {
                    block,
                    now,
                    bodies: bodies.from(own.start - still.start),
                    loads: loads.next(own.len()),
                    outs: out.take(outs[0]..outs[1]),
                    contacts: &mut contacts.take(block..block + 1)[0],
                    approach: table.approach(block, &self.ways),
                };
                tasks.push((number, Task::Pairs(own)));
            }
            out_base = outs[1];
        }
        gathers.reverse();
        let work = |(number, task): (usize, Task)| match task {
            Task::Pairs(own) => (number, Done::Pairs(own.advance(table, surfaces))),
            Task::Bodies(own) => (number, Done::Bodies(gathers[number].block(own))),
        };
        let found: Vec<(usize, Done)> = match rayon::current_num_threads() == 1 || count == 1 {
            true => tasks.into_iter().map(work).collect(),
            false => tasks.into_par_iter().with_max_len(1).map(work).collect(),
        };
        for (number, own) in found {
            let swept = &mut fronts[number].swept;
            match own {
                Done::Pairs(own) => swept.pairs.push(own),
                Done::Bodies(own) => {
                    self.ways[swept.bodies.len()] = own.1.moved.map(f64::sqrt);
                    swept.bodies.push(own);
                }
            }
        }
    }
}

/// What one thread does at a time.
enum Task<'a> {
    Pairs(BlockPairs<'a>),
    Bodies(BlockBodies<'a>),
}

/// What came of it.
enum Done {
    Pairs(Outcome),
    Bodies((Outcome, Sums)),
}

/// The pairs of a block.
struct BlockPairs<'a> {
    block: usize,
    now: Moment<'a>,
    /// From its first body on.
    bodies: BodiesFrom<'a>,
    /// What they do to its bodies.
    loads: &'a mut [Load],
    /// What they do to second bodies of other blocks.
    outs: &'a mut [Load],
    contacts: &'a mut [PairContacts],
    /// How far two bodies may have come together since the list was made; m.
    approach: f64,
}

impl BlockPairs<'_> {
    /// One step on.
    fn advance(self, table: &PairTable, surfaces: &[Interaction]) -> Outcome {
        let mut outcome = Outcome::default();
        self.loads.fill([0.0; 8]);
        let parts = table.blocks[self.block].iter().zip(self.contacts);
        for ((interaction, range), contacts) in parts {
            let part = Part {
                bodies: self.bodies,
                base: table.bounds[self.block].start as u32,
                first: &table.first[range.clone()],
                second: &table.second[range.clone()],
                out: &table.out[range.clone()],
                loads: &mut *self.loads,
                outs: &mut *self.outs,
                out_base: table.outs_before(self.block) as u32,
                approach: self.approach,
            };
            contacts.advance(part, &surfaces[*interaction], &self.now, &mut outcome);
        }
        outcome
    }
}

/// A slice of which parts are taken one after the other.
struct Cut<'a, T> {
    /// Number of the first element that is left.
    start: usize,
    left: &'a mut [T],
}

impl<'a, T> Cut<'a, T> {
    fn of(all: &'a mut [T]) -> Self {
        Self {
            start: 0,
            left: all,
        }
    }

    /// These elements, behind all that were taken before.
    fn take(&mut self, range: Range<usize>) -> &'a mut [T] {
        let left = std::mem::take(&mut self.left);
        let (_, left) = left.split_at_mut(range.start - self.start);
        let (own, left) = left.split_at_mut(range.len());
        (self.start, self.left) = (range.end, left);
        own
    }

    /// The next so many elements.
    fn next(&mut self, count: usize) -> &'a mut [T] {
        self.take(self.start..self.start + count)
    }
}
