//! One step of all blocks: forces of pairs, and where they take the bodies.
//!
//! Pairs stand with the block of their first body, and second bodies stand behind. So the bodies
//! of a block may move as soon as its own pairs and those of the blocks before it are done:
//! no later pair asks where they were. Blocks go through a step in waves, the bodies of one
//! wave together with the pairs of the next, while what they need is still near the processor.

use crate::contact::{Moment, Outcome};
use crate::gather::{BlockBodies, Gather, Sums};
use crate::interaction::Interaction;
use crate::neighbours::{BodiesFrom, PairTable};
use crate::pair_contacts::{PairContacts, Part};
use crate::react::Clock;
use crate::simulation::Simulation;
use crate::store::Load;
use crate::vector::{Rotation, Vector};
use crate::wall_contacts::NearPart;
use crate::wall_forces::WallContacts;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of a wave for each thread, where there are several: enough that none waits long for
/// the others.
const WAVE: usize = 8;

/// What blocks brought about, in their order.
#[derive(Default)]
pub(crate) struct Swept {
    pub pairs: Vec<Outcome>,
    pub bodies: Vec<(Outcome, Sums)>,
}

impl Simulation {
    /// All blocks one step on.
    pub(crate) fn sweep(&mut self, clock: Clock, with_energy: bool) -> Swept {
        let now = Moment {
            fruit: &self.scene.fruit,
            clock,
        };
        let (table, surfaces, moved) = (&self.table, &self.surfaces, self.moved);
        let wave = match rayon::current_num_threads() {
            1 => 1,
            threads => WAVE * threads,
        };
        let mut waiting = Waiting {
            first: 0,
            place: &mut self.bodies.place,
            motion: &mut self.bodies.motion,
            turn: &mut self.bodies.turn,
            fruit: &self.bodies.fruit,
            clump: &self.bodies.clump,
            offset: &self.bodies.offset,
            near: &mut self.near,
            near_start: &self.near_start,
            wall_contacts: &mut self.wall_contacts,
        };
        let mut contacts = &mut self.contacts[..];
        // Of the pairs on the bodies of one wave, and on those of the next.
        let [behind, ahead] = &mut self.loads;
        let mut swept = Swept::default();
        let mut moving = 0..0;
        while moving.start < table.bounds.len() {
            let pushing = moving.end..(moving.end + wave).min(table.bounds.len());
            let (done, outs) = self.out.split_at_mut(table.outs_before(pushing.start));
            let gather = Gather {
                table,
                out: done,
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
            };
            let mut tasks = Vec::with_capacity(moving.len() + pushing.len());
            let mut loads = &mut behind[..];
            for block in moving {
                let bodies = table.bounds[block].clone();
                tasks.push(Task::Bodies(waiting.go(bodies, &mut loads)));
            }
            ahead.resize(table.bodies_of(pushing.clone()), [0.0; 8]);
            let (mut loads, mut outs) = (&mut ahead[..], outs);
            for block in pushing.clone() {
                let bodies = table.bounds[block].clone();
                let out_base = table.outs_before(block);
                tasks.push(Task::Pairs(BlockPairs {
                    block,
                    bodies: waiting.from(bodies.start),
                    loads: take_mut(&mut loads, bodies.len()),
                    outs: take_mut(&mut outs, table.outs_before(block + 1) - out_base),
                    contacts: &mut take_mut(&mut contacts, 1)[0],
                }));
            }
            let work = |task| match task {
                Task::Pairs(own) => Done::Pairs(own.advance(table, surfaces, moved, &now)),
                Task::Bodies(own) => Done::Bodies(gather.block(own, &now)),
            };
            let found: Vec<Done> = match wave == 1 || tasks.len() == 1 {
                true => tasks.into_iter().map(work).collect(),
                false => tasks.into_par_iter().with_max_len(1).map(work).collect(),
            };
            for own in found {
                match own {
                    Done::Pairs(own) => swept.pairs.push(own),
                    Done::Bodies(own) => swept.bodies.push(own),
                }
            }
            std::mem::swap(behind, ahead);
            moving = pushing;
        }
        swept
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

/// Bodies that have not moved yet, and what goes with them.
struct Waiting<'a> {
    /// Number of the first of them.
    first: usize,
    place: &'a mut [[f64; 4]],
    motion: &'a mut [[f64; 8]],
    turn: &'a mut [Rotation],
    /// Of all bodies.
    fruit: &'a [u32],
    clump: &'a [u32],
    offset: &'a [Vector],
    near: &'a mut [NearPart],
    /// Of all bodies.
    near_start: &'a [u32],
    wall_contacts: &'a mut [Vec<WallContacts>],
}

impl<'a> Waiting<'a> {
    /// The bodies of the next block, which are to move.
    ///
    /// * `loads`: those on them, and on later bodies
    fn go<'b>(&mut self, bodies: Range<usize>, loads: &mut &'b mut [Load]) -> BlockBodies<'b>
    where
        'a: 'b,
    {
        let near = self.near_start[bodies.end] - self.near_start[bodies.start];
        self.first = bodies.end;
        BlockBodies {
            start: bodies.start,
            place: take_mut(&mut self.place, bodies.len()),
            motion: take_mut(&mut self.motion, bodies.len()),
            turn: take_mut(&mut self.turn, bodies.len()),
            loads: take_mut(loads, bodies.len()),
            near: take_mut(&mut self.near, near as usize),
            wall_contacts: &mut take_mut(&mut self.wall_contacts, 1)[0],
        }
    }

    /// Those from a body on.
    fn from(&self, body: usize) -> BodiesFrom<'_> {
        let own = body - self.first;
        BodiesFrom {
            place: &self.place[own..],
            motion: &self.motion[own..],
            turn: &self.turn[own..],
            fruit: &self.fruit[body..],
            clump: &self.clump[body..],
            offset: &self.offset[body..],
        }
    }
}

/// The pairs of a block.
struct BlockPairs<'a> {
    block: usize,
    bodies: BodiesFrom<'a>,
    /// What they do to its bodies.
    loads: &'a mut [Load],
    /// What they do to second bodies of other blocks.
    outs: &'a mut [Load],
    contacts: &'a mut [PairContacts],
}

impl BlockPairs<'_> {
    /// One step on.
    fn advance(
        self,
        table: &PairTable,
        surfaces: &[Interaction],
        moved: f64,
        now: &Moment,
    ) -> Outcome {
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
                moved,
            };
            contacts.advance(part, &surfaces[*interaction], now, &mut outcome);
        }
        outcome
    }
}

/// Takes the first elements off a slice.
fn take_mut<'a, T>(from: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    let (own, rest) = std::mem::take(from).split_at_mut(length);
    *from = rest;
    own
}
