//! From the minimiser's solution to estimates with intervals and findings.

use crate::error::Error;
use crate::finding::{Finding, LACK_OF_FIT};
use crate::fit::estimator::{Coordinate, Target};
use crate::fit::free::nuisance_name;
use crate::fit::identifiability::{directions, in_words, trade};
use crate::fit::interval::{IntervalDetail, IntervalMethod, independent_draws, mixes};
use crate::fit::plan::{Plan, sample_count};
use crate::fit::posterior::mixing;
use crate::fit::solve::Solution;
use crate::fit::types::{Estimate, Fit, PHASES, QuantityFit};
use crate::fit::uncertainty::{runs_test, standardised};
use crate::rig::kind::Rig;
use crate::rig::simulate::simulate_rig;
use crate::samples::Quantity;
use windfall_contact::laws::kind::Law;
use windfall_distribution::tail::{normal_lower, t_upper_quantile};
use windfall_numerics::least_squares::Stop;

/// Correlation above which two parameters of the law, and a parameter and a
/// nuisance, are reported as inseparable. A stiffness always moves with the
/// onset; that alone is no news.
const HIGH_CORRELATION: (f64, f64) = (0.98, 0.999);
/// A parameter that would be known this many times better if another one were is
/// reported; 1.
const MUCH_BETTER: f64 = 5.0;
/// A scale known to this part of itself is well known; 1.
const WELL_KNOWN: f64 = 0.03;
/// Runs-test score below which residuals are called structured.
const STRUCTURED_Z: f64 = -5.0;
/// Structure in residuals no larger than this times the noise is the noise's
/// own, such as the rounding of an encoder.
const STRUCTURED_RATIO: f64 = 1.1;
/// Residuals this many times the noise are called a misfit.
const MISFIT_RATIO: f64 = 2.0;

