//! Mixed models against what can be worked out by hand, and what they refuse.

#![allow(clippy::unwrap_used)]

use crate::cases;

use cases::{assert_near, case, fitted};
use nalgebra::{DMatrix, DVector};
use windfall_mixed::error::MixedError;
use windfall_mixed::fit::{MixedFit, MixedMethod, MixedOptions, fit_mixed};
use windfall_mixed::inference::{coefficient_tests, f_test, variance_uncertainty};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_f};
use windfall_mixed::predict::{NewRows, NewTerm, predict_mixed};
use windfall_mixed::profile::profile_variances;
use windfall_mixed::term::{RandomTerm, random_intercept};

/// Seven groups of five, and the mean squares between and within.
struct OneWay {
    y: Vec<f64>,
    group: Vec<usize>,
    between: f64,
    within: f64,
    mean: f64,
}

const GROUPS: usize = 7;
const EACH: usize = 5;

fn one_way() -> OneWay {
    let group: Vec<usize> = (0..GROUPS * EACH).map(|row| row / EACH).collect();
    let wave = |k: f64| (k * k * 0.7 + k).sin();
    let y: Vec<f64> = (0..GROUPS * EACH)
        .map(|row| 1000.0 + 4.0 * wave(3.1 * group[row] as f64) + wave(row as f64))
        .collect();
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let means: Vec<f64> = y
        .chunks(EACH)
        .map(|rows| rows.iter().sum::<f64>() / EACH as f64)
        .collect();
    let between: f64 = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() * EACH as f64;
    let within: f64 = y
        .iter()
        .zip(&group)
        .map(|(y, g)| (y - means[*g]).powi(2))
        .sum();
    OneWay {
        y,
        between: between / (GROUPS - 1) as f64,
        within: within / (GROUPS * (EACH - 1)) as f64,
        group,
        mean,
    }
}

fn names(count: usize) -> Vec<String> {
    (0..count).map(|k| format!("n{k}")).collect()
}

fn intercept(y: &[f64]) -> DMatrix<f64> {
    DMatrix::from_element(y.len(), 1, 1.0)
}

fn fit_one_way(data: &OneWay) -> MixedFit {
    let term = random_intercept("fruit", &data.group, &names(GROUPS));
    fit_mixed(
        &data.y,
        &intercept(&data.y),
        &names(1),
        &[term],
        &MixedOptions::default(),
    )
    .unwrap()
}

#[test]
fn closed_form_balanced_one_way() {
    // Searle, Casella and McCulloch (1992), Variance Components, sec. 3.8: REML
    // gives the estimators of the analysis of variance
    let data = one_way();
    let fit = fit_one_way(&data);
    let variance = (data.between - data.within) / EACH as f64;
    assert!(variance > 0.0);
    assert_near(
        "residual variance",
        &[fit.residual_sd.powi(2)],
        &[data.within],
        1e-10,
    );
    assert_near(
        "group variance",
        &[fit.variances[0].covariance[(0, 0)]],
        &[variance],
        1e-10,
    );
    let uncertainty = variance_uncertainty(&fit).unwrap();
    let test = &coefficient_tests(&fit, &uncertainty, 0.95)[0];
    let n = data.y.len() as f64;
    assert_near("mean", &[test.estimate], &[data.mean], 1e-14);
    assert_near("se", &[test.se], &[(data.between / n).sqrt()], 1e-10);
    assert_near("df", &[test.df], &[(GROUPS - 1) as f64], 1e-9);
    // Student's t of 6 degrees of freedom at 0.975, from tables
    assert_near(
        "half width",
        &[(test.high - test.low) / 2.0 / test.se],
        &[2.446_911_851_144_969],
        1e-7,
    );
}

#[test]
fn closed_form_restricted_profile_of_the_residual_of_a_balanced_one_way() {
    // the restricted likelihood splits into between and within: what is within rises
    // by f (x - 1 - ln x) with x = MSW / σ², and what is between is free to follow
    let data = one_way();
    let fit = fit_one_way(&data);
    let found = profile_variances(&fit, MixedMethod::Reml, 0.95).unwrap();
    let residual = &found.intervals[1];
    let f = (GROUPS * (EACH - 1)) as f64;
    for end in [residual.low, residual.high] {
        let x = data.within / (end * end);
        // χ² of one degree of freedom at 0.95, from tables
        assert_near(
            "rise",
            &[f * (x - 1.0 - x.ln())],
            &[3.841_458_820_694_124],
            1e-6,
        );
    }
    assert!(residual.low < fit.residual_sd && fit.residual_sd < residual.high);
}

