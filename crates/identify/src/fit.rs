//! Impact → Fit: the parameters of a force law from one measured impact.

use crate::error::Error;
use crate::estimator::{Coordinate, FreeParameter, Setting, Target};
use crate::finding::Finding;
use crate::model::Sampling;
use crate::motion::Motion;
use crate::problem::{FitOptions, IMPACT_VELOCITY, LawProblem, Treatment, Weighting};
use crate::regression::{RegressionEstimate, regress};
use crate::rig::Rig;
use crate::samples::{QUANTITIES, Quantity, SampleGroup};
use crate::simulate::{ImpactSummary, simulate_rig};
use crate::solve::{LARGEST_FREE, Limits, Solution, solve};
use crate::starting_values::{Features, starting_values};
use crate::uncertainty::{RunsTest, runs_test};
use statrs::distribution::{ContinuousCDF, StudentsT};
use windfall_contact::law_kind::{Law, LawKind};
use windfall_contact::restitution::nominal_restitution;
use windfall_numerics::least_squares::Stop;
use windfall_numerics::ode_step::Tolerance;
use windfall_signal::impact::{Impact, Series};

/// Correlation above which two parameters are reported as inseparable.
const HIGH_CORRELATION: f64 = 0.99;
/// Runs-test score below which residuals are called structured.
const STRUCTURED_Z: f64 = -5.0;
/// Residuals this many times the noise are called a misfit.
const MISFIT_RATIO: f64 = 2.0;
/// Range searched for a scale parameter, as factors of its start.
const SEARCH_FACTOR: f64 = 1e5;
/// Range searched for the velocity, as a factor of its start.
const VELOCITY_FACTOR: f64 = 5.0;
/// Factors of stiffness and damping tried when the first start fails.
const OTHER_STARTS: [(f64, f64); 4] = [(0.3, 1.0), (3.0, 1.0), (1.0, 0.2), (1.0, 3.0)];

/// One estimated parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Name: the law's, or "initial_velocity", "onset", "displacement_offset".
    pub name: String,
    /// Estimate; SI.
    pub value: f64,
    /// Standard deviation; SI. NaN never: a parameter without one is reported
    /// with [`Finding::Singular`] and an infinite deviation.
    pub sd: f64,
    /// Lower end of the interval; SI.
    pub low: f64,
    /// Upper end of the interval; SI.
    pub high: f64,
    /// Unit.
    pub unit: String,
}

/// How one quantity fits.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityFit {
    /// The quantity.
    pub quantity: Quantity,
    /// Samples.
    pub samples: usize,
    /// Weight in the cost.
    pub weight: f64,
    /// Noise of a sample, from the recording itself; SI.
    pub noise: f64,
    /// Root mean square residual; SI.
    pub rms_residual: f64,
    /// Runs test of the residuals, where there are enough.
    pub runs: Option<RunsTest>,
}

/// A law fitted to an impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The law with all its parameters.
    pub law: Law,
    /// The law's free parameters.
    pub parameters: Vec<Estimate>,
    /// What was estimated besides the law.
    pub nuisances: Vec<Estimate>,
    /// Correlations of all free parameters, in the order of `parameters` then
    /// `nuisances`; empty when they are not available.
    pub correlations: Vec<Vec<f64>>,
    /// Weighted sum of squared residuals.
    pub cost: f64,
    /// Its root.
    pub residual_norm: f64,
    /// Samples of all quantities.
    pub samples: usize,
    /// Evaluations of the model.
    pub evaluations: usize,
    /// Whether a minimum was reached.
    pub converged: bool,
    /// Each quantity of the cost.
    pub quantities: Vec<QuantityFit>,
    /// Linear regression of eq. (9) for comparison, by name.
    pub regression: Vec<Estimate>,
    /// The impact that the fitted law describes.
    pub simulated: ImpactSummary,
    /// Velocity at first touch of the fitted model; m/s.
    pub velocity: f64,
    /// Time of first touch on the recording's clock; s.
    pub onset: f64,
    /// Displacement offset; m.
    pub offset: f64,
    /// What a reader should know.
    pub findings: Vec<Finding>,
}

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
/// [`Error::MissingParameter`], [`Error::NoStart`], [`Error::BadInput`]. A fit
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
    let plan = plan(impact, rig, problem, options)?;
    let solution = plan.solve(rig)?;
    let mut fit = plan.report(&solution, rig)?;
    if let Rig::Carriage(carriage) = rig
        && carriage.mass_sd > 0.0
    {
        widen_for_mass(&mut fit, &plan, carriage.mass, carriage.mass_sd);
    }
    Ok(fit)
}

