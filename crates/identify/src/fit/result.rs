//! Impact → Fit: the parameters of a force law from one measured impact.

use crate::error::Error;
use crate::finding::Finding;
use crate::fit::interval::IntervalOptions;
use crate::fit::plan::{Plan, plan};
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::solve::Solution;
use crate::rig::bench::{BenchQuantity, BenchSd};
use crate::rig::kind::Rig;
use windfall_signal::impact::Impact;

pub use crate::fit::types::{CommonCause, CommonShift, Estimate, Fit, PHASES, QuantityFit};

/// Fits `problem` to `impact` as measured on `rig`.
///
/// The cost is that of eq. (8) of the 2003 pendulum study,
///
/// ```text
/// C = w_x Σ (x − x*)² + w_v Σ (v − v*)² + w_F Σ (F − F*)² (+ w_a Σ (a − a*)²)
/// ```
///
/// with the starred quantities from the rig's equation of motion under the
/// law, and for each prior (p − μ)² / σ². Standard deviations come from the residuals' own variance and
/// correlation ([`covariance`](crate::fit::uncertainty::covariance)).
///
/// # Errors
/// [`Error::NoQuantities`], [`Error::TooFewSamples`], [`Error::NothingToFit`],
/// [`Error::NoStart`], [`Error::UnknownVelocity`], [`Error::BadInput`]. A fit
/// that does not converge or ends on a bound is returned with findings.
///
/// # Source
/// Van Zeebroeck et al. (2003), J. Sound Vib. 266:465, eqs. (4)-(9), Table 1.
pub fn fit_impact(
    impact: &Impact,
    rig: &Rig,
    problem: &LawProblem,
    options: &FitOptions,
) -> Result<Fit, Error> {
    solved(impact, rig, problem, options).map(|(fit, _, _)| fit)
}

/// [`fit_impact`] with what it rests on.
pub(crate) fn solved<'a>(
    impact: &'a Impact,
    rig: &Rig,
    problem: &'a LawProblem,
    options: &'a FitOptions,
) -> Result<(Fit, Plan<'a>, Solution), Error> {
    rig.check()?;
    let mut plan = plan(impact, rig, problem, options)?;
    let solution = plan.solve(rig)?;
    let mut fit = plan.report(&solution, rig)?;
    for (quantity, sd) in options.bench.uncertain() {
        let asked = (impact, rig, problem, options);
        let quantile = plan.quantile(fit.samples);
        widen(&mut fit, asked, (quantity, sd), quantile);
    }
    for finding in &mut fit.findings {
        tell_data_alone(finding, impact, rig, (problem, options));
    }
    let of_bench = fit.common.iter().filter_map(CommonShift::of_bench);
    let of_bench: Vec<(BenchQuantity, String)> = of_bench.collect();
    fit.findings.extend(match &of_bench[..] {
        [] => None,
        [(BenchQuantity::Mass, _)] => Some(Finding::UncertainMass {
            mass: BenchQuantity::Mass.value(rig),
            sd: options.bench.of(BenchQuantity::Mass),
        }),
        all => Some(Finding::UncertainBench {
            quantities: all.iter().map(|(_, words)| words.clone()).collect(),
        }),
    });
    Ok((fit, plan, solution))
}

/// Fits several laws to one impact with one noise for all, that of the law that
/// describes it best: their costs are then −2 ln of likelihoods that can be
/// compared, up to a common constant.
///
/// # Errors
/// As [`fit_impact`], law by law.
pub fn fit_laws(
    impact: &Impact,
    rig: &Rig,
    problems: &[LawProblem],
    options: &FitOptions,
) -> Vec<Result<Fit, Error>> {
    let mut first: Vec<Result<(Plan, Solution), Error>> = problems
        .iter()
        .map(|problem| {
            rig.check()?;
            let mut plan = plan(impact, rig, problem, options)?;
            let solution = plan.solve_once(rig)?;
            Ok((plan, solution))
        })
        .collect();
    let solved = first.iter().flatten();
    let best = solved.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    let noise = match best.map(|(plan, solution)| plan.noise_after(solution, rig)) {
        Some(Ok(noise)) => noise,
        _ => {
            return first
                .into_iter()
                .map(|f| f.and_then(|(p, s)| p.report(&s, rig)))
                .collect();
        }
    };
    first
        .iter_mut()
        .map(|first| match first {
            Ok((plan, solution)) => {
                plan.noise = noise.clone();
                let solution = plan.solve_again(solution, rig)?;
                plan.report(&solution, rig)
            }
            Err(error) => Err(error.clone()),
        })
        .collect()
}