#[test]
fn closed_form_predictions_of_a_balanced_one_way() {
    let data = one_way();
    let fit = fit_one_way(&data);
    let uncertainty = variance_uncertainty(&fit).unwrap();
    let rows = NewRows {
        level: Vec::new(),
        x: DMatrix::from_element(2, 1, 1.0),
        terms: vec![NewTerm {
            columns: vec![vec![1.0; 2]],
            group: vec![Some(2), None],
        }],
    };
    let found = predict_mixed(&fit, &uncertainty, &rows, 0.95).unwrap();
    let (groups, each) = (GROUPS as f64, EACH as f64);
    let variance = (data.between - data.within) / each;
    let shrink = each * variance / data.between;
    let of_mean = data.between / (groups * each);

    let group_mean = data.y[2 * EACH..3 * EACH].iter().sum::<f64>() / each;
    let value = data.mean + shrink * (group_mean - data.mean);
    let known = variance * (1.0 - shrink) + (1.0 - shrink).powi(2) * of_mean;
    assert_near(
        "known group",
        &[found[0].predicted, found[0].se],
        &[value, known.sqrt()],
        1e-10,
    );
    assert_near(
        "its conditional sd",
        &fit.effects[0].sds[2],
        &[(variance * (1.0 - shrink)).sqrt()],
        1e-10,
    );

    // a combination of mean squares has Satterthwaite's (1946) degrees of freedom
    let new = of_mean + variance;
    let (a, b) = (
        data.between * (1.0 + 1.0 / groups) / each,
        -data.within / each,
    );
    let df = new * new / (a * a / (groups - 1.0) + b * b / (groups * (each - 1.0)));
    assert_near(
        "new group",
        &[found[1].predicted, found[1].se],
        &[data.mean, new.sqrt()],
        1e-10,
    );
    assert_near("its df", &[found[1].df], &[df], 1e-8);
    assert!(found[0].high - found[0].mean_high > data.within.sqrt());
}

#[test]
fn closed_form_prediction_errors_of_crossed_groups_by_dense_matrices() {
    let name = "y ~ level + (1 + level | operator) + (1 | fruit)";
    let given = case("crossed", name);
    let mut data = fitted("crossed", name, MixedMethod::Reml);
    // the same with a slope that varies
    let y: Vec<f64> = given
        .y
        .iter()
        .enumerate()
        .map(|(row, y)| {
            y + 2.0 * ((given.terms[1].group[row] * 7 % 10) as f64 - 4.5) * given.x[(row, 1)]
        })
        .collect();
    data = fit_mixed(
        &y,
        &given.x,
        &given.names,
        data.model.terms(),
        &MixedOptions::default(),
    )
    .unwrap();
    assert_eq!(data.findings, []);
    let rows = NewRows {
        level: Vec::new(),
        x: DMatrix::from_row_slice(3, 2, &[1.0, 0.4, 1.0, 0.9, 1.0, 0.2]),
        terms: vec![
            NewTerm {
                columns: vec![vec![1.0; 3]],
                group: vec![Some(3), None, Some(11)],
            },
            NewTerm {
                columns: vec![vec![1.0; 3], vec![0.4, 0.9, 0.2]],
                group: vec![Some(9), Some(4), None],
            },
        ],
    };
    let uncertainty = variance_uncertainty(&data).unwrap();
    let found = predict_mixed(&data, &uncertainty, &rows, 0.9).unwrap();
    for (row, found) in found.iter().enumerate() {
        let expected = dense_prediction(&data, &given.x, &y, &rows, row);
        let near = format!("row {row}");
        assert_near(
            &near,
            &[found.predicted, found.se],
            &[expected.0, expected.1],
            1e-8,
        );
    }
}

