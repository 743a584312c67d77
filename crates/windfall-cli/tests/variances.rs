//! Weights of rows and variances by level in `windfall regress`.

#![allow(clippy::unwrap_used)]

use crate::on_table::{self, close};
use serde_json::Value;

const DENTS: &str = "variety,fruit,V,n,depth\nGala,a,0.2,3,2.91\nGala,a,0.4,5,3.87\n\
    Gala,b,0.3,1,3.95\nGala,b,0.7,4,5.62\nFuji,c,0.2,6,3.12\nFuji,c,0.5,2,4.81\n\
    Fuji,d,0.6,8,5.05\nIdared,e,0.3,3,4.6\nIdared,e,0.4,7,4.71\nIdared,f,0.6,2,6.49\n\
    Idared,f,0.7,5,6.02\nIdared,f,0.1,1,2.44\n";

/// Three groups of 6, 9 and 5.
const GROUPS: &str = "g,x,y\na,1,2.1\na,2,3.4\na,3,1.9\na,4,2.2\na,5,4.0\na,6,2.8\nb,1,5.1\n\
    b,2,7.9\nb,3,3.2\nb,4,6.6\nb,5,9.4\nb,6,4.8\nb,7,5.5\nb,8,7.1\nb,9,2.9\nc,2,6.1\nc,4,6.6\n\
    c,5,6.2\nc,7,7.3\nc,8,7.0\n";

/// Impacts on eight fruit.
const FRUIT: &str = "variety,fruit,V,y\nGala,a,0.15,4.93\nGala,a,0.36,5.58\nGala,a,0.6,6.48\n\
    Gala,b,0.24,3.84\nGala,b,0.56,6.34\nGala,c,0.23,2.61\nGala,c,0.35,4.02\nGala,c,0.64,6.18\n\
    Gala,d,0.21,1.77\nGala,d,0.44,3.88\nGala,d,0.62,4.37\nFuji,e,0.22,4.05\nFuji,e,0.41,5.55\n\
    Fuji,e,0.63,6.37\nFuji,f,0.2,4.64\nFuji,f,0.38,5.2\nFuji,g,0.19,3.42\nFuji,g,0.42,4.19\n\
    Fuji,g,0.65,5.32\nFuji,h,0.2,3.66\nFuji,h,0.38,4.36\nFuji,h,0.57,5.54\n";

fn json(table: &str, arguments: &[&str]) -> Value {
    on_table::json(table, &[&["regress", "t.csv"], arguments].concat())
}

fn refused(table: &str, arguments: &[&str]) -> String {
    let (status, _, told) = on_table::run(table, &[&["regress", "t.csv"], arguments].concat());
    assert_ne!(status, Some(0), "{arguments:?}");
    told
}

/// Column of a list of objects.
fn column(rows: &Value, name: &str) -> Vec<Value> {
    let rows = rows.as_array().unwrap().iter();
    rows.map(|row| row[name].clone()).collect()
}

fn all_close(found: &[Value], expected: &[f64], limit: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        close(found, *expected, limit);
    }
}

const WEIGHTED: [&str; 6] = [
    "--formula",
    "depth ~ V + variety",
    "--weights",
    "n",
    "--folds",
    "12",
];

