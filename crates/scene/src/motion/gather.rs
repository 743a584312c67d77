//! Forces on each body added up, and where they take it.

use crate::contacts::contact::{Moment, Outcome};
use crate::contacts::neighbours::PairTable;
use crate::contacts::react::Touch;
use crate::contacts::store::{Load, add_load};
use crate::contacts::wall_contacts::{Around, Body, NearPart, WallState, aim, met_wall};
use crate::contacts::wall_forces::WallContacts;
use crate::error::Error;
use crate::event::Partner;
use crate::interaction::Interaction;
use crate::line::{HalfLine, Line};
use crate::scene::Scene;
use crate::vector::{Rotation, Vector, dot, length, plus_scaled, turned_on};
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{
    EIGHT, EightLanes, EightNumbers, LANES, Row, with_eight_lanes,
};

/// Way in one step over the radius above which contacts are missed; 1.
const LONGEST_WAY: f64 = 0.2;

/// Inverse mass (and inertia) of a sphere that moves with its clump.
pub(crate) const PART_OF_CLUMP: f64 = 0.0;

/// Sums over a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Squares of the two largest ways since the list was made; m².
    pub moved: [f64; 2],
    pub drag: f64,
    pub walls: f64,
    pub kinetic: f64,
    pub rotational: f64,
    pub potential: f64,
}

/// Loads on the bodies of two waves, kept from step to step.
pub(crate) type Loads = [Vec<Load>; 2];

/// What blocks brought about in a step, in their order.
#[derive(Default)]
pub(crate) struct Swept {
    pub pairs: Vec<Outcome>,
    pub bodies: Vec<(Outcome, Sums)>,
}

/// What is known when forces on bodies are added up.
pub(crate) struct Gather<'a> {
    pub now: Moment<'a>,
    pub table: &'a PairTable,
    /// Loads of pairs on second bodies of other blocks.
    pub out: &'a [Load],
    pub scene: &'a Scene,
    pub surfaces: &'a [Interaction],
    pub numbers: &'a [usize],
    pub walls: &'a WallState,
    /// Where the parts of walls near each body begin.
    pub near_start: &'a [u32],
    /// Numbers and materials of the bodies.
    pub bodies: (&'a [u32], &'a [u32]),
    /// Where each is in its clump, if there are clumps: see `Bodies`.
    pub clumps: (&'a [u32], &'a [Vector]),
    /// Of contacts of clumps on each body, if there are clumps.
    pub clump_loads: &'a [Load],
    pub listed: &'a [Row],
    /// Fruit that another rank follows, by number: see `Simulation`.
    pub foreign: &'a [bool],
    pub with_energy: bool,
}

/// What there is of the bodies of a block.
pub(crate) struct BlockBodies<'a> {
    pub start: usize,
    pub place: &'a mut [HalfLine],
    pub motion: &'a mut [Line],
    pub turn: &'a mut [Rotation],
    /// What pairs of the block do to each.
    pub loads: &'a mut [Load],
    /// Parts of walls near them, by body.
    pub near: &'a mut [NearPart],
    pub wall_contacts: &'a mut [WallContacts],
}

