//! Claims on repeated impacts: the sign-flip test and the critical energy.
//!
//! Reference values: `tests/repeats.py` with SciPy 1.17.1.

#![allow(clippy::unwrap_used)]

use windfall_repeat::interval::EnergyInterval;
use windfall_repeat::permutation::{Differences, SignFlipOptions, sign_flip_test};
use windfall_repeat::threshold::{Family, fit_threshold};
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal};

fn scalars(values: &[f64]) -> Differences {
    values.iter().map(|v| Some(vec![*v])).collect()
}

#[test]
fn reference_p_of_single_differences() {
    let five = [0.021, 0.013, -0.004, 0.017, 0.009];
    let eight = [0.021, 0.013, -0.004, 0.017, 0.009, -0.011, 0.002, 0.015];
    let ten = [0.3, -0.1, 0.25, 0.12, -0.31, 0.08, 0.22, 0.05, -0.02, 0.4];
    let cases: [(&[f64], f64); 3] = [(&five, 0.125), (&eight, 0.109_375), (&ten, 0.171_875)];
    for (values, expected) in cases {
        let test = sign_flip_test(&[scalars(values)], &SignFlipOptions::default()).unwrap();
        assert!(test.exact);
        assert_eq!(test.comparisons[0].p, expected);
        assert_eq!(test.patterns, 1 << (values.len() - 1));
    }
}

/// Four fruit, all alike in sign: 2 of 16 patterns reach it.
#[test]
fn closed_form_least_p_of_four_fruit() {
    let test = sign_flip_test(
        &[scalars(&[1.0, 2.0, 1.5, 3.0])],
        &SignFlipOptions::default(),
    );
    let test = test.unwrap();
    assert_eq!(
        (test.comparisons[0].p, test.comparisons[0].least_p),
        (0.125, 0.125)
    );
    assert_eq!(test.critical, None);
}

fn curve(source: &mut NoiseSource, points: usize, rise: f64) -> Vec<f64> {
    // Neighbours are correlated, as in a recording.
    let mut value = normal(source);
    let next = |i: usize| {
        value = 0.8 * value + 0.6 * normal(source);
        value + rise * i as f64 / points as f64
    };
    (0..points).map(next).collect()
}

/// Largest |t| for one sign pattern, written out: mean and standard deviation of
/// the flipped differences, with the floor of a tenth of the median rms.
fn brute_largest(comparison: &Differences, signs: &[f64]) -> f64 {
    let curves: Vec<(f64, &Vec<f64>)> = comparison
        .iter()
        .zip(signs)
        .filter_map(|(curve, sign)| Some((*sign, curve.as_ref()?)))
        .collect();
    let n = curves.len() as f64;
    let points = curves[0].1.len();
    let mut squares: Vec<f64> = (0..points)
        .map(|i| curves.iter().map(|(_, c)| c[i] * c[i]).sum::<f64>() / n)
        .collect();
    let t = |i: usize, floor: f64| {
        let mean = curves.iter().map(|(s, c)| s * c[i]).sum::<f64>() / n;
        let variance = curves
            .iter()
            .map(|(s, c)| (s * c[i] - mean).powi(2))
            .sum::<f64>()
            / (n - 1.0);
        mean.abs() / ((variance + floor) / n).sqrt()
    };
    squares.sort_by(f64::total_cmp);
    let floor = 0.01 * squares[points / 2];
    (0..points).map(|i| t(i, floor)).fold(0.0, f64::max)
}

/// Every pattern of all fruit written out, also opposite ones, with fruit missing
/// from one of the comparisons.
#[test]
fn reference_p_of_curves_by_brute_force() {
    let mut source = noise_source(3, 0);
    for rise in [0.0, 1.0, 3.0] {
        let mut comparisons: Vec<Differences> = (0..3)
            .map(|_| (0..7).map(|_| Some(curve(&mut source, 20, rise))).collect())
            .collect();
        comparisons[1][2] = None;
        let test = sign_flip_test(&comparisons, &SignFlipOptions::default()).unwrap();
        let all: Vec<Vec<f64>> = (0..128_u32)
            .map(|pattern| {
                let sign = |fruit: u32| if pattern >> fruit & 1 == 1 { -1.0 } else { 1.0 };
                let signs: Vec<f64> = (0..7).map(sign).collect();
                comparisons
                    .iter()
                    .map(|c| brute_largest(c, &signs))
                    .collect()
            })
            .collect();
        for (index, found) in test.comparisons.iter().enumerate() {
            let observed = all[0][index];
            let reached = |value: f64| value >= observed * (1.0 - 1e-9);
            let alone = all.iter().filter(|each| reached(each[index])).count();
            let family = all
                .iter()
                .filter(|each| each.iter().any(|v| reached(*v)))
                .count();
            assert_eq!(found.p_alone, alone as f64 / 128.0);
            assert_eq!(found.p, family as f64 / 128.0);
            assert!((found.statistic[found.largest].abs() / observed - 1.0).abs() < 1e-9);
            assert_eq!(found.adjusted_p[found.largest], found.p);
        }
        // The critical value: reached by at most 5 % of the patterns.
        let family = |each: &Vec<f64>| each.iter().copied().fold(0.0, f64::max);
        let critical = test.critical.unwrap();
        let share = all
            .iter()
            .filter(|each| family(each) >= critical * (1.0 - 1e-9))
            .count();
        assert!(share as f64 / 128.0 <= 0.05 && share > 0, "{share}");
    }
}