/// R 4.2: `lm(depth ~ V + variety, weights = n)`, `rstandard`, `cooks.distance`, `rstudent`,
/// `hatvalues`, car's `Anova`, sandwich's `vcovHC`, `predict(…, weights = 1)`.
#[test]
fn reference_weights_of_a_linear_model() {
    let found = json(DENTS, &[&WEIGHTED[..], &["--predict", "t.csv"]].concat());
    let estimates = [
        2.066385386181877,
        5.096833403012853,
        -0.108073878272127,
        0.653998840173165,
    ];
    all_close(&column(&found["terms"], "estimate"), &estimates, 1e-12);
    let errors = [
        0.255690798187207,
        0.474454254640745,
        0.222993553606205,
        0.205855490166518,
    ];
    all_close(&column(&found["terms"], "se"), &errors, 1e-12);
    close(&found["sigma"], 0.59720587046469, 1e-12);
    close(&found["r2"], 0.945791709961525, 1e-12);
    close(&found["r2_adjusted"], 0.925463601197097, 1e-12);
    close(&found["log_likelihood"], -1.40565100699114, 1e-12);
    close(&found["aic"], 12.8113020139823, 1e-12);
    close(&found["bic"], 15.2358352629223, 1e-12);
    close(&found["press"], 5.11366019980691, 1e-12);
    let row = &found["influence"][3];
    close(&row["standardised"], 0.436268577432379, 1e-12);
    close(&row["cook"], 0.0439900093199053, 1e-12);
    close(&row["studentised"], 0.413034776568829, 1e-12);
    close(&row["leverage"], 0.480384091491456, 1e-12);
    close(&row["residual"], 0.093905109981254, 1e-11);
    close(&row["fitted"], 5.62 - 0.093905109981254, 1e-12);
    let sums = [41.15857422045, 5.51944249953];
    all_close(&column(&found["anova"], "ss"), &sums, 1e-11);
    let f = [115.401694445616, 7.7377925366034];
    all_close(&column(&found["anova"], "f"), &f, 1e-12);
    // A further observation has weight 1.
    let prediction = &found["predictions"][0];
    close(&prediction["predicted"], 2.97767818851232, 1e-12);
    close(&prediction["low"], 1.52491334638239, 1e-12);
    close(&prediction["high"], 4.43044303064225, 1e-12);
    let robust = json(DENTS, &[&WEIGHTED[..], &["--robust"]].concat());
    let errors = [
        0.219911803128377,
        0.508468269206452,
        0.153884925384866,
        0.215437586645112,
    ];
    all_close(&column(&robust["terms"], "se"), &errors, 1e-12);
}

/// Parts of single rows: their errors are those of PRESS. The weights sum to 47.
#[test]
fn closed_form_cross_validation_is_weighted() {
    let found = json(DENTS, &WEIGHTED);
    let press = found["press"].as_f64().unwrap();
    let validation = &found["cross_validation"];
    close(&validation["rms"], (press / 47.0).sqrt(), 1e-10);
}

/// A row of weight 3 counts as three rows of its value do in estimates and pure error.
#[test]
fn conserves_rows_that_are_repeated() {
    let once = "x,y,w\n1,2,3\n1,4,1\n2,5,2\n3,4,1\n3,9,1\n4,8,2\n";
    let often = "x,y\n1,2\n1,2\n1,2\n1,4\n2,5\n2,5\n3,4\n3,9\n4,8\n4,8\n";
    let weighted = json(once, &["--formula", "y ~ x", "--weights", "w"]);
    let repeated = json(often, &["--formula", "y ~ x"]);
    let estimates = column(&repeated["terms"], "estimate");
    let estimates: Vec<f64> = estimates.iter().map(|own| own.as_f64().unwrap()).collect();
    all_close(&column(&weighted["terms"], "estimate"), &estimates, 1e-12);
    for sum in ["residual", "total"] {
        let expected = repeated[sum]["ss"].as_f64().unwrap();
        close(&weighted[sum]["ss"], expected, 1e-12);
    }
    let pure = |found: &Value| found["lack_of_fit"]["pure_error"]["ss"].clone();
    close(&pure(&weighted), pure(&repeated).as_f64().unwrap(), 1e-12);
    close(&weighted["lack_of_fit"]["pure_error"]["df"], 2.0, 1e-12);
}

/// lme4 1.1.31: `lmer(depth ~ V + (1 | fruit), weights = n)`; four times the weights are four
/// times the residual variance, and nothing else.
#[test]
fn reference_weights_of_a_mixed_model() {
    let formula = ["--formula", "depth ~ V + (1 | fruit)", "--weights"];
    let found = json(DENTS, &[&formula[..], &["n"]].concat());
    let estimates = [2.18745226129695, 5.26865891636777];
    all_close(&column(&found["terms"], "estimate"), &estimates, 1e-6);
    let errors = [0.34478351735506, 0.661024362708655];
    all_close(&column(&found["terms"], "se"), &errors, 1e-6);
    let df = [9.95787236252448, 9.47123496566084];
    all_close(&column(&found["terms"], "df"), &df, 1e-6);
    close(&found["log_likelihood"], -7.54006276615461, 1e-10);
    let sds = [0.321351210312524, 0.659080472972497];
    all_close(&column(&found["variances"], "value"), &sds, 1e-6);
    let four: String = DENTS
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let weight = cells[3].parse::<f64>().map(|own| (4.0 * own).to_string());
            let weight = weight.unwrap_or_else(|_| "n".to_owned());
            format!("{line},{}\n", weight.replace('n', "more"))
        })
        .collect();
    let other = json(&four, &[&formula[..], &["more"]].concat());
    close(
        &other["log_likelihood"],
        found["log_likelihood"].as_f64().unwrap(),
        1e-9,
    );
    for (place, factor) in [(0, 1.0), (1, 2.0)] {
        let expected = factor * found["variances"][place]["value"].as_f64().unwrap();
        close(&other["variances"][place]["value"], expected, 1e-6);
    }
}

