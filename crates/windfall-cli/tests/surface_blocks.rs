//! `windfall surface` of runs that were made in blocks.

#![allow(clippy::unwrap_used)]

use crate::on_table;
use serde_json::Value;

/// Flight times of paper helicopters in s/100, in two blocks (Box and Draper 2007, Response
/// Surfaces, Mixtures, and Ridge Analyses, 2nd ed., table 12.5).
const HELICOPTERS: &str = "\
block,x1,x2,x3,x4,ave\n1,-1,-1,-1,-1,367\n1,1,-1,-1,-1,369\n1,-1,1,-1,-1,374\n\
1,1,1,-1,-1,370\n1,-1,-1,1,-1,372\n1,1,-1,1,-1,355\n1,-1,1,1,-1,397\n\
1,1,1,1,-1,377\n1,-1,-1,-1,1,350\n1,1,-1,-1,1,373\n1,-1,1,-1,1,358\n\
1,1,1,-1,1,363\n1,-1,-1,1,1,344\n1,1,-1,1,1,355\n1,-1,1,1,1,370\n\
1,1,1,1,1,362\n1,0,0,0,0,377\n1,0,0,0,0,375\n2,-2,0,0,0,361\n\
2,2,0,0,0,364\n2,0,-2,0,0,355\n2,0,2,0,0,373\n2,0,0,-2,0,361\n\
2,0,0,2,0,360\n2,0,0,0,-2,380\n2,0,0,0,2,360\n2,0,0,0,0,370\n\
2,0,0,0,0,368\n2,0,0,0,0,369\n2,0,0,0,0,366\n";

/// Yield of a reaction, in two blocks of which only the second has the axial runs (Myers,
/// Montgomery and Anderson-Cook 2009, Response Surface Methodology, 3rd ed., table 7.6).
const REACTION: &str = "\
Time,Temp,Block,Yield\n80,170,B1,80.5\n80,180,B1,81.5\n90,170,B1,82\n\
90,180,B1,83.5\n85,175,B1,83.9\n85,175,B1,84.3\n85,175,B1,84\n\
85,175,B2,79.7\n85,175,B2,79.8\n85,175,B2,79.5\n92.07,175,B2,78.4\n\
77.93,175,B2,75.6\n85,182.07,B2,78.5\n85,167.93,B2,77\n";

pub const SURFACE: [&str; 2] = ["surface", "t.csv"];

fn json(table: &str, arguments: &[&str]) -> Value {
    on_table::json(table, &[&SURFACE[..], arguments].concat())
}

fn close(found: &Value, expected: f64) {
    on_table::close(found, expected, 1e-8);
}

const OF_HELICOPTERS: [&str; 18] = [
    "--response",
    "ave",
    "--factor",
    "x1",
    "--factor",
    "x2",
    "--factor",
    "x3",
    "--factor",
    "x4",
    "--range",
    "x1=-1..1",
    "--range",
    "x2=-1..1",
    "--range",
    "x3=-1..1",
    "--range",
    "x4=-1..1",
];
pub const OF_REACTION: [&str; 10] = [
    "--response",
    "Yield",
    "--factor",
    "Time",
    "--factor",
    "Temp",
    "--range",
    "Time=80..90",
    "--range",
    "Temp=170..180",
];

/// Against rsm 2.10 in R 4.2 (`ave ~ block + SO(x1, x2, x3, x4)`).
#[test]
fn reference_helicopters_in_two_blocks() {
    let found = json(HELICOPTERS, &OF_HELICOPTERS);
    let codes = found["findings"].as_array().unwrap().iter();
    assert!(codes.map(|own| &own["code"]).any(|own| own == "blocks"));
    let model = &found["responses"][0];
    close(&model["lack_of_fit"]["lack"]["f"], 4.6660465116279);
    close(&model["lack_of_fit"]["lack"]["p"], 0.07550030300604);
    close(&model["residual"]["ss"], 136.15);
    close(&model["model"]["ss"], 2906.54444444444);
    close(&model["blocks"]["ss"], 3059.5 - 3042.69444444444);
    close(&model["blocks"]["effects"][0]["effect"], 2.95 / 2.0);
    // The surface at the mean of the blocks; rsm shows that of the first.
    close(&model["terms"][0]["coded"], 372.8 - 2.95 / 2.0);
    let stationary = [
        0.86071070909519,
        -0.33071152487393,
        -0.83948662421018,
        -0.11614651472104,
    ];
    for (own, expected) in model["canonical"]["coded"]
        .as_array()
        .unwrap()
        .iter()
        .zip(stationary)
    {
        close(own, expected);
    }
    // Without blocks the difference between them is in the residuals.
    let none = [&OF_HELICOPTERS[..], &["--block", "none"]].concat();
    let plain = json(HELICOPTERS, &none);
    assert_eq!(plain["responses"][0]["blocks"], Value::Null);
    let residual = |own: &Value| own["responses"][0]["residual"]["ss"].as_f64().unwrap();
    assert!(residual(&plain) > residual(&found) + 10.0);
}

