//! Residual variances by level against nlme, lme4 with pbkrtest, and full covariance matrices
//! (`bench/mixed_levels_reference.R`).

use crate::cases::{assert_near, case, number_column, numbers, rows, term};
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde_json::Value;
use windfall_mixed::constraint::VarianceParameter;
use windfall_mixed::error::MixedError;
use windfall_mixed::fit::{MixedFit, MixedMethod, MixedOptions, fit_mixed};
use windfall_mixed::fit_levels::fit_mixed_levels;
use windfall_mixed::inference::{coefficient_tests, picking_contrast, variance_uncertainty};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_f, kenward_roger_tests};
use windfall_mixed::predict::{NewRows, NewTerm, predict_mixed};
use windfall_mixed::profile::{profile_roots, profile_variances};
use windfall_mixed::residual_levels::ResidualLevels;
use windfall_mixed::summary::variance_shares;
use windfall_mixed::term::random_intercept;

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

/// A table of four columns, as `g1,0.75,l1,-1.162`.
fn small(text: &str, order: &[&str], method: MixedMethod) -> Result<MixedFit, MixedError> {
    let rows: Vec<Vec<&str>> = text
        .split_whitespace()
        .map(|row| row.split(',').collect())
        .collect();
    let number = |place: usize| {
        let own = rows.iter().map(move |row| row[place].parse::<f64>());
        own.collect::<Result<Vec<f64>, _>>().unwrap()
    };
    let mut groups: Vec<String> = rows.iter().map(|row| row[0].to_owned()).collect();
    let names = groups.clone();
    groups.sort();
    groups.dedup();
    let place = |own: &String| groups.iter().position(|group| group == own).unwrap();
    let group: Vec<usize> = names.iter().map(place).collect();
    let level = rows
        .iter()
        .map(|row| order.iter().position(|own| *own == row[2]));
    let levels = ResidualLevels {
        column: "l".to_owned(),
        names: order.iter().map(|own| (*own).to_owned()).collect(),
        level: level.map(Option::unwrap).collect(),
    };
    let v = number(1);
    let x = DMatrix::from_fn(
        v.len(),
        2,
        |row, column| if column == 0 { 1.0 } else { v[row] },
    );
    let names = ["one", "x"].map(str::to_owned);
    let terms = [random_intercept("g", &group, &groups)];
    let options = MixedOptions { method };
    fit_mixed_levels((&number(3), &levels), &x, &names, &terms, &options)
}

/// The highest maximum does not depend on the order of the levels: of nine rows, one at -10.52
/// (where nlme stops) and one at -6.27 without variance between groups.
#[test]
fn converges_to_the_highest_maximum_for_any_order_of_levels() {
    let table = "g1,0.75,l1,-1.162 g1,0.73,l1,-3.6601 g1,0.06,l1,0.4679 g2,0.12,l2,-1.2624 \
                 g2,0.2,l2,-1.1332 g2,0.44,l2,-0.8184 g3,1,l1,5.2006 g3,0.66,l1,5.0503 \
                 g3,0.28,l1,2.2207";
    for order in [["l1", "l2"], ["l2", "l1"]] {
        let fit = small(table, &order, MixedMethod::MaximumLikelihood).unwrap();
        assert_near("highest", &[fit.log_likelihood], &[-6.273], 1e-4);
        assert_eq!(fit.variances[0].sds, [0.0]);
    }
    // By restricted likelihood -30.60 inside, where nlme stops at -34.28.
    let table = "g1,0.53,l1,3.9444 g1,0.32,l1,3.6887 g2,0.27,l1,4.4996 g2,0.74,l2,9.2444 \
                 g3,0.57,l2,0.2432 g3,0.07,l1,-2.4819 g4,0.42,l2,-2.0369 g4,0.93,l2,5.7553 \
                 g5,0.38,l1,4.5548 g5,0.41,l2,-3.7633 g6,0.73,l1,-3.3449 g6,0,l2,2.5426 \
                 g7,0.71,l1,0.7116 g7,0.19,l1,-0.0038";
    let fit = small(table, &["l1", "l2"], MixedMethod::Reml).unwrap();
    assert_near("inside", &[fit.log_likelihood], &[-30.601], 1e-4);
    let sds = &fit.levels.as_ref().unwrap().sds;
    assert_near("sds", sds, &[0.0218, 5.45], 1e-2);
}

