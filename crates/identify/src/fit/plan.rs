//! Everything that is decided before the minimiser runs: samples and weights,
//! free parameters, starting points.

use crate::error::{Error, check_positive};
use crate::finding::Finding;
use crate::fit::estimator::{FreeParameter, Setting, Target};
use crate::fit::free::{begin_as_known, free_parameters, is_scale};
use crate::fit::interval::{IntervalMethod, IntervalPlan};
use crate::fit::model::Sampling;
use crate::fit::noise::{NoisePlan, noise_plan, series};
use crate::fit::problem::{FitOptions, LawProblem, NoiseModel, Weighting};
use crate::fit::regression::{RegressionEstimate, regress};
use crate::fit::solve::{Limits, Solution, Start, Wanted, solve};
use crate::fit::starting_values::impact_scales;
use crate::rig::kind::Rig;
use crate::rig::motion::Motion;
use crate::rig::simulate::trajectory;
use crate::sampler::check_sampler;
use crate::samples::{Quantity, SampleGroup};
use windfall_contact::impact_law::ImpactScales;
use windfall_contact::parameter::IMPACT_VELOCITY;
use windfall_contact::starting_values::starting_values;
use windfall_numerics::ode::step::Tolerance;
use windfall_signal::impact::Impact;

/// Factors of stiffness and damping tried when the first start fails.
const OTHER_STARTS: [(f64, f64); 4] = [(0.3, 1.0), (3.0, 1.0), (1.0, 0.2), (1.0, 3.0)];

/// Cost tolerance of the first fit, which serves only to estimate the noise, over that of the final
/// one: it may end at the minimum for averaged samples, and weights and cost depend on its last
/// digits.
const CLOSER: f64 = 0.01;

/// Everything decided before the minimiser runs.
pub(crate) struct Plan<'a> {
    pub(crate) impact: &'a Impact,
    pub(crate) problem: &'a LawProblem,
    pub(crate) options: &'a FitOptions,
    pub(crate) noise: NoisePlan,
    pub(crate) free: Vec<FreeParameter>,
    pub(crate) starts: Vec<Vec<f64>>,
    pub(crate) features: ImpactScales,
    pub(crate) regression: Vec<RegressionEstimate>,
    pub(crate) motion: Motion,
    pub(crate) findings: Vec<Finding>,
    /// Whether the fit ends at the minimum for instantaneous samples: a force that a filter or
    /// a sensor has smoothed has no corner at first touch.
    pub(crate) instants: bool,
}

pub(crate) fn plan<'a>(
    impact: &'a Impact,
    rig: &Rig,
    problem: &'a LawProblem,
    options: &'a FitOptions,
) -> Result<Plan<'a>, Error> {
    if options.intervals.method == IntervalMethod::Posterior {
        check_sampler()?;
    }
    let description = problem.kind.describe();
    if problem.free_positions().next().is_none() {
        return Err(Error::NothingToFit {
            law: description.name,
        });
    }
    let (noise, mut findings) = samples(impact, options)?;
    let mut features = impact_scales(impact, rig.effective_mass());
    if let Some(velocity) = options.known_velocity {
        check_positive("the velocity at first touch", velocity)?;
        features.velocity = velocity;
    }
    let mut start = starting_values(problem.kind, &features, &problem.values);
    begin_as_known(problem, &mut start);
    let regression = regression_of(impact, problem, &start);
    let free = free_parameters(impact, problem, options, &features, &start, &mut findings)?;
    let samples = noise.groups.iter().map(sample_count).sum();
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
        noise,
        free,
        starts: starts(problem, start, &regression),
        features,
        regression,
        motion: Motion::from(rig),
        findings,
        instants: !options.response.smooths(),
    })
}

pub(crate) fn sample_count(group: &SampleGroup) -> usize {
    let quantities = Quantity::ALL.iter().filter(|q| group.holds(**q)).count();
    quantities * group.times().len()
}

