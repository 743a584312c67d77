//! What a fit estimates: parameters of the law and nuisances, with their coordinates, ranges and
//! priors.

use crate::error::Error;
use crate::finding::{Finding, in_a_sentence};
use crate::fit::estimator::{Coordinate, FreeParameter, Target};
use crate::fit::noise::series;
use crate::fit::problem::{FitOptions, Known, LawProblem, Prior, Treatment};
use crate::samples::Quantity;
use windfall_contact::impact_law::ImpactScales;
use windfall_contact::laws::kind::LawKind;
use windfall_signal::impact::Impact;

/// Range searched for a scale parameter, as factors of its start.
const SEARCH_FACTOR: f64 = 1e5;
/// Range searched for the velocity, as a factor of its start.
const VELOCITY_FACTOR: f64 = 5.0;

/// Whether a parameter is a positive scale, to be moved on a logarithmic axis.
pub(crate) fn is_scale(kind: LawKind, position: usize, start: f64) -> bool {
    let parameter = &kind.describe().parameters[position];
    parameter.unit != "1" && parameter.lower >= 0.0 && start > 0.0
}

/// Size of a parameter that is moved on a linear axis: exponents and the like
/// are of the order of one, others of that of their start.
fn linear_scale(kind: LawKind, position: usize, start: f64) -> f64 {
    match kind.describe().parameters[position].unit {
        "1" => 1.0,
        _ if start != 0.0 => start.abs(),
        _ => 1.0,
    }
}

pub(crate) fn free_parameters(
    impact: &Impact,
    problem: &LawProblem,
    options: &FitOptions,
    features: &ImpactScales,
    start: &[f64],
    findings: &mut Vec<Finding>,
) -> Result<Vec<FreeParameter>, Error> {
    let description = problem.kind.describe();
    let mut free: Vec<FreeParameter> = problem
        .free_positions()
        .map(|i| {
            let parameter = &description.parameters[i];
            let (coordinate, lower, upper) = match is_scale(problem.kind, i, start[i]) {
                true => (
                    Coordinate::Logarithm,
                    parameter.lower.max(start[i] / SEARCH_FACTOR),
                    parameter.upper.min(start[i] * SEARCH_FACTOR),
                ),
                false => (
                    Coordinate::Linear(linear_scale(problem.kind, i, start[i])),
                    parameter.lower,
                    parameter.upper,
                ),
            };
            let own = FreeParameter {
                target: Target::Law(i),
                coordinate,
                lower,
                upper,
                prior: None,
            };
            match problem.known(parameter.name) {
                Some(known) => as_known(own, known, 0.0),
                None => own,
            }
        })
        .collect();
    let nuisances = nuisances(impact, (problem, options), features, findings)?;
    if !nuisances.is_empty() {
        let names: Vec<_> = nuisances
            .iter()
            .map(|p| in_a_sentence(nuisance_name(p.target).0))
            .collect();
        findings.push(Finding::Freed {
            quantities: names.join(", "),
        });
    }
    free.extend(nuisances);
    Ok(free)
}

/// Name and unit of a nuisance.
pub(crate) fn nuisance_name(target: Target) -> (&'static str, &'static str) {
    match target {
        Target::Onset => ("onset", "s"),
        Target::DisplacementOffset => ("displacement_offset", "m"),
        Target::InitialVelocity | Target::Law(_) => ("initial_velocity", "m/s"),
    }
}

/// Moves starting values to the priors of the parameters, and into their ranges.
pub(crate) fn begin_as_known(problem: &LawProblem, start: &mut [f64]) {
    let parameters = problem.kind.describe().parameters;
    for i in problem.free_positions() {
        let Some(known) = problem.known(parameters[i].name) else {
            continue;
        };
        let prior = known.prior.filter(|_| problem.values[i].is_none());
        // A scale begins above zero.
        let prior = prior.filter(|prior| prior.mean > 0.0 || parameters[i].unit == "1");
        let (lower, upper) = known.range;
        start[i] = prior.map_or(start[i], |prior| prior.mean);
        start[i] = start[i].max(lower).min(upper);
    }
}

