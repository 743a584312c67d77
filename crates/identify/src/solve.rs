//! From free parameters to estimates with covariance: the part of a fit that
//! knows the law's concrete type.

use crate::estimator::{Coordinate, Estimator, FreeParameter, Setting, Values};
use crate::residual::{Rows, SampleGroup};
use crate::uncertainty::covariance;
use windfall_contact::law::ContactLaw;
use windfall_numerics::least_squares::{Minimum, Options, Stop};

/// Longest step of a logarithmic and of a linear coordinate.
const LONGEST_STEP: (f64, f64) = (2.0, 0.5);
/// Free parameters that one fit can have.
pub(crate) const LARGEST_FREE: usize = 8;

/// What the minimiser found, without the law's type.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Values of the law's parameters; SI.
    pub law: Vec<f64>,
    /// Values of the free parameters, in their order; SI.
    pub free: Vec<f64>,
    /// Covariance of the free parameters; empty when it is singular.
    pub covariance: Vec<Vec<f64>>,
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
}

/// Limits of the minimiser.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Relative change of the cost at convergence.
    pub cost_tolerance: f64,
    /// Evaluations.
    pub max_evaluations: usize,
}

/// Solves from each start in turn until one converges inside the bounds, and
/// returns the best; `None` when the model cannot be evaluated at any.
///
/// `law` only carries its type.
pub(crate) fn solve<L, const N: usize>(
    _law: L,
    setting: &Setting,
    free: &[FreeParameter],
    starts: &[(Vec<f64>, [f64; 4])],
    limits: &Limits,
) -> Option<Solution>
where
    L: ContactLaw<N> + From<[f64; N]>,
{
    let starts: Vec<Values<N>> = starts
        .iter()
        .filter_map(|(law, [velocity, mass, onset, offset])| {
            Some(Values {
                law: law.as_slice().try_into().ok()?,
                velocity: *velocity,
                inverse_mass: 1.0 / mass,
                onset: *onset,
                offset: *offset,
            })
        })
        .collect();
    // The narrowest arrays that hold the free parameters.
    let lanes = free.iter().filter(|p| p.target.needs_lane()).count();
    match (free.len(), lanes) {
        (..=2, _) => best_of::<L, N, 4, 2>(setting, free, &starts, limits),
        (..=4, ..=3) => best_of::<L, N, 4, 4>(setting, free, &starts, limits),
        (..=5, ..=3) => best_of::<L, N, 4, 5>(setting, free, &starts, limits),
        _ => best_of::<L, N, 8, LARGEST_FREE>(setting, free, &starts, limits),
    }
}

fn best_of<L, const N: usize, const W: usize, const P: usize>(
    setting: &Setting,
    free: &[FreeParameter],
    starts: &[Values<N>],
    limits: &Limits,
) -> Option<Solution>
where
    L: ContactLaw<N> + From<[f64; N]>,
{
    let mut best: Option<(Estimator<L, N, W, P>, Minimum<P>)> = None;
    let mut evaluations = 0;
    for start in starts {
        let mut estimator = Estimator::<L, N, W, P>::new(*setting, free, *start);
        let minimum = estimator.minimise(&options(free, limits));
        evaluations += minimum.evaluations;
        if minimum.stop == Stop::BadStart {
            continue;
        }
        let inside = minimum.at_bound.iter().all(|side| *side == 0);
        let good = minimum.stop == Stop::Converged && inside;
        if best.as_ref().is_none_or(|(_, b)| better(&minimum, b)) {
            best = Some((estimator, minimum));
        }
        if good {
            break;
        }
    }
    let (estimator, minimum) = best?;
    complete(&estimator, &minimum, setting.groups, free, evaluations)
}

fn better<const P: usize>(one: &Minimum<P>, other: &Minimum<P>) -> bool {
    one.equations.cost < other.equations.cost
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
        largest_step,
        ..Options::default()
    }
}

fn complete<L, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    groups: &[SampleGroup],
    free: &[FreeParameter],
    evaluations: usize,
) -> Option<Solution>
where
    L: ContactLaw<N> + From<[f64; N]>,
{
    let (equations, rows) = estimator.rows(&minimum.parameters)?;
    let values = estimator.values(&minimum.parameters);
    let at: Vec<f64> = free.iter().map(|p| values.get(p.target)).collect();
    let slope = |i: usize| free[i].coordinate.slope(at[i]);
    let count = free.len();
    let covariance = covariance(&equations, &rows, groups, count).map_or(vec![], |c| {
        (0..count)
            .map(|i| (0..count).map(|j| c[i][j] * slope(i) * slope(j)).collect())
            .collect()
    });
    Some(Solution {
        law: values.law.to_vec(),
        free: at,
        covariance,
        velocity: values.velocity,
        onset: values.onset,
        offset: values.offset,
        cost: equations.cost,
        evaluations: evaluations + 1,
        stop: minimum.stop,
        at_bound: minimum.at_bound[..count].to_vec(),
        rows,
    })
}