impl Gather<'_> {
    pub(crate) fn block(&self, mut block: BlockBodies) -> (Outcome, Sums) {
        let now = &self.now;
        let mut outcome = Outcome::default();
        let mut sums = Sums::default();
        self.aim_at_walls(&mut block, now, &mut outcome);
        for (own, surface) in block.wall_contacts.iter_mut().zip(self.surfaces) {
            sums.walls += own.advance(block.loads, surface, now.clock);
        }
        self.turn(&mut block, now, &mut outcome);
        let (incoming, start) = self.table.incoming(block.start, block.loads.len());
        with_eight_lanes(TakeIn {
            incoming,
            start,
            out: self.out,
            clumps: self.clump_loads.get(block.start..).unwrap_or_default(),
            loads: &mut *block.loads,
        });
        let step = now.clock.step;
        if let Some(air) = self.scene.air {
            for own in 0..block.loads.len() {
                if block.motion[own][3] == PART_OF_CLUMP || self.is_foreign(block.start + own) {
                    continue;
                }
                let (m, radius) = (&block.motion[own], block.place[own][3]);
                let velocity = [m[0], m[1], m[2]];
                let area = std::f64::consts::PI * radius * radius;
                let drag = 0.5 * air.density * air.drag_coefficient * area * length(velocity);
                for axis in 0..3 {
                    block.loads[own][axis] -= drag * velocity[axis];
                }
                sums.drag += drag * dot(velocity, velocity) * step;
            }
        }
        if self.with_energy {
            self.energies(&block, step, &mut sums);
        }
        // Who follows others is told where they go.
        if !self.foreign.is_empty() {
            return (outcome, sums);
        }
        let bodies = block.place.len();
        let furthest = with_eight_lanes(Move {
            place: &mut *block.place,
            motion: &mut *block.motion,
            turn: &mut *block.turn,
            loads: block.loads,
            listed: &self.listed[block.start..block.start + bodies],
            gravity: self.scene.gravity,
            step,
        });
        sums.moved = furthest.way;
        // Also what is no number.
        let short = furthest.share <= LONGEST_WAY * LONGEST_WAY;
        if !short {
            outcome
                .problem
                .get_or_insert_with(|| self.too_fast(&block, now));
        }
        (outcome, sums)
    }

    /// Whether another rank follows the fruit of a body.
    fn is_foreign(&self, body: usize) -> bool {
        let foreign = self.foreign.get(self.bodies.0[body] as usize);
        foreign.is_some_and(|own| *own)
    }

    /// Where bodies of the block touch walls.
    fn aim_at_walls(&self, block: &mut BlockBodies, now: &Moment, outcome: &mut Outcome) {
        let mut hits = Vec::new();
        let materials = self.scene.materials.len();
        let start = self.near_start[block.start] as usize;
        for own in 0..block.place.len() {
            let body = block.start + own;
            let near = [body, body + 1].map(|own| self.near_start[own] as usize - start);
            if near[0] == near[1] {
                continue;
            }
            let material = &self.bodies.1[body];
            let (HalfLine([x, y, z, radius]), m) = (block.place[own], &block.motion[own]);
            let around = Around {
                walls: self.walls,
                near: near[0]..near[1],
                surface: |wall: u32| {
                    let other = self.scene.walls[wall as usize].material;
                    let number = self.numbers[*material as usize * materials + other];
                    (number, &self.surfaces[number])
                },
                now,
            };
            let body = Body {
                fruit: &self.bodies.0[body],
                centre: [x, y, z],
                radius,
                velocity: [m[0], m[1], m[2]],
                spin: [m[4], m[5], m[6]],
                turn: &block.turn[own],
                clump: (&self.clumps.0[body], &self.clumps.1[body]),
            };
            let stores = &mut *block.wall_contacts;
            let near = &mut *block.near;
            aim(near, own as u32, &body, &around, stores, &mut hits, outcome);
        }
    }

    /// Loads by walls that are over although their contact lasts.
    fn turn(&self, block: &mut BlockBodies, now: &Moment, outcome: &mut Outcome) {
        let (place, turn, near) = (&*block.place, &*block.turn, &*block.near);
        let met = |[own, part]: [u32; 2], touch: Touch<f64>| {
            let body = block.start + own as usize;
            let HalfLine([x, y, z, radius]) = place[own as usize];
            let clump = (self.clumps.0[body], self.clumps.1[body]);
            let turn = turn[own as usize];
            let encounter = met_wall(&touch, ([x, y, z], radius), (turn, clump), now.clock);
            let wall = self.walls.facets[near[part as usize].facet as usize].0;
            (encounter, self.bodies.0[body], Partner::Wall(wall))
        };
        for own in block.wall_contacts.iter_mut() {
            own.turn(now.clock, met, &mut outcome.events);
        }
    }

    /// Energies at the time of the places.
    fn energies(&self, block: &BlockBodies, step: f64, sums: &mut Sums) {
        for (own, load) in block.loads.iter().enumerate() {
            let (m, HalfLine([x, y, z, _])) = (&block.motion[own], block.place[own]);
            if m[3] == PART_OF_CLUMP || self.is_foreign(block.start + own) {
                continue;
            }
            let half = |axis: usize, by: f64| m[axis] + 0.5 * step * load[axis] * by;
            let velocity = [0, 1, 2].map(|axis| half(axis, m[3]));
            let velocity = plus_scaled(velocity, self.scene.gravity, 0.5 * step);
            let spin = [4, 5, 6].map(|axis| half(axis, m[7]));
            sums.kinetic += 0.5 * dot(velocity, velocity) / m[3];
            sums.rotational += 0.5 * dot(spin, spin) / m[7];
            sums.potential -= dot(self.scene.gravity, [x, y, z]) / m[3];
        }
    }

    /// The first body that moves too far in a step.
    #[cold]
    fn too_fast(&self, block: &BlockBodies, now: &Moment) -> Error {
        let (time, step) = (now.clock.time, now.clock.step);
        let mut problem = Error::NotFinite {
            time,
            fruit: self.bodies.0[block.start],
        };
        for (own, m) in block.motion.iter().enumerate() {
            let (fruit, radius) = (self.bodies.0[block.start + own], block.place[own][3]);
            let speed = length([m[0], m[1], m[2]]);
            if !speed.is_finite() {
                return Error::NotFinite { time, fruit };
            }
            if speed * step > LONGEST_WAY * radius {
                let share = 100.0 * speed * step / radius;
                problem = Error::Speed {
                    time,
                    fruit,
                    speed,
                    share,
                };
                break;
            }
        }
        problem
    }
}

