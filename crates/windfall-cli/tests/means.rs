//! Marginal means of `windfall regress`.

#![allow(clippy::unwrap_used)]

use crate::on_table::{self, close};
use serde_json::Value;

const FRUIT: &str = "variety,dose,v,k\nFuji,low,0.1,31.2\nFuji,high,0.3,35.1\nFuji,high,0.5,36.4\n\
    Gala,low,0.2,34\nGala,low,0.4,35.9\nGala,high,0.1,36.2\nGala,high,0.6,40.1\n\
    Idared,low,0.3,38.3\nIdared,low,0.5,39.9\nIdared,high,0.2,41\nIdared,low,0.4,38.8\n";

const REGRESS: [&str; 4] = ["regress", "t.csv", "--folds", "0"];

fn run(table: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    on_table::run(table, &[&REGRESS[..], arguments].concat())
}

fn json(table: &str, arguments: &[&str]) -> Value {
    on_table::json(table, &[&REGRESS[..], arguments].concat())
}

/// Against emmeans 1.8.4 in R 4.2, `k ~ variety * dose + v`; Tukey's p against SciPy 1.17, as R's
/// `ptukey` is off by 5e-6 here.
#[test]
fn reference_means_of_an_unbalanced_table() {
    let formula = ["--formula", "k ~ variety*dose + v", "--means", "variety"];
    let found = json(FRUIT, &formula);
    let means = &found["means"][0];
    assert_eq!(means["at"][0][0], "v");
    // Mean, standard error, ends of the interval.
    let expected = [
        (
            36.567874692875,
            0.097351988621488,
            36.297582240585,
            36.838167145164,
        ),
        (
            40.214496314496,
            0.11308198659796,
            39.90053038632,
            40.528462242672,
        ),
    ];
    for (own, (mean, se, low, high)) in means["means"].as_array().unwrap()[1..].iter().zip(expected)
    {
        close(&own["mean"], mean, 1e-12);
        close(&own["se"], se, 1e-11);
        close(&own["low"], low, 1e-12);
        close(&own["high"], high, 1e-12);
    }
    let expected = [
        (
            2.4851351351351,
            0.15761791648409,
            15.766831528863,
            0.00021119186248541588,
        ),
        (
            6.1317567567568,
            0.16541432033032,
            37.069080503501,
            7.081249057683259e-06,
        ),
        (
            3.6466216216216,
            0.14912929051173,
            24.452752434538,
            3.7138281393289674e-05,
        ),
    ];
    let differences = means["differences"].as_array().unwrap();
    assert_eq!(differences[0]["contrast"], "Gala - Fuji");
    for (own, (difference, se, t, p)) in differences.iter().zip(expected) {
        close(&own["difference"], difference, 1e-11);
        close(&own["se"], se, 1e-11);
        close(&own["t"], t, 1e-11);
        close(&own["p"], p, 1e-8);
    }
    close(&differences[0]["low"], 1.9233866513438, 1e-7);
    close(&differences[0]["high"], 3.0468836189265, 1e-7);
    let (_, text, _) = run(FRUIT, &formula);
    assert!(
        text.contains("Marginal means of variety at v 0.3273:"),
        "{text}"
    );
    assert!(text.contains("Differences (Tukey):"), "{text}");
}

#[test]
fn closed_form_means_as_csv() {
    let arguments = [
        "--formula",
        "k ~ variety",
        "--means",
        "variety",
        "--format",
        "csv",
    ];
    let (_, text, _) = run(FRUIT, &arguments);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "of,what,estimate,se,df,t,p,low,high,original,original_low,original_high"
    );
    assert!(lines[1].starts_with("variety,Fuji,34.2333333333"), "{text}");
    assert!(
        lines[4].starts_with("variety,Gala - Fuji,2.3166666666"),
        "{text}"
    );
    assert_eq!(lines.len(), 7);
}

