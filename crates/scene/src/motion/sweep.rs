//! Steps of all blocks: forces of pairs, and where they take the bodies.
//!
//! Pairs stand with the block of their first body, and second bodies stand behind. So the bodies
//! of a block may move as soon as its own pairs and those of the blocks before it are done:
//! no later pair asks where they were. Blocks go through a step in waves, the bodies of one
//! wave together with the pairs of the next, while what they need is still near the processor.

use crate::contacts::bodies::BodiesFrom;
use crate::contacts::contact::{Moment, Outcome};
use crate::contacts::neighbours::PairTable;
use crate::contacts::pair_contacts::{PairContacts, Part};
use crate::contacts::react::Clock;
use crate::contacts::store::Load;
use crate::interaction::Interaction;
use crate::motion::gather::{BlockBodies, Gather, Sums, Swept};
use crate::motion::simulation::Simulation;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of a wave for each thread, where there are several: enough that none waits long for
/// the others.
const WAVE: usize = 8;

/// A step on its way through the blocks.
struct Front {
    /// Blocks whose pairs are done, and whose bodies move next; and the wave behind these.
    moving: Range<usize>,
    pushing: Range<usize>,
    /// Loads on the bodies of either.
    behind: Vec<Load>,
    ahead: Vec<Load>,
    swept: Swept,
}

impl Front {
    /// The next wave; whether there is any.
    fn goes_on(&mut self, table: &PairTable, wave: usize) -> bool {
        self.moving = std::mem::take(&mut self.pushing);
        std::mem::swap(&mut self.behind, &mut self.ahead);
        let start = self.moving.end;
        self.pushing = start..(start + wave).min(table.bounds.len());
        let bodies = table.bodies_of(self.pushing.clone());
        self.ahead.resize(bodies, Load::ZERO);
        !self.moving.is_empty() || !self.pushing.is_empty()
    }
}

impl Simulation {
    /// All blocks one step on.
    pub(crate) fn sweep(&mut self, clock: Clock, with_energy: bool) -> Swept {
        let wave = match rayon::current_num_threads() {
            1 => 1,
            threads => WAVE * threads,
        };
        let [behind, ahead] = std::mem::take(&mut self.loads);
        let mut front = Front {
            moving: 0..0,
            pushing: 0..0,
            behind,
            ahead,
            swept: Swept::default(),
        };
        while front.goes_on(&self.table, wave) {
            self.work_through(&mut front, clock, with_energy);
        }
        self.loads = [front.behind, front.ahead];
        front.swept
    }

    /// A wave.
    fn work_through(&mut self, front: &mut Front, clock: Clock, with_energy: bool) {
        let Front {
            moving,
            pushing,
            behind,
            ahead,
            swept,
        } = front;
        let blocks = [moving, pushing].map(|own| own.clone());
        let (gather, tasks) = self.tasks(blocks, [behind, ahead], clock, with_energy);
        let work = |task: Task| match task {
            Task::Pairs(own) => Done::Pairs(own.advance(gather.table, gather.surfaces)),
            Task::Bodies(own) => Done::Bodies(gather.block(own)),
        };
        let found: Vec<Done> = match rayon::current_num_threads() == 1 || tasks.len() == 1 {
            true => tasks.into_iter().map(work).collect(),
            false => tasks.into_par_iter().with_max_len(1).map(work).collect(),
        };
        for own in found {
            match own {
                Done::Pairs(own) => swept.pairs.push(own),
                Done::Bodies(own) => swept.bodies.push(own),
            }
        }
    }

    /// What there is to do in a wave.
    ///
    /// * `moving`, `pushing`: blocks whose bodies move, and whose pairs push; and the loads on
    ///   the bodies of either
    fn tasks<'a>(
        &'a mut self,
        [moving, pushing]: [Range<usize>; 2],
        [behind, loads]: [&'a mut [Load]; 2],
        clock: Clock,
        with_energy: bool,
    ) -> (Gather<'a>, Vec<Task<'a>>) {
        let table = &self.table;
        let now = Moment {
            fruit: &self.scene.fruit,
            clock,
        };
        // What pairs before the wave have done, and what those of the wave are to do.
        let (before, outs) = self.out.split_at_mut(table.outs_before(pushing.start));
        let gather = Gather {
            now,
            table,
            out: before,
            scene: &self.scene,
            surfaces: &self.surfaces,
            numbers: &self.numbers,
            walls: &self.walls,
            near_start: &self.near_start,
            bodies: (&self.bodies.fruit, &self.bodies.material),
            clumps: (&self.bodies.clump, &self.bodies.offset),
            clump_loads: &self.clump_loads,
            listed: &self.listed,
            foreign: &self.foreign,
            with_energy,
        };
        // The first body that stays where it is in this wave.
        let still = table.bounds.get(pushing.start);
        let still = still.map_or(table.bodies(), |block| block.start);
        let parts_of = |bodies: &Range<usize>| {
            let [start, end] = [bodies.start, bodies.end].map(|body| self.near_start[body]);
            start as usize..end as usize
        };
        let (place, still_place) = self.bodies.place.split_at_mut(still);
        let (motion, still_motion) = self.bodies.motion.split_at_mut(still);
        let (turn, still_turn) = self.bodies.turn.split_at_mut(still);
        let mut place = Cut::of(place);
        let mut motion = Cut::of(motion);
        let mut turn = Cut::of(turn);
        let mut near = Cut::of(&mut self.near);
        let mut wall_contacts = Cut::of(&mut self.wall_contacts);
        let mut behind = Cut::of(behind);
        let mut tasks = Vec::with_capacity(moving.len() + pushing.len());
        for block in moving {
            let bodies = table.bounds[block].clone();
            tasks.push(Task::Bodies(BlockBodies {
                start: bodies.start,
                place: place.take(bodies.clone()),
                motion: motion.take(bodies.clone()),
                turn: turn.take(bodies.clone()),
                loads: behind.next(bodies.len()),
                near: near.take(parts_of(&bodies)),
                wall_contacts: &mut wall_contacts.take(block..block + 1)[0],
            }));
        }
        let bodies = BodiesFrom {
            place: still_place,
            motion: still_motion,
            turn: still_turn,
            fruit: &self.bodies.fruit[still..],
            clump: &self.bodies.clump[still..],
            offset: &self.bodies.offset[still..],
            periods: &self.bodies.periods,
        };
        let mut contacts = Cut::of(&mut self.contacts);
        let mut outs = Cut::of(outs);
        let mut loads = Cut::of(loads);
        for block in pushing {
            let own = table.bounds[block].clone();
            let [from, to] = [block, block + 1].map(|own| table.outs_before(own));
            tasks.push(Task::Pairs(BlockPairs {
                block,
                now,
                bodies: bodies.from(own.start - still),
                loads: loads.next(own.len()),
                outs: outs.next(to - from),
                contacts: &mut contacts.take(block..block + 1)[0],
                approach: table.approach(block, &self.ways),
            }));
        }
        (gather, tasks)
    }
}

/// What one thread does at a time.
enum Task<'a> {
    Pairs(BlockPairs<'a>),
    Bodies(BlockBodies<'a>),
}

/// The result.
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
        self.loads.fill(Load::ZERO);
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
