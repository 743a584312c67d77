//! What contacts remember, eight side by side.

use crate::annuli::Annuli;
use crate::contacts::contact::{Over, Parcel, turn};
use crate::contacts::law_column::{Eight, Given, LawColumn, law_column};
use crate::contacts::memory::{Memory, Peaks};
use crate::contacts::pulse::Pulse;
use crate::contacts::react::{Clock, Normal, Reaction, Remembered, Touch, given, react};
use crate::event::Encounter;
use crate::interaction::Interaction;
use crate::line::Line;
use crate::vector::{Of, cross};
use std::ops::Range;
use windfall_contact::laws::kind::Law;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{EIGHT, EightNumbers};

/// No contact, body or entry.
pub(crate) const NONE: u32 = u32::MAX;

/// Force (N) and moment (N m) on a body: 0 to 2 and 4 to 6.
pub(crate) type Load = Line;

/// Groups of eight that are worked through at a time.
pub(crate) const CHUNK: usize = 4;

/// What every step needs of eight contacts, in whole lines of a processor's memory: those that
/// every step writes, and those that few do.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Group {
    history: Memory<Eight>,
    peaks: Peaks<Eight>,
    /// What radii multiply the median's force by; 1.
    scale: Eight,
}

/// Contacts under one law; what is needed in every step stands apart from the rest.
pub(crate) struct Store {
    groups: Vec<Group>,
    /// Elastic forces of the annuli of each group on the first bodies; N.
    elastic: Vec<Of<Eight>>,
    /// Annuli of a contact.
    annuli: usize,
    /// Moments against rolling on the first bodies, where anything acts against it; N m.
    rolling: Vec<Of<Eight>>,
    rolls: bool,
    laws: Box<dyn LawColumn>,
    encounters: Vec<Encounter>,
    pulses: Vec<Pulse>,
}

/// A contact whose force has left its band, with its displacement; m.
pub(crate) type Turning = (u32, f64);

