//! Posterior distribution of one impact's parameters, by the no-U-turn sampler.

use crate::estimator::{Estimator, FreeLaw};
use crate::interval::{FreeIntervals, IntervalDetail, Mixing, Posterior, deviation, quantile};
use crate::residual::evaluate;
use nuts_rs::rand::SeedableRng;
use nuts_rs::rand::rngs::StdRng;
use nuts_rs::{
    Chain, CpuLogpFunc, CpuMath, CpuMathError, DiagNutsSettings, HasDims, LogpError, Settings,
};
use std::collections::HashMap;
use windfall_numerics::least_squares::Minimum;
use windfall_statistics::chain_diagnostics::chain_diagnostics;

/// Draws for tuning, at most.
const MOST_TUNING: usize = 500;
/// Chains start this many standard deviations around the estimate.
const START_SPREAD: f64 = 1.0;

/// What a posterior is made with.
pub(crate) struct PosteriorPlan<'a> {
    pub chains: usize,
    pub draws: usize,
    pub seed: u64,
    pub confidence: f64,
    /// Normal priors of the coordinates: mean and standard deviation; flat where
    /// there is none.
    pub priors: &'a [Option<(f64, f64)>],
}

/// The density in coordinates in which the posterior is nearly a standard
/// normal distribution: u = û + L z, L Lᵀ the covariance.
struct Density<'a, 'b, L, const N: usize, const W: usize, const P: usize> {
    estimator: &'a Estimator<'b, L, N, W, P>,
    minimum: &'a Minimum<P>,
    factor: &'a [[f64; P]; P],
    priors: &'a [Option<(f64, f64)>],
    count: usize,
}

/// A point outside the bounds, or where the model cannot be evaluated.
#[derive(Debug, thiserror::Error)]
#[error("the model cannot be evaluated here")]
struct Outside;

impl LogpError for Outside {
    fn is_recoverable(&self) -> bool {
        true
    }
}

impl<L, const N: usize, const W: usize, const P: usize> HasDims for Density<'_, '_, L, N, W, P> {
    fn dim_sizes(&self) -> HashMap<String, u64> {
        HashMap::from([("unconstrained_parameter".to_owned(), self.count as u64)])
    }
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

impl<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize> CpuLogpFunc
    for Density<'_, '_, L, N, W, P>
{
    type LogpError = Outside;
    type FlowParameters = ();
    type ExpandedVector = Vec<f64>;

    fn dim(&self) -> usize {
        self.count
    }

    fn logp(&mut self, z: &[f64], gradient: &mut [f64]) -> Result<f64, Outside> {
        let u = self.coordinates(z);
        let bounds = self.estimator.bounds();
        let inside = (0..self.count).all(|i| u[i] >= bounds.lower[i] && u[i] <= bounds.upper[i]);
        if !inside {
            return Err(Outside);
        }
        let model = self.estimator.model(&u);
        let found = evaluate(&model, self.estimator.groups(), None).map_err(|_| Outside)?;
        let mut density = -0.5 * (found.cost - self.minimum.equations.cost);
        // The normal equations hold half the gradient of the cost.
        let mut slope = found.gradient.map(|g| -g);
        for (i, prior) in self.priors.iter().enumerate() {
            if let Some((mean, sd)) = prior {
                density -= 0.5 * ((u[i] - mean) / sd).powi(2);
                slope[i] -= (u[i] - mean) / (sd * sd);
            }
        }
        for (j, out) in gradient.iter_mut().enumerate() {
            *out = (j..self.count).map(|i| self.factor[i][j] * slope[i]).sum();
        }
        if density.is_finite() {
            Ok(density)
        } else {
            Err(Outside)
        }
    }

    fn expand_vector<R>(&mut self, _: &mut R, z: &[f64]) -> Result<Vec<f64>, CpuMathError>
    where
        R: nuts_rs::rand::Rng + ?Sized,
    {
        Ok(z.to_vec())
    }
}

/// Intervals between quantiles of the posterior.
///
/// * `minimum`: the estimate, around which the chains start
/// * `factor`: lower factor of the covariance of the coordinates
///
/// `None` when no chain can be started.
///
/// # Source
/// Hoffman and Gelman (2014), J. Machine Learning Research 15:1593.
pub(crate) fn posterior_intervals<L, const N: usize, const W: usize, const P: usize>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    factor: &[[f64; P]; P],
    plan: &PosteriorPlan,
) -> Option<FreeIntervals>
where
    L: FreeLaw<N>,
{
    let count = estimator.free().len();
    let tuning = plan.draws.min(MOST_TUNING);
    let settings = DiagNutsSettings {
        num_tune: tuning as u64,
        num_draws: plan.draws as u64,
        num_chains: plan.chains,
        seed: plan.seed,
        ..DiagNutsSettings::default()
    };
    let mut draws = vec![Vec::with_capacity(plan.chains * plan.draws); count];
    let mut divergences = 0;
    for chain in 0..plan.chains {
        let density = Density {
            estimator,
            minimum,
            factor,
            priors: plan.priors,
            count,
        };
        let place = density.coordinates(&vec![0.0; count]);
        debug_assert_eq!(place, minimum.parameters);
        let mut generator = StdRng::seed_from_u64(plan.seed ^ (chain as u64 + 1).rotate_left(32));
        let mut sampler = settings
            .new_chain(chain as u64, CpuMath::new(density), &mut generator)
            .ok()?;
        let sign = if chain % 2 == 0 { 1.0 } else { -1.0 };
        let start: Vec<f64> = (0..count)
            .map(|i| {
                if i % plan.chains.max(1) == chain / 2 {
                    sign * START_SPREAD
                } else {
                    0.0
                }
            })
            .collect();
        sampler
            .set_position(&start)
            .or_else(|_| sampler.set_position(&vec![0.0; count]))
            .ok()?;
        for step in 0..tuning + plan.draws {
            let (z, progress) = sampler.draw().ok()?;
            if step < tuning {
                continue;
            }
            divergences += usize::from(progress.diverging);
            for i in 0..count {
                let mut u = minimum.parameters[i];
                for j in 0..=i {
                    u += factor[i][j] * z[j];
                }
                draws[i].push(estimator.free()[i].coordinate.value(u));
            }
        }
    }
    Some(summarised(draws, divergences, plan))
}

fn summarised(draws: Vec<Vec<f64>>, divergences: usize, plan: &PosteriorPlan) -> FreeIntervals {
    let tail = 0.5 * (1.0 - plan.confidence);
    let ends = |level: f64| {
        draws
            .iter()
            .map(|d| quantile(&mut d.clone(), level))
            .collect()
    };
    let mixing = draws.iter().map(|d| {
        let chains: Vec<&[f64]> = d.chunks_exact(plan.draws.max(1)).collect();
        match chain_diagnostics(&chains) {
            Some(found) => Mixing {
                r_hat: found.r_hat,
                bulk_draws: found.bulk_draws,
                tail_draws: found.tail_draws,
            },
            None => Mixing {
                r_hat: f64::INFINITY,
                bulk_draws: 0.0,
                tail_draws: 0.0,
            },
        }
    });
    FreeIntervals {
        low: ends(tail),
        high: ends(1.0 - tail),
        sd: Some(draws.iter().map(|d| deviation(d)).collect()),
        detail: IntervalDetail::Posterior(Posterior {
            chains: plan.chains,
            divergences,
            mixing: mixing.collect(),
            draws,
        }),
    }
}
