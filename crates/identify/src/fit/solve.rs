//! From free parameters to estimates with covariance: the part of a fit that
//! knows the law's concrete type.

use crate::fit::batch_law::BatchLaw;
use crate::fit::bootstrap::bootstrap_intervals;
use crate::fit::estimator::{
    Coordinate, Estimator, FORESIGHT, FreeLaw, FreeParameter, Setting, Target, Values,
};
use crate::fit::interval::{FreeIntervals, IntervalMethod, IntervalPlan};
use crate::fit::model::Sampling;
use crate::fit::posterior::posterior_intervals;
use crate::fit::profile::profile_intervals;
use crate::fit::residual::Rows;
use crate::fit::uncertainty::covariance;
use crate::samples::{QUANTITIES, SampleGroup};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kind::Law;
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{Minimum, NormalEquations, Options, Stop};

/// Longest step of a logarithmic and of a linear coordinate.
const LONGEST_STEP: (f64, f64) = (2.0, 0.5);
/// Gain, in units of the residual variance, that may be lost to the kinks that
/// samples leave at separation: two tenths of a standard deviation. With free motion
/// after contact the other directions are known so well that a tenth is not reached.
const ROUGHNESS: f64 = 0.04;
/// Steps over a cusp in the onset; sampling intervals.
const CUSP_SHIFTS: [f64; 8] = [0.3, -0.3, 0.7, -0.7, 1.5, -1.5, 3.0, -3.0];
/// Difference of the law's parameters at which two minima are the same; standard deviations.
const SAME: f64 = 0.2;
/// Step of the search for another minimum; blocks of samples.
const ONSET_SHIFT: f64 = 1.5;
/// Steps of that search to either side.
const MOST_SHIFTS: usize = 4;
/// A minimum is another one if it is lower by this; units of χ².
const LOWER_BY: f64 = 1e-3;
/// Relative difference below which two costs show the same noise; 1.
const ALIKE: f64 = 0.01;
/// Free parameters that one fit can have.
pub(crate) const LARGEST_FREE: usize = 9;
/// Velocity, onset and displacement offset.
const NUISANCES: usize = 3;
const _: () = assert!(LARGEST_PARAMETERS + NUISANCES <= LARGEST_FREE);

/// What the minimiser found, without the law's type.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Values of the law's parameters; SI.
    pub law: Vec<f64>,
    /// Values of the free parameters, in their order; SI.
    pub free: Vec<f64>,
    /// Covariance of the free parameters; empty when it is singular or not wanted.
    pub covariance: Vec<Vec<f64>>,
    /// Inverse of half the second derivatives of the cost by the free parameters; empty when
    /// they are singular.
    pub inverse: Vec<Vec<f64>>,
    /// Half the gradient of the cost by the free parameters: zero but at bounds.
    pub gradient: Vec<f64>,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// Time of first touch; s.
    pub onset: f64,
    /// Displacement offset; m.
    pub offset: f64,
    /// Cost at the optimum.
    pub cost: f64,
    /// Evaluations of the model.
    pub evaluations: usize,
    /// Why the minimiser stopped.
    pub stop: Stop,
    /// −1, 0 or 1 for each free parameter: at its lower bound, at none, at its
    /// upper bound.
    pub at_bound: Vec<i8>,
    /// Residuals and derivatives.
    pub rows: Rows,
    /// Intervals other than estimate ± deviation, if requested.
    pub intervals: Option<FreeIntervals>,
}

/// Limits of the minimiser, and known uncertainties.
#[derive(Clone, Debug)]
pub(crate) struct Limits {
    /// Relative change of the cost at convergence.
    pub cost_tolerance: f64,
    /// Evaluations.
    pub max_evaluations: usize,
    /// Samples of all quantities.
    pub samples: usize,
    /// Standard uncertainty of each quantity's zero that the weights do not know;
    /// SI.
    pub offsets: [f64; QUANTITIES],
    /// Whether to end at the minimum for instantaneous samples.
    pub instants: bool,
    /// What is wanted beside the estimates.
    pub wanted: Wanted,
}

