//! Chains of draws from a density, each tuned before its draws are kept.

use crate::sampler::density::{LogDensity, Point};
use crate::sampler::no_u_turn::Chain;
use crate::sampler::tuning::Tuning;
use windfall_signal::noise::gaussian::noise_source;

/// How much of a posterior is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drawing {
    /// Chains.
    pub chains: usize,
    /// Kept draws of each.
    pub draws: usize,
    /// Seed of all of them.
    pub seed: u64,
}

/// Draws before the kept ones that tune a chain: as many as are kept, at most these.
const MOST_TUNING: usize = 500;
/// Coordinates of a start near the middle.
const NEAR_ZERO: f64 = 1e-3;

/// Runs the chains, chain c from `start(c)` or else from close to zero. `keep` takes
/// each draw, chain by chain. Returns how many diverged; `None` where a chain cannot
/// be started.
pub(crate) fn draw_chains(
    density: &dyn LogDensity,
    drawing: &Drawing,
    start: &dyn Fn(usize) -> Vec<f64>,
    keep: &mut dyn FnMut(&[f64]),
) -> Option<usize> {
    let tuning_draws = drawing.draws.min(MOST_TUNING);
    let each = tuning_draws + drawing.draws;
    let mut divergences = 0;
    for number in 0..drawing.chains {
        let point = Point::new(density, start(number))
            .or_else(|| Point::new(density, vec![NEAR_ZERO; density.size()]))?;
        let source = noise_source(drawing.seed, number as u64);
        let mut chain = Chain::new(density, point, source);
        let mut tuning = Tuning::new(&mut chain, tuning_draws);
        for step in 0..each {
            let drawn = chain.draw();
            density.drawn(number * each + step + 1, drawing.chains * each);
            if step < tuning_draws {
                tuning.learn(&mut chain, drawn.acceptance);
            } else {
                divergences += usize::from(drawn.diverged);
                keep(chain.position());
            }
        }
    }
    Some(divergences)
}