/// Value and standard error by Henderson's formulas with the rows' covariance.
fn dense_prediction(
    fit: &MixedFit,
    x: &DMatrix<f64>,
    y: &[f64],
    rows: &NewRows,
    row: usize,
) -> (f64, f64) {
    let n = y.len();
    let variance = fit.residual_sd.powi(2);
    let mut v = DMatrix::identity(n, n) * variance;
    let mut cross = DVector::zeros(n);
    let mut own = 0.0;
    for (index, term) in fit.model.terms().iter().enumerate() {
        let sigma = &fit.variances[index].covariance;
        let z = |i: usize| {
            DVector::from_iterator(term.columns.len(), term.columns.iter().map(|c| c[i]))
        };
        let new = &rows.terms[index];
        let at = DVector::from_iterator(new.columns.len(), new.columns.iter().map(|c| c[row]));
        own += (at.transpose() * sigma * &at)[(0, 0)];
        for i in 0..n {
            if new.group[row] == Some(term.group[i]) {
                cross[i] += (z(i).transpose() * sigma * &at)[(0, 0)];
            }
            for j in 0..n {
                if term.group[i] == term.group[j] {
                    v[(i, j)] += (z(i).transpose() * sigma * z(j))[(0, 0)];
                }
            }
        }
    }
    let inverse = v.try_inverse().unwrap();
    let covariance = (x.transpose() * &inverse * x).try_inverse().unwrap();
    let beta = &covariance * x.transpose() * &inverse * DVector::from_column_slice(y);
    let at = rows.x.row(row).transpose();
    let rest = DVector::from_column_slice(y) - x * &beta;
    let value = at.dot(&beta) + (cross.transpose() * &inverse * rest)[(0, 0)];
    let d = at - x.transpose() * &inverse * &cross;
    let error = own - (cross.transpose() * &inverse * &cross)[(0, 0)]
        + (d.transpose() * covariance * &d)[(0, 0)];
    (value, error.sqrt())
}

#[test]
fn closed_form_degrees_of_freedom_of_a_balanced_split_plot() {
    let formula = "y ~ storage * height + (1 | orchard) + (1 | orchard:storage)";
    let fit = fitted("split", formula, MixedMethod::Reml);
    assert_eq!(fit.findings, []);
    let tests = coefficient_tests(&fit, &variance_uncertainty(&fit).unwrap(), 0.95);
    let found: Vec<f64> = tests.iter().map(|test| test.df).collect();
    // 6 orchards: 5; whole plots: (6 - 1)(2 - 1); within: 2 (6 - 1)(3 - 1)
    assert_near("df", &found, &[5.0, 5.0, 20.0, 20.0, 20.0, 20.0], 1e-9);
}

#[test]
fn closed_form_no_variance_between_groups_leaves_ordinary_least_squares() {
    let given = case("level", "y ~ x + (1 | group)");
    let fit = fitted("level", "y ~ x + (1 | group)", MixedMethod::Reml);
    assert_eq!(fit.findings.len(), 1);
    assert_eq!(fit.theta, [0.0]);
    let y = DVector::from_column_slice(&given.y);
    let inverse = given.x.tr_mul(&given.x).try_inverse().unwrap();
    let beta = &inverse * given.x.tr_mul(&y);
    let squares = (&y - &given.x * &beta).norm_squared();
    let variance = squares / (given.y.len() - 2) as f64;
    assert_near("coefficients", &fit.coefficients, beta.as_slice(), 1e-12);
    assert_near(
        "covariance",
        fit.covariance.as_slice(),
        (inverse * variance).as_slice(),
        1e-12,
    );
    assert!(fit.effects[0].values.iter().all(|value| value[0] == 0.0));
    let profiles = profile_variances(&fit, MixedMethod::Reml, 0.95).unwrap();
    assert_eq!(profiles.intervals[0].low, 0.0);
    assert!(profiles.intervals[0].high > 0.1);
}