/// The difference of two groups is Welch's: R's `t.test(y ~ g)` of the first two.
#[test]
fn closed_form_two_variances_are_welch() {
    let two: String = GROUPS
        .lines()
        .take(16)
        .map(|line| format!("{line}\n"))
        .collect();
    let found = json(&two, &["--formula", "y ~ g", "--variance", "g"]);
    let groups: [&[f64]; 2] = [
        &[2.1, 3.4, 1.9, 2.2, 4.0, 2.8],
        &[5.1, 7.9, 3.2, 6.6, 9.4, 4.8, 5.5, 7.1, 2.9],
    ];
    let moments = groups.map(|own| {
        let n = own.len() as f64;
        let mean = own.iter().sum::<f64>() / n;
        let squares: f64 = own.iter().map(|y| (y - mean).powi(2)).sum();
        (n, mean, squares / (n - 1.0))
    });
    let parts = moments.map(|(n, _, variance)| variance / n);
    let sum: f64 = parts.iter().sum();
    let squares = parts
        .iter()
        .zip(&moments)
        .map(|(own, (n, ..))| own * own / (n - 1.0));
    let df = sum * sum / squares.sum::<f64>();
    let term = &found["terms"][1];
    close(&term["estimate"], moments[1].1 - moments[0].1, 1e-12);
    close(&term["se"], sum.sqrt(), 1e-10);
    close(&term["df"], df, 1e-9);
    close(&found["level_variances"]["anova_df"][0], df, 1e-9);
    // R 4.2: df 11.117515275357, p 0.00228461762.
    close(&term["df"], 11.117515275357, 1e-9);
    close(&term["p"], 0.00228461762, 1e-8);
    for (level, (n, _, variance)) in moments.iter().enumerate() {
        let own = &found["level_variances"]["levels"][level];
        close(&own["sd"], variance.sqrt(), 1e-10);
        close(&own["df"], n - 1.0, 1e-9);
    }
}

/// nlme 3.1: `gls(y ~ x + g, weights = varIdent(form = ~ 1 | g))`, its marginal `anova`; its search
/// ends 1e-7 from the maximum.
#[test]
fn reference_three_variances_and_a_covariate() {
    let options = ["--formula", "y ~ x + g", "--variance", "g"];
    let found = json(GROUPS, &[&options[..], &["--anova", "3"]].concat());
    let estimates = [
        2.168343387641962,
        0.161425698768963,
        2.857861451846557,
        3.632242978759431,
    ];
    all_close(&column(&found["terms"], "estimate"), &estimates, 1e-7);
    let errors = [
        0.3870656620010204,
        0.0626104268426343,
        0.8242439798431273,
        0.3665575891369585,
    ];
    all_close(&column(&found["terms"], "se"), &errors, 1e-7);
    close(&found["log_likelihood"], -29.0870705011263, 1e-11);
    let sds = [0.781533199755193, 2.262483304670702, 0.325856202918964];
    all_close(
        &column(&found["level_variances"]["levels"], "sd"),
        &sds,
        1e-6,
    );
    let f = [6.6474031861341, 49.1177953347954];
    all_close(&column(&found["anova"], "f"), &f, 1e-6);
}

