//! What priors and ranges that the user gave do to estimates and intervals.

use crate::finding::Finding;
use crate::fit::plan::Plan;
use crate::fit::problem::Prior;
use crate::fit::solve::Solution;
use crate::fit::types::{CommonCause, CommonShift, Estimate};

/// Joint deviations by which data and prior differ that contradict each other.
const CONTRADICTS: f64 = 3.0;
/// Part of what is known of a parameter above which a prior pulls the estimate noticeably; 1.
pub const NOTICEABLE: f64 = 0.1;
/// The same above which the prior says more than the data; 1.
const MOSTLY: f64 = 0.5;

impl Plan<'_> {
    /// What the deviation of each prior moves: part of the deviations already, and the same in
    /// all impacts that are fitted with it.
    ///
    /// ```text
    /// σ ∂p̂/∂μ = N⁻¹ e / σ
    /// ```
    pub(crate) fn shifts_of_priors(
        &self,
        solution: &Solution,
        estimates: &[Estimate],
    ) -> Vec<CommonShift> {
        let own = self.priors().filter(|_| !solution.inverse.is_empty());
        own.map(|(index, prior)| CommonShift {
            cause: CommonCause::Prior {
                parameter: estimates[index].name.clone(),
                unit: estimates[index].unit.clone(),
            },
            sd: prior.sd,
            shifts: solution
                .inverse
                .iter()
                .map(|row| row[index] / prior.sd)
                .collect(),
        })
        .collect()
    }

    /// Free parameters that have a prior.
    fn priors(&self) -> impl Iterator<Item = (usize, Prior)> + '_ {
        let free = self.free.iter().enumerate();
        free.filter_map(|(index, parameter)| Some((index, parameter.prior?)))
    }

    /// Priors that the data contradict, and priors that say more than the data.
    ///
    /// With C the variance of the estimate p̂ and w = 1 − C/σ² the part that is of the data, the
    /// data alone say d = μ + (p̂ − μ)/w with the variance C/w, and the two are apart by
    ///
    /// ```text
    /// (d − μ) / √(C/w + σ²) = (p̂ − μ) / (σ √w)
    /// ```
    pub(crate) fn remarks_on_priors(
        &self,
        solution: &Solution,
        estimates: &[&Estimate],
    ) -> Vec<Finding> {
        let mut out = Vec::new();
        for (index, prior) in self.priors() {
            let Some(row) = solution.covariance.get(index) else {
                continue;
            };
            let estimate = estimates[index];
            let share = (row[index] / (prior.sd * prior.sd)).min(1.0);
            let of_data = 1.0 - share;
            let away = solution.free[index] - prior.mean;
            let apart = away / (prior.sd * of_data.sqrt());
            if of_data > 0.0 && apart.abs() > CONTRADICTS {
                let clock = estimate.value - solution.free[index];
                out.push(Finding::PriorContradicted {
                    parameter: estimate.name.clone(),
                    unit: estimate.unit.clone(),
                    prior: (clock + prior.mean, prior.sd),
                    data: (
                        clock + prior.mean + away / of_data,
                        (row[index] / of_data).sqrt(),
                    ),
                    apart: apart.abs(),
                    pulled: share > NOTICEABLE,
                });
            } else if share > MOSTLY {
                out.push(Finding::MostlyPrior {
                    parameter: estimate.name.clone(),
                    share,
                });
            }
        }
        out
    }

    /// Ends of the intervals at bounds: an estimate at a bound has the bound for one end and for
    /// the other the value at which the cost has risen by the square of `quantile`,
    ///
    /// ```text
    /// δ²/C + 2 g δ = t²
    /// ```
    ///
    /// with C the variance and g half the gradient of the cost at the bound; it has no standard
    /// deviation. Other intervals end at the ranges that the user gave.
    pub(crate) fn end_at_bounds(
        &self,
        solution: &Solution,
        estimates: &mut [Estimate],
        quantile: f64,
    ) {
        for (index, estimate) in estimates.iter_mut().enumerate() {
            let side = solution.at_bound[index];
            if side != 0 && solution.intervals.is_none() {
                let variance = solution.inverse.get(index).map(|row| row[index]);
                let push = solution.gradient[index].abs();
                let reach = variance.map_or(f64::INFINITY, |variance| {
                    variance * ((push * push + quantile * quantile / variance).sqrt() - push)
                });
                let inwards = estimate.value - f64::from(side) * reach;
                estimate.low = estimate.value.min(inwards);
                estimate.high = estimate.value.max(inwards);
                estimate.sd = f64::INFINITY;
            }
            if let Some(known) = self.problem.known(&estimate.name) {
                estimate.low = estimate.low.max(known.range.0);
                estimate.high = estimate.high.min(known.range.1);
            }
        }
    }
}