/// A free parameter with its prior, within the range that is known of it.
///
/// * `clock`: time on the recording's clock at which that of the fit is zero; s
fn as_known(own: FreeParameter, known: &Known, clock: f64) -> FreeParameter {
    let (low, high) = (known.range.0 - clock, known.range.1 - clock);
    let inside = |value: f64| match own.coordinate {
        Coordinate::Logarithm => value > 0.0,
        Coordinate::Linear(_) => true,
    };
    let given = |end: f64| end.is_finite() && inside(end);
    let width = own.upper - own.lower;
    let mut lower = if given(low) { low } else { own.lower };
    let mut upper = if given(high) { high } else { own.upper };
    // A range wholly outside of what is usually searched, open on one side.
    if lower >= upper {
        match given(low) {
            true => upper = lower + width,
            false => lower = upper - width,
        }
    }
    if own.coordinate == Coordinate::Logarithm && lower <= 0.0 {
        lower = upper / (SEARCH_FACTOR * SEARCH_FACTOR);
    }
    let prior = known.prior.map(|prior| Prior {
        mean: prior.mean - clock,
        ..prior
    });
    FreeParameter {
        lower,
        upper,
        prior,
        ..own
    }
}

/// Which nuisances are free, and findings for those that are held.
fn nuisances(
    impact: &Impact,
    (problem, options): (&LawProblem, &FitOptions),
    features: &ImpactScales,
    findings: &mut Vec<Finding>,
) -> Result<Vec<FreeParameter>, Error> {
    let has = |q: Quantity| options.quantities.holds(q) && series(impact, q).is_some();
    let moves = has(Quantity::Displacement) || has(Quantity::Rate);
    let mut free = Vec::new();

    let velocity = FreeParameter {
        target: Target::InitialVelocity,
        coordinate: Coordinate::Logarithm,
        lower: features.velocity / VELOCITY_FACTOR,
        upper: features.velocity * VELOCITY_FACTOR,
        prior: None,
    };
    let has_prior = |target: Target| {
        let known = problem.known(nuisance_name(target).0);
        known.is_some_and(|known| known.prior.is_some())
    };
    let velocity_is_known = has_prior(Target::InitialVelocity);
    let measured = impact.measured.impact_velocity.is_some() || options.known_velocity.is_some();
    let held = |quantity, value, unit, reason| Finding::Held {
        quantity,
        value,
        unit,
        reason,
    };
    match options.initial_velocity {
        Treatment::Free => free.push(velocity),
        Treatment::Auto if moves || !measured || velocity_is_known => free.push(velocity),
        Treatment::Auto => findings.push(held(
            "initial velocity",
            features.velocity,
            "m/s",
            "the quantities in the cost say little about it, and the motion before contact was measured",
        )),
        Treatment::Fixed if !measured => return Err(Error::UnknownVelocity),
        Treatment::Fixed => {
            findings.push(held("initial velocity", features.velocity, "m/s", "as asked"));
        }
    }
    let onset = FreeParameter {
        target: Target::Onset,
        coordinate: Coordinate::Linear(features.duration),
        lower: -features.duration,
        upper: features.duration,
        prior: None,
    };
    match options.onset {
        Treatment::Auto | Treatment::Free => free.push(onset),
        Treatment::Fixed => findings.push(held("onset", impact.onset, "s", "as asked")),
    }
    let offset = FreeParameter {
        target: Target::DisplacementOffset,
        coordinate: Coordinate::Linear(features.displacement),
        lower: -2.0 * features.displacement,
        upper: 2.0 * features.displacement,
        prior: None,
    };
    if has(Quantity::Displacement) {
        match options.displacement_offset {
            Treatment::Auto | Treatment::Free => free.push(offset),
            Treatment::Fixed => findings.push(held("displacement offset", 0.0, "m", "as asked")),
        }
    }
    for own in &mut free {
        if let Some(known) = problem.known(nuisance_name(own.target).0) {
            let onset = own.target == Target::Onset;
            *own = as_known(*own, known, if onset { impact.onset } else { 0.0 });
        }
    }
    Ok(free)
}
