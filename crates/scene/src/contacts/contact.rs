//! One contact from its beginning to its event, whatever it is with.

use crate::annuli::Annuli;
use crate::binary;
use crate::contacts::memory::{History, Peaks};
use crate::contacts::pulse::{Load, Mark, Pulse, Watched};
use crate::contacts::react::{Clock, Touch, first_force, first_weight, stored_energy};
use crate::error::Error;
use crate::event::{Encounter, Event, Partner};
use crate::scene::Fruit;
use crate::vector::{Rotation, Vector, dot, length, plus_scaled, scaled, turned_back, unit};
use windfall_contact::laws::kind::Law;

/// What every contact of a step needs to know.
#[derive(Clone, Copy)]
pub(crate) struct Moment<'a> {
    pub fruit: &'a [Fruit],
    pub clock: Clock,
}

/// What a block of contacts brings about besides forces.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub events: Vec<Event>,
    pub problem: Option<Error>,
}

/// A contact that is carried into a new list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parcel {
    /// What radii multiply the median's force by; 1.
    pub scale: f64,
    pub history: History,
    pub peaks: Peaks<f64>,
    /// Elastic forces of the annuli on the first body; N.
    pub annuli: Annuli,
    /// Moment against rolling on the first body; N m.
    pub rolling: Vector,
    pub encounter: Encounter,
    pub pulse: Pulse,
}

binary!(Parcel {
    scale,
    history,
    peaks,
    annuli,
    rolling,
    encounter,
    pulse
});

impl Parcel {
    /// A contact that begins.
    ///
    /// * `touch`: at the end of the step of first touch
    /// * `law`: with the fruit's own parameters
    pub(crate) fn begin(
        scale: f64,
        law: &Law,
        touch: &Touch<f64>,
        clock: Clock,
        encounter: Encounter,
    ) -> Self {
        Self {
            scale,
            history: History {
                // So that the first rate taken on from here is that along the normal of now.
                rate: touch.rate - 2.0 * dot(touch.slip, touch.normal),
                normal: -first_weight(law, touch, clock.step),
                ..History::default()
            },
            peaks: Peaks {
                ended: clock.time,
                force: first_force(law, touch, clock.step),
                ..Peaks::default()
            },
            annuli: Annuli::default(),
            rolling: [0.0; 3],
            encounter,
            pulse: Pulse {
                last: Mark {
                    time: encounter.time,
                    ..Mark::default()
                },
                ..Pulse::default()
            },
        }
    }

    /// The same contact seen from the second body.
    pub(crate) fn swapped(self) -> Self {
        Self {
            scale: self.scale,
            history: self.history.swapped(),
            peaks: self.peaks,
            annuli: self.annuli.swapped(),
            rolling: scaled(self.rolling, -1.0),
            encounter: self.encounter.swapped(),
            pulse: self.pulse,
        }
    }
}

/// Overlap over the smaller radius above which a law of two spheres means nothing.
pub(crate) const LARGEST_OVERLAP: f64 = 0.3;

/// Why a contact with so much overlap means nothing.
pub(crate) fn too_deep(time: f64, fruit: u32, partner: String, overlap: f64, radius: f64) -> Error {
    match overlap.is_finite() {
        true => Error::Overlap {
            time,
            fruit,
            partner,
            overlap,
            share: 100.0 * overlap / radius,
        },
        false => Error::NotFinite { time, fruit },
    }
}

/// How a contact begins; place and spots are the caller's.
pub(crate) fn encounter(touch: &Touch<f64>, clock: Clock) -> Encounter {
    let &Touch {
        displacement,
        rate,
        slip,
        ..
    } = touch;
    // First touch lies within the step.
    let since = match rate > 0.0 {
        true => (displacement / rate).min(clock.step),
        false => 0.0,
    };
    Encounter {
        time: clock.time - since,
        place: [0.0; 3],
        spot: [0.0; 3],
        other_spot: [0.0; 3],
        normal_speed: rate,
        tangential_speed: length(slip),
    }
}

/// Where on its fruit a body is touched: a direction from the fruit's centre that turns with it.
///
/// * `offset`: of the body from the centre of its clump, if it belongs to one; m
/// * `normal`: from the body's centre to where it is touched; length 1
pub(crate) fn spot(turn: Rotation, offset: Option<Vector>, radius: f64, normal: Vector) -> Vector {
    let inward = turned_back(turn, normal);
    let from_centre = offset.and_then(|offset| unit(plus_scaled(offset, inward, radius)));
    from_centre.unwrap_or(inward)
}