/// What is wanted of a solution beside its estimates.
#[derive(Clone, Debug)]
pub(crate) enum Wanted {
    /// Residuals, of which the noise is found; no covariance.
    Residuals,
    /// Their covariance too.
    Covariance,
    /// And other intervals than estimate ± deviation.
    Intervals(IntervalPlan),
}

/// Solves from each start in turn until one converges inside the bounds, and
/// returns the best; `None` when the model cannot be evaluated at any.
pub(crate) fn solve(
    law: &Law,
    samples: (Setting, &[SampleGroup]),
    free: &[FreeParameter],
    starts: &[Start],
    limits: &Limits,
) -> Option<Solution> {
    // The narrowest arrays that hold the free parameters; the field's usual
    // law and those of the user are compiled for themselves, the others share
    // their code.
    let lanes = free.iter().filter(|p| p.target.needs_lane()).count();
    match (law, free.len(), lanes) {
        (Law::KuwabaraKono(law), ..=2, _) => {
            best_of::<_, 2, 4, 2>(*law, samples, free, starts, limits)
        }
        (Law::KuwabaraKono(law), ..=5, ..=3) => {
            best_of::<_, 2, 4, 5>(*law, samples, free, starts, limits)
        }
        (Law::User(law), ..=5, ..=3) => {
            best_of::<_, LARGEST_PARAMETERS, 4, 5>(*law, samples, free, starts, limits)
        }
        (law, _, _) => {
            let law = AnyLaw(*law);
            best_of::<_, LARGEST_PARAMETERS, 8, LARGEST_FREE>(law, samples, free, starts, limits)
        }
    }
}

/// Where a fit begins: the law's parameters; velocity, mass, onset and offset.
pub(crate) type Start = (Vec<f64>, [f64; 4]);

/// [`Start`] in the arrays of an estimator.
pub(crate) fn values<const N: usize>((law, [velocity, mass, onset, offset]): &Start) -> Values<N> {
    let mut parameters = [0.0; N];
    parameters[..law.len()].copy_from_slice(law);
    Values {
        law: parameters,
        velocity: *velocity,
        inverse_mass: 1.0 / mass,
        onset: *onset,
        offset: *offset,
    }
}

fn best_of<L: BatchLaw<N>, const N: usize, const W: usize, const P: usize>(
    law: L,
    samples: (Setting, &[SampleGroup]),
    free: &[FreeParameter],
    starts: &[Start],
    limits: &Limits,
) -> Option<Solution> {
    let law_count = starts.first()?.0.len();
    let mut best: Option<(Estimator<L, N, W, P>, Minimum<P>)> = None;
    let mut evaluations = 0;
    for start in starts {
        let mut estimator =
            Estimator::<L, N, W, P>::new(law, samples.0, samples.1, free, values(start));
        let minimum = estimator.minimise(&options(free, limits));
        evaluations += minimum.evaluations;
        if minimum.stop == Stop::BadStart {
            continue;
        }
        let inside = minimum.at_bound.iter().all(|side| *side == 0);
        let good = minimum.stop == Stop::Converged && inside;
        if best
            .as_ref()
            .is_none_or(|(_, b)| minimum.equations.cost < b.equations.cost)
        {
            best = Some((estimator, minimum));
        }
        if good {
            break;
        }
    }
    let (estimator, minimum) = best?;
    let (minimum, spent) = past_cusp(&estimator, minimum, &options(free, limits));
    evaluations += spent;
    let (minimum, spent) = over_onsets(&estimator, minimum, &options(free, limits));
    evaluations += spent;
    let smooth = minimum;
    let seen = match (limits.instants, &limits.wanted) {
        (true, Wanted::Residuals) => residuals_alike(&estimator, &minimum),
        _ => None,
    };
    let (minimum, spent) = match limits.instants && seen.is_none() {
        true => polished(&estimator, minimum, &options(free, limits)),
        false => (minimum, 0),
    };
    evaluations += spent;
    let mut solution = complete(law_count, &estimator, &minimum, limits, seen)?;
    solution.evaluations += evaluations;
    if let Wanted::Intervals(plan) = &limits.wanted
        && minimum.stop == Stop::Converged
    {
        solution.intervals = intervals(&estimator, &smooth, plan, &options(free, limits));
    }
    Some(solution)
}