/// Everything decided before the minimiser runs.
struct Plan<'a> {
    impact: &'a Impact,
    problem: &'a LawProblem,
    options: &'a FitOptions,
    groups: Vec<SampleGroup>,
    free: Vec<FreeParameter>,
    starts: Vec<Vec<f64>>,
    features: Features,
    regression: Vec<RegressionEstimate>,
    motion: Motion,
    findings: Vec<Finding>,
}

fn series(impact: &Impact, quantity: Quantity) -> Option<&Series> {
    let found = match quantity {
        Quantity::Displacement => &impact.displacement,
        Quantity::Rate => &impact.rate,
        Quantity::Force => &impact.force,
        Quantity::Acceleration => &impact.acceleration,
    };
    found.as_ref().filter(|s| !s.times.is_empty())
}

fn plan<'a>(
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
    let features = Features::of(impact, rig.effective_mass());
    let start = starting_values(problem.kind, &features, &problem.values);
    let regression = regression_of(impact, problem, &start);
    let free = free_parameters(impact, problem, options, &features, &start, &mut findings);
    let samples = groups.iter().map(sample_count).sum();
    if samples <= free.len() || free.len() > LARGEST_FREE {
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

fn sample_count(group: &SampleGroup) -> usize {
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
) -> Vec<FreeParameter> {
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
    let nuisances = nuisances(impact, options, features, findings);
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
    free
}

/// Name and unit of a nuisance.
fn nuisance_name(target: Target) -> (&'static str, &'static str) {
    match target {
        Target::Onset => ("onset", "s"),
        Target::DisplacementOffset => ("displacement_offset", "m"),
        Target::Mass => ("mass", "kg"),
        Target::InitialVelocity | Target::Law(_) => ("initial_velocity", "m/s"),
    }
}

/// Which nuisances are free, and findings for those that are held.
fn nuisances(
    impact: &Impact,
    options: &FitOptions,
    features: &Features,
    findings: &mut Vec<Finding>,
) -> Vec<FreeParameter> {
    let has = |q: Quantity| options.quantities.holds(q) && series(impact, q).is_some();
    let moves = has(Quantity::Displacement) || has(Quantity::Rate);
    let mut free = Vec::new();

    let velocity = FreeParameter {
        target: Target::InitialVelocity,
        coordinate: Coordinate::Logarithm,
        lower: features.velocity / VELOCITY_FACTOR,
        upper: features.velocity * VELOCITY_FACTOR,
    };
    let measured = impact.measured.impact_velocity.is_some();
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
    free
}

impl Plan<'_> {
    fn solve(&self, rig: &Rig) -> Result<Solution, Error> {
        self.solve_with_mass(rig.effective_mass(), &self.starts)
    }

    fn solve_with_mass(&self, mass: f64, starts: &[Vec<f64>]) -> Result<Solution, Error> {
        let description = self.problem.kind.describe();
        let no_start = Error::NoStart {
            law: description.name,
        };
        let tied_velocity = description
            .parameters
            .iter()
            .position(|p| p.name == IMPACT_VELOCITY)
            .filter(|&i| self.problem.values[i].is_none() && !self.problem.free[i]);
        let accuracy = self.options.accuracy;
        let setting = Setting {
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
            sampling: Sampling::Averaged,
        };
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

    fn report(&self, solution: &Solution, rig: &Rig) -> Result<Fit, Error> {
        let law = self.problem.kind.with_parameters(&solution.law)?;
        let samples: usize = self.groups.iter().map(sample_count).sum();
        let estimates = self.estimates(solution, &law, samples);
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
            quantities: self.quantity_fits(solution),
            regression: self.regression_estimates(&law),
            simulated,
            velocity: solution.velocity,
            onset: self.impact.onset + solution.onset,
            offset: solution.offset,
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

    fn quantile(&self, samples: usize) -> f64 {
        let freedom = (samples - self.free.len()) as f64;
        let student = StudentsT::new(0.0, 1.0, freedom);
        student.map_or(f64::INFINITY, |t| {
            t.inverse_cdf(0.5 * (1.0 + self.options.confidence))
        })
    }

    fn estimates(&self, solution: &Solution, law: &Law, samples: usize) -> Vec<Estimate> {
        let quantile = self.quantile(samples);
        self.free
            .iter()
            .enumerate()
            .map(|(i, parameter)| {
                let (name, unit) = self.name_and_unit(parameter.target, law);
                let sd = solution
                    .covariance
                    .get(i)
                    .map_or(f64::INFINITY, |row| row[i].max(0.0).sqrt());
                // The onset is told on the recording's clock.
                let value = match parameter.target {
                    Target::Onset => self.impact.onset + solution.free[i],
                    _ => solution.free[i],
                };
                Estimate {
                    name,
                    value,
                    sd,
                    low: value - quantile * sd,
                    high: value + quantile * sd,
                    unit,
                }
            })
            .collect()
    }

    fn regression_estimates(&self, law: &Law) -> Vec<Estimate> {
        let described = self.problem.kind.describe().parameters;
        self.regression
            .iter()
            .map(|r| Estimate {
                name: described[r.position].name.to_owned(),
                value: r.value,
                sd: r.standard_error,
                low: r.value - 2.0 * r.standard_error,
                high: r.value + 2.0 * r.standard_error,
                unit: law.unit_of(r.position),
            })
            .collect()
    }

    fn quantity_fits(&self, solution: &Solution) -> Vec<QuantityFit> {
        let mut out = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            for quantity in Quantity::ALL.into_iter().filter(|q| group.holds(*q)) {
                let residuals = &solution.rows.residuals[g][quantity as usize];
                let square: f64 = residuals.iter().map(|r| r * r).sum();
                out.push(QuantityFit {
                    quantity,
                    samples: residuals.len(),
                    weight: group.weight(quantity),
                    noise: series(self.impact, quantity).map_or(f64::NAN, |s| s.noise),
                    rms_residual: (square / residuals.len().max(1) as f64).sqrt(),
                    runs: runs_test(residuals),
                });
            }
        }
        out.sort_by_key(|q| q.quantity);
        out
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
            out.push(Finding::AtBound {
                parameter: estimates[i].name.clone(),
                side: if lower { "lower" } else { "upper" },
                bound: if lower {
                    self.free[i].lower
                } else {
                    self.free[i].upper
                },
                unit: estimates[i].unit.clone(),
            });
        }
        if solution.covariance.is_empty() {
            out.push(Finding::Singular);
        }
        for i in 0..fit.correlations.len() {
            for j in 0..i {
                let correlation = fit.correlations[i][j];
                if correlation.abs() > HIGH_CORRELATION {
                    out.push(Finding::Correlated {
                        first: estimates[j].name.clone(),
                        second: estimates[i].name.clone(),
                        correlation,
                    });
                }
            }
        }
        out.extend(fit.quantities.iter().flat_map(quantity_remarks));
        if let Some(nominal) = nominal_restitution(&fit.law) {
            out.push(Finding::NominalRestitution {
                nominal,
                delivered: fit.simulated.restitution,
            });
        }
        out
    }
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
    if let Some(runs) = found.runs.filter(|r| r.z < STRUCTURED_Z) {
        out.push(Finding::StructuredResiduals {
            quantity: found.quantity.name(),
            z: runs.z,
        });
    }
    out
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

/// Adds the uncertainty of the mass to the intervals, by fitting with the mass
/// one standard deviation lower and higher.
fn widen_for_mass(fit: &mut Fit, plan: &Plan, mass: f64, sd: f64) {
    let at = vec![fit.law.parameters()];
    let low = plan.solve_with_mass((mass - sd).max(0.1 * mass), &at);
    let high = plan.solve_with_mass(mass + sd, &at);
    let (Ok(low), Ok(high)) = (low, high) else {
        return;
    };
    let quantile = plan.quantile(fit.samples);
    let estimates = fit.parameters.iter_mut().chain(&mut fit.nuisances);
    for (i, estimate) in estimates.enumerate() {
        let by_mass = 0.5 * (high.free[i] - low.free[i]);
        estimate.sd = estimate.sd.hypot(by_mass);
        estimate.low = estimate.value - quantile * estimate.sd;
        estimate.high = estimate.value + quantile * estimate.sd;
    }
    fit.findings.push(Finding::UncertainMass { mass, sd });
}
