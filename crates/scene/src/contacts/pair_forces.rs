//! Forces of pairs that touch, eight at a time.

use crate::contacts::bodies::BodiesFrom;
use crate::contacts::contact::LARGEST_OVERLAP;
use crate::contacts::law_column::Eight;
use crate::contacts::react::{Clock, Normal, Touch, direction_before, surface_motion};
use crate::contacts::store::{CHUNK, Load, Store, Turning, add_load, loads};
use crate::interaction::Interaction;
use crate::vector::dot;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{EIGHT, EightLanes, EightNumbers, Row};

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

impl EightLanes for Batch<'_> {
    /// The largest overlap beyond [`LARGEST_OVERLAP`]; m.
    type Output = f64;

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) -> f64 {
        let mut batch = self;
        let mut deepest = zero;
        let mut meetings = [Meeting::all(zero); CHUNK];
        let mut given = [[Lanes::ZERO; 3]; CHUNK];
        let mut found = [Normal::all(Lanes::ZERO); CHUNK];
        let groups = batch.pairs.len().div_ceil(EIGHT);
        let (step, rolls) = (batch.clock.step, batch.surface.rolls());
        for first in (0..groups).step_by(CHUNK) {
            let count = CHUNK.min(groups - first);
            for own in 0..count {
                let pairs = batch.pairs_of(first + own);
                let meeting = meet(batch.bodies, pairs, (step, rolls), zero);
                let touch = &meeting.touch;
                deepest = deepest.max(touch.displacement - meeting.smaller * LARGEST_OVERLAP);
                given[own] = batch.store.given(first + own, touch, zero);
                meetings[own] = meeting;
            }
            let (given, found) = (&given[..count], &mut found[..count]);
            batch.store.normal(batch.surface, first, given, found);
            for own in 0..count {
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
    fn pairs_of(&self, group: usize) -> [[u32; 2]; EIGHT] {
        let start = group * EIGHT;
        let last = self.pairs.len() - 1;
        let mut pairs = [self.pairs[start].bodies; EIGHT];
        for lane in 1..EIGHT {
            pairs[lane] = self.pairs[(start + lane).min(last)].bodies;
        }
        pairs
    }

    /// Forces of a group, to those whom they push.
    #[inline(always)]
    fn push<R: EightNumbers>(
        &mut self,
        group: usize,
        meeting: &Meeting<R>,
        found: &Normal<Eight>,
        zero: R,
    ) {
        let start = group * EIGHT;
        let count = EIGHT.min(self.pairs.len() - start);
        let touch = &meeting.touch;
        let Lanes(overlap) = touch.displacement.plain();
        let mut parted = [false; EIGHT];
        for lane in 0..EIGHT {
            parted[lane] = overlap[lane] <= 0.0;
        }
        let together = parted == [false; EIGHT];
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
        if reaction.turned.any_above_zero() {
            let Lanes(turned) = reaction.turned.plain();
            for lane in (0..count).filter(|lane| !parted[*lane] && turned[*lane] > 0.0) {
                self.turning.push(((start + lane) as u32, overlap[lane]));
            }
        }
        for (lane, pair) in self.pairs[start..start + count].iter().enumerate() {
            if !together && parted[lane] {
                continue;
            }
            let Pair { bodies, out } = *pair;
            let [first, second] = bodies;
            add_load(&mut self.loads[first as usize], near[lane]);
            // Second bodies stand behind.
            match self.loads.get_mut(second as usize) {
                Some(load) => add_load(load, far[lane]),
                None => self.outs[out as usize].0 = far[lane].plain().0,
            }
        }
    }
}

/// Where eight pairs touch.
#[derive(Clone, Copy)]
struct Meeting<R> {
    touch: Touch<R>,
    /// From the centre of the first body, and of the second, to the contact; m.
    near: R,
    far: R,
    /// The smaller radius; m.
    smaller: R,
}

impl<R: EightNumbers> Meeting<R> {
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
fn half(row: &Load, at: usize) -> Row {
    Lanes([row[at], row[at + 1], row[at + 2], row[at + 3]])
}

#[inline(always)]
fn meet<R: EightNumbers>(
    bodies: &BodiesFrom,
    pairs: [[u32; 2]; EIGHT],
    (step, rolls): (f64, bool),
    zero: R,
) -> Meeting<R> {
    let (places, motions) = (bodies.place, bodies.motion);
    let mut rows = [[Row::ZERO; EIGHT]; 6];
    for lane in 0..EIGHT {
        let [a, b] = [pairs[lane][0] as usize, pairs[lane][1] as usize];
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
    let between = bodies.periods.nearest(between);
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
            // Only what rolls has a use for it.
            radius: if rolls { left * right / reach } else { zero },
        },
        near,
        far,
        smaller: left.min(right),
    }
}