impl Plan<'_> {
    pub(crate) fn report(&self, solution: &Solution, rig: &Rig) -> Result<Fit, Error> {
        let law = self.problem.kind.with_parameters(&solution.law)?;
        let samples: usize = self.noise.groups.iter().map(sample_count).sum();
        let quantile = self.quantile(samples);
        let mut estimates = self.estimates(solution, &law, quantile);
        let common = self.shifts_of_priors(solution, &estimates);
        self.end_at_bounds(solution, &mut estimates, quantile);
        let law_count = self.problem.free_positions().count();
        let simulated = simulate_rig(&law, rig, solution.velocity, self.options.end)?;
        let mut fit = Fit {
            law,
            parameters: estimates[..law_count].to_vec(),
            nuisances: estimates[law_count..].to_vec(),
            correlations: correlations(&solution.covariance),
            cost: solution.cost,
            residual_norm: solution.cost.sqrt(),
            samples,
            evaluations: solution.evaluations,
            converged: solution.stop == Stop::Converged,
            quantities: self.quantity_fits(solution, simulated.contact_duration),
            regression: self.regression_estimates(&law, quantile),
            simulated,
            velocity: solution.velocity,
            onset: self.impact.onset + solution.onset,
            offset: solution.offset,
            directions: directions(&solution.covariance),
            common,
            intervals: self.interval_detail(solution),
            findings: self.findings.clone(),
        };
        let remarks = self.remarks(solution, &fit);
        fit.findings.extend(remarks);
        Ok(fit)
    }

    fn name_and_unit(&self, target: Target, law: &Law) -> (String, String) {
        match target {
            Target::Law(i) => {
                let name = self.problem.kind.describe().parameters[i].name;
                (name.to_owned(), law.unit_of(i))
            }
            other => {
                let (name, unit) = nuisance_name(other);
                (name.to_owned(), unit.to_owned())
            }
        }
    }

    pub(crate) fn quantile(&self, samples: usize) -> f64 {
        let freedom = (samples - self.free.len()) as f64;
        match freedom > 0.0 {
            true => t_upper_quantile(0.5 * (1.0 - self.options.confidence), freedom),
            false => f64::INFINITY,
        }
    }

    fn estimates(&self, solution: &Solution, law: &Law, quantile: f64) -> Vec<Estimate> {
        self.free
            .iter()
            .enumerate()
            .map(|(i, parameter)| {
                let (name, unit) = self.name_and_unit(parameter.target, law);
                let sd = solution
                    .covariance
                    .get(i)
                    .map_or(f64::INFINITY, |row| row[i].max(0.0).sqrt());
                // The onset is on the recording's clock.
                let clock = match parameter.target {
                    Target::Onset => self.impact.onset,
                    _ => 0.0,
                };
                let value = clock + solution.free[i];
                let mut estimate = Estimate {
                    name,
                    value,
                    sd,
                    low: value - quantile * sd,
                    high: value + quantile * sd,
                    unit,
                };
                if let Some(intervals) = &solution.intervals {
                    estimate.low = clock + intervals.low[i];
                    estimate.high = clock + intervals.high[i];
                    if let Some(sds) = &intervals.sd {
                        estimate.sd = sds[i];
                    }
                }
                estimate
            })
            .collect()
    }

    /// The detail of the intervals, with onsets on the recording's clock.
    fn interval_detail(&self, solution: &Solution) -> IntervalDetail {
        let Some(intervals) = &solution.intervals else {
            return IntervalDetail::Asymptotic;
        };
        let mut detail = intervals.detail.clone();
        let Some(onset) = self.free.iter().position(|p| p.target == Target::Onset) else {
            return detail;
        };
        let values = match &mut detail {
            IntervalDetail::Asymptotic => return detail,
            IntervalDetail::Profile(curves) => &mut curves[onset].values,
            IntervalDetail::Bootstrap(found) => &mut found.estimates[onset],
            IntervalDetail::Posterior(found) => &mut found.draws[onset],
        };
        values
            .iter_mut()
            .for_each(|value| *value += self.impact.onset);
        if let IntervalDetail::Posterior(found) = &mut detail {
            // Rounding makes and parts ties between draws: R-hat is that of the draws told.
            let each = found.draws[onset].len() / found.chains.max(1);
            found.mixing[onset] = mixing(&found.draws[onset], each);
        }
        detail
    }

    fn regression_estimates(&self, law: &Law, quantile: f64) -> Vec<Estimate> {
        let described = self.problem.kind.describe().parameters;
        self.regression
            .iter()
            .map(|r| Estimate {
                name: described[r.position].name.to_owned(),
                value: r.value,
                sd: r.standard_error,
                low: r.value - quantile * r.standard_error,
                high: r.value + quantile * r.standard_error,
                unit: law.unit_of(r.position),
            })
            .collect()
    }

    fn quantity_fits(&self, solution: &Solution, duration: f64) -> Vec<QuantityFit> {
        let mut out = Vec::new();
        for (g, group) in self.noise.groups.iter().enumerate() {
            for quantity in Quantity::ALL.into_iter().filter(|q| group.holds(*q)) {
                let residuals = &solution.rows.residuals[g][quantity as usize];
                let square: f64 = residuals.iter().map(|r| r * r).sum();
                let runs = runs_test(&standardised(group, quantity, residuals));
                let as_they_are = runs_test(residuals);
                let both = runs.zip(as_they_are);
                out.push(QuantityFit {
                    quantity,
                    samples: residuals.len(),
                    weight: group.weights[quantity as usize],
                    noise: self.noise.noise[quantity as usize],
                    persistence: self.noise.persistence[quantity as usize],
                    rms_residual: (square / residuals.len().max(1) as f64).sqrt(),
                    standardised: self.standardised_rms(g, quantity, residuals),
                    runs,
                    chance: both.map(|(a, b)| normal_lower(a.z.max(b.z))),
                    by_phase: by_phase(group.times(), residuals, (solution.onset, duration)),
                });
            }
        }
        out.sort_by_key(|q| q.quantity);
        out
    }

    /// Root mean square of residuals by the noise that the recording shows.
    fn standardised_rms(&self, group: usize, quantity: Quantity, residuals: &[f64]) -> f64 {
        let group = &self.noise.groups[group];
        let z = standardised(group, quantity, residuals);
        let square = z.iter().map(|z| z * z).sum::<f64>() / z.len().max(1) as f64;
        let noise = self.noise.noise[quantity as usize];
        (square / (group.weights[quantity as usize] * noise * noise)).sqrt()
    }

    /// A law's parameter that would be known much better if another one were.
    fn weak_direction(&self, solution: &Solution, fit: &Fit) -> Option<Finding> {
        let weakest = fit.directions.first()?;
        // What is well known needs no better knowledge.
        let poor = |i: &usize| {
            let estimate = &fit.parameters[*i];
            let relative = self.free[*i].coordinate == Coordinate::Logarithm;
            !relative || estimate.sd > WELL_KNOWN * estimate.value.abs()
        };
        let trades = (0..fit.parameters.len())
            .filter(poor)
            .filter_map(|i| trade(&solution.covariance, i));
        let worst = trades.max_by(|a, b| a.factor.total_cmp(&b.factor))?;
        if worst.factor < MUCH_BETTER {
            return None;
        }
        let estimates: Vec<&Estimate> = fit.parameters.iter().chain(&fit.nuisances).collect();
        let described: Vec<(&str, f64, &str, bool)> = estimates
            .iter()
            .zip(&self.free)
            .map(|(e, free)| {
                let relative = free.coordinate == Coordinate::Logarithm;
                (e.name.as_str(), e.value, e.unit.as_str(), relative)
            })
            .collect();
        let quantities = fit.quantities.iter().map(|q| q.quantity.name());
        Some(Finding::WeakDirection {
            parameter: estimates[worst.parameter].name.clone(),
            partner: estimates[worst.partner].name.clone(),
            factor: worst.factor,
            quantities: quantities.collect::<Vec<_>>().join(" and "),
            direction: in_words(weakest, &solution.covariance, &described),
        })
    }

    fn remarks(&self, solution: &Solution, fit: &Fit) -> Vec<Finding> {
        let mut out = Vec::new();
        if !fit.converged {
            out.push(Finding::NoConvergence {
                evaluations: fit.evaluations,
            });
        }
        let estimates: Vec<_> = fit.parameters.iter().chain(&fit.nuisances).collect();
        for (i, side) in solution
            .at_bound
            .iter()
            .enumerate()
            .filter(|(_, s)| **s != 0)
        {
            let lower = *side < 0;
            let name = estimates[i].name.clone();
            let given = self.problem.known(&name).is_some_and(|known| {
                let end = if lower { known.range.0 } else { known.range.1 };
                end.is_finite()
            });
            out.push(Finding::AtBound {
                parameter: name,
                side: if lower { "lower" } else { "upper" },
                bound: estimates[i].value,
                unit: estimates[i].unit.clone(),
                given,
            });
        }
        out.extend(interval_remarks(&fit.intervals, &estimates));
        let wanted = self.options.intervals.method;
        if wanted != IntervalMethod::Asymptotic && fit.intervals == IntervalDetail::Asymptotic {
            out.push(Finding::IntervalsAsymptotic {
                method: wanted.name(),
            });
        }
        if solution.covariance.is_empty() {
            out.push(Finding::Singular);
        }
        for i in 0..fit.correlations.len() {
            for j in 0..i {
                let correlation = fit.correlations[i][j];
                let law = i < fit.parameters.len();
                let limit = if law {
                    HIGH_CORRELATION.0
                } else {
                    HIGH_CORRELATION.1
                };
                if correlation.abs() > limit {
                    out.push(Finding::Correlated {
                        first: estimates[j].name.clone(),
                        second: estimates[i].name.clone(),
                        correlation,
                    });
                }
            }
        }
        out.extend(self.remarks_on_priors(solution, &estimates));
        out.extend(self.weak_direction(solution, fit));
        let remarks = fit.quantities.iter().flat_map(quantity_remarks);
        out.extend(remarks.chain(lack_of_fit(&fit.quantities)));
        if let Some(nominal) = fit.law.nominal_restitution() {
            out.push(Finding::NominalRestitution {
                nominal,
                delivered: fit.simulated.restitution,
            });
        }
        out
    }
}