#[test]
fn closed_form_shifted_and_scaled_columns_change_nothing_but_themselves() {
    let given = case("growth", "y ~ day + (1 + day | subject)");
    let mut far = case("growth", "y ~ day + (1 + day | subject)");
    for row in 0..far.y.len() {
        let year = 2013.0 + given.x[(row, 1)] * 1e-3;
        far.x[(row, 1)] = year;
        far.terms[0].columns[1][row] = year;
    }
    let options = MixedOptions::default();
    let near = fit_mixed(&given.y, &given.x, &given.names, &given.terms, &options).unwrap();
    let far = fit_mixed(&far.y, &far.x, &far.names, &far.terms, &options).unwrap();
    assert_near(
        "slope",
        &[far.coefficients[1] * 1e-3],
        &[near.coefficients[1]],
        1e-8,
    );
    assert_near(
        "sd of slopes",
        &[far.variances[0].sds[1] * 1e-3],
        &[near.variances[0].sds[1]],
        1e-6,
    );
    assert_near(
        "likelihood",
        &[far.criterion - 2.0 * 1e-3_f64.ln()],
        &[near.criterion],
        1e-10,
    );
}

#[test]
fn closed_form_numbering_of_groups_and_order_of_rows_do_not_matter() {
    let given = case("crossed", "y ~ level + (1 | operator) + (1 | fruit)");
    let first = fitted(
        "crossed",
        "y ~ level + (1 | operator) + (1 | fruit)",
        MixedMethod::Reml,
    );
    let n = given.y.len();
    let order: Vec<usize> = (0..n).map(|row| (row * 101 + 7) % n).collect();
    let moved = |term: &RandomTerm| RandomTerm {
        group: order
            .iter()
            .map(|row| 2 * (term.groups - 1 - term.group[*row]))
            .collect(),
        groups: 2 * term.groups,
        group_names: names(2 * term.groups),
        ..term.clone()
    };
    let y: Vec<f64> = order.iter().map(|row| given.y[*row]).collect();
    let x = DMatrix::from_fn(n, 2, |row, column| given.x[(order[row], column)]);
    let terms: Vec<RandomTerm> = given.terms.iter().map(moved).rev().collect();
    let second = fit_mixed(&y, &x, &given.names, &terms, &MixedOptions::default()).unwrap();
    assert_near(
        "coefficients",
        &second.coefficients,
        &first.coefficients,
        1e-9,
    );
    assert_near("criterion", &[second.criterion], &[first.criterion], 1e-12);
    let groups = given.terms[0].groups;
    let (first, second) = (&first.effects[0], &second.effects[1]);
    for group in 0..groups {
        let place = 2 * (groups - 1 - group);
        assert_near("effect", &second.values[place], &first.values[group], 1e-6);
        assert_eq!(second.values[place + 1], [0.0]);
        assert!(second.sds[place + 1][0] > second.sds[place][0]);
    }
}

#[test]
fn repeats_profile_for_any_number_of_threads() {
    let fit = fitted("growth", "y ~ day + (1 + day | subject)", MixedMethod::Reml);
    let runs = [1, 2, 8].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| profile_variances(&fit, MixedMethod::Reml, 0.95).unwrap())
    });
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
}

fn refused(change: impl Fn(&mut Vec<f64>, &mut DMatrix<f64>, &mut Vec<RandomTerm>)) -> String {
    let mut given = case("apple", "k ~ velocity + radius + (1 | fruit)");
    change(&mut given.y, &mut given.x, &mut given.terms);
    let names = names(given.x.ncols());
    let options = MixedOptions::default();
    let error: MixedError =
        fit_mixed(&given.y, &given.x, &names, &given.terms, &options).unwrap_err();
    error.to_string()
}

#[test]
fn rejects_what_cannot_be_fitted_and_says_why() {
    let message = refused(|y, _, _| y[3] = f64::NAN);
    assert!(message.starts_with("response, row 4: NaN"), "{message}");
    let message = refused(|_, x, _| *x = x.clone().insert_column(3, 0.0));
    assert!(message.contains("column n3 is zero"), "{message}");
    let message = refused(|_, x, _| {
        *x = x.clone().insert_column(3, 2.0);
        let sum = x.column(1) + x.column(3);
        x.set_column(2, &sum);
    });
    assert!(
        message.contains("column n2 is a combination of n0, n1"),
        "{message}"
    );
    let message = refused(|y, _, terms| {
        terms[0].group = (0..y.len()).collect();
        terms[0].groups = y.len();
        terms[0].group_names = names(y.len());
    });
    assert!(
        message.contains("100 random effects for 100 rows"),
        "{message}"
    );
    let message = refused(|_, _, terms| terms[0].group.fill(0));
    assert!(
        message.contains("1 groups with rows, and at least 2"),
        "{message}"
    );
    let message = refused(|_, _, terms| terms[0].group[5] = 40);
    assert!(
        message.contains("row 6: group 40, but there are 40"),
        "{message}"
    );
    let message = refused(|_, _, terms| terms.clear());
    assert!(message.contains("has no columns"), "{message}");
    let message = refused(|_, _, terms| {
        let again = terms[0].clone();
        terms.push(again);
    });
    assert!(message.contains("is a multiple of"), "{message}");
    let message = refused(|y, x, _| *y = x.column(1).iter().map(|v| 3.0 * v + 1.0).collect());
    assert!(
        message.contains("the fixed effects reproduce the response"),
        "{message}"
    );
    let message = refused(|y, _, _| {
        y.pop();
    });
    assert!(message.contains("99 are needed"), "{message}");
}

