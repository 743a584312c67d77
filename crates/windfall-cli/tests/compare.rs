//! Group summaries and comparisons from the command line.

#![allow(clippy::unwrap_used, clippy::excessive_precision)]

use assert_cmd::Command;
use std::path::PathBuf;

struct Run {
    code: i32,
    text: String,
    error: String,
}

fn windfall(arguments: &[&str]) -> Run {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run {
        code: output.status.code().unwrap(),
        text: text(output.stdout),
        error: text(output.stderr),
    }
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let run = windfall(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&run.text).unwrap_or_else(|_| panic!("{}", run.error))
}

/// Three groups of 7, 7 and 5 values, one value missing, one row without group.
const TABLE: &str = "# comment
variety,tree,firmness_N
a,1,9.1\na,2,10.4\na,3,8.7\na,4,11.2\na,5,9.9\na,6,10.8\na,7,9.5
b,1,11.0\nb,2,12.9\nb,3,9.2\nb,4,13.1\nb,5,12.0\nb,6,10.1\nb,7,12.6
d,1,8.2\nd,2,14.9\nd,3,6.1\nd,4,12.7\nd,5,5.3\nd,6,NA\n,8,7.0
";

fn table(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

#[track_caller]
fn check(found: &serde_json::Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().unwrap();
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} against {expected}: {error:e}");
}

fn codes(outcome: &serde_json::Value) -> Vec<&str> {
    let findings = outcome["findings"].as_array().unwrap();
    findings
        .iter()
        .map(|f| f["code"].as_str().unwrap())
        .collect()
}

/// Expected: R 4.2.2: aov, oneway.test, leveneTest (car), bartlett.test, TukeyHSD.
#[test]
fn reference_comparison_of_three_groups() {
    let (_folder, path) = table(TABLE);
    let path = path.to_str().unwrap();
    let found = json(&["compare", path, "--value", "firmness_N", "--by", "variety"]);
    check(&found["anova"]["between_ss"], 15.44318796992483200, 1e-12);
    check(&found["anova"]["f"], 1.39274801965360839, 1e-12);
    check(&found["welch"]["p"], 0.11798011218317775, 1e-11);
    check(&found["levene"]["f"], 14.498304472557875, 1e-12);
    check(&found["brown_forsythe"]["p"], 0.020259672868085429, 1e-11);
    check(&found["bartlett"]["statistic"], 11.238876692588146, 1e-12);
    let pairs = found["pairs"].as_array().unwrap();
    check(&pairs[0]["p"], 0.42470252840093137, 1e-8);
    check(&pairs[2]["difference"], -2.11714285714285744, 1e-12);
    assert_eq!(codes(&found), ["missing", "ungrouped", "unequal-variances"]);
    let letters: Vec<&str> = (0..3)
        .map(|i| found["groups"][i]["letters"].as_str().unwrap())
        .collect();
    assert_eq!(letters, ["a", "a", "a"]);
}

/// Expected: R 4.2.2, t.test(paired = TRUE), t.test(var.equal = TRUE), t.test.
#[test]
fn reference_two_groups_are_t_tests() {
    let (_folder, path) = table(TABLE);
    let path = path.to_str().unwrap();
    let start = ["compare", path, "--value", "firmness_N", "--by", "variety"];
    let two: String = TABLE
        .lines()
        .filter(|l| !l.starts_with("d,"))
        .fold(String::new(), |text, line| text + line + "\n");
    let (_folder, two) = table(&two);
    let two = two.to_str().unwrap();
    let paired = json(&[
        "compare",
        two,
        "--value",
        "firmness_N",
        "--by",
        "variety",
        "--paired",
        "tree",
    ]);
    assert_eq!(paired["method"], "paired t test");
    check(&paired["pairs"][0]["statistic"], 3.31019332708834746, 1e-12);
    check(&paired["pairs"][0]["p"], 0.01620084059798220, 1e-12);
    check(&paired["pairs"][0]["low"], 0.42099745130254396, 1e-11);
    assert_eq!(paired["pairs"][0]["n_pairs"], 7);
    assert_eq!(paired["groups"][0]["letters"], "b");
    // a against d
    let rest: String = TABLE
        .lines()
        .filter(|l| !l.starts_with("b,"))
        .fold(String::new(), |text, line| text + line + "\n");
    let (_folder, rest) = table(&rest);
    let rest = rest.to_str().unwrap();
    let start_rest = ["compare", rest, "--value", "firmness_N", "--by", "variety"];
    let student = json(&start_rest);
    check(&student["pairs"][0]["p"], 0.76066158834656583, 1e-12);
    let welch = json(&[&start_rest[..], &["--pairs", "games-howell"]].concat());
    assert_eq!(welch["method"], "Welch's t test");
    check(&welch["pairs"][0]["p"], 0.80413793572269776, 1e-12);
    // three groups of the same trees: pairs by Holm, and a hint at mixed models
    let three = json(&[&start[..], &["--paired", "tree"]].concat());
    assert!(codes(&three).contains(&"mixed-model") && codes(&three).contains(&"unpaired"));
}