/// A contact with its last step: bodies part with a force that is there to the end.
pub(crate) fn parted(mut parcel: Parcel, gap: f64, clock: Clock) -> Parcel {
    let history = &mut parcel.history;
    if history.normal > 0.0 {
        history.work += 0.5 * history.normal * history.rate * clock.step;
        let since = match history.rate < 0.0 {
            true => (gap / -history.rate).min(clock.step),
            false => 0.0,
        };
        parcel.peaks.ended = clock.time - since;
    }
    parcel
}

/// A contact that lasts, as if it ended with the last step.
///
/// * `last`: when that was; s
pub(crate) fn lasting(mut parcel: Parcel, last: f64) -> Parcel {
    if parcel.history.normal > 0.0 {
        parcel.peaks.ended = last;
    }
    parcel
}

/// Loads that are over, as the first body sees them.
pub(crate) struct Over {
    pub encounter: Encounter,
    /// Loads of the contact before.
    pub before: u32,
    pub pulse: Load,
    pub rest: Option<Load>,
    /// Whether the last of them was still there when the scene ended.
    pub lasting: bool,
}

impl Over {
    /// What is left of a contact when it ends.
    ///
    /// * `law`: of this contact
    pub(crate) fn of(parcel: &Parcel, law: &Law, lasting: bool) -> Self {
        let (history, peaks) = (&parcel.history, &parcel.peaks);
        let end = Mark {
            time: peaks.ended,
            force: history.normal,
            displacement: peaks.reach,
            work: history.work,
            friction_work: history.friction_work,
        };
        let most = [peaks.force, peaks.reach];
        let stored = |depth: f64| stored_energy(law, depth, peaks.displacement);
        let began = parcel.encounter.time;
        let (pulse, rest) = parcel.pulse.parts(began, (end, 0.0), most, &stored);
        Self {
            encounter: parcel.encounter,
            before: parcel.pulse.number,
            pulse,
            rest,
            lasting,
        }
    }

    /// As events of two fruit; the lower number first.
    pub(crate) fn of_pair(mut self, (first, second): (u32, u32)) -> impl Iterator<Item = Event> {
        if second < first {
            self.encounter = self.encounter.swapped();
        }
        let partner = Partner::Fruit(first.max(second));
        self.with(first.min(second), partner)
    }

    /// As events of a fruit with its partner.
    pub(crate) fn with(self, fruit: u32, partner: Partner) -> impl Iterator<Item = Event> {
        let loads = [Some(self.pulse), self.rest].into_iter().flatten();
        let last = usize::from(self.rest.is_some());
        let encounter = self.encounter;
        let speed = |load: &Load, own: f64| if load.resting { 0.0 } else { own };
        loads.enumerate().map(move |(place, load)| Event {
            fruit,
            partner,
            time: load.began,
            duration: load.ended - load.began,
            lasting: self.lasting && place == last,
            number: self.before + 1 + place as u32,
            resting: load.resting,
            width: load.fell - load.began,
            place: encounter.place,
            spot: encounter.spot,
            other_spot: encounter.other_spot,
            normal_speed: speed(&load, encounter.normal_speed),
            tangential_speed: speed(&load, encounter.tangential_speed),
            peak_force: load.force,
            largest_displacement: load.displacement,
            absorbed_energy: load.work,
            friction_energy: load.friction_work,
        })
    }
}

/// A contact whose speed grows so many times from first touch on is pushed by others; 1.
const PUSHED: f64 = 1.5;

/// A force leaves its band; the loads that are over.
///
/// * `encounter`: of the present pulse; `law`: of this contact
pub(crate) fn turn(
    history: &mut History,
    peaks: &mut Peaks<f64>,
    pulse: &mut Pulse,
    encounter: &mut Encounter,
    law: impl Fn() -> Law,
    (time, displacement): (f64, f64),
) -> Option<Over> {
    let now = Mark {
        time,
        force: history.normal,
        displacement,
        work: history.work,
        friction_work: history.friction_work,
    };
    let (before, began) = (pulse.number, *encounter);
    let deepest = peaks.displacement;
    let watched = Watched {
        peak: [peaks.force, peaks.reach],
        above: peaks.above,
        stored: &|depth| stored_energy(&law(), depth, deepest),
    };
    let turn = pulse.turn(encounter.time, now, &watched);
    [peaks.below, peaks.above] = turn.band;
    if turn.anew {
        (peaks.force, peaks.reach) = (now.force, displacement);
    }
    let grows = pulse.number > 0 || history.rate >= PUSHED * encounter.normal_speed;
    if grows && !pulse.fallen {
        // A later pulse is as fast as it is while its force grows, and so is a first one that
        // others push on from behind.
        encounter.normal_speed = encounter.normal_speed.max(history.rate);
    }
    let (load, rest) = turn.over?;
    history.work -= pulse.rise.work;
    history.friction_work -= pulse.rise.friction_work;
    Some(Over {
        encounter: began,
        before,
        pulse: load,
        rest,
        lasting: false,
    })
}