/// Share of failed replicates that is reported; 1.
const FAILED_SHARE: f64 = 0.02;

fn interval_remarks(detail: &IntervalDetail, estimates: &[&Estimate]) -> Vec<Finding> {
    let name = |i: usize| estimates[i].name.clone();
    let mut out = Vec::new();
    match detail {
        IntervalDetail::Asymptotic => {}
        IntervalDetail::Profile(curves) => {
            for (i, curve) in curves.iter().enumerate() {
                let sides = [(curve.open_below, "lower"), (curve.open_above, "upper")];
                for (_, side) in sides.into_iter().filter(|(open, _)| *open) {
                    out.push(Finding::OpenInterval {
                        parameter: name(i),
                        side,
                    });
                }
            }
        }
        IntervalDetail::Bootstrap(found) => {
            if found.failed as f64 > FAILED_SHARE * found.replicates as f64 {
                out.push(Finding::FailedReplicates {
                    failed: found.failed,
                    replicates: found.replicates,
                });
            }
        }
        IntervalDetail::Posterior(found) => {
            if found.divergences > 0 {
                out.push(Finding::Divergences {
                    divergences: found.divergences,
                    draws: found.draws.first().map_or(0, Vec::len),
                });
            }
            for (i, mixing) in found.mixing.iter().enumerate() {
                if !mixes(mixing) {
                    out.push(Finding::NotMixed {
                        parameter: name(i),
                        r_hat: mixing.r_hat,
                        draws: independent_draws(mixing),
                    });
                }
            }
        }
    }
    out
}

