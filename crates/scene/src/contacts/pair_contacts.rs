//! Contacts of two fruit, compiled once for each law.

use crate::contacts::bodies::BodiesFrom;
use crate::contacts::contact::{Moment, Outcome, Over, Parcel, encounter, parted, spot, too_deep};
use crate::contacts::pair_forces::{Batch, Pair};
use crate::contacts::react::{Clock, Touch, direction_before, surface_motion};
use crate::contacts::store::{Load, Store, Turning};
use crate::error::{Error, fruit_name};
use crate::event::Encounter;
use crate::interaction::Interaction;
use crate::vector::{dot, length, plus_scaled, scaled};
use windfall_contact::effective::effective_radius;
use windfall_contact::laws::kind::Law;
use windfall_numerics::prefetch::prefetch;
use windfall_numerics::real_vector::with_eight_lanes;

/// The entries of one block and one interaction.
pub(crate) struct Part<'a> {
    /// From the first body of the block on.
    pub bodies: BodiesFrom<'a>,
    /// Number of that body.
    pub base: u32,
    pub first: &'a [u32],
    pub second: &'a [u32],
    /// Where each has what it does to a second body of another block, or [`NONE`](crate::contacts::store::NONE).
    pub out: &'a [u32],
    /// Loads of pairs on the bodies of the block.
    pub loads: &'a mut [Load],
    /// Loads on second bodies of other blocks; zero where nothing touches.
    pub outs: &'a mut [Load],
    /// How far two bodies may have come together since the list was made; m.
    pub approach: f64,
}

/// Contacts of one block and one interaction.
pub(crate) struct PairContacts {
    store: Store,
    entries: Vec<u32>,
    pairs: Vec<Pair>,
    /// Entries without a contact that may soon touch.
    awake: Vec<Awake>,
    /// Those that cannot before bodies have moved by half their gap; the widest first.
    asleep: Vec<(f64, u32)>,
    /// Contacts that end in the present step, and those whose force leaves its band.
    parting: Vec<u32>,
    turning: Vec<Turning>,
}

/// An entry and its bodies, from the first of the block on.
#[derive(Clone, Copy)]
struct Awake {
    entry: u32,
    pair: [u32; 2],
}

/// How many entries ahead memory is prefetched.
const AHEAD: usize = 16;

impl PairContacts {
    /// No contacts yet of an interaction, with room for so many, and for so many entries.
    pub fn new(surface: &Interaction, room: usize, entries: usize) -> Self {
        Self {
            store: Store::new(surface, room),
            entries: Vec::with_capacity(room),
            pairs: Vec::with_capacity(room),
            awake: Vec::new(),
            asleep: Vec::with_capacity(entries - room),
            parting: Vec::new(),
            turning: Vec::new(),
        }
    }

    /// Forces of all entries, one step on.
    pub(crate) fn advance(
        &mut self,
        part: Part,
        surface: &Interaction,
        now: &Moment,
        outcome: &mut Outcome,
    ) {
        let Part {
            bodies,
            base,
            first,
            second,
            out,
            loads,
            outs,
            approach,
        } = part;
        self.wake(approach, |entry| {
            [first[entry as usize] - base, second[entry as usize] - base]
        });
        if let Err(problem) = self.begin_all(&bodies, out, (surface, now)) {
            outcome.problem.get_or_insert(problem);
            return;
        }
        let mut parting = std::mem::take(&mut self.parting);
        let mut turning = std::mem::take(&mut self.turning);
        let deepest = with_eight_lanes(Batch {
            bodies: &bodies,
            store: &mut self.store,
            pairs: &self.pairs,
            loads,
            outs: &mut *outs,
            parting: &mut parting,
            turning: &mut turning,
            surface,
            clock: now.clock,
        });
        if deepest > 0.0 {
            outcome
                .problem
                .get_or_insert_with(|| self.deepest(&bodies, now));
        }
        for own in turning.drain(..) {
            if let Some(over) = self.store.turn(own, now.clock) {
                let pair = self.pairs[own.0 as usize].bodies;
                let (_, encounter) = met(pair, &bodies, now.clock);
                self.store.begin_again(own.0, encounter);
                outcome.events.extend(over.of_pair(fruit_of(pair, &bodies)));
            }
        }
        self.turning = turning;
        for contact in parting.drain(..) {
            let pair = self.finish(contact as usize, &bodies, now, outcome);
            if let Some(out) = outs.get_mut(pair.out as usize) {
                *out = Load::ZERO;
            }
        }
        self.parting = parting;
    }

    /// Number of contacts.
    pub(crate) fn count(&self) -> usize {
        self.store.len()
    }

    /// Takes over the contact of an entry of a new list; entries come in rising order.
    pub(crate) fn adopt(&mut self, entry: u32, pair: Pair, law: &Law, parcel: Parcel) {
        if self.store.adopt(law, parcel).is_some() {
            self.entries.push(entry);
            self.pairs.push(pair);
        }
    }

    /// Every other entry of a new list waits until it may touch.
    ///
    /// * `pairs`: the bodies of all entries
    pub(crate) fn wait(&mut self, pairs: impl Iterator<Item = [u32; 2]>, bodies: &BodiesFrom) {
        let mut known = self.entries.iter().copied().peekable();
        for (entry, pair) in (0..).zip(pairs) {
            if known.next_if_eq(&entry).is_none() {
                self.asleep.push((-bodies.overlap(pair), entry));
            }
        }
        let widest_first = |a: &(f64, u32), b: &(f64, u32)| (b.0, b.1).partial_cmp(&(a.0, a.1));
        self.asleep
            .sort_unstable_by(|a, b| widest_first(a, b).unwrap_or(std::cmp::Ordering::Equal));
    }

