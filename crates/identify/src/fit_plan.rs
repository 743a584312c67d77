//! Everything that is decided before the minimiser runs: samples and weights,
//! free parameters, starting points.

use crate::error::Error;
use crate::estimator::{Coordinate, FreeParameter, Setting, Target};
use crate::finding::Finding;
use crate::model::Sampling;
use crate::motion::Motion;
use crate::problem::{FitOptions, IMPACT_VELOCITY, LawProblem, Treatment, Weighting};
use crate::regression::{RegressionEstimate, regress};
use crate::rig::Rig;
use crate::samples::{QUANTITIES, Quantity, SampleGroup};
use crate::simulate::check_positive;
use crate::solve::{Limits, Solution, solve};
use crate::starting_values::{Features, starting_values};
use windfall_contact::law_kind::LawKind;
use windfall_numerics::ode_step::Tolerance;
use windfall_signal::impact::{Impact, Series};

/// Range searched for a scale parameter, as factors of its start.
const SEARCH_FACTOR: f64 = 1e5;
/// Range searched for the velocity, as a factor of its start.
const VELOCITY_FACTOR: f64 = 5.0;
/// Factors of stiffness and damping tried when the first start fails.
const OTHER_STARTS: [(f64, f64); 4] = [(0.3, 1.0), (3.0, 1.0), (1.0, 0.2), (1.0, 3.0)];

/// Everything decided before the minimiser runs.
pub(crate) struct Plan<'a> {
    pub(crate) impact: &'a Impact,
    pub(crate) problem: &'a LawProblem,
    pub(crate) options: &'a FitOptions,
    pub(crate) groups: Vec<SampleGroup>,
    pub(crate) free: Vec<FreeParameter>,
    pub(crate) starts: Vec<Vec<f64>>,
    pub(crate) features: Features,
    pub(crate) regression: Vec<RegressionEstimate>,
    pub(crate) motion: Motion,
    pub(crate) findings: Vec<Finding>,
}

pub(crate) fn series(impact: &Impact, quantity: Quantity) -> Option<&Series> {
    let found = match quantity {
        Quantity::Displacement => &impact.displacement,
        Quantity::Rate => &impact.rate,
        Quantity::Force => &impact.force,
        Quantity::Acceleration => &impact.acceleration,
    };
    found.as_ref().filter(|s| !s.times.is_empty())
}

pub(crate) fn plan<'a>(
    impact: &'a Impact,
    rig: &Rig,
    problem: &'a LawProblem,
    options: &'a FitOptions,
) -> Result<Plan<'a>, Error> {
    let description = problem.kind.describe();
    if problem.free_positions().next().is_none() {
        return Err(Error::NothingToFit {
            law: description.name,
        });
    }
    let (groups, mut findings) = sample_groups(impact, options)?;
    let mut features = Features::of(impact, rig.effective_mass());
    if let Some(velocity) = options.known_velocity {
        check_positive("the velocity at first touch", velocity)?;
        features.velocity = velocity;
    }
    let start = starting_values(problem.kind, &features, &problem.values);
    let regression = regression_of(impact, problem, &start);
    let free = free_parameters(impact, problem, options, &features, &start, &mut findings)?;
    let samples = groups.iter().map(sample_count).sum();
    if samples <= free.len() {
        return Err(Error::TooFewSamples {
            samples,
            parameters: free.len(),
        });
    }
    Ok(Plan {
        impact,
        problem,
        options,
        groups,
        free,
        starts: starts(problem, start, &regression),
        features,
        regression,
        motion: Motion::from(rig),
        findings,
    })
}

pub(crate) fn sample_count(group: &SampleGroup) -> usize {
    let quantities = Quantity::ALL.iter().filter(|q| group.holds(**q)).count();
    quantities * group.times().len()
}

