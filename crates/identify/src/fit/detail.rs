//! A fit with its samples: what was measured, what the model says, what is left.

use crate::error::Error;
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::result::solved;
use crate::fit::types::{CommonCause, Fit};
use crate::rig::kind::Rig;
use crate::samples::Quantity;
use windfall_signal::impact::Impact;

/// The samples of one quantity as the fit used them.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedSeries {
    /// The quantity.
    pub quantity: Quantity,
    /// Times on the recording's clock; s.
    pub times: Vec<f64>,
    /// Measured, less what the instruments make of the motion; SI.
    pub measured: Vec<f64>,
    /// Model minus measured; SI.
    pub residuals: Vec<f64>,
    /// Weight of the square of each residual in the cost: 1/σ² where weights are those of the
    /// noise; 1/SI².
    pub weights: Vec<f64>,
    /// Correlation of the noise of successive samples; 1.
    pub persistence: f64,
}

/// A fit with its samples and its covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct FitDetail {
    /// The fit.
    pub fit: Fit,
    /// The samples of each quantity.
    pub series: Vec<FittedSeries>,
    /// Covariance of the parameters, then of the nuisances, from the curvature of the cost and
    /// with what is uncertain of the bench; SI. Empty where it is singular.
    ///
    /// Its diagonal holds the squares of the standard deviations, except where the intervals
    /// have deviations of their own (bootstrap, posterior).
    pub covariance: Vec<Vec<f64>>,
}

/// [`fit_impact`](crate::fit::result::fit_impact), with samples and covariance.
///
/// # Errors
/// As [`fit_impact`](crate::fit::result::fit_impact).
pub fn fit_in_detail(
    impact: &Impact,
    rig: &Rig,
    problem: &LawProblem,
    options: &FitOptions,
) -> Result<FitDetail, Error> {
    let (fit, plan, solution) = solved(impact, rig, problem, options)?;
    let mut series = Vec::new();
    for (group, residuals) in plan.noise.groups.iter().zip(&solution.rows.residuals) {
        for quantity in Quantity::ALL.into_iter().filter(|q| group.holds(*q)) {
            let samples = 0..group.times().len();
            series.push(FittedSeries {
                quantity,
                times: group.times().iter().map(|t| impact.onset + t).collect(),
                measured: group.values(quantity).to_vec(),
                residuals: residuals[quantity as usize].clone(),
                weights: samples.map(|i| group.weight_of(quantity, i)).collect(),
                persistence: group.persistence[quantity as usize],
            });
        }
    }
    series.sort_by_key(|own| own.quantity);
    let mut covariance = solution.covariance;
    // What priors move is in the covariance already.
    let of_bench = fit.common.iter();
    for own in of_bench.filter(|own| matches!(own.cause, CommonCause::Bench(_))) {
        for (row, first) in covariance.iter_mut().zip(&own.shifts) {
            let cells = row.iter_mut().zip(&own.shifts);
            cells.for_each(|(cell, second)| *cell += first * second);
        }
    }
    Ok(FitDetail {
        fit,
        series,
        covariance,
    })
}