fn quantity_remarks(found: &QuantityFit) -> Vec<Finding> {
    let mut out = Vec::new();
    let ratio = found.rms_residual / found.noise;
    if ratio > MISFIT_RATIO {
        out.push(Finding::Misfit {
            quantity: found.quantity.name(),
            ratio,
            noise: found.noise,
        });
    }
    if let Some(runs) = found
        .runs
        .filter(|r| r.z < STRUCTURED_Z && ratio > STRUCTURED_RATIO)
    {
        out.push(Finding::StructuredResiduals {
            quantity: found.quantity.name(),
            z: runs.z,
        });
    }
    out
}

/// The quantity whose residuals are least random, where chance would do as much once in a
/// hundred impacts; not one of which graver things are said.
///
/// # Source
/// Šidák (1967), J. Am. Stat. Assoc. 62:626, for the least of several probabilities.
fn lack_of_fit(quantities: &[QuantityFit]) -> Option<Finding> {
    let tested = quantities.iter().filter_map(|own| Some((own, own.chance?)));
    let count = tested.clone().count() as f64;
    let (least, chance) = tested.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let p = -(count * (-chance).ln_1p()).exp_m1();
    (p < LACK_OF_FIT && quantity_remarks(least).is_empty()).then(|| Finding::LackOfFit {
        quantity: least.quantity.name(),
        p,
    })
}

/// Means of residuals over their root mean square in equal parts of a contact; zero where there
/// is no sample.
///
/// * `onset`: on the clock of `times`; s
fn by_phase(times: &[f64], residuals: &[f64], (onset, duration): (f64, f64)) -> [f64; PHASES] {
    let (mut sums, mut counts) = ([0.0; PHASES], [0.0; PHASES]);
    let mut square = 0.0;
    for (time, residual) in times.iter().zip(residuals) {
        square += residual * residual;
        let phase = (time - onset) / duration * PHASES as f64;
        if (0.0..PHASES as f64).contains(&phase) {
            sums[phase as usize] += residual;
            counts[phase as usize] += 1.0;
        }
    }
    let rms = (square / residuals.len().max(1) as f64).sqrt();
    std::array::from_fn(|i| match counts[i] > 0.0 && rms > 0.0 {
        true => sums[i] / counts[i] / rms,
        false => 0.0,
    })
}

fn correlations(covariance: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let sd = |i: usize| covariance[i][i].sqrt();
    let n = covariance.len();
    (0..n)
        .map(|i| {
            let entry = |j| {
                if i == j {
                    1.0
                } else {
                    covariance[i][j] / (sd(i) * sd(j))
                }
            };
            (0..n).map(entry).collect()
        })
        .collect()
}
