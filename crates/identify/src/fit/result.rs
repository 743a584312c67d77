//! Impact → Fit: the parameters of a force law from one measured impact.

use crate::error::Error;
use crate::finding::Finding;
use crate::fit::plan::{Plan, plan};
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::solve::Solution;
use crate::rig::kind::Rig;
use windfall_signal::impact::Impact;

pub use crate::fit::types::{Estimate, Fit, QuantityFit};

/// Fits `problem` to `impact` as measured on `rig`.
///
/// The cost is that of eq. (8) of the 2003 pendulum study,
///
/// ```text
/// C = w_x Σ (x − x*)² + w_v Σ (v − v*)² + w_F Σ (F − F*)² (+ w_a Σ (a − a*)²)
/// ```
///
/// with the starred quantities from the rig's equation of motion under the
/// law. Standard deviations come from the residuals' own variance and
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
    rig.check()?;
    let mut plan = plan(impact, rig, problem, options)?;
    let solution = plan.solve(rig)?;
    let mut fit = plan.report(&solution, rig)?;
    if let Rig::Carriage(carriage) = rig
        && carriage.mass_sd > 0.0
    {
        widen_for_mass(&mut fit, &plan, carriage.mass, carriage.mass_sd);
    }
    Ok(fit)
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
            let plan = plan(impact, rig, problem, options)?;
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

/// Adds the uncertainty of the mass to the intervals, by fitting with the mass
/// one standard deviation lower and higher.
fn widen_for_mass(fit: &mut Fit, plan: &Plan, mass: f64, sd: f64) {
    let at = vec![fit.law.parameters()];
    // A mass that is hardly known is varied by no more than half of itself.
    let step = sd.min(0.5 * mass);
    let low = plan.solve_with_mass(mass - step, &at);
    let high = plan.solve_with_mass(mass + step, &at);
    let (Ok(low), Ok(high)) = (low, high) else {
        fit.findings.push(Finding::MassLeftOut { mass, sd });
        return;
    };
    let quantile = plan.quantile(fit.samples);
    let estimates = fit.parameters.iter_mut().chain(&mut fit.nuisances);
    for (i, estimate) in estimates.enumerate() {
        let by_mass = 0.5 * (high.free[i] - low.free[i]) * sd / step;
        estimate.sd = estimate.sd.hypot(by_mass);
        estimate.low = estimate.value - quantile * estimate.sd;
        estimate.high = estimate.value + quantile * estimate.sd;
    }
    fit.findings.push(Finding::UncertainMass { mass, sd });
}