/// Samples with their noise, and findings for missing quantities.
fn samples(impact: &Impact, options: &FitOptions) -> Result<(NoisePlan, Vec<Finding>), Error> {
    let mut findings = Vec::new();
    let missing = Quantity::ALL
        .into_iter()
        .filter(|q| options.quantities.holds(*q) && series(impact, *q).is_none());
    findings.extend(missing.map(|q| Finding::MissingQuantity { quantity: q.name() }));
    let plan = noise_plan(impact, options, &mut findings);
    if plan.groups.is_empty() {
        let present = Quantity::ALL
            .into_iter()
            .filter(|q| series(impact, *q).is_some());
        let present: Vec<_> = present.map(Quantity::name).collect();
        return Err(Error::NoQuantities {
            wanted: options.quantities.names().join(", "),
            present: present.join(", "),
        });
    }
    Ok((plan, findings))
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
        .filter(|&i| is_scale(problem.kind, i, start[i]));
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

impl Plan<'_> {
    /// Solves from the planned starts; then once more with the noise that the
    /// residuals show.
    pub(crate) fn solve(&mut self, rig: &Rig) -> Result<Solution, Error> {
        if !self.modelled() && self.intervals_wanted().is_none() {
            return self.solve_once(rig);
        }
        let first = match self.options.response.is_none() {
            true => self.solve_planned(rig, Wanted::Residuals)?,
            false => self.solve_once(rig)?,
        };
        self.noise = self.noise_after(&first, rig)?;
        self.solve_again(&first, rig)
    }

    /// Solves from the planned starts with the noise as it is planned.
    pub(crate) fn solve_once(&mut self, rig: &Rig) -> Result<Solution, Error> {
        let first = self.solve_planned(rig, Wanted::Covariance)?;
        match self.options.response.is_none() {
            true => Ok(first),
            false => self.settle(first, rig),
        }
    }

    /// The noise that the residuals of `first` show, where it is modelled.
    pub(crate) fn noise_after(&self, first: &Solution, rig: &Rig) -> Result<NoisePlan, Error> {
        if !self.modelled() {
            return Ok(self.noise.clone());
        }
        let velocities = self.velocities_at_edges(first, rig)?;
        let count = self.free.len();
        Ok(self
            .noise
            .recalibrated(self.impact, &first.rows, &velocities, count))
    }

    /// Solves once more from a solution, with the intervals that are wanted.
    pub(crate) fn solve_again(&self, first: &Solution, rig: &Rig) -> Result<Solution, Error> {
        let motion = [
            first.velocity,
            rig.effective_mass(),
            first.onset,
            first.offset,
        ];
        let start = (first.law.clone(), motion);
        let wanted = self.intervals_wanted();
        let wanted = wanted.map_or(Wanted::Covariance, Wanted::Intervals);
        let mut second = self.solve_from(&[start], wanted)?;
        second.evaluations += first.evaluations;
        Ok(second)
    }

    /// Whether weights are those of the noise that the recording shows.
    fn modelled(&self) -> bool {
        self.options.weighting == Weighting::InverseVariance
            && self.options.noise == NoiseModel::Automatic
    }

    fn velocities_at_edges(&self, solution: &Solution, rig: &Rig) -> Result<Vec<f64>, Error> {
        let Some(edges) = &self.noise.edges else {
            return Ok(Vec::new());
        };
        let law = self.problem.kind.with_parameters(&solution.law)?;
        let onset = self.impact.onset + solution.onset;
        let times: Vec<f64> = edges.times.iter().map(|t| t - onset).collect();
        let motion = trajectory(&law, rig, solution.velocity, &times, self.options.end)?;
        Ok(motion.rate)
    }

    fn solve_planned(&self, rig: &Rig, wanted: Wanted) -> Result<Solution, Error> {
        let (velocity, mass) = (self.features.velocity, rig.effective_mass());
        let starts = self.starts.iter();
        let starts = starts.map(|law| (law.clone(), [velocity, mass, 0.0, 0.0]));
        self.solve_from(&starts.collect::<Vec<_>>(), wanted)
    }

    fn intervals_wanted(&self) -> Option<IntervalPlan> {
        let options = self.options.intervals;
        let samples = self.noise.groups.iter().map(sample_count).sum();
        (options.method != IntervalMethod::Asymptotic).then(|| IntervalPlan {
            options,
            confidence: self.options.confidence,
            quantile: self.quantile(samples),
        })
    }

    /// What the minimiser holds constant.
    pub(crate) fn setting(&self) -> Setting {
        let description = self.problem.kind.describe();
        let tied_velocity = description
            .parameters
            .iter()
            .position(|p| p.name == IMPACT_VELOCITY)
            .filter(|&i| self.problem.values[i].is_none() && !self.problem.free[i]);
        let accuracy = self.options.accuracy;
        Setting {
            motion: self.motion,
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

    pub(crate) fn solve_from(&self, starts: &[Start], wanted: Wanted) -> Result<Solution, Error> {
        let description = self.problem.kind.describe();
        let no_start = Error::NoStart {
            law: description.name,
        };
        let closer = match wanted {
            Wanted::Residuals => CLOSER,
            Wanted::Covariance | Wanted::Intervals(_) => 1.0,
        };
        let limits = Limits {
            cost_tolerance: closer * self.options.cost_tolerance,
            max_evaluations: self.options.max_evaluations,
            samples: self.noise.groups.iter().map(sample_count).sum(),
            offsets: Quantity::ALL.map(|q| match self.modelled() {
                true => 0.0,
                false => series(self.impact, q).map_or(0.0, |s| s.zero_sd),
            }),
            instants: self.instants,
            wanted,
        };
        let law = self.problem.kind.with_parameters(&starts[0].0)?;
        let samples = (self.setting(), &self.noise.groups[..]);
        solve(&law, samples, &self.free, starts, &limits).ok_or(no_start)
    }
}