    /// The entries of contacts.
    pub(crate) fn entries(&self) -> &[u32] {
        &self.entries
    }

    /// Law and memory of a contact.
    pub(crate) fn at(&self, contact: usize) -> (Law, Parcel) {
        self.store.at(contact)
    }

    /// Entries whose bodies may have come together since the list was made.
    ///
    /// * `pair`: the bodies of an entry
    fn wake(&mut self, approach: f64, pair: impl Fn(u32) -> [u32; 2]) {
        while let Some(&(gap, entry)) = self.asleep.last() {
            let sleeps = gap > approach;
            if sleeps {
                break;
            }
            self.asleep.pop();
            let pair = pair(entry);
            self.awake.push(Awake { entry, pair });
        }
    }

    /// Contacts of entries that touch now.
    fn begin_all(
        &mut self,
        bodies: &BodiesFrom,
        out: &[u32],
        work: (&Interaction, &Moment),
    ) -> Result<(), Error> {
        let mut place = 0;
        while let Some(&Awake { entry, pair }) = self.awake.get(place) {
            if let Some(later) = self.awake.get(place + AHEAD) {
                for body in later.pair {
                    prefetch(&bodies.place[body as usize]);
                }
            }
            let [a, b] = pair.map(|body| &bodies.place[body as usize]);
            let between = bodies.between(pair);
            let reach = a[3] + b[3];
            let apart = dot(between, between) >= reach * reach || bodies.overlap(pair) <= 0.0;
            if apart {
                place += 1;
            } else {
                let out = out[entry as usize];
                self.begin(entry, Pair { bodies: pair, out }, bodies, work)?;
                self.awake.swap_remove(place);
            }
        }
        Ok(())
    }

    #[cold]
    fn begin(
        &mut self,
        entry: u32,
        pair: Pair,
        bodies: &BodiesFrom,
        (surface, now): (&Interaction, &Moment),
    ) -> Result<(), Error> {
        let [i, j] = pair.bodies.map(|body| body as usize);
        let draws = |body: usize| &now.fruit[bodies.fruit[body] as usize].draws;
        let (touch, encounter) = met(pair.bodies, bodies, now.clock);
        let law = surface.law_of(touch.radius, draws(i), Some(draws(j)))?;
        let parcel = Parcel::begin(
            surface.scale(touch.radius),
            &law,
            &touch,
            now.clock,
            encounter,
        );
        self.adopt(entry, pair, &law, parcel);
        Ok(())
    }

    /// The pair that overlaps too much.
    #[cold]
    fn deepest(&self, bodies: &BodiesFrom, now: &Moment) -> Error {
        let share = |pair: &Pair| {
            let [i, j] = pair.bodies.map(|body| body as usize);
            let radius = bodies.place[i][3].min(bodies.place[j][3]);
            (bodies.overlap(pair.bodies) / radius, i, j, radius)
        };
        let all = self.pairs.iter().map(share);
        let (share, i, j, radius) =
            all.fold((0.0, 0, 0, 1.0), |a, b| if b.0 > a.0 { b } else { a });
        let partner = fruit_name(bodies.fruit[j]);
        too_deep(
            now.clock.time,
            bodies.fruit[i],
            partner,
            share * radius,
            radius,
        )
    }

    /// A contact whose bodies part, out of the list.
    #[cold]
    fn finish(
        &mut self,
        contact: usize,
        bodies: &BodiesFrom,
        now: &Moment,
        outcome: &mut Outcome,
    ) -> Pair {
        let pair = self.pairs[contact].bodies;
        let gap = -bodies.overlap(pair);
        let (law, parcel) = self.store.at(contact);
        let over = Over::of(&parted(parcel, gap, now.clock), &law, false);
        outcome.events.extend(over.of_pair(fruit_of(pair, bodies)));
        self.store.remove(contact);
        let entry = self.entries.swap_remove(contact);
        self.awake.push(Awake { entry, pair });
        self.pairs.swap_remove(contact)
    }
}

/// The fruit of two bodies.
fn fruit_of(pair: [u32; 2], bodies: &BodiesFrom) -> (u32, u32) {
    let [i, j] = pair.map(|body| bodies.fruit[body as usize]);
    (i, j)
}

/// How two bodies touch now, as a beginning.
fn met(pair: [u32; 2], bodies: &BodiesFrom, clock: Clock) -> (Touch<f64>, Encounter) {
    let [i, j] = pair.map(|body| body as usize);
    let centre = |body: usize| [0, 1, 2].map(|axis| bodies.place[body][axis]);
    let (a, b) = (bodies.place[i][3], bodies.place[j][3]);
    let radius = effective_radius(a, b);
    let displacement = bodies.overlap(pair);
    let between = bodies.between(pair);
    let distance = length(between);
    let normal = scaled(between, 1.0 / distance);
    let (u, w) = (&bodies.motion[i], &bodies.motion[j]);
    let relative = [u[0] - w[0], u[1] - w[1], u[2] - w[2]];
    let arms = [4, 5, 6].map(|at| a * u[at] + b * w[at]);
    let before = direction_before((between, distance), relative, clock.step);
    let (rate, slip) = surface_motion(relative, arms, before);
    let touch = Touch {
        normal,
        displacement,
        rate,
        slip,
        spin: [4, 5, 6].map(|at| u[at] - w[at]),
        radius,
    };
    let mut encounter = encounter(&touch, clock);
    encounter.place = plus_scaled(centre(i), normal, a - 0.5 * displacement);
    let spot = |body: usize, normal| {
        let radius = bodies.place[body][3];
        spot(bodies.turn[body], bodies.offset_of(body), radius, normal)
    };
    encounter.spot = spot(i, normal);
    encounter.other_spot = spot(j, scaled(normal, -1.0));
    (touch, encounter)
}
