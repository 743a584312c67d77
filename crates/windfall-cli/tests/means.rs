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
    assert_eq!(differences[0]["pair"], "Gala - Fuji");
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
    assert_eq!(lines[0], "of,what,estimate,se,df,t,p,low,high");
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
    let missing = FRUIT.replace("Fuji,low,0.1,31.2\n", "");
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
            &missing,
            &["--means", "variety"],
            "the mean of Fuji cannot be estimated",
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
    // Over varieties the mean of a dose needs the missing cell too; without the interaction
    // neither does.
    let plain = ["--formula", "k ~ variety + dose + v", "--means", "variety"];
    assert_eq!(
        json(&missing, &plain)["means"][0]["means"]
            .as_array()
            .unwrap()
            .len(),
        3
    );
}