/// 5 % of campaigns in which nothing changes give p ≤ 0.05, whatever the number
/// of comparisons: 12 fruit have 2048 patterns, so p ≤ 0.05 has 102/2048 = 4.98 %.
#[test]
fn recovers_the_type_one_error() {
    let (trials, mut wrong) = (2000, 0);
    let mut source = noise_source(7, 0);
    for _ in 0..trials {
        let comparisons: Vec<Differences> = (0..3)
            .map(|_| (0..12).map(|_| Some(curve(&mut source, 12, 0.0))).collect())
            .collect();
        let test = sign_flip_test(&comparisons, &SignFlipOptions::default()).unwrap();
        wrong += usize::from(test.comparisons.iter().any(|c| c.p <= 0.05));
    }
    // Three standard errors of 2000 trials at 5 %.
    let rate = wrong as f64 / f64::from(trials);
    assert!(
        (rate - 0.05).abs() < 3.0 * (0.05 * 0.95 / f64::from(trials)).sqrt(),
        "{rate}"
    );
}

/// Drawn patterns agree with all patterns within their own error.
#[test]
fn converges_drawn_to_enumerated_patterns() {
    let mut source = noise_source(9, 0);
    let comparison: Differences = (0..12).map(|_| Some(curve(&mut source, 20, 1.2))).collect();
    let all = sign_flip_test(
        std::slice::from_ref(&comparison),
        &SignFlipOptions::default(),
    );
    let drawn = SignFlipOptions {
        most_patterns: 0,
        ..SignFlipOptions::default()
    };
    let drawn = sign_flip_test(&[comparison], &drawn).unwrap();
    let (exact, p) = (all.unwrap().comparisons[0].p, drawn.comparisons[0].p);
    assert!(!drawn.exact && drawn.patterns == 20_000);
    assert!(
        (p - exact).abs() < 4.0 * (exact * (1.0 - exact) / 2e4).sqrt() + 1e-4,
        "{p} {exact}"
    );
}

const INF: f64 = f64::INFINITY;

/// The fruit of tests/scipy/repeats.py.
const FRUIT: [(f64, f64); 12] = [
    (0.10, 0.14),
    (0.14, 0.20),
    (0.20, 0.28),
    (0.14, 0.20),
    (0.0, 0.10),
    (0.28, INF),
    (0.20, 0.28),
    (0.10, 0.20),
    (0.14, 0.20),
    (0.20, INF),
    (0.10, 0.14),
    (0.14, 0.28),
];

fn intervals(ends: &[(f64, f64)]) -> Vec<EnergyInterval> {
    let interval = |&(low, high): &(f64, f64)| EnergyInterval { low, high };
    ends.iter().map(interval).collect()
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value / expected - 1.0).abs() < tolerance,
        "{value}, expected {expected}"
    );
}

#[test]
fn reference_thresholds_by_scipy() {
    let fruit = intervals(&FRUIT);
    let normal = fit_threshold(&fruit, Family::LogNormal, 0.05).unwrap();
    close(normal.spread.value, 0.392_456_706_573_749, 1e-6);
    close(normal.median.value, 0.174_412_314_441_267_2, 1e-6);
    close(normal.ln_likelihood, -15.890_854_691_093_61, 1e-10);
    close(normal.median.low.unwrap(), 0.134_352_266_539_747_63, 1e-6);
    close(normal.median.high.unwrap(), 0.229_775_329_641_033_98, 1e-6);
    let weibull = fit_threshold(&fruit, Family::Weibull, 0.05).unwrap();
    close(1.0 / weibull.spread.value, 2.951_138_324_668_558_5, 1e-6);
    close(weibull.median.value, 0.182_938_823_763_379_03, 1e-6);
    close(weibull.ln_likelihood, -16.046_603_609_509_077, 1e-10);
    close(weibull.median.low.unwrap(), 0.136_187_133_522_891_63, 1e-6);
    close(weibull.median.high.unwrap(), 0.233_251_620_643_016_16, 1e-6);
}