/// Where the variance of a level runs to zero, the highest maximum at which it does not is taken,
/// as nlme's, and the reader is told; without such a maximum the level is named.
#[test]
fn says_where_a_level_does_not_scatter() {
    let table = "g1,0.51,l2,0.7134 g1,0.3,l3,-1.7542 g1,0.38,l3,-1.3186 g2,0.02,l3,4.0422 \
                 g2,0.06,l2,-1.7816 g2,0.84,l3,2.3187 g3,0.76,l2,0.9759 g3,0.84,l3,1.1917 \
                 g3,0.09,l2,5.4742 g4,0.56,l1,2.1118 g4,0.68,l2,6.2696 g4,0.57,l3,3.5481 \
                 g5,0.6,l2,-0.5535 g5,0.25,l1,0.6016 g5,0.86,l2,0.2138";
    let fit = small(table, &["l1", "l2", "l3"], MixedMethod::Reml).unwrap();
    assert_near("nlme", &[fit.log_likelihood], &[-29.716], 1e-4);
    let sds = &fit.levels.as_ref().unwrap().sds;
    assert_near("sds", sds, &[1.161, 2.897, 0.438], 2e-3);
    let table = "g1,0.52,l2,1.6294 g1,0.05,l2,1.0928 g2,0.78,l1,2.4306 g2,0.37,l2,6.3642 \
                 g3,0.99,l1,14.8174 g3,0.91,l1,-4.4737 g4,0.93,l1,-7.5609 g4,0.4,l1,-0.2195 \
                 g5,0.88,l1,-14.6369 g5,0.81,l1,7.4265 g6,0.5,l2,5.7693 g6,0.83,l1,15.9584";
    match small(table, &["l1", "l2"], MixedMethod::Reml) {
        Ok(fit) => {
            let code = "higher_without_scatter";
            assert!(
                fit.findings.iter().any(|own| own.code() == code),
                "{:?}",
                fit.findings
            );
        }
        Err(told) => assert!(told.to_string().contains("\"l2\" has no scatter"), "{told}"),
    }
}

/// Degrees of freedom do not depend on the unit of the response.
#[test]
fn conserves_degrees_of_freedom_in_any_unit() {
    let given = &reference()["cases"][1];
    let table = case("apple", formula("apple"));
    let df = |scale: f64| {
        let y: Vec<f64> = table.y.iter().map(|own| own * scale).collect();
        let levels = levels_of(given);
        let options = MixedOptions::default();
        let rows = (&table.x, &table.names[..], &table.terms[..]);
        let by_level = fit_mixed_levels((&y, &levels), rows.0, rows.1, rows.2, &options);
        let one = fit_mixed(&y, rows.0, rows.1, rows.2, &options);
        let both = [by_level.unwrap(), one.unwrap()].map(|fit| {
            let uncertainty = variance_uncertainty(&fit).unwrap();
            assert_eq!(uncertainty.findings, []);
            let tests = coefficient_tests(&fit, &uncertainty, 0.95);
            tests.iter().map(|own| own.df).collect::<Vec<f64>>()
        });
        both.concat()
    };
    let usual = df(1.0);
    for scale in [1e-9, 1e-4, 1e5, 1e9] {
        assert_near("df", &df(scale), &usual, 1e-5);
    }
}

/// Small tables whose levels hardly tell their variances: the answer, or the refusal, does not
/// depend on the order of the levels.
#[test]
fn conserves_answers_of_small_tables_when_levels_change_places() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let (mut answered, mut differ) = (0, Vec::new());
    for table in 0..60 {
        let groups = 3 + table % 6;
        let mut text = String::new();
        for group in 0..groups {
            let own = 3.0 * (uniform() - 0.5);
            for _ in 0..2 + table % 4 {
                let level = 1 + (3.0 * uniform()) as usize;
                let scatter = [0.3, 1.0, 4.0][level - 1] * (uniform() + uniform() - 1.0);
                let y = own + scatter;
                text += &format!("g{group},{:.2},l{level},{y:.4} ", uniform());
            }
        }
        if ["l1", "l2", "l3"]
            .iter()
            .any(|own| text.matches(own).count() < 2)
        {
            continue;
        }
        let orders = [["l1", "l2", "l3"], ["l3", "l1", "l2"]];
        let both = orders.map(|order| small(&text, &order, MixedMethod::Reml));
        let values = both.map(|own| own.map(|fit| fit.log_likelihood));
        match values {
            [Ok(a), Ok(b)] if (a - b).abs() < 1e-5 => answered += 1,
            [Err(_), Err(_)] => {}
            values => differ.push((table, values)),
        }
    }
    println!("{answered} answered, {differ:?}");
    assert!(answered > 30 && differ.len() <= 1, "{answered} {differ:?}");
}
