//! What the instruments of a bench make of a fitted motion, taken off the samples.
//!
//! A filter, a sensor or an arm that swings makes of the force F of the model what is recorded,
//! F + δ(F). The samples less δ(F) of the last fit are fitted again until nothing moves: the
//! residuals are then those of the recorded force beside the model as the instruments show it.

use crate::error::Error;
use crate::fit::noise::NoisePlan;
use crate::fit::plan::Plan;
use crate::fit::response::{Motion, Shift};
use crate::fit::solve::Solution;
use crate::rig::kind::Rig;
use crate::samples::Quantity;

/// Fits at most, until what the instruments make of the motion is that of the motion fitted.
const MOST_FITS: usize = 8;
/// Change of each parameter, in its standard deviations, below which it stands.
const SETTLED: f64 = 0.01;

impl NoisePlan {
    /// The same samples with something else taken off them than before.
    ///
    /// * `onset`: of the times of the edges; s
    fn shifted(mut self, shift: Shift, onset: f64) -> Self {
        let before = self.shift.take();
        let change = |quantity: Quantity, time: f64| {
            let off = before.as_ref().map_or(0.0, |own| own.at(quantity, time));
            off - shift.at(quantity, time)
        };
        if let Some(edges) = &mut self.edges {
            for (value, time) in edges.values.iter_mut().zip(&edges.times) {
                *value += change(Quantity::Displacement, time - onset);
            }
        }
        for group in &mut self.groups {
            group.shift(change);
        }
        self.shift = Some(shift);
        self
    }
}

impl Plan<'_> {
    /// Solves with what the instruments make of the solution taken off the samples, from a
    /// solution on.
    ///
    /// # Errors
    /// [`Error::ResponseTooLarge`], [`Error::ResponseUnsettled`]; a fit fails.
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
                return Ok(solution);
            }
        }
        Err(Error::ResponseUnsettled { fits: MOST_FITS })
    }
}