/// What pairs of other blocks, and clumps, do to the bodies of a block.
struct TakeIn<'a> {
    /// Numbers of those pairs in which each body is second, and where those of each begin.
    incoming: &'a [u32],
    start: &'a [u32],
    out: &'a [Load],
    /// Of clumps on the bodies from the first of the block on, if there are clumps.
    clumps: &'a [Load],
    loads: &'a mut [Load],
}

impl EightLanes for TakeIn<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) {
        for (load, own) in self.loads.iter_mut().zip(self.start.windows(2)) {
            let numbers = &self.incoming[own[0] as usize..own[1] as usize];
            if numbers.is_empty() {
                continue;
            }
            let mut sum = zero.with_plain(Lanes(load.0));
            for number in numbers {
                sum = sum + zero.with_plain(Lanes(self.out[*number as usize].0));
            }
            load.0 = sum.plain().0;
        }
        for (load, own) in self.loads.iter_mut().zip(self.clumps) {
            add_load(load, zero.with_plain(Lanes(own.0)));
        }
    }
}

/// Bodies one step on, by what acts on them.
struct Move<'a> {
    place: &'a mut [HalfLine],
    motion: &'a mut [Line],
    turn: &'a mut [Rotation],
    loads: &'a [Load],
    listed: &'a [Row],
    gravity: Vector,
    step: f64,
}

/// Of all bodies that moved.
struct Furthest {
    /// Squares of the two largest ways since the list was made; m².
    way: [f64; 2],
    /// Square of the largest way in the step over the radius; 1. No number where a body has
    /// none.
    share: f64,
}

impl EightLanes for Move<'_> {
    type Output = Furthest;

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) -> Furthest {
        let step = self.step;
        let gravity = zero.constant(step);
        let gravity = [
            gravity * self.gravity[0],
            gravity * self.gravity[1],
            gravity * self.gravity[2],
        ];
        let (mut way, mut second) = (zero, zero);
        let (mut share, mut all) = (zero, zero);
        let count = self.place.len();
        for start in (0..count).step_by(EIGHT) {
            let lanes = EIGHT.min(count - start);
            // The last few are filled up with the last of them.
            let mut rows = [[Row::ZERO; EIGHT]; 7];
            for lane in 0..EIGHT {
                let own = start + lane.min(lanes - 1);
                let (m, load) = (&self.motion[own], &self.loads[own]);
                rows[0][lane] = Lanes(self.place[own].0);
                rows[1][lane] = Lanes([m[0], m[1], m[2], m[3]]);
                rows[2][lane] = Lanes([m[4], m[5], m[6], m[7]]);
                rows[3][lane] = Lanes([load[0], load[1], load[2], load[3]]);
                rows[4][lane] = Lanes([load[4], load[5], load[6], load[7]]);
                rows[5][lane] = Lanes(self.turn[own]);
                rows[6][lane] = self.listed[own];
            }
            let [mut place, mut velocity] = [zero.columns(rows[0]), zero.columns(rows[1])];
            let [mut spin, force] = [zero.columns(rows[2]), zero.columns(rows[3])];
            let [moment, listed] = [zero.columns(rows[4]), zero.columns(rows[6])];
            let mut from = [zero; 3];
            for axis in 0..3 {
                velocity[axis] =
                    velocity[axis] + force[axis] * (velocity[3] * step) + gravity[axis];
                spin[axis] = spin[axis] + moment[axis] * (spin[3] * step);
                place[axis] = place[axis] + velocity[axis] * step;
                from[axis] = place[axis] - listed[axis];
            }
            let turn = turned_on(zero.columns(rows[5]), [spin[0], spin[1], spin[2]], step);
            let own = dot(from, from);
            second = second.max(way.min(own));
            way = way.max(own);
            let velocities = [velocity[0], velocity[1], velocity[2]];
            let own = dot(velocities, velocities) * (step * step) / (place[3] * place[3]);
            share = share.max(own);
            // A largest one does not show what is no number.
            all = all + own;
            let (stands, moves) = (R::rows(place, turn), R::rows(velocity, spin));
            for lane in 0..lanes {
                let own = start + lane;
                let Lanes(row) = stands[lane].plain();
                self.place[own].copy_from_slice(&row[..LANES]);
                self.turn[own].copy_from_slice(&row[LANES..]);
                *self.motion[own] = moves[lane].plain().0;
            }
        }
        let Lanes(all) = all.plain();
        let finite = all.iter().all(|own| own.is_finite());
        let largest = |own: R| own.plain().0.into_iter().fold(0.0, f64::max);
        let [Lanes(way), Lanes(second)] = [way.plain(), second.plain()];
        let ways = way.into_iter().chain(second);
        Furthest {
            way: ways.fold([0.0; 2], |[a, b], own| [a.max(own), b.max(a.min(own))]),
            share: if finite { largest(share) } else { f64::NAN },
        }
    }
}
