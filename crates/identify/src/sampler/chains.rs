//! Chains of the no-U-turn sampler of `nuts-rs`.

use crate::sampler::density::{Drawing, LogDensity};
use nuts_rs::{Chain, CpuLogpFunc, LogpError, SampleStats, SamplerArgs, new_sampler};
use rand_chacha_sampler::ChaCha12Rng;
use rand_chacha_sampler::rand_core::SeedableRng;

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
    let settings = SamplerArgs {
        num_tune: tuning as u64,
        num_draws: drawing.draws as u64,
        ..SamplerArgs::default()
    };
    let mut divergences = 0;
    for chain in 0..drawing.chains {
        let seed = drawing.seed ^ (chain as u64 + 1).rotate_left(32);
        let mut generator = ChaCha12Rng::seed_from_u64(seed);
        let mut sampler = new_sampler(Sampled(density), settings, chain as u64, &mut generator);
        sampler
            .set_position(&start(chain))
            .or_else(|_| sampler.set_position(&vec![NEAR_ZERO; density.size()]))
            .ok()?;
        let each = tuning + drawing.draws;
        for step in 0..each {
            let (z, progress) = sampler.draw().ok()?;
            density.drawn(chain * each + step + 1, drawing.chains * each);
            if step >= tuning {
                divergences += usize::from(progress.divergence_info().is_some());
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

impl CpuLogpFunc for Sampled<'_> {
    type Err = Outside;

    fn dim(&self) -> usize {
        self.0.size()
    }

    fn logp(&mut self, z: &[f64], gradient: &mut [f64]) -> Result<f64, Outside> {
        let found = self.0.evaluate(z, gradient).ok_or(Outside)?;
        let finite = found.is_finite() && gradient.iter().all(|g| g.is_finite());
        if finite { Ok(found) } else { Err(Outside) }
    }
}