/// Groups the series that share their times, each with its weight. Times count
/// from the threshold's onset.
fn sample_groups(
    impact: &Impact,
    options: &FitOptions,
) -> Result<(Vec<SampleGroup>, Vec<Finding>), Error> {
    let mut findings = Vec::new();
    let mut used: Vec<(Quantity, &Series)> = Vec::new();
    for quantity in Quantity::ALL {
        if !options.quantities.holds(quantity) {
            continue;
        }
        match series(impact, quantity) {
            Some(found) => used.push((quantity, found)),
            None => findings.push(Finding::MissingQuantity {
                quantity: quantity.name(),
            }),
        }
    }
    if used.is_empty() {
        let present = Quantity::ALL
            .into_iter()
            .filter(|q| series(impact, *q).is_some());
        let present: Vec<_> = present.map(Quantity::name).collect();
        return Err(Error::NoQuantities {
            wanted: options.quantities.names().join(", "),
            present: present.join(", "),
        });
    }
    let mut groups = Vec::new();
    let mut grouped = [false; QUANTITIES];
    for (i, &(_, first)) in used.iter().enumerate() {
        if grouped[i] {
            continue;
        }
        let mut values: [Option<(&[f64], f64)>; QUANTITIES] = [None; QUANTITIES];
        for (j, &(quantity, other)) in used.iter().enumerate().skip(i) {
            if !grouped[j] && other.times == first.times {
                grouped[j] = true;
                let weight = weight_of(impact, other, options.weighting);
                values[quantity as usize] = Some((&other.values, weight));
            }
        }
        let times: Vec<f64> = first.times.iter().map(|t| t - impact.onset).collect();
        groups.push(SampleGroup::new(&times, values));
    }
    Ok((groups, findings))
}

fn weight_of(impact: &Impact, series: &Series, weighting: Weighting) -> f64 {
    match weighting {
        Weighting::InverseVariance => 1.0 / (series.noise * series.noise),
        Weighting::InverseMean => {
            let inside = series.times.iter().zip(&series.values);
            let inside = inside.filter(|(t, _)| **t >= impact.onset && **t <= impact.end);
            let (sum, count) = inside.fold((0.0, 0), |(sum, n), (_, v)| (sum + v.abs(), n + 1));
            f64::from(count) / f64::max(sum, f64::MIN_POSITIVE)
        }
    }
}

fn regression_of(impact: &Impact, problem: &LawProblem, start: &[f64]) -> Vec<RegressionEstimate> {
    let law = problem.kind.with_parameters(start).ok();
    law.and_then(|law| regress(impact, &law))
        .unwrap_or_default()
}

/// Starting points in the order in which they are tried.
fn starts(
    problem: &LawProblem,
    start: Vec<f64>,
    regression: &[RegressionEstimate],
) -> Vec<Vec<f64>> {
    let mut out = Vec::new();
    // The regression, where it makes sense, is nearer than the rough guess.
    if !regression.is_empty() && regression.iter().all(|r| r.value > 0.0) {
        let mut near = start.clone();
        for r in regression.iter().filter(|r| problem.free[r.position]) {
            near[r.position] = r.value;
        }
        out.push(near);
    }
    out.push(start.clone());
    let mut scales = problem
        .free_positions()
        .filter(|&i| is_scale(problem.kind, i));
    let (first, second) = (scales.next(), scales.next());
    for (stiffness, damping) in OTHER_STARTS {
        let mut other = start.clone();
        for (position, factor) in [(first, stiffness), (second, damping)] {
            if let Some(i) = position {
                other[i] *= factor;
            }
        }
        out.push(other);
    }
    out
}

/// Whether a parameter is a positive scale, to be moved on a logarithmic axis.
fn is_scale(kind: LawKind, position: usize) -> bool {
    kind.describe().parameters[position].unit != "1"
}