/// nlme 3.1: `lme(y ~ V + variety, random = ~ 1 | fruit, weights = varIdent(form = ~ 1 | variety))`;
/// degrees of freedom and Kenward and Roger's errors from the rows' covariance matrix
/// (`bench/mixed_levels_reference.R`).
#[test]
fn reference_variances_by_level_beside_random_effects() {
    let options = ["--formula", "y ~ V + variety + (1 | fruit)", "--variance"];
    let options = [&options[..], &["variety"]].concat();
    let found = json(FRUIT, &options);
    let estimates = [2.885659962213886, 4.971099881471027, -0.292014243289222];
    all_close(&column(&found["terms"], "estimate"), &estimates, 1e-7);
    let errors = [0.442437238437414, 0.408519865651464, 0.609101794075712];
    all_close(&column(&found["terms"], "se"), &errors, 1e-7);
    let df = [6.06265851631078, 8.35844513933398, 5.64348331495878];
    all_close(&column(&found["terms"], "df"), &df, 1e-5);
    close(&found["log_likelihood"], -18.446852117155, 1e-10);
    let sds = [0.816623357299883, 0.233545637974092, 0.589456734391988];
    all_close(&column(&found["variances"], "value"), &sds, 1e-6);
    let of = column(&found["variances"], "of");
    assert_eq!(of, ["(Intercept)", "Fuji", "Gala"]);
    let test = &found["level_variances"]["test"];
    close(&test["statistic"], 4.13380227851896, 1e-6);
    assert_eq!(test["df"], 1);
    assert_eq!(found["level_variances"]["by"], "variety");
    let rows = &found["level_variances"]["rows"];
    assert_eq!(*rows, serde_json::json!([["Fuji", 11], ["Gala", 11]]));
    let adjusted = [
        &options[..],
        &["--df", "kenward-roger", "--means", "variety"],
    ]
    .concat();
    let adjusted = json(FRUIT, &adjusted);
    let errors = [0.44703724896651, 0.442387854051788, 0.609274538086426];
    all_close(&column(&adjusted["terms"], "se"), &errors, 1e-6);
    let df = [6.66640918737592, 8.32873675772476, 6.08717248801947];
    all_close(&column(&adjusted["terms"], "df"), &df, 1e-6);
    // emmeans of the fit by nlme.
    let means = json(FRUIT, &[&options[..], &["--means", "variety"]].concat());
    let own = &means["means"][0]["means"];
    all_close(&column(own, "mean"), &[4.840206, 4.548192], 1e-6);
    all_close(&column(own, "se"), &[0.414562, 0.4462177], 1e-6);
}

/// Whether means are equal is one question beside random effects, too.
#[test]
fn conserves_the_test_of_a_term_beside_random_effects() {
    let options = [
        "--formula",
        "y ~ g + (1 | x)",
        "--variance",
        "g",
        "--means",
        "g",
    ];
    let found = json(GROUPS, &options);
    let expected = found["anova"][0]["df_denominator"].as_f64().unwrap();
    for other in [&[][..], &["--levels", "g=c,a,b"], &["--contrasts", "sum"]] {
        let found = json(GROUPS, &[&options[..], other].concat());
        close(&found["anova"][0]["df_denominator"], expected, 1e-6);
        let test = &found["means"][0]["tests"][0];
        close(&test["df_denominator"], expected, 1e-6);
    }
}

/// A further impact on a fruit that was not struck scatters as its variety does.
#[test]
fn predicts_impacts_with_the_variance_of_their_level() {
    let options = ["--formula", "y ~ V + variety + (1 | fruit)", "--variance"];
    let options = [&options[..], &["variety"]].concat();
    let found = json(FRUIT, &[&options[..], &["--predict", "t.csv"]].concat());
    let width = |row: usize| {
        let own = &found["predictions"][row];
        own["high"].as_f64().unwrap() - own["low"].as_f64().unwrap()
    };
    // Fruit a and e at nearly the same velocity.
    assert!(width(0) > 1.7 * width(11), "{} {}", width(0), width(11));
    let one = json(FRUIT, &["--formula", options[1]]);
    assert!(one["level_variances"].is_null());
}

#[test]
fn says_what_is_wrong_with_variances_by_level_beside_random_effects() {
    let options = ["--formula", "y ~ V + (1 | fruit)", "--variance"];
    let with = |column: &'static str, more: &[&'static str]| {
        let all = [&options[..], &[column], more].concat();
        refused(FRUIT, &all)
    };
    let told = with("colour", &[]);
    assert!(told.contains("colour"), "{told}");
    for more in [
        &["--robust"][..],
        &["--select", "backward"],
        &["--weights", "V"],
    ] {
        let told = with("variety", more);
        assert!(
            told.contains("--variance") || told.contains(more[0]),
            "{told}"
        );
    }
    // The same words with backticks, as in formulas.
    let plain = json(FRUIT, &[&options[..], &["variety"]].concat());
    let quoted = json(FRUIT, &[&options[..], &["`variety`"]].concat());
    assert_eq!(plain["level_variances"], quoted["level_variances"]);
    let told = with("V", &[]);
    assert!(
        told.contains("V holds 20 different numbers in 22 rows"),
        "{told}"
    );
    let one = FRUIT.replace("Gala", "Fuji");
    let told = refused(&one, &[&options[..], &["variety"]].concat());
    assert!(told.contains("have the same variety"), "{told}");
    // Only the prediction needs the level that is missing; no figure is written before.
    let table = FRUIT.replace("y\nGala", "y\n,z,0.3,NA\nGala");
    let asked = [
        &options[..],
        &["variety", "--predict", "t.csv", "--figures", "fig"],
    ]
    .concat();
    let told = refused(&table, &asked);
    assert!(told.contains("line 2: variety is missing"), "{told}");
    // Each fruit has a slope of its own for two or three impacts.
    let own = [
        "--formula",
        "y ~ fruit*V + (1 | variety)",
        "--variance",
        "fruit",
    ];
    let told = refused(FRUIT, &own);
    assert!(told.contains("coefficients of its own"), "{told}");
}