/// Against rsm 2.10 in R 4.2 (`Yield ~ Block + SO(x1, x2)`).
#[test]
fn reference_reaction_in_two_blocks() {
    let found = json(
        REACTION,
        &[&OF_REACTION[..], &["--block", "Block"]].concat(),
    );
    let model = &found["responses"][0];
    close(&model["residual"]["ss"], 0.186404553354278);
    close(&model["model"]["ss"], 27.6657142857143 - 0.186404553354278);
    close(&model["lack_of_fit"]["lack"]["ss"], 0.0530712200209);
    close(&model["lack_of_fit"]["pure_error"]["ss"], 0.4 / 3.0);
    close(
        &model["terms"][0]["coded"],
        84.0954272034500 - 4.4575297618726 / 2.0,
    );
    close(&model["canonical"]["coded"][0], 0.372295397461);
    close(&model["canonical"]["coded"][1], 0.334380203386);
}

#[test]
fn rejects_blocks_that_are_none() {
    let one = REACTION.replace("B2", "B1");
    let own: String = REACTION
        .lines()
        .enumerate()
        .map(|(run, line)| {
            line.replace("B1", &format!("{run}"))
                .replace("B2", &format!("{run}"))
                + "\n"
        })
        .collect();
    for (table, column, said) in [
        (&one[..], "Block", "all runs are in one block"),
        (&own[..], "Block", "in a block of its own"),
        (REACTION, "Day", "there is no column \"Day\""),
        (REACTION, "Time", "is a factor or a response"),
    ] {
        let (status, _, told) = on_table::run(
            table,
            &[&SURFACE[..], &OF_REACTION[..], &["--block", column]].concat(),
        );
        assert_eq!(status, Some(2), "{column}: {told}");
        assert!(told.contains(said), "{column}: {told}");
    }
}

/// A term that is the difference between the blocks has no estimate, and that is said.
#[test]
fn says_what_blocks_hide() {
    let table = "block,a,b,y\n1,-1,-1,1\n2,1,-1,3\n2,-1,1,2.5\n1,1,1,5\n1,-1,-1,1.1\n2,1,-1,3.1\n\
                 2,-1,1,2.4\n1,1,1,5.1\n";
    let arguments = [
        "--response",
        "y",
        "--factor",
        "a",
        "--factor",
        "b",
        "--model",
        "A + B + AB",
    ];
    let found = json(table, &arguments);
    let findings = found["findings"].as_array().unwrap();
    let aliased = findings
        .iter()
        .find(|own| own["code"] == "aliased")
        .unwrap();
    let told = aliased["message"].as_str().unwrap();
    assert!(
        told.contains("AB has no estimate") && told.contains("block[1]"),
        "{told}"
    );
}

/// Correlated factors, where the types of analysis part ways.
const CORRELATED: &str = "\
A,B,y\n-1,-0.8,10.2\n-0.6,-0.2,12.9\n-0.9,0.1,12.1\n0.2,0.4,15.8\n0.5,0.9,14.1\n\
0.8,0.3,16.9\n1,1,14.6\n0.1,-0.5,14.4\n-0.2,0.6,13.9\n0.7,0.8,15.2\n-0.5,-1,10.8\n0.3,0,16.1\n";

/// Against models with and without the term, but for those that contain it (R 4.2, `deviance` of
/// `lm`), over the residuals of all terms.
#[test]
fn reference_hierarchical_tests_of_correlated_factors() {
    let factors = ["--response", "y", "--factor", "A", "--factor", "B"];
    let ranges = ["--range", "A=-1..1", "--range", "B=-1..1"];
    let found = json(
        CORRELATED,
        &[&factors[..], &ranges, &["--anova", "2"]].concat(),
    );
    let terms = found["responses"][0]["terms"].as_array().unwrap();
    for (own, (name, ss, f, p)) in terms[1..].iter().zip([
        (
            "A",
            19.5087553306059,
            225.514317012656,
            5.49334363006765e-06,
        ),
        ("B", 0.477749721310728, 5.52261793633502, 0.0570564852823879),
        (
            "AB",
            0.0579274832144119,
            0.66962123374759,
            0.444459535466337,
        ),
        (
            "A^2",
            0.360417933449307,
            4.16630393500399,
            0.0873049517520193,
        ),
        (
            "B^2",
            3.13635447407061,
            36.2551492980181,
            0.000946820598764744,
        ),
    ]) {
        assert_eq!(own["term"], name);
        close(&own["ss"], ss);
        close(&own["f"], f);
        close(&own["p"], p);
    }
}
