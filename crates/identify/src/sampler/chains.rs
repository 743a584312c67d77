//! Chains of the no-U-turn sampler of `nuts-rs`.

use crate::sampler::density::{Drawing, LogDensity};
use nuts_rs::rand::SeedableRng;
use nuts_rs::rand::rngs::StdRng;
use nuts_rs::{
    Chain, CpuLogpFunc, CpuMath, CpuMathError, DiagNutsSettings, HasDims, LogpError, Settings,
};
use std::collections::HashMap;

/// Draws before the kept ones that tune a chain: as many as are kept, at most these.
const MOST_TUNING: usize = 500;
/// Coordinates of a start near the middle.
const NEAR_ZERO: f64 = 1e-3;

/// Runs the chains, chain c from `start(c)` or else from close to zero (at zero itself
/// a slope may be exactly zero, which the sampler refuses). `keep` takes each
/// draw, chain by chain. Returns how many diverged; `None` where a chain cannot be
/// started.
///
/// # Source
/// Hoffman and Gelman (2014), J. Machine Learning Research 15:1593.
pub(crate) fn draw_chains(
    density: &dyn LogDensity,
    drawing: &Drawing,
    start: &dyn Fn(usize) -> Vec<f64>,
    keep: &mut dyn FnMut(&[f64]),
) -> Option<usize> {
    let tuning = drawing.draws.min(MOST_TUNING);
    let settings = DiagNutsSettings {
        num_tune: tuning as u64,
        num_draws: drawing.draws as u64,
        num_chains: drawing.chains,
        seed: drawing.seed,
        ..DiagNutsSettings::default()
    };
    let mut divergences = 0;
    for chain in 0..drawing.chains {
        let seed = drawing.seed ^ (chain as u64 + 1).rotate_left(32);
        let mut generator = StdRng::seed_from_u64(seed);
        let math = CpuMath::new(Sampled(density));
        let mut sampler = settings
            .new_chain(chain as u64, math, &mut generator)
            .ok()?;
        sampler
            .set_position(&start(chain))
            .or_else(|_| sampler.set_position(&vec![NEAR_ZERO; density.size()]))
            .ok()?;
        let each = tuning + drawing.draws;
        for step in 0..each {
            let (z, progress) = sampler.draw().ok()?;
            density.drawn(chain * each + step + 1, drawing.chains * each);
            if step >= tuning {
                divergences += usize::from(progress.diverging);
                keep(&z);
            }
        }
    }
    Some(divergences)
}

/// A density as the sampler wants it.
struct Sampled<'a>(&'a dyn LogDensity);

/// A point without a density.
#[derive(Debug, thiserror::Error)]
#[error("the model cannot be evaluated here")]
struct Outside;

impl LogpError for Outside {
    fn is_recoverable(&self) -> bool {
        true
    }
}

impl HasDims for Sampled<'_> {
    fn dim_sizes(&self) -> HashMap<String, u64> {
        HashMap::from([("unconstrained_parameter".to_owned(), self.0.size() as u64)])
    }
}

impl CpuLogpFunc for Sampled<'_> {
    type LogpError = Outside;
    type FlowParameters = ();
    type ExpandedVector = Vec<f64>;

    fn dim(&self) -> usize {
        self.0.size()
    }

    fn logp(&mut self, z: &[f64], gradient: &mut [f64]) -> Result<f64, Outside> {
        let found = self.0.evaluate(z, gradient).ok_or(Outside)?;
        let finite = found.is_finite() && gradient.iter().all(|g| g.is_finite());
        if finite { Ok(found) } else { Err(Outside) }
    }

    fn expand_vector<R>(&mut self, _: &mut R, z: &[f64]) -> Result<Vec<f64>, CpuMathError>
    where
        R: nuts_rs::rand::Rng + ?Sized,
    {
        Ok(z.to_vec())
    }
}