/// With a mean for each level, a further observation of one of n rows lies within
/// t s √(1 + 1/n) of its mean, t with n - 1 degrees of freedom (`qt(0.975, n - 1)` in R).
#[test]
fn closed_form_observations_scatter_as_their_level() {
    let options = ["--formula", "y ~ g", "--variance", "g"];
    let found = json(GROUPS, &[&options[..], &["--predict", "t.csv"]].concat());
    let quantiles = [2.570581835636314, 2.306004135204166, 2.776445105197799];
    for (level, (row, t)) in [0, 6, 15].into_iter().zip(quantiles).enumerate() {
        let own = &found["level_variances"]["levels"][level];
        let (n, sd) = (own["rows"].as_f64().unwrap(), own["sd"].as_f64().unwrap());
        let own = &found["predictions"][row];
        let width = own["high"].as_f64().unwrap() - own["low"].as_f64().unwrap();
        let expected = 2.0 * t * sd * (1.0 + 1.0 / n).sqrt();
        assert!((width / expected - 1.0).abs() < 1e-9, "{width} {expected}");
    }
}

/// Whether means are equal is one question, however categories are coded.
#[test]
fn conserves_the_test_of_a_term_under_other_contrasts() {
    let options = ["--formula", "y ~ x + g", "--variance", "g", "--means", "g"];
    let found = json(GROUPS, &options);
    let expected = found["level_variances"]["anova_df"][1].as_f64().unwrap();
    for other in [
        &["--contrasts", "sum"][..],
        &["--anova", "3"],
        &["--levels", "g=c,b,a"],
    ] {
        let found = json(GROUPS, &[&options[..], other].concat());
        close(&found["level_variances"]["anova_df"][1], expected, 1e-8);
        close(
            &found["means"][0]["tests"][0]["df_denominator"],
            expected,
            1e-8,
        );
    }
}

#[test]
fn rejects_what_tells_no_weight_or_variance() {
    let with = |n: &str| DENTS.replace("Gala,b,0.3,1,", &format!("Gala,b,0.3,{n},"));
    for (n, says) in [("0", "is 0 in row 3"), ("-2", "is -2 in row 3")] {
        for formula in ["depth ~ V", "depth ~ V + (1 | fruit)"] {
            let told = refused(&with(n), &["--formula", formula, "--weights", "n"]);
            assert!(told.contains("line 4") && told.contains(says), "{told}");
        }
    }
    let left_out = json(&with(""), &["--formula", "depth ~ V", "--weights", "n"]);
    assert_eq!(left_out["left_out"], 1);
    let one = GROUPS.to_owned() + "d,3,5\n";
    let flat = "g,y\na,1\na,1\na,1\nb,3\nb,4\nb,3.3\n";
    let own = "g,x,y\na,1,1\na,2,3\nb,1,2\nb,2,4\nb,3,5\nb,4,9\n";
    let saturated = ["--formula", "y ~ g*x", "--variance", "g"];
    let plain = ["--formula", "y ~ g", "--variance", "g"];
    for (table, arguments, says) in [
        (one.as_str(), plain, "\"d\" has one row"),
        (flat, plain, "\"a\" has no scatter"),
        (own, saturated, "\"a\" has coefficients of its own"),
    ] {
        let told = refused(table, &arguments);
        assert!(told.contains(says), "{told}");
    }
    for other in [
        &["--robust"][..],
        &["--select", "backward"],
        &["--weights", "x"],
        &["--fold-by", "x"],
    ] {
        let told = refused(GROUPS, &[&plain[..], other].concat());
        assert!(told.contains("--variance"), "{told}");
    }
}
