//! Residual variances by level against nlme, lme4 with pbkrtest, and full covariance matrices
//! (`bench/mixed_levels_reference.R`).

use crate::cases::{assert_near, case, number_column, numbers, rows, term};
use nalgebra::DMatrix;
use serde_json::Value;
use windfall_mixed::constraint::VarianceParameter;
use windfall_mixed::error::MixedError;
use windfall_mixed::fit::{MixedFit, MixedMethod, MixedOptions};
use windfall_mixed::fit_levels::fit_mixed_levels;
use windfall_mixed::inference::{coefficient_tests, picking_contrast, variance_uncertainty};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_f, kenward_roger_tests};
use windfall_mixed::predict::{NewRows, NewTerm, predict_mixed};
use windfall_mixed::profile::{profile_roots, profile_variances};
use windfall_mixed::residual_levels::ResidualLevels;
use windfall_mixed::summary::variance_shares;

fn reference() -> Value {
    serde_json::from_str(include_str!("data/levels.json")).unwrap()
}

fn formula(table: &str) -> &'static str {
    match table {
        "growth" => "y ~ day + (1 + day | subject)",
        "apple" => "k ~ velocity + radius + (1 | fruit)",
        "crossed" => "y ~ level + (1 | operator) + (1 | fruit)",
        _ => "y",
    }
}

fn levels_of(given: &Value) -> ResidualLevels {
    let names = given["names"].as_array().unwrap();
    ResidualLevels {
        column: "level".to_owned(),
        names: names
            .iter()
            .map(|own| own.as_str().unwrap().to_owned())
            .collect(),
        level: numbers(&given["level"])
            .iter()
            .map(|own| *own as usize)
            .collect(),
    }
}

fn fitted(given: &Value, method: MixedMethod) -> MixedFit {
    let table = given["table"].as_str().unwrap();
    let case = case(table, formula(table));
    fit_mixed_levels(
        (&case.y, &levels_of(given)),
        &case.x,
        &case.names,
        &case.terms,
        &MixedOptions { method },
    )
    .unwrap()
}

/// Entries of the terms' covariances, then residual variances.
fn variances(fit: &MixedFit) -> Vec<f64> {
    let mut all = Vec::new();
    for own in &fit.variances {
        for column in 0..own.columns.len() {
            all.extend((column..own.columns.len()).map(|row| own.covariance[(row, column)]));
        }
    }
    let levels = fit.levels.as_ref().unwrap();
    all.extend(levels.sds.iter().map(|own| own * own));
    all
}

const METHODS: [(&str, MixedMethod); 2] = [
    ("reml", MixedMethod::Reml),
    ("ml", MixedMethod::MaximumLikelihood),
];

#[test]
fn reference_estimates_by_level() {
    for given in reference()["cases"].as_array().unwrap() {
        for (name, method) in METHODS {
            let (own, fit) = (&given[name], fitted(given, method));
            let what = format!("{} {name}", given["table"]);
            assert_eq!(fit.findings, [], "{what}");
            let near = |of: &str, found: &[f64], expected: &Value, tolerance: f64| {
                assert_near(
                    &format!("{what}, {of}"),
                    found,
                    &numbers(expected),
                    tolerance,
                );
            };
            near("variances", &variances(&fit), &own["variances"], 1e-7);
            near(
                "coefficients",
                &fit.coefficients,
                &own["coefficients"],
                1e-8,
            );
            let found = fit.covariance.as_slice();
            assert_near(&what, found, &rows(&own["covariance"]).concat(), 1e-7);
            let likelihoods = [
                ("log_likelihood", fit.log_likelihood, 1e-10),
                (
                    "equal_log_likelihood",
                    fit.levels.as_ref().unwrap().equal_log_likelihood,
                    1e-10,
                ),
            ];
            for (key, found, tolerance) in likelihoods {
                near(key, &[found], &own[key], tolerance);
            }
            if own["nlme"].is_number() {
                near("nlme", &[fit.log_likelihood], &own["nlme"], 1e-8);
            }
        }
    }
}