/// Whatever the coding of the categories, means are the same.
#[test]
fn conserves_means_under_other_contrasts() {
    let of = |contrasts: &str| {
        let formula = "k ~ variety*dose + v";
        let arguments = [
            "--formula",
            formula,
            "--means",
            "dose,variety",
            "--contrasts",
            contrasts,
        ];
        json(FRUIT, &arguments)["means"][0].clone()
    };
    let (treatment, sum) = (of("treatment"), of("sum"));
    for (a, b) in treatment["means"]
        .as_array()
        .unwrap()
        .iter()
        .zip(sum["means"].as_array().unwrap())
    {
        assert_eq!(a["levels"], b["levels"]);
        close(&a["mean"], b["mean"].as_f64().unwrap(), 1e-10);
        close(&a["se"], b["se"].as_f64().unwrap(), 1e-10);
    }
}

#[test]
fn rejects_means_that_cannot_be_estimated() {
    // Fuji at a low dose is missing.
    for (table, arguments, said) in [
        (FRUIT, &["--means", "variety,"][..], "separated by commas"),
        (
            FRUIT,
            &["--means", "v"][..],
            "v is no category of the model: there are variety, dose",
        ),
        (FRUIT, &["--means", "variety,variety"], "stands there twice"),
        (
            FRUIT,
            &["--means", "variety", "--select", "backward"],
            "without --select",
        ),
        (
            FRUIT,
            &["--slopes", "variety"],
            "variety is no column of numbers of the model: there are v",
        ),
        (FRUIT, &["--slopes", "v,"], "V,dose | variety"),
        (FRUIT, &["--compare", "control"], "say --means or --slopes"),
        (
            FRUIT,
            &["--means", "dose", "--at", "variety=1"],
            "--at variety: variety is no column of numbers",
        ),
        (FRUIT, &["--means", "dose", "--at", "v=x"], "and its value"),
        (
            FRUIT,
            &["--means", "dose", "--at", "v=1", "--at", "v=2"],
            "held at another value",
        ),
        (
            FRUIT,
            &["--means", "dose", "--compare", "=1,-1"],
            "a name of its own",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "control=none"],
            "no row has it in variety: there are Fuji, Gala, Idared",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "polynomial"],
            "--levels 'variety=Fuji,Gala,Idared'",
        ),
        (
            FRUIT,
            &["--means", "variety,dose", "--compare", "polynomial"],
            "write 'dose | variety'",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "a = 1, -1"],
            "2 weights for 3 means, in this order: Fuji, Gala, Idared",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "a = 1, -1, 1"],
            "sum to 0, these to 1",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "a = 0, 0, 0"],
            "all weights are zero",
        ),
        (
            FRUIT,
            &["--means", "variety", "--compare", "all"],
            "expected pairs, control",
        ),
        (
            FRUIT,
            &[
                "--means",
                "variety",
                "--compare",
                "control",
                "--compare",
                "pairs",
            ],
            "one after another",
        ),
        (
            FRUIT,
            &[
                "--means",
                "variety",
                "--compare",
                "control",
                "--adjust",
                "tukey",
            ],
            "Tukey's is for all pairs",
        ),
    ] {
        let formula = ["--formula", "k ~ variety*dose + v"];
        let (status, _, told) = run(table, &[&formula[..], arguments].concat());
        assert_eq!(status, Some(2), "{arguments:?}: {told}");
        assert!(told.contains(said), "{arguments:?}: {told}");
    }
    let both = ["--formula", "k ~ C(v) + v", "--means", "v"];
    let (status, _, told) = run(FRUIT, &both);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("as a category and as a number"), "{told}");
    let rows = (0..303).map(|row| format!("f{},{}\n", row % 101, row * row % 17));
    let many = format!("id,k\n{}", rows.collect::<String>());
    let (status, _, told) = run(&many, &["--formula", "k ~ id", "--means", "id"]);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("there are 101 means"), "{told}");
}

