//! Published values from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;

fn windfall(arguments: &[&str]) -> (bool, String, String) {
    let output = Command::cargo_bin("windfall")
        .unwrap()
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (
        output.status.success(),
        text(output.stdout),
        text(output.stderr),
    )
}

const SHOW: [&str; 3] = ["card", "show", "--library"];

/// The printed law is one that `simulate impact` takes.
#[test]
fn closed_form_a_published_law_is_simulated() {
    let (_, text, _) = windfall(&[&SHOW[..], &["jonagold-2003", "--format", "json"]].concat());
    let shown: serde_json::Value = serde_json::from_str(&text).unwrap();
    let law = shown["entries"][0]["law"].as_str().unwrap();
    let (_, text, error) = windfall(&[
        "simulate",
        "impact",
        "--law",
        law,
        "--mass",
        "0.2 kg",
        "--velocity",
        "0.5 m/s",
        "--format",
        "json",
    ]);
    let simulated: serde_json::Value = serde_json::from_str(&text).expect(&error);
    // the reference case of this law: 32.86620939 N
    let peak = simulated["peak_force"].as_f64().unwrap();
    assert!((peak / 32.86620939 - 1.0).abs() < 1e-8, "{peak}");
}

#[test]
fn closed_form_a_list_an_entry_and_a_table() {
    let (_, list, _) = windfall(&SHOW);
    assert!(list.contains("golden-delicious-regression"), "{list}");
    assert!(
        list.lines().all(|line| line.chars().count() <= 110),
        "{list}"
    );
    let at = [
        "golden-delicious-regression",
        "--at",
        "V=0.34, R=50 mm, t=6 ms",
    ];
    let (_, text, _) = windfall(&[&SHOW[..], &at].concat());
    assert!(
        text.contains("--law 'kuwabara-kono(k=812712.562592, c=2171.074317)'"),
        "{text}"
    );
    assert!(
        text.contains("caution:") && text.contains("source:"),
        "{text}"
    );
    let (_, csv, _) = windfall(&[&SHOW[..], &["--fruit", "tomato", "--format", "csv"]].concat());
    assert_eq!(csv.lines().count(), 4, "{csv}");
    assert!(csv.lines().nth(1).unwrap().contains("141326"), "{csv}");
}

#[test]
fn rejects_library_options_without_the_library() {
    let (fine, _, error) = windfall(&["card", "show", "--laws", "--fruit", "apple"]);
    assert!(!fine && error.contains("'--fruit <FRUIT>'"), "{error}");
    let (fine, _, error) = windfall(&["card", "show", "--fruit", "apple"]);
    assert!(!fine && error.contains("--library"), "{error}");
}
