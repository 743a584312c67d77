//! One contact from its beginning to its event, whatever it is with.

use crate::annuli::Annuli;
use crate::contacts::react::{Clock, History, Peaks};
use crate::error::Error;
use crate::event::{Encounter, Event, Partner};
use crate::scene::Fruit;
use crate::vector::{
    Rotation, Vector, dot, length, plus_scaled, scaled, subtract, turned_back, unit,
};

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
}

impl Parcel {
    /// A contact that begins.
    pub(crate) fn begin(scale: f64, clock: Clock, encounter: Encounter) -> Self {
        Self {
            scale,
            history: History {
                rate: encounter.normal_speed,
                ..History::default()
            },
            peaks: Peaks {
                ended: clock.time,
                ..Peaks::default()
            },
            annuli: Annuli::default(),
            rolling: [0.0; 3],
            encounter,
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
        }
    }
}

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
pub(crate) fn encounter(
    normal: Vector,
    displacement: f64,
    velocity: Vector,
    clock: Clock,
) -> Encounter {
    let rate = dot(velocity, normal);
    let slip = subtract(velocity, scaled(normal, rate));
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

/// The event of two fruit; the lower number first.
pub(crate) fn event_of_pair(parcel: Parcel, (first, second): (u32, u32), lasting: bool) -> Event {
    let parcel = match second < first {
        true => parcel.swapped(),
        false => parcel,
    };
    let partner = Partner::Fruit(first.max(second));
    event(&parcel, first.min(second), partner, lasting)
}

pub(crate) fn event(parcel: &Parcel, fruit: u32, partner: Partner, lasting: bool) -> Event {
    let (history, peaks, encounter) = (&parcel.history, &parcel.peaks, &parcel.encounter);
    Event {
        fruit,
        partner,
        time: encounter.time,
        duration: peaks.ended - encounter.time,
        lasting,
        place: encounter.place,
        spot: encounter.spot,
        other_spot: encounter.other_spot,
        normal_speed: encounter.normal_speed,
        tangential_speed: encounter.tangential_speed,
        peak_force: peaks.force,
        largest_displacement: peaks.displacement,
        absorbed_energy: history.work,
        friction_energy: history.friction_work,
    }
}