#[test]
fn reference_satterthwaite_and_kenward_roger_by_level() {
    for given in reference()["cases"].as_array().unwrap() {
        for (name, method) in METHODS {
            let (own, fit) = (&given[name], fitted(given, method));
            let what = format!("{} {name}", given["table"]);
            let uncertainty = variance_uncertainty(&fit).unwrap();
            let tests = coefficient_tests(&fit, &uncertainty, 0.95);
            let df: Vec<f64> = tests.iter().map(|own| own.df).collect();
            assert_near(&what, &df, &numbers(&own["satterthwaite"]), 1e-5);
            if method != MixedMethod::Reml {
                continue;
            }
            let adjusted = kenward_roger(&fit).unwrap();
            let found = adjusted.covariance.as_slice();
            assert_near(&what, found, &rows(&own["kr_covariance"]).concat(), 1e-6);
            let tests = kenward_roger_tests(&fit, &adjusted, 0.95);
            let df: Vec<f64> = tests.iter().map(|own| own.df).collect();
            assert_near(&what, &df, &numbers(&own["kr_df"]), 1e-6);
            let joint = numbers(&own["joint"]);
            let joint: Vec<usize> = joint.iter().map(|own| *own as usize).collect();
            let contrast = picking_contrast(df.len(), &joint);
            let test = kenward_roger_f(&fit, &adjusted, &contrast).unwrap();
            let expected = numbers(&own["kr_joint"]);
            assert_near(&what, &[test.denominator, test.f], &expected, 1e-6);
        }
    }
}

/// Two halves of the subjects, each with a line, a variance between subjects and a residual one
/// of its own: what lme4 and pbkrtest find for each alone.
#[test]
fn reference_parts_that_share_nothing() {
    let y = number_column("growth", "y");
    let day = number_column("growth", "day");
    let subject = term("growth", &["1"], "subject", true);
    let half: Vec<usize> = subject.group.iter().map(|own| own / 9).collect();
    let of = |side: usize| move |own: &usize| f64::from(u8::from(*own == side));
    let marks: Vec<Vec<f64>> = (0..2)
        .map(|side| half.iter().map(of(side)).collect())
        .collect();
    let x = DMatrix::from_fn(y.len(), 4, |row, column| {
        let mark = marks[column / 2][row];
        if column % 2 == 0 {
            mark
        } else {
            mark * day[row]
        }
    });
    let names: Vec<String> = (0..4).map(|own| format!("x{own}")).collect();
    let terms: Vec<_> = marks
        .iter()
        .map(|mark| {
            let mut own = subject.clone();
            own.columns = vec![mark.clone()];
            own
        })
        .collect();
    let levels = ResidualLevels {
        column: "half".to_owned(),
        names: vec!["a".to_owned(), "b".to_owned()],
        level: half,
    };
    let fit = fit_mixed_levels((&y, &levels), &x, &names, &terms, &MixedOptions::default());
    let fit = fit.unwrap();
    let tests = kenward_roger_tests(&fit, &kenward_roger(&fit).unwrap(), 0.95);
    let sds = fit.levels.as_ref().unwrap().sds.clone();
    let mut likelihood = 0.0;
    for (side, own) in reference()["halves"].as_array().unwrap().iter().enumerate() {
        let name = format!("half {side}");
        let near = |found: &[f64], key: &str, tolerance: f64| {
            assert_near(&name, found, &numbers(&own[key]), tolerance);
        };
        let part = &tests[2 * side..2 * side + 2];
        let of = |get: fn(&windfall_mixed::coefficient::Coefficient) -> f64| {
            part.iter().map(get).collect::<Vec<f64>>()
        };
        near(&of(|own| own.estimate), "coefficients", 1e-6);
        near(&of(|own| own.se), "kr_se", 1e-5);
        near(&of(|own| own.df), "kr_df", 1e-5);
        near(&[sds[side]], "sigma", 1e-5);
        near(&fit.variances[side].sds, "between", 1e-5);
        likelihood += numbers(&own["log_likelihood"])[0];
    }
    assert_near("likelihood", &[fit.log_likelihood], &[likelihood], 1e-8);
}

/// Where an interval ends, the likelihood with the parameter held has fallen by what the level
/// of confidence says; near the estimate it falls as the parameter's curvature says.
#[test]
fn conserves_the_fall_of_the_likelihood_at_the_ends_of_profiles() {
    const Z: f64 = 1.959963984540054;
    let given = &reference()["cases"][1];
    let fit = fitted(given, MixedMethod::Reml);
    let profiles = profile_variances(&fit, MixedMethod::Reml, 0.95).unwrap();
    assert_eq!(profiles.findings, []);
    let sds = &fit.levels.as_ref().unwrap().sds;
    let mut of_levels = 0;
    for own in &profiles.intervals {
        let roots = profile_roots(&fit, own, &[own.low, own.estimate, own.high]);
        // The likelihood may not fall as far before a level does not vary at all.
        let open = own.low == 0.0;
        assert!(
            open || (roots[0] + Z).abs() < 1e-5,
            "{}: {roots:?}",
            own.name
        );
        assert!(roots[1].abs() < 1e-4, "{}: {roots:?}", own.name);
        assert!((roots[2] - Z).abs() < 1e-5, "{}: {roots:?}", own.name);
        if let VarianceParameter::ResidualSd { level } = own.parameter {
            of_levels += 1;
            assert_near(&own.name, &[own.estimate], &[sds[level]], 1e-12);
        }
    }
    assert_eq!(of_levels, 2);
}

