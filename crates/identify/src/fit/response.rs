//! What the instruments of a bench make of a motion.

use crate::error::Error;
use crate::rig::kind::Rig;
use crate::rig::simulate::{simulate_rig, trajectory};
use crate::samples::{Quantity, SampleGroup};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_signal::response::Response;

/// Largest error of an instrument that measures the contact, as a part of what it measures; 1.
const MOST: f64 = 0.5;

/// Steps after first touch whose impulse is made right, and parts that each is summed in.
const FIRST: usize = 4;
const PARTS: usize = 16;

/// What the instruments add to force and displacement, from first touch on.
#[derive(Clone, Debug)]
pub(crate) struct Shift {
    /// First touch on the clock of the samples; s.
    onset: f64,
    step: f64,
    force: Vec<f64>,
    displacement: Vec<f64>,
}

/// A motion whose instruments are asked for.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    /// Its law.
    pub law: &'a Law,
    /// Its rig.
    pub rig: &'a Rig,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// End of contact.
    pub end: EndRule,
    /// First touch on the clock of the samples; s.
    pub onset: f64,
}

impl Motion<'_> {
    /// The force from first touch until `until` on the clock of the samples, as finely as
    /// `response` and the samples want it; N, with the step, s.
    pub(crate) fn force(
        &self,
        response: &Response,
        interval: f64,
        until: f64,
    ) -> Result<(f64, Vec<f64>), Error> {
        let step = response.step(interval);
        let count = ((until - self.onset) / step).ceil().max(1.0) as usize + 2;
        let times: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
        let mut force = trajectory(self.law, self.rig, self.velocity, &times, self.end)?.force;
        force[0] = self.begins(step, &force)?;
        Ok((step, force))
    }

    /// The force at first touch with which straight lines between the steps have the impulse of
    /// the curve; N.
    ///
    /// A damped force rises as the square root of time, and what swings would be excited by too
    /// small an impulse.
    fn begins(&self, step: f64, force: &[f64]) -> Result<f64, Error> {
        let steps = FIRST.min(force.len() - 1);
        let part = step / PARTS as f64;
        let times: Vec<f64> = (0..=steps * PARTS).map(|i| i as f64 * part).collect();
        let fine = trajectory(self.law, self.rig, self.velocity, &times, self.end)?.force;
        let impulse = part * trapezoids(&fine);
        let rest = step * (trapezoids(&force[..=steps]) - 0.5 * force[0]);
        Ok(2.0 * (impulse - rest) / step)
    }
}

impl Shift {
    /// # Errors
    /// [`Error::ResponseTooLarge`]; the motion cannot be simulated.
    pub(crate) fn of(
        response: &Response,
        motion: &Motion,
        groups: &[SampleGroup],
    ) -> Result<Self, Error> {
        let (interval, until) = clock(groups);
        let (step, force) = motion.force(response, interval, until)?;
        let own = Self::of_force(response, motion.onset, step, &force);
        let largest = |curve: &[f64]| curve.iter().fold(0.0, |most, own| own.abs().max(most));
        let law = motion.law;
        let deepest = simulate_rig(law, motion.rig, motion.velocity, motion.end)?.max_displacement;
        for (channel, part) in [
            ("force", largest(&own.force) / largest(&force)),
            ("displacement", largest(&own.displacement) / deepest),
        ] {
            if part.is_nan() || part > MOST {
                return Err(Error::ResponseTooLarge { channel, part });
            }
        }
        Ok(own)
    }

    /// What instruments add to a force.
    pub(crate) fn of_force(response: &Response, onset: f64, step: f64, force: &[f64]) -> Self {
        Self {
            onset,
            step,
            force: response.force_error(step, force),
            displacement: response.displacement_error(step, force),
        }
    }

    /// What is added to a quantity; SI.
    pub(crate) fn at(&self, quantity: Quantity, time: f64) -> f64 {
        let curve = match quantity {
            Quantity::Force => &self.force,
            Quantity::Displacement => &self.displacement,
            Quantity::Rate | Quantity::Acceleration => return 0.0,
        };
        value_at(curve, (time - self.onset) / self.step)
    }
}

/// Sum of a curve at unit distance, with halves at both ends.
fn trapezoids(curve: &[f64]) -> f64 {
    let ends = curve[0] + curve[curve.len() - 1];
    curve.iter().sum::<f64>() - 0.5 * ends
}

/// The value of a curve at a place between its points: nothing before the first, and the last
/// behind it.
pub(crate) fn value_at(curve: &[f64], place: f64) -> f64 {
    if place <= 0.0 {
        return 0.0;
    }
    let last = curve.len() - 1;
    let at = (place as usize).min(last);
    let next = (at + 1).min(last);
    let part = (place - at as f64).min(1.0);
    curve[at] + part * (curve[next] - curve[at])
}

/// Shortest time between samples and the last time; s.
pub(crate) fn clock(groups: &[SampleGroup]) -> (f64, f64) {
    let intervals = groups.iter().map(SampleGroup::interval);
    let shortest = intervals.filter(|own| *own > 0.0).fold(1.0, f64::min);
    let ends = groups.iter().filter_map(|group| group.times().last());
    (shortest, ends.copied().fold(f64::NEG_INFINITY, f64::max))
}
