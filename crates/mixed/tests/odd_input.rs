//! Numbers that no laboratory writes: an answer or an error, never a panic.

#![allow(clippy::unwrap_used)]

use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use windfall_mixed::fit::{MixedMethod, MixedOptions, fit_mixed};
use windfall_mixed::inference::{
    coefficient_tests, f_test, picking_contrast, variance_uncertainty,
};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_tests};
use windfall_mixed::profile::profile_variances;
use windfall_mixed::summary::variance_shares;
use windfall_mixed::term::RandomTerm;

const ODD: [f64; 12] = [
    0.0,
    1.0,
    -1.0,
    2.0,
    1e-9,
    1e9,
    1e160,
    -1e300,
    1e-300,
    0.1,
    f64::NAN,
    f64::INFINITY,
];

fn below(random: &mut ChaCha8Rng, count: usize) -> usize {
    (random.next_u64() % count as u64) as usize
}

/// Numbers near 1, now and then an odd one.
fn number(random: &mut ChaCha8Rng, odd: usize) -> f64 {
    if below(random, 100) < odd {
        return ODD[below(random, ODD.len())];
    }
    below(random, 1000) as f64 / 300.0
}

fn term(random: &mut ChaCha8Rng, rows: usize, odd: usize) -> RandomTerm {
    let groups = 1 + below(random, 6);
    let width = 1 + below(random, 3);
    let mut columns: Vec<Vec<f64>> = (0..width)
        .map(|_| (0..rows).map(|_| number(random, odd)).collect())
        .collect();
    columns[0] = vec![1.0; rows];
    RandomTerm {
        name: "group".to_owned(),
        column_names: (0..width).map(|k| k.to_string()).collect(),
        columns,
        group: (0..rows)
            .map(|_| below(random, groups + usize::from(odd > 8)))
            .collect(),
        groups,
        group_names: (0..groups).map(|k| k.to_string()).collect(),
        correlated: below(random, 2) == 0,
    }
}

#[test]
fn rejects_or_answers_whatever_the_numbers_are() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut answered = 0;
    for case in 0..300 {
        let odd = [0, 0, 1, 10][case % 4];
        let rows = 3 + below(&mut random, 20);
        let y: Vec<f64> = (0..rows).map(|_| number(&mut random, odd)).collect();
        let p = 1 + below(&mut random, 3);
        let x = DMatrix::from_fn(rows, p, |_, k| {
            if k == 0 {
                1.0
            } else {
                number(&mut random, odd)
            }
        });
        let names: Vec<String> = (0..p).map(|k| format!("x{k}")).collect();
        let terms: Vec<RandomTerm> = (0..1 + below(&mut random, 3))
            .map(|_| term(&mut random, rows, odd))
            .collect();
        let method = [MixedMethod::Reml, MixedMethod::MaximumLikelihood][case % 2];
        let Ok(fit) = fit_mixed(&y, &x, &names, &terms, &MixedOptions { method }) else {
            continue;
        };
        answered += 1;
        assert!(
            fit.coefficients.iter().all(|value| value.is_finite()),
            "case {case}"
        );
        assert_eq!(variance_shares(&fit).random.len(), terms.len());
        if let Ok(uncertainty) = variance_uncertainty(&fit) {
            assert_eq!(coefficient_tests(&fit, &uncertainty, 0.95).len(), p);
            f_test(&fit, &uncertainty, &picking_contrast(p, &[0])).ok();
        }
        if let Ok(adjusted) = kenward_roger(&fit) {
            assert_eq!(kenward_roger_tests(&fit, &adjusted, 0.95).len(), p);
        }
        if case % 20 == 0 {
            profile_variances(&fit, method, 0.95).ok();
        }
    }
    assert!(answered > 50, "{answered}");
}