/// Fuji at a low dose is missing: what rests on it is named and left out.
#[test]
fn detects_means_that_cannot_be_estimated() {
    let missing = FRUIT.replace("Fuji,low,0.1,31.2\n", "");
    let told = |found: &Value| {
        let findings = found["findings"].as_array().unwrap().iter();
        let own = findings.filter(|own| own["code"] == "not-estimable");
        own.map(|own| own["message"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let formula = ["--formula", "k ~ variety*dose + v"];
    let of = |arguments: &[&str]| json(&missing, &[&formula[..], arguments].concat());
    let found = of(&["--means", "variety"]);
    assert_eq!(found["means"][0]["means"].as_array().unwrap().len(), 2);
    assert_eq!(
        found["means"][0]["differences"][0]["contrast"],
        "Idared - Gala"
    );
    assert_eq!(
        found["means"][0]["differences"].as_array().unwrap().len(),
        1
    );
    assert_eq!(told(&found).len(), 1);
    assert!(
        told(&found)[0].contains("no mean of Fuji"),
        "{:?}",
        told(&found)
    );
    assert!(
        told(&found)[0].contains("depends on variety[Idared]:dose"),
        "{:?}",
        told(&found)
    );
    // A sum of one's own that needs the missing cell is named.
    let own = of(&["--means", "variety", "--compare", "Gala - Fuji = -1, 1, 0"]);
    assert_eq!(own["means"][0]["differences"].as_array().unwrap().len(), 0);
    assert!(
        told(&own)[1].contains("Gala - Fuji cannot be estimated"),
        "{:?}",
        told(&own)
    );
    // Over varieties the mean of a high dose needs no missing cell, that of a low one does.
    let found = of(&["--means", "dose", "--at", "v=0.2"]);
    assert_eq!(found["means"][0]["means"][0]["levels"][0], "high");
    assert_eq!(found["means"][0]["means"].as_array().unwrap().len(), 1);
    // Where each dose misses a variety, no mean over varieties is left.
    let none = missing.replace("Gala,high,0.1,36.2\nGala,high,0.6,40.1\n", "");
    let arguments = ["--formula", "k ~ variety*dose", "--means", "dose"];
    let (status, _, error) = run(&none, &arguments);
    assert_eq!(status, Some(2), "{error}");
    assert!(
        error.contains("the mean of high cannot be estimated"),
        "{error}"
    );
    // Without the interaction none does.
    let plain = ["--formula", "k ~ variety + dose + v", "--means", "variety"];
    let found = json(&missing, &plain);
    assert_eq!(found["means"][0]["means"].as_array().unwrap().len(), 3);
    assert!(told(&found).is_empty());
}

/// Against emmeans 1.8.4 in R 4.2; p of several t from mvtnorm 1.1 asked for six digits.
#[test]
fn reference_contrasts_with_a_control_slopes_and_ratios() {
    let control = json(
        FRUIT,
        &[
            "--formula",
            "log(k) ~ variety + v",
            "--means",
            "variety",
            "--compare",
            "control=Gala",
        ],
    );
    let means = &control["means"][0];
    assert_eq!(means["adjusted"], "Dunnett");
    assert_eq!(means["original"], "k");
    let scaled = &means["means"][1]["original"];
    close(&scaled["value"], 36.50310184323, 1e-11);
    close(&scaled["low"], 34.51020391662, 1e-11);
    close(&scaled["high"], 38.61108579355, 1e-11);
    let joint = [0.2377404069, 0.1138750902];
    for ((own, p), (name, difference, ratio)) in means["differences"]
        .as_array()
        .unwrap()
        .iter()
        .zip(joint)
        .zip([
            ("Fuji - Gala", -0.06016752429646, 0.9416067783576),
            ("Idared - Gala", 0.07341818766644, 1.0761804882331),
        ])
    {
        assert_eq!(own["contrast"], name);
        close(&own["difference"], difference, 1e-11);
        close(&own["p"], p, 1e-7);
        close(&own["ratio"]["value"], ratio, 1e-11);
    }
    close(&means["tests"][0]["p"], 0.02267285826826, 1e-11);
    let slopes = json(
        FRUIT,
        &["--formula", "k ~ variety*v", "--slopes", "v,variety"],
    );
    let slopes = slopes["means"][0]["means"].as_array().unwrap();
    for (own, (slope, se)) in slopes.iter().zip([
        (13.0, 5.661740963208),
        (8.983050847458, 4.169644019075),
        (-2.8, 7.161598786245),
    ]) {
        close(&own["mean"], slope, 1e-9);
        close(&own["se"], se, 1e-9);
    }
    let within = ["--formula", "k ~ variety*dose", "--means", "variety | dose"];
    let within = json(FRUIT, &[&within[..], &["--adjust", "holm"]].concat());
    let differences = within["means"][0]["differences"].as_array().unwrap();
    assert_eq!(differences[3]["within"][0], "low");
    for (own, p) in differences
        .iter()
        .zip([0.3517, 0.1120, 0.3517, 0.1006, 0.0204, 0.0665])
    {
        let found = own["p"].as_f64().unwrap();
        assert!((found - p).abs() < 5e-5, "{own}");
    }
}

/// An end that no value leads to is open, and no sign is made up.
#[test]
fn detects_responses_that_do_not_lead_back() {
    let means = |formula: &str| {
        let found = json(FRUIT, &["--formula", formula, "--means", "dose"]);
        found["means"][0].clone()
    };
    let open = means("exp(-8*v) ~ dose");
    let own = &open["means"][0];
    let (low, value) = (own["low"].as_f64().unwrap(), own["mean"].as_f64().unwrap());
    assert!(low < 0.0, "{own}");
    close(&own["original"]["value"], -value.ln() / 8.0, 1e-12);
    let high = own["high"].as_f64().unwrap();
    close(&own["original"]["low"], -high.ln() / 8.0, 1e-12);
    assert_eq!(own["original"]["high"], Value::Null);
    // Squares of both signs.
    assert_eq!(means("(v - 0.3)^2 ~ dose")["original"], Value::Null);
    let line = means("k * 1000 ~ dose");
    assert_eq!(line["meaning"], "k of a mean of k * 1000 is its mean");
}

/// Fits without noise are said to be so, and end.
#[test]
fn detects_exact_fits() {
    let table = "a,y\np,1\np,1\np,1\nq,2\nq,2\nq,2\nr,4\nr,4\nr,4\n";
    let found = json(table, &["--formula", "y ~ a", "--means", "a"]);
    let codes = found["findings"].as_array().unwrap().iter();
    assert!(codes.map(|own| &own["code"]).any(|own| own == "exact-fit"));
    assert_eq!(found["means"][0]["means"][2]["mean"], 4.0);
}

/// `v` runs from 0.1 to 0.6.
#[test]
fn detects_means_outside_of_the_rows() {
    for (at, outside) in [("v=0.6", false), ("v=0.61", true)] {
        let formula = ["--formula", "k ~ dose + v", "--means", "dose", "--at", at];
        let found = json(FRUIT, &formula);
        let mut codes = found["findings"].as_array().unwrap().iter();
        let told = codes.find(|own| own["code"] == "extrapolated");
        assert_eq!(told.is_some(), outside, "{at}");
        if let Some(told) = told {
            let message = told["message"].as_str().unwrap();
            assert!(message.contains("v (rows have 0.1"), "{message}");
        }
    }
}

/// A column far from zero, in models of either kind.
#[test]
fn detects_columns_far_from_zero() {
    let mut table = "g,x,y\n".to_owned();
    for row in 0..24 {
        let x = 1e8 + f64::from(row * 7 % 24);
        let y = f64::from(row % 4) + 0.1 * f64::from(row * row % 7);
        table += &format!("g{},{x},{y}\n", row % 4);
    }
    for random in [&[][..], &["--random", "g"]] {
        let found = on_table::json(
            &table,
            &[&["regress", "t.csv", "--formula", "y ~ x"], random].concat(),
        );
        let mut codes = found["findings"].as_array().unwrap().iter();
        assert!(
            codes.any(|own| own["code"] == "ill-conditioned"),
            "{random:?}"
        );
    }
}
