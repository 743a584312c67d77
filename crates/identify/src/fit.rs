//! Impact → Fit: the parameters of a force law from one measured impact.

use crate::error::Error;
use crate::finding::Finding;
use crate::fit_plan::{Plan, plan};
use crate::problem::{FitOptions, LawProblem};
use crate::rig::Rig;
use windfall_signal::impact::Impact;

pub use crate::fit_types::{Estimate, Fit, QuantityFit};

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
/// correlation ([`covariance`](crate::uncertainty::covariance)).
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