/// The order of the levels does not matter, nor does that of the profiles' coordinates.
#[test]
fn conserves_everything_when_levels_change_places() {
    let given = &reference()["cases"][1];
    let table = case("apple", formula("apple"));
    let mut levels = levels_of(given);
    let fit = fitted(given, MixedMethod::Reml);
    levels.names.reverse();
    levels.level.iter_mut().for_each(|own| *own = 1 - *own);
    let turned = fit_mixed_levels(
        (&table.y, &levels),
        &table.x,
        &table.names,
        &table.terms,
        &MixedOptions::default(),
    );
    let turned = turned.unwrap();
    let both = [&fit, &turned].map(|own| profile_variances(own, own.method, 0.9).unwrap());
    let ends = |place: usize, level: usize| {
        let wanted = VarianceParameter::ResidualSd { level };
        let own = both[place].intervals.iter();
        let found = own.clone().find(|own| own.parameter == wanted).unwrap();
        [found.low, found.high]
    };
    assert_near("first", &ends(0, 0), &ends(1, 1), 1e-6);
    assert_near("second", &ends(0, 1), &ends(1, 0), 1e-6);
    let [a, b] = [&fit, &turned].map(variance_shares);
    let shares = |own: &windfall_mixed::summary::VarianceShares| [own.residual, own.r2_conditional];
    assert_near("shares", &shares(&a), &shares(&b), 1e-8);
}

/// A further observation has the variance of its own level.
#[test]
fn closed_form_prediction_of_an_observation_of_each_level() {
    let given = &reference()["cases"][1];
    let fit = fitted(given, MixedMethod::Reml);
    let uncertainty = variance_uncertainty(&fit).unwrap();
    let rows = NewRows {
        x: DMatrix::from_row_slice(2, 3, &[1.0, 0.3, 38.0, 1.0, 0.3, 38.0]),
        terms: vec![NewTerm {
            columns: vec![vec![1.0; 2]],
            group: vec![None; 2],
        }],
        level: vec![0, 1],
    };
    // At so small a confidence the half width is a multiple of the standard error alone.
    let found = predict_mixed(&fit, &uncertainty, &rows, 1e-6).unwrap();
    let sds = &fit.levels.as_ref().unwrap().sds;
    for (own, sd) in found.iter().zip(sds) {
        let ratio = (own.high - own.predicted) / (own.mean_high - own.predicted);
        let expected = (own.se.powi(2) + sd.powi(2)).sqrt() / own.se;
        assert_near("ratio", &[ratio], &[expected], 1e-2);
    }
    let unknown = NewRows {
        level: vec![0, 2],
        ..rows
    };
    let refused = predict_mixed(&fit, &uncertainty, &unknown, 0.95).unwrap_err();
    assert!(matches!(refused, MixedError::UnknownLevel { row: 2, .. }));
}

#[test]
fn rejects_levels_whose_variance_cannot_be_told() {
    let given = &reference()["cases"][1];
    let table = case("apple", formula("apple"));
    let refused = |y: &[f64], x: &DMatrix<f64>, levels: &ResidualLevels| {
        let names: Vec<String> = (0..x.ncols()).map(|own| format!("x{own}")).collect();
        let options = MixedOptions::default();
        let fit = fit_mixed_levels((y, levels), x, &names, &table.terms, &options);
        fit.map(|_| ()).unwrap_err().to_string()
    };
    let mut levels = levels_of(given);
    levels.names.push("c".to_owned());
    levels.level[7] = 2;
    let said = refused(&table.y, &table.x, &levels);
    assert!(said.contains("\"c\" has one row"), "{said}");
    // Two rows with a coefficient each.
    levels.level[8] = 2;
    let rows = table.y.len();
    let with = table.x.clone().insert_columns(3, 2, 0.0);
    let mut with = with;
    with[(7, 3)] = 1.0;
    with[(8, 4)] = 1.0;
    let said = refused(&table.y, &with, &levels);
    assert!(said.contains("coefficients of its own"), "{said}");
    // Rows that lie on the line of the fixed effects, in fruit that do not differ.
    let fitted = |row: usize| 100.0 + 3.0 * table.x[(row, 1)];
    let noise = |row: usize| match row % 2 {
        0 => (row * 37 % 11) as f64 - 5.0,
        _ => 0.0,
    };
    let y: Vec<f64> = (0..rows).map(|row| fitted(row) + noise(row)).collect();
    let exact = ResidualLevels {
        column: "level".to_owned(),
        names: vec!["noisy".to_owned(), "exact".to_owned()],
        level: (0..rows).map(|row| row % 2).collect(),
    };
    let said = refused(&y, &table.x, &exact);
    assert!(said.contains("\"exact\" has no scatter"), "{said}");
}
