//! Random numbers that depend on nothing but a seed and what they are for.

use crate::population::{normal, normal_of_two};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Standard normal numbers of a stream of a seed.
pub fn normals(seed: u64, stream: u64, count: usize) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    (0..count).map(|_| normal(&mut generator)).collect()
}

/// A standard normal number of some words, whatever was drawn before: of one contact, say.
pub fn normal_of(words: &[u64]) -> f64 {
    let mixed = words.iter().fold(0, |state, word| scrambled(state ^ word));
    let unit = |word: u64| (word >> 11) as f64 / (1_u64 << 53) as f64;
    normal_of_two(unit(mixed), unit(scrambled(mixed)))
}

/// A word whose bits all depend on all of those of another.
///
/// # Source
/// Steele, Lea and Flood (2014), "Fast splittable pseudorandom number generators", OOPSLA 14.
fn scrambled(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(numbers: &[f64]) -> (f64, f64, f64) {
        let n = numbers.len() as f64;
        let mean = |power: i32| numbers.iter().map(|own| own.powi(power)).sum::<f64>() / n;
        (mean(1), mean(2), mean(4))
    }

    #[test]
    fn closed_form_moments_of_normal_numbers() {
        let n = 100_000;
        let own: Vec<f64> = (0..n).map(|i| normal_of(&[1, i, 7])).collect();
        for numbers in [own.clone(), normals(3, 1, n as usize)] {
            let (first, second, fourth) = moments(&numbers);
            // Five standard errors: 1/√n, √2/√n, √96/√n.
            assert!(
                first.abs() < 0.016 && (second - 1.0).abs() < 0.023,
                "{first} {second}"
            );
            assert!((fourth - 3.0).abs() < 0.16, "{fourth}");
        }
        // Neighbours do not go together.
        let product = own.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n as f64;
        assert!(product.abs() < 0.016, "{product}");
        assert_eq!(own[5], normal_of(&[1, 5, 7]));
        assert_ne!(normals(3, 1, 4), normals(3, 2, 4));
    }
}