/// No point of a fine grid of (median, spread) is likelier, and the interval of
/// the spread is where the likelihood over medians has fallen by χ²/2.
#[test]
fn reference_threshold_by_a_grid() {
    use statrs::distribution::{ContinuousCDF, Normal};
    let found = fit_threshold(&intervals(&FRUIT), Family::LogNormal, 0.05).unwrap();
    let below = |energy: f64, median: f64, spread: f64| match energy {
        0.0 => 0.0,
        INF => 1.0,
        _ => Normal::standard().cdf((energy / median).ln() / spread),
    };
    let ln = |median: f64, spread: f64| {
        let each = FRUIT
            .iter()
            .map(|(low, high)| (below(*high, median, spread) - below(*low, median, spread)).ln());
        each.sum::<f64>()
    };
    let medians: Vec<f64> = (0..400).map(|i| 0.08 * 1.005_f64.powi(i)).collect();
    let over_medians = |spread: f64| {
        medians
            .iter()
            .map(|m| ln(*m, spread))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let spreads = (0..300).map(|i| 0.1 * 1.01_f64.powi(i));
    let best = spreads.map(over_medians).fold(f64::NEG_INFINITY, f64::max);
    assert!(best <= found.ln_likelihood + 1e-12 && best > found.ln_likelihood - 1e-3);
    let (low, high) = (found.spread.low.unwrap(), found.spread.high.unwrap());
    for end in [low, high] {
        // χ²(0.95, 1)/2 = 1.920729.
        assert!(
            (over_medians(end) - found.ln_likelihood + 1.920_729).abs() < 1e-3,
            "{end}"
        );
    }
}

/// One interval, and nested ones: fruit need not differ, so the spread is at its
/// least, and the median is anywhere in the innermost interval.
#[test]
fn closed_form_fruit_that_need_not_differ() {
    for ends in [
        &[(0.1, 0.2)][..],
        &[(0.05, 0.4), (0.1, 0.3), (0.1, 0.2), (0.0, 0.9)],
    ] {
        let found = fit_threshold(&intervals(ends), Family::LogNormal, 0.05).unwrap();
        assert!(
            found.spread_at_bound && found.ln_likelihood.abs() < 1e-6,
            "{found:?}"
        );
        assert_eq!(found.spread.low, None);
        assert!((0.1..0.2).contains(&found.median.value), "{found:?}");
    }
}

/// Two fruit, apart: P = Φ-mass of (x₁, x₂] and (x₂, x₃], by symmetry of ln E
/// the median is the end they share.
#[test]
fn closed_form_median_by_symmetry() {
    let found = fit_threshold(
        &intervals(&[(0.1, 0.2), (0.2, 0.4)]),
        Family::LogNormal,
        0.05,
    );
    close(found.unwrap().median.value, 0.2, 1e-9);
}

/// Fruit with log-normal critical energies, impacts at rising energies: the
/// intervals hold the median and the spread put in about 95 % of the time.
#[test]
fn recovers_the_critical_energy_at_its_stated_rate() {
    let energies: Vec<f64> = (0..9).map(|i| 0.05 * 1.4_f64.powi(i)).collect();
    let (trials, median, spread) = (300, 0.2_f64, 0.35);
    let (mut of_median, mut of_spread) = (0, 0);
    for seed in 0..trials {
        let mut source = noise_source(seed, 0);
        let fruit: Vec<EnergyInterval> = (0..20)
            .map(|_| {
                let critical = median * (spread * normal(&mut source)).exp();
                let high = energies.iter().find(|e| **e >= critical);
                let low = energies.iter().rfind(|e| **e < critical);
                EnergyInterval {
                    low: low.copied().unwrap_or(0.0),
                    high: high.copied().unwrap_or(INF),
                }
            })
            .collect();
        let found = fit_threshold(&fruit, Family::LogNormal, 0.05).unwrap();
        let inside = |low: Option<f64>, high: Option<f64>, truth: f64| {
            low.is_none_or(|low| low < truth) && high.is_none_or(|high| truth < high)
        };
        of_median += usize::from(inside(found.median.low, found.median.high, median));
        of_spread += usize::from(inside(found.spread.low, found.spread.high, spread));
    }
    // 95 % less three standard errors of 300 trials; 20 fruit cost a little.
    for inside in [of_median, of_spread] {
        assert!(
            (0.91..=0.985).contains(&(inside as f64 / 300.0)),
            "{of_median} {of_spread}"
        );
    }
}

#[test]
fn rejects_what_has_no_threshold() {
    let message = |ends: &[(f64, f64)]| {
        let result = fit_threshold(&intervals(ends), Family::LogNormal, 0.05);
        result.unwrap_err().to_string()
    };
    assert!(message(&[(0.1, INF), (0.2, INF)]).contains("no fruit changed"));
    assert!(message(&[(0.0, 0.1), (0.0, 0.2)]).contains("begin lower"));
    assert!(message(&[(0.3, 0.1)]).contains("expected 0 ≤ low < high"));
    let one = sign_flip_test(&[scalars(&[0.1])], &SignFlipOptions::default());
    assert!(one.unwrap_err().to_string().contains("at least 2"));
}
