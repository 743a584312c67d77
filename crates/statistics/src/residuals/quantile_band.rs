//! How far ordered values may lie from their quantiles.

use rayon::prelude::*;
use windfall_distribution::tail::beta_lower;
use windfall_numerics::root::bracketed_root;

/// Numbers of values up to which the level of a band is calculated.
const MOST_EXACT: usize = 1000;

/// Relative widths of the brackets of a level and of a probability.
const LEVEL_TOLERANCE: f64 = 1e-4;
const TOLERANCE: f64 = 1e-13;

/// Level of a pointwise band around ordered independent values that holds all of them together
/// with some confidence (equal local levels).
///
/// * `count`: number of values, at least 1
/// * `confidence`: that all lie within; in (0, 1)
///
/// Returns the probability of each single value outside; see [`probability_band`]. For more than
/// 1000 values it follows from that of 1000 by (ln n · ln ln n)^-1.1, which meets the levels of
/// 3000 and 10,000 within 0.2 %.
///
/// # Source
/// Aldor-Noiman, S., Brown, L. D., Buja, A., Rolke, W. and Stine, R. A. (2013), The power to see:
/// a new graphical test of normality, Am. Stat. 67, 249-260; Weine, E., McPeek, M. S. and Abney,
/// M. (2023), J. Stat. Softw. 106(10), for the name and the rate.
pub fn local_level(count: usize, confidence: f64) -> f64 {
    let outside = 1.0 - confidence;
    if count <= 1 {
        return outside;
    }
    if count > MOST_EXACT {
        let rate = |n: f64| (n.ln() * n.ln().ln()).powf(-1.1);
        let ratio = rate(count as f64) / rate(MOST_EXACT as f64);
        return ratio * local_level(MOST_EXACT, confidence);
    }
    // On a logarithmic scale; Bonferroni's level is the least that there can be.
    let (low, high) = ((outside / count as f64).ln(), outside.ln());
    let excess = |level: f64| {
        let lower = (0..count).into_par_iter();
        let lower = lower.map(|place| probability_band(place, count, level.exp()).0);
        probability_within(&lower.collect::<Vec<_>>()) - confidence
    };
    bracketed_root(low, high, LEVEL_TOLERANCE, excess).exp()
}

/// Ends between which an ordered value lies but for `level`: the probability of the distribution
/// below the lower end, and that above the upper end. Quantiles of Beta(i, n + 1 - i) and
/// Beta(n + 1 - i, i), i = `place` + 1.
pub fn probability_band(place: usize, count: usize, level: f64) -> (f64, f64) {
    let (i, above) = ((place + 1) as f64, (count - place) as f64);
    let lower = |a: f64, b: f64| {
        let tolerance = TOLERANCE * a / (a + b);
        bracketed_root(0.0, 1.0, tolerance, |x| 0.5 * level - beta_lower(x, a, b))
    };
    (lower(i, above), lower(above, i))
}

/// Probability that ordered uniform values all lie above `lower` and below its mirror image.
///
/// # Numerics
/// The number of values below a place is a Poisson process whose count is known at the end
/// (Khmaladze and Shinjikashvili 2001, Adv. Appl. Probab. 33, 361); from one end of an interval
/// to the next its distribution is convolved and cut to the counts that are allowed.
fn probability_within(lower: &[f64]) -> f64 {
    let count = lower.len();
    let rate = count as f64;
    let upper: Vec<f64> = lower.iter().rev().map(|own| 1.0 - own).collect();
    let mut places = [lower, &upper, &[1.0]].concat();
    places.sort_by(f64::total_cmp);
    let (mut at, mut first, mut chances) = (0.0, 0, vec![1.0]);
    for place in places {
        let step = rate * (place - at);
        at = place;
        // Just before a lower end its value must still be missing.
        let least = upper.partition_point(|own| *own <= place);
        let most = lower.partition_point(|own| *own < place);
        let mut added = vec![(-step).exp()];
        for k in 1..=most.saturating_sub(first) {
            added.push(added[k - 1] * step / k as f64);
        }
        let sum = |total: usize| -> f64 {
            let before = chances.iter().enumerate();
            let before = before.take_while(|(k, _)| first + k <= total);
            before.map(|(k, own)| own * added[total - first - k]).sum()
        };
        chances = (least.max(first)..=most).map(sum).collect();
        first = first.max(least);
    }
    // The chance of the count itself, e⁻ⁿ nⁿ / n!.
    let own: f64 = (1..=count).map(|k| (rate / k as f64).ln()).sum::<f64>() - rate;
    chances.last().copied().unwrap_or(0.0) / own.exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one value the band is pointwise; of two with ends a < b and 1 - b, 1 - a the chance
    /// is 2 ∫∫ over a ≤ u ≤ 1 - b', u ≤ v, which is 1 - 4 corners by hand below.
    #[test]
    fn closed_form_one_and_two_values() {
        assert!((local_level(1, 0.95) - 0.05).abs() < 1e-12);
        // U(1) in [0.1, 0.7], U(2) in [0.3, 0.9], U(1) <= U(2):
        // 2 (∫_{.1}^{.3} .6 du + ∫_{.3}^{.7} (.9 - u) du) = 2 (.12 + .16) = 0.56
        assert!((probability_within(&[0.1, 0.3]) - 0.56).abs() < 1e-12);
        let (low, high) = probability_band(0, 2, 0.05);
        // U(1) of two: P(U(1) < x) = 1 - (1 - x)²
        assert!((low - (1.0 - 0.975_f64.sqrt())).abs() < 1e-12);
        assert!((high - 0.025_f64.sqrt()).abs() < 1e-12, "{high}");
    }

    /// Of 2,000 samples of 20 values each, all lie within the band in 95 %, three standard
    /// errors of that share being 1.5 %.
    #[test]
    fn recovers_the_confidence() {
        let count = 20;
        let level = local_level(count, 0.95);
        let band: Vec<(f64, f64)> = (0..count)
            .map(|place| probability_band(place, count, level))
            .collect();
        let mut state = 12_345_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut within = 0_u32;
        for _ in 0..2000 {
            let mut sample: Vec<f64> = (0..count).map(|_| uniform()).collect();
            sample.sort_by(f64::total_cmp);
            let all = sample.iter().zip(&band);
            within += u32::from(
                all.clone()
                    .all(|(u, (low, high))| low <= u && *u <= 1.0 - high),
            );
        }
        assert!(
            (f64::from(within) / 2000.0 - 0.95).abs() < 0.015,
            "{within}"
        );
    }

    /// The same sweep written in R (qbeta, dpois, convolve) gives these levels.
    #[test]
    fn reference_levels() {
        for (count, expected, limit) in [
            (10, 0.007_384_98, 1e-4),
            (100, 0.002_195_31, 1e-4),
            (1000, 0.001_071_10, 2e-4),
            (3000, 0.000_838_469, 3e-3),
            (10_000, 0.000_670_739, 3e-3),
        ] {
            let found = local_level(count, 0.95);
            assert!((found / expected - 1.0).abs() < limit, "{count}: {found}");
        }
    }
}