fn free_parameters(
    impact: &Impact,
    problem: &LawProblem,
    options: &FitOptions,
    features: &Features,
    start: &[f64],
    findings: &mut Vec<Finding>,
) -> Result<Vec<FreeParameter>, Error> {
    let description = problem.kind.describe();
    let mut free: Vec<FreeParameter> = problem
        .free_positions()
        .map(|i| {
            let parameter = &description.parameters[i];
            let scale = is_scale(problem.kind, i);
            FreeParameter {
                target: Target::Law(i),
                coordinate: if scale {
                    Coordinate::Logarithm
                } else {
                    Coordinate::Linear(1.0)
                },
                lower: if scale {
                    parameter.lower.max(start[i] / SEARCH_FACTOR)
                } else {
                    parameter.lower
                },
                upper: if scale {
                    parameter.upper.min(start[i] * SEARCH_FACTOR)
                } else {
                    parameter.upper
                },
            }
        })
        .collect();
    let nuisances = nuisances(impact, options, features, findings)?;
    if !nuisances.is_empty() {
        let names: Vec<_> = nuisances
            .iter()
            .map(|p| nuisance_name(p.target).0)
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

/// Which nuisances are free, and findings for those that are held.
fn nuisances(
    impact: &Impact,
    options: &FitOptions,
    features: &Features,
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
    };
    let measured = impact.measured.impact_velocity.is_some() || options.known_velocity.is_some();
    let held = |quantity, value, unit, reason| Finding::Held {
        quantity,
        value,
        unit,
        reason,
    };
    match options.initial_velocity {
        Treatment::Free => free.push(velocity),
        Treatment::Auto if moves || !measured => free.push(velocity),
        Treatment::Auto => findings.push(held(
            "initial_velocity",
            features.velocity,
            "m/s",
            "the quantities in the cost say little about it, and the motion before contact was measured",
        )),
        Treatment::Fixed if !measured => return Err(Error::UnknownVelocity),
        Treatment::Fixed => findings.push(held(
            "initial_velocity",
            features.velocity,
            "m/s",
            "as asked",
        )),
    }
    let onset = FreeParameter {
        target: Target::Onset,
        coordinate: Coordinate::Linear(features.duration),
        lower: -features.duration,
        upper: features.duration,
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
    };
    if has(Quantity::Displacement) {
        match options.displacement_offset {
            Treatment::Auto | Treatment::Free => free.push(offset),
            Treatment::Fixed => findings.push(held("displacement_offset", 0.0, "m", "as asked")),
        }
    }
    Ok(free)
}

impl Plan<'_> {
    pub(crate) fn solve(&self, rig: &Rig) -> Result<Solution, Error> {
        self.solve_with_mass(rig.effective_mass(), &self.starts)
    }

    /// What the minimiser holds constant.
    pub(crate) fn setting(&self) -> Setting<'_> {
        let description = self.problem.kind.describe();
        let tied_velocity = description
            .parameters
            .iter()
            .position(|p| p.name == IMPACT_VELOCITY)
            .filter(|&i| self.problem.values[i].is_none() && !self.problem.free[i]);
        let accuracy = self.options.accuracy;
        Setting {
            motion: self.motion,
            groups: &self.groups,
            end: self.options.end,
            tolerance: Tolerance {
                relative: accuracy,
                absolute: [
                    1e-3 * accuracy * self.features.displacement,
                    1e-2 * accuracy * self.features.velocity,
                ],
            },
            tied_velocity,
            sampling: if self.free.iter().any(|p| p.target == Target::Onset) {
                Sampling::Averaged
            } else {
                Sampling::Instantaneous
            },
        }
    }

    pub(crate) fn solve_with_mass(
        &self,
        mass: f64,
        starts: &[Vec<f64>],
    ) -> Result<Solution, Error> {
        let description = self.problem.kind.describe();
        let no_start = Error::NoStart {
            law: description.name,
        };
        let setting = self.setting();
        let limits = Limits {
            cost_tolerance: self.options.cost_tolerance,
            max_evaluations: self.options.max_evaluations,
            samples: self.groups.iter().map(sample_count).sum(),
            offsets: Quantity::ALL.map(|q| series(self.impact, q).map_or(0.0, |s| s.zero_sd)),
        };
        let starts: Vec<(Vec<f64>, [f64; 4])> = starts
            .iter()
            .map(|law| (law.clone(), [self.features.velocity, mass, 0.0, 0.0]))
            .collect();
        let law = self.problem.kind.with_parameters(&starts[0].0)?;
        solve(&law, &setting, &self.free, &starts, &limits).ok_or(no_start)
    }
}