#[test]
fn rejects_variances_that_fixed_effects_take_up() {
    let data = one_way();
    let x = DMatrix::from_fn(data.y.len(), GROUPS, |row, k| {
        f64::from(u8::from(data.group[row] == k))
    });
    let term = random_intercept("fruit", &data.group, &names(GROUPS));
    let options = MixedOptions::default();
    let fit = fit_mixed(&data.y, &x, &names(GROUPS), &[term], &options).unwrap();
    assert!(
        fit.findings
            .iter()
            .any(|finding| finding.code() == "flat_criterion")
    );
}

#[test]
fn rejects_groups_that_leave_no_residual() {
    let group = one_way().group;
    let y: Vec<f64> = group.iter().map(|g| (*g as f64).sin()).collect();
    let term = random_intercept("fruit", &group, &names(GROUPS));
    let options = MixedOptions::default();
    let error = fit_mixed(&y, &intercept(&y), &names(1), &[term], &options).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("fixed and random effects reproduce the response"),
        "{message}"
    );
}

#[test]
fn closed_form_two_terms_of_one_group_are_one_term_without_correlation() {
    let formula = "y ~ day + (1 + day || subject)";
    let given = case("growth", formula);
    let one = fitted("growth", formula, MixedMethod::Reml);
    let part = |k: usize| RandomTerm {
        columns: vec![given.terms[0].columns[k].clone()],
        column_names: vec![given.terms[0].column_names[k].clone()],
        ..given.terms[0].clone()
    };
    let terms = [part(0), part(1)];
    let options = MixedOptions::default();
    let two = fit_mixed(&given.y, &given.x, &given.names, &terms, &options).unwrap();
    assert_near("criterion", &[two.criterion], &[one.criterion], 1e-12);
    assert_near("theta", &two.theta, &one.theta, 1e-9);
    assert_near(
        "effect",
        &two.effects[1].values[3],
        &one.effects[0].values[3][1..],
        1e-8,
    );
}

#[test]
fn rejects_tests_of_nothing() {
    let fit = fitted(
        "growth",
        "y ~ day + (1 + day || subject)",
        MixedMethod::Reml,
    );
    let uncertainty = variance_uncertainty(&fit).unwrap();
    let adjusted = kenward_roger(&fit).unwrap();
    for contrast in [DMatrix::zeros(0, 2), DMatrix::zeros(1, 2)] {
        let expected = MixedError::EmptyContrast;
        assert_eq!(f_test(&fit, &uncertainty, &contrast).unwrap_err(), expected);
        assert_eq!(
            kenward_roger_f(&fit, &adjusted, &contrast).unwrap_err(),
            expected
        );
    }
    let nan = DMatrix::from_element(1, 2, f64::NAN);
    f_test(&fit, &uncertainty, &nan).unwrap_err();
    kenward_roger_f(&fit, &adjusted, &DMatrix::zeros(1, 3)).unwrap_err();
    profile_variances(&fit, MixedMethod::Reml, 1.5).unwrap_err();
    assert!(coefficient_tests(&fit, &uncertainty, 1.0)[0].low.is_nan());
    let plain = fitted(
        "growth",
        "y ~ day + (1 + day || subject)",
        MixedMethod::MaximumLikelihood,
    );
    assert_eq!(
        kenward_roger(&plain).unwrap_err(),
        MixedError::NeedsRestricted
    );
}
