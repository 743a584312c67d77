//! Comparisons of means and variances against R.
//!
//! Expected values: R 4.2.2 (t.test, aov, oneway.test, bartlett.test) and its
//! package car (leveneTest), printed with 17 digits.

#![allow(clippy::excessive_precision)] // as R printed them

use windfall_statistics::compare::equal_variance::{bartlett, brown_forsythe, levene};
use windfall_statistics::compare::means::{MeanDifference, paired, pooled, welch};
use windfall_statistics::compare::one_way_anova::{one_way_anova, welch_anova};

const A: [f64; 7] = [9.1, 10.4, 8.7, 11.2, 9.9, 10.8, 9.5];
const B: [f64; 7] = [11.0, 12.9, 9.2, 13.1, 12.0, 10.1, 12.6];
const D: [f64; 5] = [8.2, 14.9, 6.1, 12.7, 5.3];

fn groups() -> [Vec<f64>; 3] {
    [A.to_vec(), B.to_vec(), D.to_vec()]
}

#[track_caller]
fn check(found: f64, expected: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < 1e-12, "{found} against {expected}: {error:e}");
}

#[track_caller]
fn check_difference(found: &MeanDifference, expected: [f64; 6]) {
    let [t, df, p, low, high, standard_error] = expected;
    check(found.t, t);
    check(found.df, df);
    check(found.p, p);
    check(found.low, low);
    check(found.high, high);
    check(found.standard_error, standard_error);
}

#[test]
fn reference_t_tests() {
    check_difference(
        &paired(&A, &B, 0.95).unwrap(),
        [
            -3.31019332708834746,
            6.0,
            0.01620084059798220,
            -2.80757397726888414,
            -0.42099745130254396,
            0.48767112817112801,
        ],
    );
    check_difference(
        &pooled(&A, &D, 0.95).unwrap(),
        [
            0.31306696564489955,
            10.0,
            0.76066158834656583,
            -3.07604341182380825,
            4.08175769753809536,
            1.60622869238626742,
        ],
    );
    check_difference(
        &welch(&A, &D, 0.9).unwrap(),
        [
            0.26385511735426920,
            4.27112756608511734,
            0.80413793572269776,
            -3.48705117188917457,
            4.49276545760346124,
            1.90580780808573258,
        ],
    );
}

#[test]
fn closed_form_effect_sizes() {
    // means 2 and 5, both variances 1: d = -3; J(4) = Γ(2)/(√2 Γ(3/2)) = √(2/π)
    let found = pooled(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], 0.95).unwrap();
    check(found.cohen_d, -3.0);
    check(found.hedges_g, -3.0 * (2.0 / std::f64::consts::PI).sqrt());
    // equal variances and sizes: Welch's is the same test
    let welch = welch(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], 0.95).unwrap();
    check(welch.p, found.p);
    check(welch.cohen_d, -3.0);
}

#[test]
fn reference_analysis_of_variance() {
    let found = one_way_anova(&groups()).unwrap();
    check(found.between_ss, 15.44318796992483200);
    check(found.within_ss, 88.70628571428575526);
    check(found.f, 1.39274801965360839);
    check(found.p, 0.27693543112293412);
    check(found.residual_sd, 5.54414285714285970_f64.sqrt());
    let found = welch_anova(&groups()).unwrap();
    check(found.f, 2.8473256769037265);
    check(found.df2, 7.790141166014668);
    check(found.p, 0.11798011218317775);
}

#[test]
fn closed_form_two_groups_have_f_of_t_squared() {
    let t = pooled(&A, &D, 0.95).unwrap();
    let f = one_way_anova(&[A.to_vec(), D.to_vec()]).unwrap();
    check(f.f, t.t * t.t);
    check(f.p, t.p);
    let t = welch(&A, &D, 0.95).unwrap();
    let f = welch_anova(&[A.to_vec(), D.to_vec()]).unwrap();
    check(f.f, t.t * t.t);
    check(f.df2, t.df);
}

#[test]
fn reference_equal_variance() {
    let found = levene(&groups()).unwrap();
    check(found.f, 14.498304472557875);
    check(found.p, 0.00025557688768245107);
    let found = brown_forsythe(&groups()).unwrap();
    check(found.f, 5.0244962016103329);
    check(found.p, 0.020259672868085429);
    let found = bartlett(&groups()).unwrap();
    check(found.statistic, 11.238876692588146);
    check(found.p, 0.0036266774738896832);
}

#[test]
fn rejects_what_cannot_be_compared() {
    let of = |result: Result<MeanDifference, _>| match result {
        Ok(found) => panic!("{found:?}"),
        Err(error) => windfall_statistics::sample_error::SampleError::to_string(&error),
    };
    assert_eq!(
        of(paired(&A, &D, 0.95)),
        "the pairs: 7 values against 5; each needs its partner"
    );
    assert_eq!(
        of(paired(&A, &A, 0.95)),
        "the samples compared: all values are equal, so there is no spread to compare with"
    );
    assert_eq!(
        of(welch(&A, &[1.0], 0.95)),
        "the second sample: 1 values, and at least 2 are needed"
    );
    assert!(one_way_anova(&[vec![1.0], vec![2.0]]).is_err());
    assert!(one_way_anova(&[vec![1.0, 1.0], vec![2.0, 2.0]]).is_err());
    assert!(welch_anova(&[vec![1.0, 1.0], vec![2.0, 3.0]]).is_err());
    assert!(bartlett(&[vec![1.0, 1.0], vec![2.0, 3.0]]).is_err());
}
