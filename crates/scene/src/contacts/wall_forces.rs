//! Forces of walls on the fruit that touch them, eight at a time.

use crate::contacts::contact::Parcel;
use crate::contacts::law_column::Eight;
use crate::contacts::react::{Clock, Normal, Touch};
use crate::contacts::store::{CHUNK, Load, NONE, Store, Turning, add_load, loads};
use crate::event::{Encounter, Event, Partner};
use crate::interaction::Interaction;
use crate::vector::Vector;
use windfall_contact::laws::kind::Law;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{EIGHT, EightLanes, EightNumbers, Row, with_eight_lanes};

/// How a fruit and a wall meet, in rows: normal and displacement, slip and R*, spin and distance
/// of the contact from the centre, velocity of the wall and rate of the displacement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallMeeting([Row; 4]);

impl WallMeeting {
    /// * `arm`: from the centre to the wall; m
    pub fn new(touch: &Touch<f64>, arm: f64, wall_velocity: Vector) -> Self {
        let row = |[x, y, z]: Vector, last: f64| Lanes([x, y, z, last]);
        Self([
            row(touch.normal, touch.displacement),
            row(touch.slip, touch.radius),
            row(touch.spin, arm),
            row(wall_velocity, touch.rate),
        ])
    }

    pub(crate) fn rows(&self) -> [[f64; 4]; 4] {
        self.0.map(|Lanes(row)| row)
    }

    /// How they touch; without spin.
    fn touch(&self) -> Touch<f64> {
        let [
            [x, y, z, displacement],
            [u, v, w, radius],
            _,
            [_, _, _, rate],
        ] = self.rows();
        Touch {
            normal: [x, y, z],
            displacement,
            rate,
            slip: [u, v, w],
            spin: [0.0; 3],
            radius,
        }
    }

    /// Of rows as [`WallMeeting::rows`] gives them.
    pub(crate) fn of_rows(rows: [[f64; 4]; 4]) -> Self {
        Self(rows.map(Lanes))
    }

    /// From the fruit to the wall; length 1.
    pub(crate) fn normal(&self) -> Vector {
        let Lanes([x, y, z, _]) = self.0[0];
        [x, y, z]
    }
}

/// Contacts of the bodies of one block with walls, of one interaction.
pub(crate) struct WallContacts {
    store: Store,
    /// The body of each, and the place of the part of the wall.
    holders: Vec<[u32; 2]>,
    meetings: Vec<WallMeeting>,
    /// Force on the fruit a step ago; N.
    forces: Vec<Row>,
    /// Those whose force leaves its band in the present step.
    turning: Vec<Turning>,
}

impl WallContacts {
    /// No contacts yet of an interaction.
    pub fn new(surface: &Interaction) -> Self {
        Self {
            store: Store::new(surface, 0),
            holders: Vec::new(),
            meetings: Vec::new(),
            forces: Vec::new(),
            turning: Vec::new(),
        }
    }

    /// Takes over a contact; its number.
    ///
    /// * `holder`: the body of the block, and the place of the part among those near
    /// * `force`: on the fruit a step ago; N
    pub(crate) fn adopt(
        &mut self,
        holder: [u32; 2],
        law: &Law,
        parcel: Parcel,
        force: Vector,
    ) -> u32 {
        let slot = self.store.adopt(law, parcel);
        if slot.is_some() {
            let [x, y, z] = force;
            self.holders.push(holder);
            self.meetings.push(WallMeeting([Lanes::ZERO; 4]));
            self.forces.push(Lanes([x, y, z, 0.0]));
        }
        slot.unwrap_or(NONE)
    }

    /// Another part of the wall takes over a contact.
    pub(crate) fn hold(&mut self, slot: u32, place: u32) {
        self.holders[slot as usize][1] = place;
    }

    /// Law, memory and last force of a contact.
    pub(crate) fn at(&self, slot: u32) -> (Law, Parcel, Vector) {
        let (law, parcel) = self.store.at(slot as usize);
        let Lanes([x, y, z, _]) = self.forces[slot as usize];
        (law, parcel, [x, y, z])
    }

    /// Takes out a contact; the place of the part whose contact takes its number.
    pub(crate) fn remove(&mut self, slot: u32) -> Option<u32> {
        let at = slot as usize;
        self.store.remove(at);
        self.holders.swap_remove(at);
        self.meetings.swap_remove(at);
        self.forces.swap_remove(at);
        self.holders.get(at).map(|[_, place]| *place)
    }

    /// Where a contact touches now.
    pub(crate) fn aim(&mut self, slot: u32, meeting: WallMeeting) {
        self.meetings[slot as usize] = meeting;
    }

    /// Where it touched last.
    pub(crate) fn meeting(&self, slot: u32) -> WallMeeting {
        self.meetings[slot as usize]
    }

    /// Adds the forces of all to the loads of the block's bodies, one step on; the work that
    /// walls did, J.
    pub(crate) fn advance(
        &mut self,
        loads: &mut [Load],
        surface: &Interaction,
        clock: Clock,
    ) -> f64 {
        if self.holders.is_empty() {
            return 0.0;
        }
        with_eight_lanes(Batch {
            contacts: self,
            loads,
            surface,
            clock,
        })
    }