/// Replaces what a contradicted prior's finding says of the data alone, which is derived from
/// noise that the prior itself made larger, by a fit without the prior.
fn tell_data_alone(
    finding: &mut Finding,
    impact: &Impact,
    rig: &Rig,
    (problem, options): (&LawProblem, &FitOptions),
) {
    let Finding::PriorContradicted {
        parameter,
        prior,
        data,
        apart,
        ..
    } = finding
    else {
        return;
    };
    let mut without = problem.clone();
    let known = without.known.iter_mut();
    known
        .filter(|known| known.name == *parameter)
        .for_each(|known| known.prior = None);
    let options = FitOptions {
        bench: BenchSd::default(),
        intervals: IntervalOptions::default(),
        ..*options
    };
    let fit = fit_impact(impact, rig, &without, &options).ok();
    let fit = fit.filter(|fit| fit.converged);
    let own = fit.as_ref().and_then(|fit| {
        let mut all = fit.parameters.iter().chain(&fit.nuisances);
        all.find(|own| own.name == *parameter && own.sd.is_finite())
    });
    if let Some(own) = own {
        *data = (own.value, own.sd);
        *apart = (own.value - prior.0).abs() / own.sd.hypot(prior.1);
    }
}

/// Adds the uncertainty of a quantity of the bench to the intervals, by fits with it one
/// standard deviation lower and higher; what that moves is kept.
fn widen(
    fit: &mut Fit,
    (impact, rig, problem, options): (&Impact, &Rig, &LawProblem, &FitOptions),
    (quantity, sd): (BenchQuantity, f64),
    quantile: f64,
) {
    let mut response = options.response;
    let of_response = quantity.of_response(&mut response).copied();
    let value = of_response.unwrap_or_else(|| quantity.value(rig));
    // A quantity that is hardly known is varied by no more than half of itself.
    let step = if value > 0.0 { sd.min(0.5 * value) } else { sd };
    let mut near = problem.clone();
    for (i, value) in fit.law.parameters().into_iter().enumerate() {
        if near.free[i] {
            near.values[i] = Some(value);
        }
    }
    let bench = options.bench;
    let options = FitOptions {
        bench: BenchSd::default(),
        intervals: IntervalOptions::default(),
        ..*options
    };
    let refit = |step: f64| {
        let mut options = options;
        let fit = match quantity.of_response(&mut options.response) {
            Some(own) => {
                *own += step;
                fit_impact(impact, rig, &near, &options)
            }
            None => {
                let (impact, rig) = bench.moved((impact, rig), quantity, step);
                fit_impact(&impact, &rig, &near, &options)
            }
        };
        let fit = fit.ok()?;
        fit.converged.then_some(fit)
    };
    let (Some(low), Some(high)) = (refit(-step), refit(step)) else {
        fit.findings.push(Finding::BenchLeftOut {
            quantity: quantity.name(),
            sd,
            unit: quantity.unit(),
        });
        return;
    };
    let all = |fit: &Fit| -> Vec<f64> {
        let estimates = fit.parameters.iter().chain(&fit.nuisances);
        estimates.map(|estimate| estimate.value).collect()
    };
    let moved = all(&high).into_iter().zip(all(&low));
    let shifts: Vec<f64> = moved
        .map(|(high, low)| 0.5 * (high - low) * sd / step)
        .collect();
    let estimates = fit.parameters.iter_mut().chain(&mut fit.nuisances);
    for (estimate, shift) in estimates.zip(&shifts) {
        estimate.sd = estimate.sd.hypot(*shift);
        let reach = |end: f64| (end - estimate.value).hypot(quantile * shift);
        let (low, high) = (reach(estimate.low), reach(estimate.high));
        (estimate.low, estimate.high) = (estimate.value - low, estimate.value + high);
    }
    fit.common.push(CommonShift {
        cause: CommonCause::Bench(quantity),
        sd,
        shifts,
    });
}
