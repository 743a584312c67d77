//! What the instruments of a bench make of a fitted motion, taken off the samples.
//!
//! A filter, a sensor or an arm that swings makes of the force F of the model what is recorded,
//! F + δ(F). The samples less δ(F) of the last fit are fitted again until nothing moves: the
//! residuals are then those of the recorded force beside the model as the instruments show it.

use crate::error::Error;
use crate::fit::noise::NoisePlan;
use crate::fit::plan::Plan;
use crate::fit::solve::Solution;
use crate::rig::kind::Rig;
use crate::rig::simulate::trajectory;
use crate::samples::{Quantity, SampleGroup};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_signal::response::Response;

/// Fits at most, until what the instruments make of the motion is that of the motion fitted.
const MOST_FITS: usize = 8;
/// Change of each parameter, in its standard deviations, below which it stands.
const SETTLED: f64 = 0.01;

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
        let motion = trajectory(self.law, self.rig, self.velocity, &times, self.end)?;
        Ok((step, motion.force))
    }
}

impl Shift {
    fn of(response: &Response, motion: &Motion, groups: &[SampleGroup]) -> Result<Self, Error> {
        let (interval, until) = clock(groups);
        let (step, force) = motion.force(response, interval, until)?;
        Ok(Self::of_force(response, motion.onset, step, &force))
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
        let place = (time - self.onset) / self.step;
        if place <= 0.0 {
            return 0.0;
        }
        let last = curve.len() - 1;
        let at = (place as usize).min(last);
        let next = (at + 1).min(last);
        let part = (place - at as f64).min(1.0);
        curve[at] + part * (curve[next] - curve[at])
    }
}

/// Shortest time between samples and the last time; s.
pub(crate) fn clock(groups: &[SampleGroup]) -> (f64, f64) {
    let intervals = groups.iter().map(SampleGroup::interval);
    let shortest = intervals.filter(|own| *own > 0.0).fold(1.0, f64::min);
    let ends = groups.iter().filter_map(|group| group.times().last());
    (shortest, ends.copied().fold(f64::NEG_INFINITY, f64::max))
}

impl NoisePlan {
    /// The same samples with something else taken off them than before.
    ///
    /// * `onset`: of the times of the edges; s
    fn shifted(self, shift: Shift, onset: f64) -> Self {
        self.with_shift(Some(shift), onset)
    }

    /// [`shifted`](Self::shifted), or the samples as they were recorded.
    pub(crate) fn with_shift(mut self, shift: Option<Shift>, onset: f64) -> Self {
        let before = self.shift.take();
        let change = |quantity: Quantity, time: f64| {
            let off = before.as_ref().map_or(0.0, |own| own.at(quantity, time));
            off - shift.as_ref().map_or(0.0, |own| own.at(quantity, time))
        };
        if let Some(edges) = &mut self.edges {
            for (value, time) in edges.values.iter_mut().zip(&edges.times) {
                *value += change(Quantity::Displacement, time - onset);
            }
        }
        for group in &mut self.groups {
            group.shift(change);
        }
        self.shift = shift;
        self
    }
}

impl Plan<'_> {
    /// Solves with what the instruments make of the solution taken off the samples, from a
    /// solution on.
    pub(crate) fn settle(&mut self, first: Solution, rig: &Rig) -> Result<Solution, Error> {
        let mut solution = first;
        for _ in 0..MOST_FITS {
            let law = self.problem.kind.with_parameters(&solution.law)?;
            let motion = Motion {
                law: &law,
                rig,
                velocity: solution.velocity,
                end: self.options.end,
                onset: solution.onset,
            };
            let shift = Shift::of(&self.options.response, &motion, &self.noise.groups)?;
            self.noise = self.noise.clone().shifted(shift, self.impact.onset);
            let start = [
                solution.velocity,
                rig.effective_mass(),
                solution.onset,
                solution.offset,
            ];
            let next = self.solve_from(&[(solution.law.clone(), start)], None)?;
            let moved = solution.free.iter().zip(&next.free).enumerate();
            let settled = moved.into_iter().all(|(i, (before, after))| {
                let variance = next.covariance.get(i).map_or(f64::INFINITY, |row| row[i]);
                (after - before).powi(2) <= SETTLED * SETTLED * variance
            });
            let evaluations = solution.evaluations;
            solution = next;
            solution.evaluations += evaluations;
            if settled {
                break;
            }
        }
        Ok(solution)
    }
}
