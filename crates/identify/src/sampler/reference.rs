//! The sampler against posteriors that are known otherwise.

use crate::sampler::chains::Drawing;
use crate::sampler::chains::draw_chains;
use crate::sampler::density::LogDensity;
use std::cell::Cell;
use windfall_statistics::chain_diagnostics::chain_diagnostics;

const DRAWING: Drawing = Drawing {
    chains: 4,
    draws: 4000,
    seed: 5,
};

/// Draws of each quantity that `of` tells of a point, and how many diverged.
fn draws(density: &dyn LogDensity, of: &dyn Fn(&[f64]) -> Vec<f64>) -> (Vec<Vec<f64>>, usize) {
    let mut out: Vec<Vec<f64>> = Vec::new();
    let start = |chain: usize| vec![chain as f64 - 1.5; density.size()];
    let divergences = draw_chains(density, &DRAWING, &start, &mut |z| {
        let told = of(z);
        out.resize(told.len(), Vec::new());
        for (all, value) in out.iter_mut().zip(told) {
            all.push(value);
        }
    });
    (out, divergences.unwrap())
}

/// The mean of draws against an expectation, within four standard errors of both.
#[track_caller]
fn check_mean(what: &str, all: &[f64], expected: f64, its_error: f64) {
    let chains: Vec<&[f64]> = all.chunks_exact(DRAWING.draws).collect();
    let found = chain_diagnostics(&chains).unwrap();
    assert!(found.r_hat < 1.01, "{what}: {found:?}");
    let n = all.len() as f64;
    let mean = all.iter().sum::<f64>() / n;
    let square: f64 = all.iter().map(|v| (v - mean).powi(2)).sum();
    let error = (square / n / found.bulk_draws).sqrt();
    assert!(error < 0.1 * (square / n).sqrt(), "{what}: {found:?}");
    assert!(
        (mean - expected).abs() < 4.0 * error.hypot(its_error),
        "{what}: {mean} ± {error} against {expected}"
    );
}

/// A normal distribution with this inverse covariance matrix.
struct Correlated {
    inverse: [[f64; 3]; 3],
    evaluations: Cell<usize>,
}

impl LogDensity for Correlated {
    fn size(&self) -> usize {
        3
    }

    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64> {
        self.evaluations.set(self.evaluations.get() + 1);
        for (slope, row) in gradient.iter_mut().zip(&self.inverse) {
            *slope = -row.iter().zip(z).map(|(a, z)| a * z).sum::<f64>();
        }
        Some(0.5 * z.iter().zip(&*gradient).map(|(z, g)| z * g).sum::<f64>())
    }
}

/// Means and second moments of a normal distribution: sds 1, 2, 30, the first two
/// correlated by 0.8.
#[test]
fn closed_form_moments_of_a_normal_distribution() {
    let whole = 1.0 - 0.8 * 0.8;
    let density = Correlated {
        inverse: [
            [1.0 / whole, -0.4 / whole, 0.0],
            [-0.4 / whole, 0.25 / whole, 0.0],
            [0.0, 0.0, 1.0 / 900.0],
        ],
        evaluations: Cell::new(0),
    };
    let moments = |z: &[f64]| {
        let [x, y, far] = [z[0], z[1], z[2] / 30.0];
        vec![x, y, far, x * x, x * y, y * y, far * far, far.powi(4)]
    };
    let (found, divergences) = draws(&density, &moments);
    assert_eq!(divergences, 0);
    for (all, expected) in found.iter().zip([0.0, 0.0, 0.0, 1.0, 1.6, 4.0, 1.0, 3.0]) {
        check_mean("moment", all, expected, 0.0);
    }
    // About seven evaluations per draw once variances are known.
    let each = density.evaluations.get() / (4 * 4500);
    assert!((3..12).contains(&each), "{each}");
}

/// Half a normal distribution: there is no density below zero.
struct Half;

impl LogDensity for Half {
    fn size(&self) -> usize {
        1
    }

    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64> {
        gradient[0] = -z[0];
        (z[0] >= 0.0).then_some(-0.5 * z[0] * z[0])
    }
}

#[test]
fn closed_form_mean_beside_an_edge() {
    let (found, divergences) = draws(&Half, &|z| vec![z[0]]);
    assert!(divergences > 0);
    assert!(found[0].iter().all(|z| *z >= 0.0));
    let (mean, n) = ((2.0 / std::f64::consts::PI).sqrt(), found[0].len() as f64);
    let average = found[0].iter().sum::<f64>() / n;
    assert!((average / mean - 1.0).abs() < 0.05, "{average}");
}

/// Eight schools, not centred: effects of coaching and their errors (Rubin 1981,
/// J. Educational Statistics 6:377).
struct Schools;

const EFFECTS: [f64; 8] = [28.0, 8.0, -3.0, 7.0, -1.0, 1.0, 18.0, 12.0];
const ERRORS: [f64; 8] = [15.0, 10.0, 16.0, 11.0, 9.0, 11.0, 10.0, 18.0];

impl LogDensity for Schools {
    fn size(&self) -> usize {
        10
    }

    /// Coordinates: the schools' standardised effects, μ, ln τ; priors: normal (0, 5) of
    /// μ, half of Cauchy's (0, 5) of τ.
    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64> {
        let (mu, tau) = (z[8], z[9].exp());
        let ratio = tau / 5.0;
        let mut sum = -0.5 * (mu / 5.0).powi(2) - (ratio * ratio).ln_1p() + z[9];
        gradient[8] = -mu / 25.0;
        gradient[9] = 1.0 - 2.0 * ratio * ratio / (1.0 + ratio * ratio);
        for i in 0..8 {
            let away = (EFFECTS[i] - mu - tau * z[i]) / ERRORS[i];
            let slope = away / ERRORS[i];
            sum -= 0.5 * (away * away + z[i] * z[i]);
            gradient[i] = slope * tau - z[i];
            gradient[8] += slope;
            gradient[9] += slope * tau * z[i];
        }
        Some(sum)
    }
}

#[test]
fn reference_eight_schools() {
    // Means and their Monte Carlo errors: posteriordb, eight_schools_noncentered.
    let expected = [
        (6.150_502, 0.055_7),
        (4.939_581, 0.046_2),
        (3.905_906, 0.054_2),
        (4.796_017, 0.047_5),
        (3.614_436, 0.046_1),
        (4.051_148, 0.048_5),
        (6.317_170, 0.049_9),
        (4.883_997, 0.054_3),
        (4.410_518, 0.033_0),
        (3.602_060, 0.031_9),
    ];
    let told = |z: &[f64]| {
        let (mu, tau) = (z[8], z[9].exp());
        let effects = z[..8].iter().map(|z| mu + tau * z);
        effects.chain([mu, tau]).collect()
    };
    let (found, divergences) = draws(&Schools, &told);
    assert!(divergences < 160, "{divergences}");
    for (k, (all, (mean, error))) in found.iter().zip(expected).enumerate() {
        check_mean(&format!("quantity {k}"), all, mean, error);
    }
}

#[test]
fn repeats_for_a_seed() {
    let one = draws(&Schools, &|z| z.to_vec());
    assert_eq!(one, draws(&Schools, &|z| z.to_vec()));
}
