//! The impacts of a drop in numbers, with their derivatives.

use crate::contact::ContactPiece;
use crate::dual::fixed;
use crate::event::{DropEvent, RigDuals};
use crate::flight::FlightPiece;
use crate::follow::{Departure, DropEnding, DropSink, Touch};
use crate::observe::{Observed, contact_at, flight_at, sigma_at};
use windfall_contact::law::ContactLaw;
use windfall_identify::rig::simulate::highest;
use windfall_numerics::quadrature::EIGHT_NODES;
use windfall_numerics::real::Lanes;

/// A value and the time at which it was reached, with derivatives: those of
/// the value are total, as it is a maximum.
#[derive(Clone, Copy, Debug)]
pub struct Peak<const W: usize> {
    /// The value.
    pub value: Lanes<W>,
    /// Since first touch of the drop; s.
    pub time: f64,
}

/// One impact of a drop in numbers, times from first touch of the drop.
#[derive(Clone, Copy, Debug)]
pub struct ImpactTally<const W: usize> {
    /// First touch.
    pub touch: Touch<W>,
    /// Largest force between fruit and plate; N.
    pub contact_force: Peak<W>,
    /// Largest force on the support, from this touch to the next; N.
    pub support_force: Peak<W>,
    /// Largest indentation; m.
    pub displacement: Peak<W>,
    /// Integral of the contact force; N s.
    pub impulse: f64,
    /// The fruit leaves; `None` where it stays, or time ran out.
    pub departure: Option<Departure<W>>,
}

/// A quantity of an observation: its value, and with derivatives.
type Value = fn(&Observed<1>) -> f64;
type Full<const W: usize> = fn(&Observed<W>) -> Lanes<W>;

/// Impacts of a drop, and what comes after them.
#[derive(Clone, Debug)]
pub struct DropTally<const W: usize> {
    /// In order of time.
    pub impacts: Vec<ImpactTally<W>>,
    /// First touch after the last of them, where there is one.
    pub beyond: Option<Touch<W>>,
    /// How the drop ended.
    pub ending: DropEnding,
}

/// Collects the impacts of a drop.
pub(crate) struct Tally<'a, L, const N: usize, const W: usize> {
    pub event: &'a DropEvent<L, N, W>,
    pub rig: &'a RigDuals<W>,
    /// The same without derivatives, to search for maxima.
    pub values: (&'a DropEvent<L, N, 1>, &'a RigDuals<1>),
    pub impacts: Vec<ImpactTally<W>>,
    /// First touch after the last of them.
    pub beyond: Option<Touch<W>>,
}

fn none_yet<const W: usize>() -> Peak<W> {
    Peak {
        value: fixed(f64::NEG_INFINITY),
        time: 0.0,
    }
}

fn raise<const W: usize>(peak: &mut Peak<W>, value: Lanes<W>, time: f64) {
    if value.0[0] > peak.value.0[0] {
        *peak = Peak { value, time };
    }
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> DropSink<W> for Tally<'_, L, N, W> {
    fn touch(&mut self, touch: &Touch<W>) {
        self.impacts.push(ImpactTally {
            touch: *touch,
            contact_force: none_yet(),
            support_force: none_yet(),
            displacement: none_yet(),
            impulse: 0.0,
            departure: None,
        });
    }

    #[inline(always)]
    fn contact(&mut self, piece: &ContactPiece<W>) {
        let Some(found) = self.impacts.last_mut() else {
            return;
        };
        let end = sigma_at(piece, piece.to).min(1.0);
        let plain = piece.values();
        let seen = |sigma: f64| contact_at(self.values.0, self.values.1, &plain, sigma);
        let start = piece.start.0[0];
        let full = |sigma: f64| contact_at(self.event, self.rig, piece, sigma);
        let peak = |peak: &mut Peak<W>, of: Value, slope: Value, value: Full<W>| {
            let at = highest(end, |s| of(&seen(s)), |s| slope(&seen(s)));
            if of(&seen(at)) > peak.value.0[0] {
                let at = full(at);
                raise(peak, value(&at), start + at.time);
            }
        };
        peak(
            &mut found.contact_force,
            |o| o.contact_force.0[0],
            |o| o.contact_rate,
            |o| o.contact_force,
        );
        if self.rig.ringing.is_some() {
            peak(
                &mut found.support_force,
                |o| o.support_force.0[0],
                |o| o.support_rate,
                |o| o.support_force,
            );
        } else {
            found.support_force = found.contact_force;
        }
        peak(
            &mut found.displacement,
            |o| o.displacement.0[0],
            |o| o.rate.0[0],
            |o| o.displacement,
        );
        // ∫ F dt = ∫ F q s^(q−1) ds
        let (power, width) = (f64::from(piece.power), piece.step.width);
        for (node, weight) in EIGHT_NODES {
            let sigma = 0.5 * end * (1.0 + node);
            let s = piece.step.start + sigma * width;
            let stretch = power * s.powi(piece.power as i32 - 1);
            let force = seen(sigma).contact_force.0[0];
            found.impulse += 0.5 * end * width * weight * stretch * force;
        }
    }

    #[inline(always)]
    fn flight(&mut self, piece: &FlightPiece<W>) {
        let (Some(found), Some(plate)) = (self.impacts.last_mut(), &piece.plate) else {
            return;
        };
        // A decaying oscillation is highest within its first period.
        let end = (32.0 * plate.short_time()).min(piece.duration);
        let seen = |part: f64| flight_at(self.rig, piece, part * end);
        let at = highest(
            1.0,
            |part| seen(part).support_force.0[0],
            |part| seen(part).support_rate,
        );
        let at = seen(at);
        let time = piece.start.0[0] + at.time;
        raise(&mut found.support_force, at.support_force, time);
    }

    fn departure(&mut self, departure: &Departure<W>) {
        if let Some(found) = self.impacts.last_mut() {
            found.departure = Some(*departure);
        }
    }

    fn beyond(&mut self, touch: &Touch<W>) {
        self.beyond = Some(*touch);
    }
}
