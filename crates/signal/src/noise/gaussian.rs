//! White Gaussian noise with a stream that is fixed by its seed.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Source of uniform and standard normal numbers.
#[derive(Clone, Debug)]
pub struct NoiseSource {
    generator: ChaCha8Rng,
    spare: Option<f64>,
}

/// A source for a seed; different `stream`s of one seed are independent.
pub fn noise_source(seed: u64, stream: u64) -> NoiseSource {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    NoiseSource {
        generator,
        spare: None,
    }
}

/// Uniform number in [0, 1) with 53 random bits.
pub fn uniform(source: &mut NoiseSource) -> f64 {
    const STEP: f64 = 1.0 / (1u64 << 53) as f64;
    (source.generator.next_u64() >> 11) as f64 * STEP
}

/// Standard normal number.
///
/// # Source
/// Box and Muller (1958), Ann. Math. Statist. 29, 610.
pub fn normal(source: &mut NoiseSource) -> f64 {
    if let Some(spare) = source.spare.take() {
        return spare;
    }
    // 1 − u is never zero.
    let radius = (-2.0 * (1.0 - uniform(source)).ln()).sqrt();
    let angle = std::f64::consts::TAU * uniform(source);
    source.spare = Some(radius * angle.sin());
    radius * angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_moments_of_the_normal_distribution() {
        let mut source = noise_source(1, 0);
        let n = 200_000;
        let values: Vec<f64> = (0..n).map(|_| normal(&mut source)).collect();
        let moment = |power| values.iter().map(|v: &f64| v.powi(power)).sum::<f64>() / f64::from(n);
        // Mean 0, variance 1, fourth moment 3; standard errors 1/√n, √2/√n, √96/√n.
        let error = 1.0 / f64::from(n).sqrt();
        assert!(moment(1).abs() < 4.0 * error);
        assert!((moment(2) - 1.0).abs() < 4.0 * 2f64.sqrt() * error);
        assert!((moment(4) - 3.0).abs() < 4.0 * 96f64.sqrt() * error);
    }

    #[test]
    fn repeats_for_a_seed_and_differs_between_streams() {
        let draw = |seed, stream| {
            let mut source = noise_source(seed, stream);
            [
                normal(&mut source),
                normal(&mut source),
                uniform(&mut source),
            ]
        };
        assert_eq!(draw(7, 1), draw(7, 1));
        assert_ne!(draw(7, 1), draw(7, 2));
        assert_ne!(draw(7, 1), draw(8, 1));
    }
}
