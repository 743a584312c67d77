//! What the iterations of a population end with.

use crate::population::design::Design;
use crate::population::finding::PopulationFinding;
use crate::population::linear::{LinearProblem, Mode};
use crate::population::optimum::Optimum;

/// Change of the estimates, in their standard errors, below which they have
/// settled.
pub(crate) const SETTLED: f64 = 0.05;

/// Everything that the iterations change.
pub(crate) struct State<const Q: usize> {
    /// Impacts in the order of their fruit, as indices of the data.
    pub order: Vec<usize>,
    pub design: Design,
    pub problem: LinearProblem<Q>,
    pub optimum: Optimum<Q>,
    pub modes: Vec<Mode<Q>>,
    /// log ∫ of the normal approximation of each impact's likelihood, over
    /// that at its fit.
    pub not_quadratic: f64,
    pub shift_from_fits: f64,
    pub shift_from_first_order: f64,
    pub change: f64,
    pub iterations: usize,
    pub not_followed: usize,
    pub single: bool,
}

/// Findings of the iterations.
pub(crate) fn iteration_findings<const Q: usize>(state: &State<Q>) -> Vec<PopulationFinding> {
    let mut out = Vec::new();
    if state.single {
        out.push(PopulationFinding::OneImpactEach);
    }
    if state.not_followed > 0 {
        out.push(PopulationFinding::NotFollowed {
            impacts: state.not_followed,
        });
    }
    if state.change > SETTLED {
        out.push(PopulationFinding::NoConvergence {
            change: state.change,
            iterations: state.iterations,
        });
    }
    if !state.optimum.minimum.converged {
        out.push(PopulationFinding::NoMaximum);
    }
    out
}