/// Intervals around the smooth minimum, which follows the data without the cusps
/// of instantaneous samples.
fn intervals<L: BatchLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    plan: &IntervalPlan,
    options: &Options<P>,
) -> Option<FreeIntervals> {
    let count = estimator.free().len();
    if plan.options.method == IntervalMethod::Asymptotic {
        return None;
    }
    let (equations, rows) = estimator.rows(&minimum.parameters)?;
    let minimum = Minimum {
        equations,
        ..*minimum
    };
    let covariance = equations.inverse(count)?;
    match plan.options.method {
        IntervalMethod::Asymptotic => None,
        IntervalMethod::Profile => Some(profile_intervals(
            estimator,
            &minimum,
            &covariance,
            plan.quantile,
            options,
        )),
        IntervalMethod::Bootstrap => bootstrap_intervals(estimator, &minimum, &rows, plan, options),
        IntervalMethod::Posterior => {
            let factor = cholesky::lower(&covariance)?;
            posterior_intervals(estimator, &minimum, &factor, plan)
        }
    }
}

/// A minimum next to a cusp at which the minimiser is stuck, from a part of a sampling
/// interval before and after it: one as low, or one at which the law is the same.
fn past_cusp<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: Minimum<P>,
    options: &Options<P>,
) -> (Minimum<P>, usize) {
    let free = estimator.free();
    let intervals = estimator.groups().iter().map(SampleGroup::interval);
    let interval = intervals
        .filter(|own| *own > 0.0)
        .fold(f64::INFINITY, f64::min);
    let onset = free.iter().position(|p| p.target == Target::Onset);
    let (Some(onset), Stop::Stuck, true) = (onset, minimum.stop, interval.is_finite()) else {
        return (minimum, 0);
    };
    let Coordinate::Linear(scale) = free[onset].coordinate else {
        return (minimum, 0);
    };
    let highest = minimum.equations.cost * (1.0 + options.roughness);
    let same_law = |other: &Minimum<P>| {
        let covariance = other.equations.inverse(free.len());
        covariance.is_some_and(|covariance| {
            free.iter().enumerate().all(|(i, own)| {
                let off = other.parameters[i] - minimum.parameters[i];
                !matches!(own.target, Target::Law(_)) || off.abs() <= SAME * covariance[i][i].sqrt()
            })
        })
    };
    let mut spent = 0;
    for shift in CUSP_SHIFTS {
        let mut start = minimum.parameters;
        start[onset] += shift * interval / scale;
        let other = estimator.clone().minimise_from(&start, options);
        spent += other.evaluations;
        let found = other.equations.cost <= highest || same_law(&other);
        if other.stop == Stop::Converged && found {
            return (other, spent);
        }
    }
    (minimum, spent)
}

/// The lowest of the minima that lie a block of samples before or after: where
/// noise is persistent the cost is wavy in the onset.
fn over_onsets<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: Minimum<P>,
    options: &Options<P>,
) -> (Minimum<P>, usize) {
    let free = estimator.free();
    let blocks = estimator.groups().iter().filter(|group| group.means);
    let interval = blocks.map(SampleGroup::interval).fold(0.0, f64::max);
    let onset = free.iter().position(|p| p.target == Target::Onset);
    let (Some(onset), true) = (onset, interval > 0.0) else {
        return (minimum, 0);
    };
    let Coordinate::Linear(scale) = free[onset].coordinate else {
        return (minimum, 0);
    };
    let (mut best, mut spent) = (minimum, 0);
    for side in [-1.0, 1.0] {
        for _ in 0..MOST_SHIFTS {
            let mut start = best.parameters;
            start[onset] += side * ONSET_SHIFT * interval / scale;
            let other = estimator.clone().minimise_from(&start, options);
            spent += other.evaluations;
            let usable = matches!(other.stop, Stop::Converged | Stop::Stuck);
            if !(usable && other.equations.cost < best.equations.cost - LOWER_BY) {
                break;
            }
            best = other;
        }
    }
    (best, spent)
}

