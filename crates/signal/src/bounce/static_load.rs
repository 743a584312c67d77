//! The level that a force has while nothing touches.

use crate::noise::estimate::{baseline, combined_noise, median, quantum};
use crate::trigger::scale::white_noise;
use crate::uncertain::Uncertain;

/// Part of the recording of which the level is first guessed; 1.
const PILOT_SHARE: f64 = 0.01;
/// … of at least this many samples.
const PILOT_SAMPLES: usize = 8;
/// The first contact is sought above this many standard deviations; 1.
const PILOT_LEVEL: f64 = 8.0;
/// … and this part of the largest departure; 1.
const PILOT_HEIGHT: f64 = 0.02;
/// Fewest samples before the first contact that make a level.
pub const LEAST_SAMPLES: usize = 10;
/// Left out before the first contact, as a part of what is before it; 1.
const GUARD: f64 = 0.1;
/// Blocks of which the level's own scatter is taken.
const LEVEL_BLOCKS: usize = 8;
/// Blocks that scatter by more than this many standard deviations are not quiet; 1.
const QUIET: f64 = 1.6;

/// What a force does before the first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    /// Its level; unit of the force. `sd`: that of a mean over it.
    pub level: Uncertain,
    /// Standard deviation of the noise of one sample.
    pub noise: f64,
    /// Samples before the first contact; below [`LEAST_SAMPLES`] the recording
    /// begins in contact and the level comes from quiet stretches elsewhere.
    pub samples: usize,
    /// Largest departure from the level, of either sign.
    pub largest: f64,
    /// True if the first large departure is negative.
    pub reversed: bool,
}

/// Level and noise before the first contact.
pub fn before_contact(values: &[f64]) -> Before {
    let step = quantum(values);
    let pilot_samples = ((PILOT_SHARE * values.len() as f64) as usize).max(PILOT_SAMPLES);
    let pilot = median(&values[..pilot_samples.min(values.len())]).unwrap_or(0.0);
    let largest = values
        .iter()
        .fold(0.0, |a: f64, v| a.max((v - pilot).abs()));
    let rough = combined_noise(Some(white_noise(values)), step, largest).deviation;
    let threshold = (PILOT_LEVEL * rough).max(PILOT_HEIGHT * largest);
    let first = values
        .iter()
        .position(|v| (v - pilot).abs() > threshold)
        .unwrap_or(values.len());
    let samples = first - (GUARD * first as f64).ceil() as usize;
    let quiet = &values[..samples];
    let (level, scatter) = match baseline(quiet) {
        Some(found) if samples >= LEAST_SAMPLES => found,
        _ => (median(values).unwrap_or(pilot), rough),
    };
    let noise = combined_noise(Some(scatter.max(rough)), step, largest).deviation;
    let largest = values
        .iter()
        .fold(0.0, |a: f64, v| a.max((v - level).abs()));
    let reversed = values
        .iter()
        .find(|v| (**v - level).abs() > 0.3 * largest)
        .is_some_and(|v| *v < level);
    Before {
        level: Uncertain::new(level, mean_sd(quiet, noise)),
        noise,
        samples,
        largest,
        reversed,
    }
}

/// Standard deviation of a mean: the larger of those from samples and from block means.
fn mean_sd(values: &[f64], noise: f64) -> f64 {
    let n = values.len();
    if n < LEAST_SAMPLES {
        return noise;
    }
    let white = noise / (n as f64).sqrt();
    if n < 4 * LEVEL_BLOCKS {
        return white;
    }
    let means: Vec<f64> = values
        .chunks_exact(n / LEVEL_BLOCKS)
        .map(|block| block.iter().sum::<f64>() / block.len() as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let square: f64 = means.iter().map(|m| (m - mean).powi(2)).sum();
    let blocks = (square / (means.len() - 1) as f64 / means.len() as f64).sqrt();
    white.max(blocks)
}

/// A quiet stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuietBlock {
    /// Sample in its middle.
    pub middle: f64,
    /// Its mean; unit of the force.
    pub mean: f64,
    /// Samples.
    pub samples: usize,
}

/// Blocks of a force that do not move beyond noise.
///
/// * `noise`: standard deviation of a sample
/// * `block`: samples of a block; no shorter than the top of a pulse
pub fn quiet_blocks(values: &[f64], noise: f64, block: usize) -> Vec<QuietBlock> {
    let half = (block / 2).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    values
        .chunks_exact(block)
        .enumerate()
        .filter_map(|(index, part)| {
            let centre = mean(part);
            let square: f64 = part.iter().map(|v| (v - centre).powi(2)).sum();
            let scatter = (square / (block - 1).max(1) as f64).sqrt();
            let moves = (mean(&part[..half]) - mean(&part[block - half..])).abs();
            let quiet = scatter <= QUIET * noise
                && moves <= 5.0 * noise * (2.0 / half as f64).sqrt() + 0.2 * noise;
            quiet.then_some(QuietBlock {
                middle: index as f64 * block as f64 + 0.5 * (block - 1) as f64,
                mean: centre,
                samples: block,
            })
        })
        .collect()
}

/// Level of every sample by straight lines from quiet block to quiet block.
pub fn followed_level(blocks: &[QuietBlock], samples: usize, otherwise: f64) -> Vec<f64> {
    let mut next = 0;
    (0..samples)
        .map(|i| {
            let at = i as f64;
            while next < blocks.len() && blocks[next].middle < at {
                next += 1;
            }
            match (next.checked_sub(1).map(|b| blocks[b]), blocks.get(next)) {
                (Some(a), Some(b)) => {
                    let share = (at - a.middle) / (b.middle - a.middle);
                    a.mean + share * (b.mean - a.mean)
                }
                (Some(a), None) => a.mean,
                (None, Some(b)) => b.mean,
                (None, None) => otherwise,
            }
        })
        .collect()
}

/// Whether the level of quiet blocks moves enough to matter to thresholds.
pub fn moves(blocks: &[QuietBlock], noise: f64) -> bool {
    let means: Vec<f64> = blocks.iter().map(|b| b.mean).collect();
    let Some(centre) = median(&means) else {
        return false;
    };
    let far = |b: &&QuietBlock| {
        (b.mean - centre).abs() > 4.0 * noise / (b.samples as f64).sqrt() + 0.3 * noise
    };
    blocks.iter().filter(far).count() * 10 > blocks.len()
}