#[test]
fn closed_form_summary_of_groups() {
    let (_folder, path) = table("g,h,k\nx,1,1\nx,1,2\nx,2,3\ny,1,4\ny,1,\n");
    let path = path.to_str().unwrap();
    let found = json(&["summary", path, "--by", "g,h", "--value", "k"]);
    let groups = found["values"][0]["groups"].as_array().unwrap();
    let names: Vec<&str> = groups
        .iter()
        .map(|g| g["group"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["x, 1", "x, 2", "y, 1"]);
    check(&groups[0]["mean"], 1.5, 1e-15);
    check(&groups[0]["sd"], 0.5_f64.sqrt(), 1e-15);
    // Student's t of one degree of freedom at 0.975: tan(0.475 π)
    let t = (0.475 * std::f64::consts::PI).tan();
    check(&groups[0]["high"], 1.5 + 0.5 * t, 1e-12);
    assert!(groups[1]["sd"].is_null());
    assert_eq!(groups[2]["missing"], 1);
    let csv = windfall(&[
        "summary", path, "--by", "g,h", "--value", "k", "--format", "csv",
    ]);
    assert!(
        csv.text.starts_with("value,g,h,n,missing,mean,sd,cv,"),
        "{}",
        csv.text
    );
    assert_eq!(csv.text.lines().count(), 4);
    let text = windfall(&["summary", path]).text;
    assert!(
        text.contains("median") && text.contains("95 % interval"),
        "{text}"
    );
}

/// Repeats of one fruit are not independent values: said, or averaged.
#[test]
fn rejects_repeats_as_independent_values() {
    let (_folder, path) =
        table("variety,fruit,k\na,1,1\na,1,1.1\na,2,2\na,2,2.1\nb,3,4\nb,3,4.1\nb,4,5\nb,4,5.1\n");
    let path = path.to_str().unwrap();
    let start = ["compare", path, "--value", "k", "--by", "variety"];
    let naive = json(&start);
    assert!(codes(&naive).contains(&"repeated-specimens"));
    let honest = json(&[&start[..], &["--specimen", "fruit"]].concat());
    assert_eq!(codes(&honest)[0], "averaged");
    assert_eq!(honest["groups"][0]["n"], 2);
    assert_eq!(honest["anova"]["within_df"], 2.0);
    let p = |outcome: &serde_json::Value| outcome["pairs"][0]["p"].as_f64().unwrap();
    assert!(p(&honest) > p(&naive));
}

#[test]
fn closed_form_agreement_with_its_caveat() {
    let (_folder, path) = table("o,p\n1,1\n2,2\n3,4\n,5\n");
    let path = path.to_str().unwrap();
    let start = [
        "compare",
        path,
        "--measured",
        "o",
        "--predicted",
        "p",
        "--parameters",
        "1",
    ];
    let found = json(&start);
    check(&found["chi_squared"], 0.25, 1e-15);
    check(&found["reduced_chi_squared"], 0.5, 1e-15);
    check(&found["r2"], 0.5, 1e-15);
    check(&found["rmse"], (1.0_f64 / 3.0).sqrt(), 1e-15);
    let text = windfall(&start).text;
    assert!(
        text.contains("an index of distance and not a test"),
        "{text}"
    );
}

#[test]
fn rejects_wrong_requests() {
    let (_folder, path) = table(TABLE);
    let path = path.to_str().unwrap();
    for (arguments, expected) in [
        (
            vec!["--value", "firmness", "--by", "variety"],
            "did you mean \"firmness_N\"?",
        ),
        (vec!["--value", "variety", "--by", "tree"], "holds text"),
        (vec!["--value", "firmness_N"], "--by <COLUMNS>"),
        (vec!["--measured", "firmness_N"], "--predicted <COLUMN>"),
        (
            vec![
                "--value",
                "firmness_N",
                "--by",
                "variety",
                "--confidence",
                "95",
            ],
            "--confidence is 95; a number between 0 and 1 is expected",
        ),
        (
            vec!["--value", "tree", "--by", "tree", "--paired", "variety"],
            "1 against 2: the samples compared",
        ),
    ] {
        let run = windfall(&[&["compare", path], &arguments[..]].concat());
        assert!(run.error.contains(expected), "{arguments:?}: {}", run.error);
        assert_eq!(run.code, 2, "{arguments:?}");
        assert!(run.text.is_empty());
    }
    let (_folder, one) = table("g,k\nx,1\nx,2\n");
    let run = windfall(&[
        "compare",
        one.to_str().unwrap(),
        "--value",
        "k",
        "--by",
        "g",
    ]);
    assert!(
        run.error.contains("a comparison needs at least two"),
        "{}",
        run.error
    );
}

/// A number of fruit is no group.
#[test]
fn rejects_more_groups_than_can_be_compared() {
    let rows = (0..2_002).map(|row| format!("f{},{}\n", row / 2, row % 7));
    let (_folder, path) = table(&format!("g,k\n{}", rows.collect::<String>()));
    let path = path.to_str().unwrap();
    let run = windfall(&["compare", path, "--value", "k", "--by", "g"]);
    assert_eq!(run.code, 2);
    assert!(run.error.contains("makes 1001 groups"), "{}", run.error);
    assert!(run.error.contains("--specimen"), "{}", run.error);
}