/// The minimum for instantaneous samples nearest to that for averaged ones: the
/// averaging only made the way there smooth. Where a cusp is in the way, or where
/// averages describe the samples better, the smooth minimum stays.
fn polished<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: Minimum<P>,
    options: &Options<P>,
) -> (Minimum<P>, usize) {
    if !may_be_polished(estimator, &minimum) {
        return (minimum, 0);
    }
    let exact = estimator
        .with_sampling(Sampling::Instantaneous)
        .minimise_from(&minimum.parameters, options);
    let good = exact.stop == Stop::Converged
        && exact.at_bound == minimum.at_bound
        && exact.equations.cost <= minimum.equations.cost;
    let spent = exact.evaluations;
    (if good { exact } else { minimum }, spent)
}

fn may_be_polished<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
) -> bool {
    let means = estimator.groups().iter().any(|group| group.means);
    minimum.stop == Stop::Converged && estimator.averages() && !means
}

/// Residuals of instantaneous samples at the minimum for averaged ones; `None` unless both have
/// the same cost to 1 % and so show the same noise.
fn residuals_alike<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
) -> Option<(NormalEquations<P>, Rows)> {
    let exact = estimator.with_sampling(Sampling::Instantaneous);
    let seen = may_be_polished(estimator, minimum)
        .then(|| exact.residuals(&minimum.parameters))
        .flatten()?;
    let apart = seen.0.cost - minimum.equations.cost;
    (apart.abs() < ALIKE * minimum.equations.cost).then_some(seen)
}

fn options<const P: usize>(free: &[FreeParameter], limits: &Limits) -> Options<P> {
    let mut largest_step = [f64::INFINITY; P];
    for (step, parameter) in largest_step.iter_mut().zip(free) {
        *step = match parameter.coordinate {
            Coordinate::Logarithm => LONGEST_STEP.0,
            Coordinate::Linear(_) => LONGEST_STEP.1,
        };
    }
    Options {
        cost_tolerance: limits.cost_tolerance,
        max_evaluations: limits.max_evaluations,
        roughness: ROUGHNESS / limits.samples as f64,
        largest_step,
        foresight: FORESIGHT,
        ..Options::default()
    }
}

fn complete<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    law_count: usize,
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    limits: &Limits,
    seen: Option<(NormalEquations<P>, Rows)>,
) -> Option<Solution> {
    let (equations, rows) = seen.or_else(|| match limits.wanted {
        Wanted::Residuals => estimator.residuals(&minimum.parameters),
        Wanted::Covariance | Wanted::Intervals(_) => estimator.rows(&minimum.parameters),
    })?;
    let values = estimator.values(&minimum.parameters);
    let free = estimator.free();
    let at: Vec<f64> = free.iter().map(|p| values.get(p.target)).collect();
    let slope = |i: usize| free[i].coordinate.slope(at[i]);
    let count = free.len();
    let in_si = |matrix: Option<[[f64; P]; P]>| -> Vec<Vec<f64>> {
        let row = |c: &[[f64; P]; P], i: usize| -> Vec<f64> {
            (0..count).map(|j| c[i][j] * slope(i) * slope(j)).collect()
        };
        matrix.map_or(vec![], |c| (0..count).map(|i| row(&c, i)).collect())
    };
    let covariance = match limits.wanted {
        Wanted::Residuals => None,
        Wanted::Covariance | Wanted::Intervals(_) => {
            let mut priors = NormalEquations::ZERO;
            estimator.add_priors(&minimum.parameters, 1, &mut priors);
            let samples = (&rows, estimator.groups());
            covariance(&equations, samples, &limits.offsets, &priors, count)
        }
    };
    Some(Solution {
        law: values.law[..law_count].to_vec(),
        inverse: in_si(equations.inverse(count)),
        gradient: (0..count)
            .map(|i| equations.gradient[i] / slope(i))
            .collect(),
        covariance: in_si(covariance),
        free: at.clone(),
        velocity: values.velocity,
        onset: values.onset,
        offset: values.offset,
        // Of the samples as they were taken in the end, not of the averages that
        // the covariance is made with.
        cost: minimum.equations.cost,
        evaluations: 1,
        stop: minimum.stop,
        at_bound: minimum.at_bound[..count].to_vec(),
        rows,
        intervals: None,
    })
}