impl Store {
    /// No contacts yet of an interaction, with room for so many.
    pub fn new(surface: &Interaction, room: usize) -> Self {
        let groups = room.div_ceil(EIGHT);
        Self {
            groups: Vec::with_capacity(groups),
            elastic: Vec::with_capacity(groups * surface.annuli),
            annuli: surface.annuli,
            rolling: Vec::with_capacity(if surface.rolls() { groups } else { 0 }),
            rolls: surface.rolls(),
            laws: law_column(&surface.law, room),
            encounters: Vec::with_capacity(room),
            pulses: Vec::with_capacity(room),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.encounters.len()
    }

    /// Takes over a contact; its number. The law of an interaction keeps its kind.
    pub(crate) fn adopt(&mut self, law: &Law, parcel: Parcel) -> Option<u32> {
        if !self.laws.push(law) {
            return None;
        }
        let own = self.len();
        if own.is_multiple_of(EIGHT) {
            self.groups.push(Group {
                history: Memory::ZERO,
                peaks: Peaks::ZERO,
                scale: Lanes::ZERO,
            });
            if self.rolls {
                self.rolling.push([Lanes::ZERO; 3]);
            }
            let elastic = self.elastic.len() + self.annuli;
            self.elastic.resize(elastic, [Lanes::ZERO; 3]);
        }
        self.encounters.push(parcel.encounter);
        self.pulses.push(parcel.pulse);
        self.put(own, &parcel);
        Some(own as u32)
    }

    /// Law and memory of a contact.
    pub(crate) fn at(&self, contact: usize) -> (Law, Parcel) {
        (self.laws.at(contact), self.parcel(contact))
    }

    pub(crate) fn parcel(&self, contact: usize) -> Parcel {
        let (group, lane) = (contact / EIGHT, contact % EIGHT);
        let eight = &self.groups[group];
        Parcel {
            scale: eight.scale.0[lane],
            history: eight.history.lane(lane),
            peaks: eight.peaks.lane(lane),
            annuli: self.annuli_of(contact),
            rolling: match self.rolling.get(group) {
                Some(own) => own.map(|axis| axis.0[lane]),
                None => [0.0; 3],
            },
            encounter: self.encounters[contact],
            pulse: self.pulses[contact],
        }
    }

    /// Takes out a contact; the last one takes its number.
    pub(crate) fn remove(&mut self, contact: usize) {
        let last = self.len() - 1;
        let moved = self.parcel(last);
        self.put(contact, &moved);
        self.laws.swap_remove(contact);
        self.encounters.swap_remove(contact);
        self.pulses.swap_remove(contact);
        if last.is_multiple_of(EIGHT) {
            self.groups.pop();
            self.rolling.pop();
            self.elastic.truncate(self.elastic.len() - self.annuli);
        }
    }

    /// Where the annuli of a group of eight stand.
    #[inline(always)]
    fn annuli(&self, group: usize) -> Range<usize> {
        group * self.annuli..(group + 1) * self.annuli
    }

    fn annuli_of(&self, contact: usize) -> Annuli {
        let mut all = Annuli::default();
        let lanes = &self.elastic[self.annuli(contact / EIGHT)];
        for (own, lanes) in all.0.iter_mut().zip(lanes) {
            *own = lanes.map(|axis| axis.0[contact % EIGHT]);
        }
        all
    }

    /// All but the encounter.
    fn put(&mut self, contact: usize, parcel: &Parcel) {
        let (group, lane) = (contact / EIGHT, contact % EIGHT);
        let annuli = self.annuli(group);
        let eight = &mut self.groups[group];
        eight.history.put_lane(lane, &parcel.history);
        eight.peaks.put_lane(lane, &parcel.peaks);
        eight.scale.0[lane] = parcel.scale;
        let rolling = self.rolling.get_mut(group).zip(Some(&parcel.rolling));
        let elastic = self.elastic[annuli].iter_mut().zip(&parcel.annuli.0);
        for (lanes, own) in elastic.chain(rolling) {
            for axis in 0..3 {
                lanes[axis].0[lane] = own[axis];
            }
        }
    }

    /// What contacts of a group remember before a step.
    pub(crate) fn before(&self, group: usize) -> [Parcel; EIGHT] {
        let last = self.len() - 1;
        std::array::from_fn(|lane| self.parcel((group * EIGHT + lane).min(last)))
    }

    /// Puts back what contacts of a group were before a step.
    pub(crate) fn restore(&mut self, group: usize, lanes: [bool; EIGHT], before: &[Parcel; EIGHT]) {
        for lane in (0..EIGHT).filter(|lane| lanes[*lane]) {
            if group * EIGHT + lane < self.len() {
                self.put(group * EIGHT + lane, &before[lane]);
            }
        }
    }

    /// The force of a contact has left its band; the loads that are over.
    #[cold]
    pub(crate) fn turn(&mut self, (contact, displacement): Turning, clock: Clock) -> Option<Over> {
        let contact = contact as usize;
        let (eight, lane) = (&mut self.groups[contact / EIGHT], contact % EIGHT);
        let mut history = eight.history.lane(lane);
        let mut peaks = eight.peaks.lane(lane);
        let pulse = &mut self.pulses[contact];
        let now = (clock.time, displacement);
        let laws = &self.laws;
        let encounter = &mut self.encounters[contact];
        let law = || laws.at(contact);
        let over = turn(&mut history, &mut peaks, pulse, encounter, law, now);
        eight.peaks.put_lane(lane, &peaks);
        if over.is_some() {
            eight.history.put_lane(lane, &history);
        }
        over
    }

    /// A later pulse of a contact began.
    pub(crate) fn begin_again(&mut self, contact: u32, encounter: Encounter) {
        let contact = contact as usize;
        self.encounters[contact] = encounter.from(self.pulses[contact].rise.time);
    }

    /// Arguments of the law for a group of eight.
    #[inline(always)]
    pub(crate) fn given<R: EightNumbers>(&self, group: usize, touch: &Touch<R>, zero: R) -> Given {
        let Group { history, peaks, .. } = &self.groups[group];
        let peak = zero.with_plain(peaks.displacement);
        zero.each_plain(given(touch, zero.with_plain(history.rate), peak))
    }

    /// What the laws of some groups say.
    pub(crate) fn normal(
        &self,
        surface: &Interaction,
        first: usize,
        given: &[Given],
        found: &mut [Normal<Eight>],
    ) {
        let median = surface.spread.is_none().then_some(&surface.law);
        self.laws.normal(median, first, given, found);
    }

    /// Forces of a group of eight, one step on.
    ///
    /// * `found`: what the law says
    #[inline(always)]
    pub(crate) fn react<R: EightNumbers>(
        &mut self,
        group: usize,
        touch: &Touch<R>,
        found: &Normal<Eight>,
        (surface, clock): (&Interaction, Clock),
        zero: R,
    ) -> Reaction<R> {
        let annuli = self.annuli(group);
        let eight = &mut self.groups[group];
        let mut memory = eight.history.with_plain(zero);
        let before = eight.peaks.with_plain(zero);
        let mut peaks = before;
        // The laws of fruit that differ have the factor within.
        let scale = match surface.spread {
            None => zero.with_plain(eight.scale),
            Some(_) => zero.constant(1.0),
        };
        let found = Normal {
            force: zero.with_plain(found.force) * scale,
            damping: zero.with_plain(found.damping) * scale,
            stiffness: zero.with_plain(found.stiffness) * scale,
        };
        let rolls = self.rolls;
        let mut moment = match rolls {
            true => zero.with_each_plain(self.rolling[group]),
            false => [zero; 3],
        };
        let own = Remembered {
            memory: &mut memory,
            peaks: &mut peaks,
            annuli: &mut self.elastic[annuli],
            rolling: if rolls { Some(&mut moment) } else { None },
        };
        let reaction = react(found, surface, touch, clock, own);
        eight.history = memory.plain();
        if peaks.growth_from(&before).any_above_zero() {
            eight.peaks = peaks.plain();
        }
        if rolls {
            self.rolling[group] = zero.each_plain(moment);
        }
        reaction
    }
}

/// Loads of eight contacts: on the first bodies, or on the second.
///
/// * `arm`: from the body's centre to the contact; m
/// * `sign`: of the force on it
#[inline(always)]
pub(crate) fn loads<R: EightNumbers>(
    normal: Of<R>,
    reaction: &Reaction<R>,
    arm: R,
    sign: f64,
    zero: R,
) -> [R; EIGHT] {
    let (force, twist) = (reaction.force, cross(normal, reaction.force));
    let rolling = reaction.rolling;
    R::rows(
        [force[0] * sign, force[1] * sign, force[2] * sign, zero],
        [
            twist[0] * arm + rolling[0] * sign,
            twist[1] * arm + rolling[1] * sign,
            twist[2] * arm + rolling[2] * sign,
            zero,
        ],
    )
}

/// Adds one of [`loads`].
#[inline(always)]
pub(crate) fn add_load<R: EightNumbers>(to: &mut Load, own: R) {
    let Lanes(sum) = (own.with_plain(Lanes(to.0)) + own).plain();
    to.0 = sum;
}
