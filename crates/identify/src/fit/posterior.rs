//! Posterior distribution of one impact's parameters, by the no-U-turn sampler.

use crate::fit::estimator::{Coordinate, Estimator, FreeLaw};
use crate::fit::interval::{
    FreeIntervals, IntervalDetail, IntervalPlan, Posterior, deviation, quantile,
};
use crate::fit::search::Share;
use crate::sampler::chain_diagnostics::{ChainDiagnostics, chain_diagnostics};
use crate::sampler::{Drawing, LogDensity, draw_chains};
use windfall_numerics::least_squares::Minimum;

/// Chains start this many standard deviations around the estimate.
const START_SPREAD: f64 = 1.0;

/// The density in coordinates in which the posterior is nearly a standard
/// normal distribution: u = û + L z, L Lᵀ the covariance.
struct Density<'a, 'b, L, const N: usize, const W: usize, const P: usize> {
    estimator: &'a Estimator<'b, L, N, W, P>,
    minimum: &'a Minimum<P>,
    factor: &'a [[f64; P]; P],
    count: usize,
}

impl<L, const N: usize, const W: usize, const P: usize> Density<'_, '_, L, N, W, P> {
    fn coordinates(&self, z: &[f64]) -> [f64; P] {
        let mut u = self.minimum.parameters;
        for i in 0..self.count {
            for j in 0..=i {
                u[i] += self.factor[i][j] * z[j];
            }
        }
        u
    }
}

impl<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize> LogDensity
    for Density<'_, '_, L, N, W, P>
{
    fn size(&self) -> usize {
        self.count
    }

    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64> {
        let u = self.coordinates(z);
        let bounds = self.estimator.bounds();
        let inside = (0..self.count).all(|i| u[i] >= bounds.lower[i] && u[i] <= bounds.upper[i]);
        if !inside {
            return None;
        }
        let share = Share::all(self.estimator.groups());
        let found = self.estimator.evaluate_share(&u, &share)?.equations;
        let mut density = -0.5 * (found.cost - self.minimum.equations.cost);
        // The normal equations hold half the gradient of the cost.
        let mut slope = found.gradient.map(|g| -g);
        for (i, parameter) in self.estimator.free().iter().enumerate() {
            // A prior is one of the value, and chains move in its logarithm.
            if parameter.prior.is_some() && parameter.coordinate == Coordinate::Logarithm {
                density += u[i];
                slope[i] += 1.0;
            }
        }
        for (j, out) in gradient.iter_mut().enumerate() {
            *out = (j..self.count).map(|i| self.factor[i][j] * slope[i]).sum();
        }
        Some(density)
    }
}

/// Intervals between quantiles of the posterior.
///
/// * `minimum`: the estimate, around which the chains start
/// * `factor`: lower factor of the covariance of the coordinates
///
/// `None` when no chain can be started.
pub(crate) fn posterior_intervals<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    factor: &[[f64; P]; P],
    plan: &IntervalPlan,
) -> Option<FreeIntervals> {
    let count = estimator.free().len();
    let density = Density {
        estimator,
        minimum,
        factor,
        count,
    };
    let drawing = plan.options.drawing();
    let Drawing { chains, draws, .. } = drawing;
    let start = |chain: usize| {
        let sign = if chain.is_multiple_of(2) { 1.0 } else { -1.0 };
        let at = |i: usize| match i % chains.max(1) == chain / 2 {
            true => sign * START_SPREAD,
            false => 0.0,
        };
        (0..count).map(at).collect()
    };
    let mut drawn = vec![Vec::with_capacity(chains * draws); count];
    let divergences = draw_chains(&density, &drawing, &start, &mut |z| {
        let u = density.coordinates(z);
        for (i, parameter) in estimator.free().iter().enumerate() {
            drawn[i].push(parameter.coordinate.value(u[i]));
        }
    })?;
    Some(summarised(drawn, divergences, plan))
}

fn summarised(draws: Vec<Vec<f64>>, divergences: usize, plan: &IntervalPlan) -> FreeIntervals {
    let tail = 0.5 * (1.0 - plan.confidence);
    let ends = |level: f64| {
        draws
            .iter()
            .map(|d| quantile(&mut d.clone(), level))
            .collect()
    };
    let mixing = draws.iter().map(|d| mixing(d, plan.options.draws));
    FreeIntervals {
        low: ends(tail),
        high: ends(1.0 - tail),
        sd: Some(draws.iter().map(|d| deviation(d)).collect()),
        detail: IntervalDetail::Posterior(Posterior {
            chains: plan.options.chains,
            divergences,
            mixing: mixing.collect(),
            draws,
        }),
    }
}

/// How well chains of `draws` each, one after the other, mix.
pub(crate) fn mixing(all: &[f64], draws: usize) -> ChainDiagnostics {
    let chains: Vec<&[f64]> = all.chunks_exact(draws.max(1)).collect();
    chain_diagnostics(&chains).unwrap_or(ChainDiagnostics {
        r_hat: f64::INFINITY,
        bulk_draws: 0.0,
        tail_draws: 0.0,
    })
}
