//! Forces of pairs that touch, four at a time.

use crate::contacts::law_column::Four;
use crate::contacts::neighbours::BodiesFrom;
use crate::contacts::react::{Clock, Normal, Touch, direction_before, surface_motion};
use crate::contacts::store::{CHUNK, Load, Store, Turning, add_load, loads};
use crate::interaction::Interaction;
use crate::vector::dot;
use windfall_numerics::prefetch::prefetch;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{FourLanes, FourNumbers, LANES};

/// How many groups ahead memory is prefetched.
const AHEAD: usize = 24;

/// The bodies of a contact, from the first of the block on, and its number among those that
/// reach into another block, or [`NONE`](crate::contacts::store::NONE).
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    pub bodies: [u32; 2],
    pub out: u32,
}

/// Contacts of one block and one interaction.
pub(crate) struct Batch<'a> {
    pub bodies: &'a BodiesFrom<'a>,
    pub store: &'a mut Store,
    pub pairs: &'a [Pair],
    /// Loads of pairs on the bodies of the block.
    pub loads: &'a mut [Load],
    /// Loads on second bodies of other blocks.
    pub outs: &'a mut [Load],
    /// Contacts whose bodies do not touch any more: for the caller, in falling order.
    pub parting: &'a mut Vec<u32>,
    /// Contacts whose force has left its band.
    pub turning: &'a mut Vec<Turning>,
    pub surface: &'a Interaction,
    pub clock: Clock,
}

impl FourLanes for Batch<'_> {
    /// The largest overlap over the smaller radius; 1.
    type Output = f64;

    #[inline(always)]
    fn run<R: FourNumbers>(self, zero: R) -> f64 {
        let mut batch = self;
        let mut deepest = zero;
        let mut meetings = [Meeting::all(zero); CHUNK];
        let mut given = [[Lanes::ZERO; 3]; CHUNK];
        let mut found = [Normal::all(Lanes::ZERO); CHUNK];
        let groups = batch.pairs.len().div_ceil(LANES);
        let step = batch.clock.step;
        for first in (0..groups).step_by(CHUNK) {
            let count = CHUNK.min(groups - first);
            batch.prefetch(first + CHUNK);
            for own in 0..count {
                let meeting = meet(batch.bodies, batch.pairs_of(first + own), step, zero);
                let touch = &meeting.touch;
                deepest = deepest.max(touch.displacement / meeting.smaller);
                given[own] = batch.store.given(first + own, touch, zero);
                meetings[own] = meeting;
            }
            let (given, found) = (&given[..count], &mut found[..count]);
            batch.store.normal(batch.surface, first, given, found);
            for own in 0..count {
                batch.store.prefetch(first + own + AHEAD);
                batch.push(first + own, &meetings[own], &found[own], zero);
            }
        }
        batch.parting.reverse();
        let Lanes(deepest) = deepest.plain();
        deepest.into_iter().fold(0.0, f64::max)
    }
}

impl Batch<'_> {
    /// The bodies of a group of contacts; the last group is filled up with its last.
    #[inline(always)]
    fn pairs_of(&self, group: usize) -> [[u32; 2]; LANES] {
        let start = group * LANES;
        let last = self.pairs.len() - 1;
        [
            self.pairs[start].bodies,
            self.pairs[(start + 1).min(last)].bodies,
            self.pairs[(start + 2).min(last)].bodies,
            self.pairs[(start + 3).min(last)].bodies,
        ]
    }

    /// Asks for the memory of the bodies of the next groups, and of what is to push them.
    #[inline(always)]
    fn prefetch(&self, first: usize) {
        let later = self.pairs.iter().skip(first * LANES);
        for Pair { bodies, out } in later.take(CHUNK * LANES) {
            for body in bodies {
                prefetch(&self.bodies.place[*body as usize]);
                prefetch(&self.bodies.motion[*body as usize]);
            }
            if let Some(out) = self.outs.get(*out as usize) {
                prefetch(out);
            }
        }
    }

    /// Forces of a group, to those whom they push.
    #[inline(always)]
    fn push<R: FourNumbers>(
        &mut self,
        group: usize,
        meeting: &Meeting<R>,
        found: &Normal<Four>,
        zero: R,
    ) {
        let start = group * LANES;
        let count = LANES.min(self.pairs.len() - start);
        let touch = &meeting.touch;
        let Lanes(overlap) = touch.displacement.plain();
        let parted = [
            overlap[0] <= 0.0,
            overlap[1] <= 0.0,
            overlap[2] <= 0.0,
            overlap[3] <= 0.0,
        ];
        let together = parted == [false; LANES];
        let before = (!together).then(|| self.store.before(group));
        let work = (self.surface, self.clock);
        let reaction = self.store.react(group, touch, found, work, zero);
        let near = loads(touch.normal, &reaction, meeting.near, 1.0, zero);
        let far = loads(touch.normal, &reaction, meeting.far, -1.0, zero);
        if let Some(before) = before {
            self.store.restore(group, parted, &before);
            for lane in (0..count).filter(|lane| parted[*lane]) {
                self.parting.push((start + lane) as u32);
            }
        }
        let Lanes(turned) = reaction.turned.plain();
        for lane in 0..count {
            if !together && parted[lane] {
                continue;
            }
            if turned[lane] > 0.0 {
                self.turning.push(((start + lane) as u32, overlap[lane]));
            }
            let Pair { bodies, out } = self.pairs[start + lane];
            let [first, second] = bodies;
            add_load(
                &mut self.loads[first as usize],
                &near.0[lane],
                &near.1[lane],
            );
            // Second bodies stand behind.
            match self.loads.get_mut(second as usize) {
                Some(load) => add_load(load, &far.0[lane], &far.1[lane]),
                None => put(&mut self.outs[out as usize], &far.0[lane], &far.1[lane]),
            }
        }
    }
}

