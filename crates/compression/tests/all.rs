//! Laws fitted to slow compressions.

#![allow(clippy::unwrap_used)]

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use windfall_compression::fit::{CompressionFit, LoadingCurve, fit_compression};
use windfall_contact::expression::parse_law;

/// A loading at a constant rate, first touch at 0.3 mm and recorded from 0.36 mm
/// on, with noise of force.
fn curve(law: &str, rate: f64, noise: f64, rng: &mut ChaCha8Rng) -> LoadingCurve {
    let law = parse_law(law).unwrap().complete().unwrap();
    let deformation: Vec<f64> = (72..400).map(|i| f64::from(i) * 5e-6).collect();
    let force = deformation
        .iter()
        .map(|d| {
            let force = law.force(d - 3e-4, rate, 0.0);
            // The sum of twelve uniform numbers is normal to a few per cent.
            let normal: f64 = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
            force + noise * normal
        })
        .collect();
    LoadingCurve {
        rate: vec![rate; deformation.len()],
        deformation,
        force,
    }
}

fn fit(curves: &[LoadingCurve], law: &str, free: &[&str]) -> CompressionFit {
    let free: Vec<String> = free.iter().map(|name| (*name).to_owned()).collect();
    fit_compression(curves, &parse_law(law).unwrap(), &free).unwrap()
}

#[test]
fn recovers_laws_without_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (truth, law, free, values) in [
        ("hertz(k=4e5)", "hertz", vec![], vec![4e5]),
        (
            "kuwabara-kono(k=4e5, c=900)",
            "kuwabara-kono",
            vec![],
            vec![4e5, 900.0],
        ),
        (
            "kelvin-voigt(k=2e4, c=300)",
            "kelvin-voigt(c=300)",
            vec![],
            vec![2e4, 300.0],
        ),
        (
            "power-law(k=1e6, n=1.7, c=0, p=0.5)",
            "power-law(c=0, p=0.5)",
            vec!["n"],
            vec![1e6, 1.7, 0.0, 0.5],
        ),
    ] {
        let found = fit(&[curve(truth, 0.02, 0.0, &mut rng)], law, &free);
        assert!(found.converged, "{law}: {found:?}");
        for (value, expected) in found.law.parameters().iter().zip(values) {
            assert!(
                (value - expected).abs() <= 1e-6 * expected,
                "{law}: {value} {expected}"
            );
        }
        assert!((found.touches[0].value - 3e-4).abs() < 1e-10);
    }
}

/// Several rates tell k and c; the 95 % intervals hold both, 400 times over.
#[test]
fn recovers_stiffness_and_damping_from_several_rates() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let truth = "kuwabara-kono(k=4e5, c=20000)";
    let (mut inside, mut sum) = ([0; 2], [0.0; 2]);
    let repeats = 400;
    for _ in 0..repeats {
        let curves = [1e-3, 5e-3, 2e-2].map(|rate| curve(truth, rate, 0.05, &mut rng));
        let found = fit(&curves, "kuwabara-kono", &[]);
        for (i, expected) in [4e5, 20000.0].into_iter().enumerate() {
            let estimate = found.parameters[i].unwrap();
            inside[i] += usize::from(estimate.low < expected && expected < estimate.high);
            sum[i] += estimate.value / expected / f64::from(repeats);
        }
    }
    // Binomial: 0.95 ± 3 × 0.011.
    for i in 0..2 {
        let part = inside[i] as f64 / f64::from(repeats);
        assert!((0.915..=0.985).contains(&part), "parameter {i}: {part}");
        assert!((sum[i] - 1.0).abs() < 0.005, "parameter {i}: {}", sum[i]);
    }
}

/// One slow rate does not tell the damping: the interval says so.
#[test]
fn closed_form_one_slow_rate_tells_no_damping() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let slow = curve("kuwabara-kono(k=4e5, c=900)", 1e-4, 0.05, &mut rng);
    let found = fit(&[slow], "kuwabara-kono", &[]);
    let c = found.parameters[1].unwrap();
    assert!(c.low < 0.0 && c.high > 900.0 && c.sd > 5e3, "{c:?}");
}

#[test]
fn rejects_laws_with_a_memory() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let one = [curve("hertz(k=4e5)", 1e-3, 0.0, &mut rng)];
    let law = parse_law("thornton").unwrap();
    let message = fit_compression(&one, &law, &[]).unwrap_err().to_string();
    assert!(message.contains("choose hertz"), "{message}");
}