    /// Loads that are over because the force of their contact has left its band.
    ///
    /// * `met`: how a body of the block and a part of a wall meet now, as a beginning; with the
    ///   fruit and its partner
    pub(crate) fn turn(
        &mut self,
        clock: Clock,
        met: impl Fn([u32; 2], Touch<f64>) -> (Encounter, u32, Partner),
        events: &mut Vec<Event>,
    ) {
        let mut turning = std::mem::take(&mut self.turning);
        for own in turning.drain(..) {
            if let Some(over) = self.store.turn(own, clock) {
                let slot = own.0 as usize;
                let touch = self.meetings[slot].touch();
                let (encounter, fruit, partner) = met(self.holders[slot], touch);
                self.store.begin_again(own.0, encounter);
                events.extend(over.with(fruit, partner));
            }
        }
        self.turning = turning;
    }

    /// How a group meets walls; the last group is filled up with its last contact.
    #[inline(always)]
    fn meet<R: EightNumbers>(&self, group: usize, zero: R) -> Meeting<R> {
        let last = self.meetings.len() - 1;
        let mut rows = [[Row::ZERO; EIGHT]; 4];
        for lane in 0..EIGHT {
            let own = &self.meetings[(group * EIGHT + lane).min(last)];
            for row in 0..4 {
                rows[row][lane] = own.0[row];
            }
        }
        let [x, y, z, displacement] = zero.columns(rows[0]);
        let [u, v, w, radius] = zero.columns(rows[1]);
        let [p, q, r, arm] = zero.columns(rows[2]);
        let [a, b, c, rate] = zero.columns(rows[3]);
        let touch = Touch {
            normal: [x, y, z],
            displacement,
            rate,
            slip: [u, v, w],
            spin: [p, q, r],
            radius,
        };
        let wall = [a, b, c];
        Meeting { touch, arm, wall }
    }
}

/// All contacts in a step.
struct Batch<'a> {
    contacts: &'a mut WallContacts,
    loads: &'a mut [Load],
    surface: &'a Interaction,
    clock: Clock,
}

/// How eight fruit meet walls.
#[derive(Clone, Copy)]
struct Meeting<R> {
    touch: Touch<R>,
    /// From the centre to the wall; m.
    arm: R,
    /// Velocity of the wall; m/s.
    wall: [R; 3],
}

impl EightLanes for Batch<'_> {
    /// Work that walls did; J.
    type Output = f64;

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) -> f64 {
        let mut batch = self;
        let mut meetings = [Meeting {
            touch: Touch::all(zero),
            arm: zero,
            wall: [zero; 3],
        }; CHUNK];
        let mut given = [[Lanes::ZERO; 3]; CHUNK];
        let mut found = [Normal::all(Lanes::ZERO); CHUNK];
        let mut work = zero;
        let groups = batch.contacts.holders.len().div_ceil(EIGHT);
        for first in (0..groups).step_by(CHUNK) {
            let count = CHUNK.min(groups - first);
            for own in 0..count {
                meetings[own] = batch.contacts.meet(first + own, zero);
                let touch = &meetings[own].touch;
                given[own] = batch.contacts.store.given(first + own, touch, zero);
            }
            let (given, found) = (&given[..count], &mut found[..count]);
            batch
                .contacts
                .store
                .normal(batch.surface, first, given, found);
            for own in 0..count {
                work = work + batch.push(first + own, &meetings[own], &found[own], zero);
            }
        }
        let Lanes(work) = work.plain();
        work.into_iter().sum()
    }
}

impl Batch<'_> {
    /// Forces of a group on its bodies; the work of walls, J.
    #[inline(always)]
    fn push<R: EightNumbers>(
        &mut self,
        group: usize,
        meeting: &Meeting<R>,
        found: &Normal<Eight>,
        zero: R,
    ) -> R {
        let WallContacts {
            store,
            holders,
            forces,
            turning,
            ..
        } = &mut *self.contacts;
        let Meeting { touch, arm, wall } = meeting;
        let start = group * EIGHT;
        let count = EIGHT.min(holders.len() - start);
        let on = (self.surface, self.clock);
        let reaction = store.react(group, touch, found, on, zero);
        let acting = loads(touch.normal, &reaction, *arm, 1.0, zero);
        let mut before = [Row::ZERO; EIGHT];
        before[..count].copy_from_slice(&forces[start..start + count]);
        let before = zero.columns(before);
        let mut power = zero;
        for axis in 0..3 {
            power = power + (before[axis] + reaction.force[axis]) * wall[axis];
        }
        let Lanes(mut work) = (power * (0.5 * self.clock.step)).plain();
        work[count..].fill(0.0);
        let (Lanes(turned), Lanes(depth)) = (reaction.turned.plain(), touch.displacement.plain());
        for lane in 0..count {
            if turned[lane] > 0.0 {
                turning.push(((start + lane) as u32, depth[lane]));
            }
            let Lanes([x, y, z, ..]) = acting[lane].plain();
            forces[start + lane] = Lanes([x, y, z, 0.0]);
            let body = holders[start + lane][0] as usize;
            add_load(&mut self.loads[body], acting[lane]);
        }
        zero.with_plain(Lanes(work))
    }
}