#[inline(always)]
fn put(to: &mut Load, force: &Four, moment: &Four) {
    to[..LANES].copy_from_slice(&force.0);
    to[LANES..].copy_from_slice(&moment.0);
}

/// Where four pairs touch.
#[derive(Clone, Copy)]
struct Meeting<R> {
    touch: Touch<R>,
    /// From the centre of the first body, and of the second, to the contact; m.
    near: R,
    far: R,
    /// The smaller radius; m.
    smaller: R,
}

impl<R: FourNumbers> Meeting<R> {
    fn all(zero: R) -> Self {
        Self {
            touch: Touch::all(zero),
            near: zero,
            far: zero,
            smaller: zero,
        }
    }
}

/// Half a row.
#[inline(always)]
fn half(row: &Load, at: usize) -> Four {
    Lanes([row[at], row[at + 1], row[at + 2], row[at + 3]])
}

#[inline(always)]
fn meet<R: FourNumbers>(
    bodies: &BodiesFrom,
    pairs: [[u32; 2]; LANES],
    step: f64,
    zero: R,
) -> Meeting<R> {
    let (places, motions) = (bodies.place, bodies.motion);
    let i = [pairs[0][0], pairs[1][0], pairs[2][0], pairs[3][0]];
    let j = [pairs[0][1], pairs[1][1], pairs[2][1], pairs[3][1]];
    let mut rows = [[Lanes::ZERO; LANES]; 6];
    for lane in 0..LANES {
        let (a, b) = (i[lane] as usize, j[lane] as usize);
        rows[0][lane] = Lanes(places[a].0);
        rows[1][lane] = Lanes(places[b].0);
        let (u, w) = (&motions[a], &motions[b]);
        rows[2][lane] = half(u, 0);
        rows[3][lane] = half(w, 0);
        rows[4][lane] = half(u, 4);
        rows[5][lane] = half(w, 4);
    }
    let [a, b] = [zero.columns(rows[0]), zero.columns(rows[1])];
    let [u, w] = [zero.columns(rows[2]), zero.columns(rows[3])];
    let [p, q] = [zero.columns(rows[4]), zero.columns(rows[5])];
    let between = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let (left, right) = (a[3], b[3]);
    let reach = left + right;
    let distance = dot(between, between).sqrt();
    let displacement = reach - distance;
    let inverse = zero.constant(1.0) / distance;
    let normal = [
        between[0] * inverse,
        between[1] * inverse,
        between[2] * inverse,
    ];
    let half = displacement * 0.5;
    let (near, far) = (left - half, right - half);
    let relative = [u[0] - w[0], u[1] - w[1], u[2] - w[2]];
    let arms = [
        near * p[0] + far * q[0],
        near * p[1] + far * q[1],
        near * p[2] + far * q[2],
    ];
    let before = direction_before((between, distance), relative, step);
    let (rate, slip) = surface_motion(relative, arms, before);
    Meeting {
        touch: Touch {
            normal,
            displacement,
            rate,
            slip,
            spin: [p[0] - q[0], p[1] - q[1], p[2] - q[2]],
            radius: left * right / reach,
        },
        near,
        far,
        smaller: left.min(right),
    }
}
