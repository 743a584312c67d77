//! What the instruments of a bench make of a motion.

use crate::error::Error;
use crate::fit::model::Sampling;
use crate::fit::onset_average::{FADE_END, kept};
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
const PARTS: usize = 32;

/// The force of a motion, as the samples of its fit are compared with it.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// First touch on the clock of the samples; s.
    onset: f64,
    step: f64,
    force: Vec<f64>,
    /// Around first touch the fit compares means over the time between samples.
    start: Option<Start>,
}

/// A curve around first touch.
#[derive(Clone, Debug)]
struct Start {
    /// Time between samples; s.
    interval: f64,
    /// Values from half an interval before first touch on, `PARTS` to the interval.
    values: Vec<f64>,
}

/// What the instruments add to force and displacement, from first touch on.
#[derive(Clone, Debug)]
pub(crate) struct Shift {
    /// First touch on the clock of the samples; s.
    onset: f64,
    step: f64,
    force: Vec<f64>,
    start: Option<Start>,
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
    /// How its fit compares samples of the force around first touch.
    pub sampling: Sampling,
}

impl Motion<'_> {
    /// The force from first touch until the last sample, as finely as `response` and the
    /// samples want it.
    pub(crate) fn curve(
        &self,
        response: &Response,
        groups: &[SampleGroup],
    ) -> Result<Curve, Error> {
        let (interval, until) = clock(groups);
        let step = response.step(interval);
        let count = ((until - self.onset) / step).ceil().max(1.0) as usize + 2;
        let mut force = self.force(step, count)?;
        force[0] = self.begins(step, &force)?;
        let of_force = groups.iter().find(|group| group.holds(Quantity::Force));
        let interval = of_force.map_or(0.0, SampleGroup::interval);
        let start = match self.sampling == Sampling::Averaged && interval > 0.0 {
            true => Some(self.mean(interval)?),
            false => None,
        };
        Ok(Curve {
            onset: self.onset,
            step,
            force,
            start,
        })
    }

    /// The force at `count` times from first touch on; N.
    fn force(&self, step: f64, count: usize) -> Result<Vec<f64>, Error> {
        let times: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
        Ok(trajectory(self.law, self.rig, self.velocity, &times, self.end)?.force)
    }

    /// The force at first touch with which straight lines between the steps have the impulse of
    /// the curve; N.
    ///
    /// A damped force rises as the square root of time, and what swings would be excited by too
    /// small an impulse.
    fn begins(&self, step: f64, force: &[f64]) -> Result<f64, Error> {
        let steps = FIRST.min(force.len() - 1);
        let part = step / PARTS as f64;
        let fine = self.force(part, steps * PARTS + 1)?;
        let impulse = part * trapezoids(&fine);
        let rest = step * (trapezoids(&force[..=steps]) - 0.5 * force[0]);
        Ok(2.0 * (impulse - rest) / step)
    }

    /// Means over `interval` around first touch, as
    /// [`OnsetAverage`](crate::fit::onset_average::OnsetAverage) has them; N.
    fn mean(&self, interval: f64) -> Result<Start, Error> {
        let (half, last) = (PARTS / 2, FADE_END as usize * PARTS);
        let fine = self.force(interval / PARTS as f64, last + half + 1)?;
        let impulse = |at: usize| trapezoids(&fine[..=at]) / PARTS as f64;
        let values = (0..=last + half).map(|i| {
            let mean = impulse(i) - impulse(i.saturating_sub(PARTS));
            let now = i.checked_sub(half).map_or(0.0, |at| fine[at]);
            let intervals = (i as f64 - half as f64) / PARTS as f64;
            now + kept(intervals).0 * (mean - now)
        });
        let values = values.collect();
        Ok(Start { interval, values })
    }
}

impl Start {
    /// The value at a time from first touch, where it lies in the range; `None` elsewhere.
    fn at(&self, time: f64) -> Option<f64> {
        let place = (time / self.interval + 0.5) * PARTS as f64;
        let inside = place > 0.0 && place < (self.values.len() - 1) as f64;
        inside.then(|| value_at(&self.values, place))
    }

    /// Another curve less this one.
    fn below(&self, other: impl Fn(f64) -> f64) -> Self {
        let times = (0..self.values.len()).map(|i| (i as f64 / PARTS as f64 - 0.5) * self.interval);
        let values = times.zip(&self.values);
        Self {
            interval: self.interval,
            values: values.map(|(time, own)| other(time) - own).collect(),
        }
    }
}

impl Curve {
    /// The force at a time on the clock of the samples; N.
    pub(crate) fn at(&self, time: f64) -> f64 {
        let time = time - self.onset;
        let start = self.start.as_ref().and_then(|start| start.at(time));
        start.unwrap_or_else(|| value_at(&self.force, time / self.step))
    }

    /// Of a response, what it adds.
    pub(crate) fn shift(&self, response: &Response) -> Shift {
        let force = response.force_error(self.step, &self.force);
        let seen = |time: f64| {
            let place = time / self.step;
            value_at(&self.force, place) + value_at(&force, place)
        };
        let start = self.start.as_ref().filter(|_| response.smooths());
        Shift {
            onset: self.onset,
            step: self.step,
            start: start.map(|start| start.below(seen)),
            displacement: response.displacement_error(self.step, &self.force),
            force,
        }
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
        let curve = motion.curve(response, groups)?;
        let own = curve.shift(response);
        let largest = |curve: &[f64]| curve.iter().fold(0.0, |most, own| own.abs().max(most));
        let law = motion.law;
        let deepest = simulate_rig(law, motion.rig, motion.velocity, motion.end)?.max_displacement;
        for (channel, part) in [
            ("force", largest(&own.force) / largest(&curve.force)),
            ("displacement", largest(&own.displacement) / deepest),
        ] {
            if part.is_nan() || part > MOST {
                return Err(Error::ResponseTooLarge { channel, part });
            }
        }
        Ok(own)
    }

    /// What is added to a quantity; SI.
    pub(crate) fn at(&self, quantity: Quantity, time: f64) -> f64 {
        let time = time - self.onset;
        let place = time / self.step;
        match quantity {
            Quantity::Force => {
                let start = self.start.as_ref().and_then(|start| start.at(time));
                start.unwrap_or_else(|| value_at(&self.force, place))
            }
            Quantity::Displacement => value_at(&self.displacement, place),
            Quantity::Rate | Quantity::Acceleration => 0.0,
        }
    }
}

/// Sum of a curve at unit distance, with halves at both ends.
fn trapezoids(curve: &[f64]) -> f64 {
    let ends = curve[0] + curve[curve.len() - 1];
    curve.iter().sum::<f64>() - 0.5 * ends
}

/// The value of a curve at a place between its points: nothing before the first, and the last
/// behind it.
fn value_at(curve: &[f64], place: f64) -> f64 {
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
