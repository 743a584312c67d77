//! Tests of residuals against R, statsmodels and SciPy.

#![allow(clippy::excessive_precision)] // as the references printed them

use nalgebra::DMatrix;
use windfall_statistics::residuals::box_cox::{BoxCoxOptions, box_cox};
use windfall_statistics::residuals::heteroscedasticity::koenker;
use windfall_statistics::residuals::normality::{anderson_darling, shapiro_wilk};
use windfall_statistics::residuals::order::durbin_watson;

const Y: [f64; 12] = [2.1, 3.7, 2.9, 8.4, 5.5, 4.4, 3.9, 2.2, 12.6, 6.1, 3.3, 4.8];
const Z: [f64; 12] = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0, 5.0, 3.0, 5.0, 8.0];

/// 1, x = 1 … 12, z.
fn design() -> DMatrix<f64> {
    DMatrix::from_fn(12, 3, |i, j| match j {
        0 => 1.0,
        1 => (i + 1) as f64,
        _ => Z[i],
    })
}

/// Residuals of y on the design by R 4.2.2, lm.
const RESIDUALS: [f64; 12] = [
    -1.58215725806451513,
    -0.87794968443197929,
    -1.10724929873772826,
    3.20365971248246817,
    1.16765866058905976,
    0.93165760869565239,
    -1.93062762973352120,
    -2.76662868162692854,
    7.03087745441795331,
    -0.36491497194950973,
    -2.88751314866760200,
    -0.81681276297335181,
];

#[track_caller]
fn check(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} against {expected}: {error:e}");
}

/// Expected: R 4.2.2, shapiro.test.
#[test]
fn reference_shapiro_wilk() {
    let sixty: Vec<f64> = (1..=60)
        .map(f64::from)
        .map(|i| (i * 12.9898).sin() * 4.0 + (i % 7.0).powf(1.3))
        .collect();
    let many: Vec<f64> = (1..=3000)
        .map(|i: u32| (f64::from(i * 7919 % 3001) / 3001.0).powf(1.5))
        .collect();
    for (values, w, p) in [
        (&Y[..], 0.83463657606340125, 0.023842328940115141),
        (&Y[..7], 0.90854019882329173, 0.3858583022487081),
        (&Y[..5], 0.92108813689118196, 0.5369836815661615),
        (&sixty, 0.96498080172572231, 0.082641961088088356),
        (&many, 0.92975533659687248, 2.1141246540693608e-35),
    ] {
        let found = shapiro_wilk(values).unwrap();
        check(found.statistic, w, 1e-8);
        check(found.p, p, 1e-6);
    }
    // evenly spaced: W = 1
    let found = shapiro_wilk(&[2.1, 3.7, 2.9]).unwrap();
    assert!((found.statistic - 1.0).abs() < 1e-12 && (found.p - 1.0).abs() < 1e-6);
}

/// Expected: statsmodels 0.15, normal_ad.
#[test]
fn reference_normality_by_other_tests() {
    let found = anderson_darling(&Y).unwrap();
    check(found.statistic, 0.7295841336981663, 1e-11);
    check(found.p, 0.04136195891371575, 1e-9);
}

/// Expected: statsmodels 0.15, het_breuschpagan (robust).
#[test]
fn reference_heteroscedasticity() {
    let found = koenker(&RESIDUALS, &design()).unwrap();
    assert_eq!(found.df, 2.0);
    check(found.statistic, 0.8125155197430645, 1e-11);
    check(found.p, 0.6661384415347027, 1e-11);
}

/// Expected: statsmodels 0.15 for the statistic; the p-value of Durbin-Watson by four million simulated residuals of this
/// design in NumPy: 0.55245 ± 0.00025.
#[test]
fn reference_order_of_residuals() {
    let found = durbin_watson(&RESIDUALS, &design()).unwrap();
    check(found.statistic, 2.2262242671940307, 1e-12);
    assert!((found.p_alike - 0.55245).abs() < 0.001, "{found:?}");
    assert!((found.p_alike + found.p_alternating - 1.0).abs() < 1e-9);
}

/// Expected: R 4.2.2, the profile of MASS::boxcox, its maximum and interval by
/// optimize and uniroot on the same likelihood.
#[test]
fn reference_box_cox() {
    let options = BoxCoxOptions {
        lowest: -2.0,
        highest: 2.0,
        steps: 8,
        ..BoxCoxOptions::default()
    };
    let found = box_cox(&Y, &design(), &options).unwrap();
    let expected = [
        -8.7051742589130345,
        -6.9857755066237370,
        -5.8103044107904855,
        -5.3326870098676942,
        -5.6929145490218689,
        -6.9623515408174912,
        -9.1083203480087818,
        -12.0122922638328937,
        -15.5229476469073937,
    ];
    for ((lambda, found), expected) in found.profile.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-11, "{lambda}: {found}");
    }
    assert!((found.lambda + 0.45396761).abs() < 1e-6, "{}", found.lambda);
    assert!((found.low.unwrap() + 1.5869470).abs() < 1e-6);
    assert!((found.high.unwrap() - 0.5801910).abs() < 1e-6);
    // an interval that leaves the range looked at has no end there
    let narrow = BoxCoxOptions {
        lowest: -1.0,
        highest: 0.0,
        ..options
    };
    let found = box_cox(&Y, &design(), &narrow).unwrap();
    assert_eq!((found.low, found.high), (None, None));
}

/// Multiplicative noise: the logarithm is inside the interval, the values
/// themselves are not.
#[test]
fn recovers_the_logarithm() {
    let response: Vec<f64> = (0..60)
        .map(|i| (0.05 * f64::from(i) + (f64::from(i) * 12.9898).sin()).exp())
        .collect();
    let line = DMatrix::from_fn(60, 2, |i, j| if j == 0 { 1.0 } else { i as f64 });
    let found = box_cox(&response, &line, &BoxCoxOptions::default()).unwrap();
    assert!(
        found.low.unwrap() < 0.0 && found.high.unwrap() > 0.0,
        "{found:?}"
    );
    assert!(found.high.unwrap() < 0.5, "{found:?}");
}

#[test]
fn rejects_samples_that_say_nothing() {
    assert!(shapiro_wilk(&[1.0, 1.0, 1.0]).is_err());
    assert!(shapiro_wilk(&vec![1.0; 6000]).is_err());
    assert!(koenker(&[1.0, -1.0, 1.0, -1.0], &DMatrix::zeros(4, 1)).is_err());
    let mut response = Y;
    response[4] = 0.0;
    let message = box_cox(&response, &design(), &BoxCoxOptions::default()).unwrap_err();
    assert_eq!(
        message.to_string(),
        "a response with powers of it: value 5 is 0, and all have to be above zero"
    );
}
