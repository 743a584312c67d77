//! `windfall regress` and `windfall surface` from the command line.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use std::path::PathBuf;

fn run(arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("windfall").unwrap();
    command.args(arguments).output().unwrap()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    let output = run(&[arguments, &["--format", "json"]].concat());
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {messages}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(value: &serde_json::Value, path: &str) -> f64 {
    let found = value.pointer(path).and_then(serde_json::Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {path}"))
}

fn close(found: f64, expected: f64, limit: f64) {
    assert!((found / expected - 1.0).abs() < limit, "{found} {expected}");
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) -> String {
        let path: PathBuf = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    }
}

/// Runs of the drop study as printed (Kang et al. 2023, Table 3).
const DROP_STUDY: &str = "run,k,e,C,force_N,interval_ms
1,1,2.25,3.5E-4,14.9,334\n2,0.44,1.8,2E-4,9.4,380\n3,0.65,2.25,6E-4,11.8,275
4,0.86,1.8,5E-4,11.2,310\n5,0.44,2.7,5E-4,13.6,282\n6,0.65,2.25,1E-4,13.6,385
7,0.44,1.8,5E-4,7.6,276\n8,0.3,2.25,3.5E-4,9.7,328\n9,0.86,2.7,2E-4,18.3,334
10,0.86,2.7,5E-4,15.1,287\n11,0.65,2.25,3.5E-4,13.1,326\n12,0.44,2.7,2E-4,14.3,362
13,0.65,1.5,3.5E-4,8.4,323\n14,0.65,3,3.5E-4,17.7,301\n15,0.86,1.8,2E-4,12.4,372
";

/// Values recomputed in exact coding by an independent program.
#[test]
fn reference_drop_study_through_the_command() {
    let folder = Folder::new();
    let table = folder.write("runs.csv", DROP_STUDY);
    let factors = ["--factor", "k", "--factor", "e", "--factor", "C"];
    let both = ["--response", "force_N", "--model", "A + B + C"];
    let interval = ["--response", "interval_ms", "--model", "A+B+C+AB+AC+BC+B^2"];
    let goals = [
        "--goal",
        "force_N = target 11.3",
        "--goal",
        "interval_ms = target 299",
    ];
    let asked = [&["surface", &table][..], &factors, &both, &interval, &goals].concat();
    let found = json(&asked);
    close(number(&found, "/press"), 5.884851647513279, 1e-8);
    close(number(&found, "/terms/2/coded"), 2.660984196, 1e-9);
    close(number(&found, "/terms/2/ss"), 96.7019573830742, 1e-8);
    close(
        number(&found, "/responses/1/r2_predicted"),
        0.9667526970275302,
        1e-8,
    );
    close(
        number(&found, "/responses/1/terms/7/f"),
        24.740676369279036,
        1e-8,
    );
    close(number(&found, "/family/to"), 0.95342, 1e-4);
    assert_eq!(number(&found, "/family/dimension"), 1.0);
    let held = json(&[&asked[..], &["--hold", "k=0.868"]].concat());
    close(number(&held, "/optimum/actual/1"), 1.9095231060188587, 1e-8);
    close(number(&held, "/optimum/actual/2"), 0.0005559867348, 1e-8);
    assert!(held["family"].is_null());
    let codes: Vec<&str> = found["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|finding| finding["code"].as_str().unwrap())
        .collect();
    assert!(codes.contains(&"rounded-levels") && codes.contains(&"not-unique"));
    // A grid for contours: 5 × 5 points, factors and two columns for each response.
    let grid = run(&[
        &asked[..],
        &["--grid", "k,C", "--grid-points", "5", "--format", "csv"],
    ]
    .concat());
    let text = String::from_utf8(grid.stdout).unwrap();
    assert_eq!(text.lines().count(), 26);
    assert_eq!(
        text.lines().next().unwrap(),
        "k,e,C,force_N,force_N_se,interval_ms,interval_ms_se"
    );
}

/// A design written by one command is read with its coding by the next.
#[test]
fn conserves_the_coding_from_design_to_surface() {
    let folder = Folder::new();
    let ranges = ["--factor", "k=0.3..1", "--factor", "e=1.5..3"];
    let output = run(&[&["design", "ccd"][..], &ranges].concat());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(
        run(&[&["design", "ccd"][..], &ranges, &["--format", "csv"]].concat()).stdout,
    )
    .unwrap();
    // A response that is a plane in coded units: 10 + 2 k - 3 e.
    let mut lines: Vec<String> = Vec::new();
    let mut header: Vec<String> = Vec::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        lines.push(match (line.starts_with('#'), header.is_empty()) {
            (true, _) => line.to_owned(),
            (false, true) => {
                header = cells.iter().map(|cell| (*cell).to_owned()).collect();
                format!("{line},y")
            }
            (false, false) => {
                let at = |name: &str| -> f64 {
                    let place = header.iter().position(|cell| cell == name).unwrap();
                    cells[place].parse().unwrap()
                };
                let bend = 1e-3 * (at("k_coded") * 7.0).sin();
                format!(
                    "{line},{}",
                    10.0 + 2.0 * at("k_coded") - 3.0 * at("e_coded") + bend
                )
            }
        });
    }
    let table = folder.write("runs.csv", &(lines.join("\n") + "\n"));
    let found = json(&["surface", &table, "--response", "y", "--model", "linear"]);
    assert_eq!(found["factors"][0]["name"], "k");
    close(number(&found, "/terms/1/coded"), 2.0, 1e-3);
    close(number(&found, "/terms/2/coded"), -3.0, 1e-9);
}

/// Order and probabilities of a backward elimination without hierarchy, as it is
/// told by hand from t² of a full model: y depends on a alone.
#[test]
fn closed_form_regression_selection_and_prediction() {
    let folder = Folder::new();
    let mut text = "a,b,y\n".to_owned();
    for i in 0..20 {
        let (a, b) = (f64::from(i), f64::from((i * 7) % 5));
        let wave = if i % 2 == 0 { 0.5 } else { -0.5 };
        text += &format!("{a},{b},{}\n", 3.0 + 2.0 * a + wave);
    }
    let table = folder.write("table.csv", &text);
    let selection = ["--select", "backward", "--p-remove", "0.05"];
    let asked = [
        "regress",
        &table,
        "--response",
        "y",
        "--terms",
        "a + b + a:b",
    ];
    let found = json(&[&asked[..], &selection].concat());
    assert_eq!(found["formula"], "y ~ 1 + a");
    assert_eq!(found["removed"].as_array().unwrap().len(), 2);
    // Slope of the wave on a: Σ (a - 9.5) w / Σ (a - 9.5)² = -5 / 665.
    close(
        number(&found, "/terms/1/estimate"),
        2.0 - 5.0 / 665.0,
        1e-12,
    );
    let new = folder.write("new.csv", "a,b\n100,1\n");
    let found = json(&[&asked[..4], &["--terms", "a", "--predict", &new]].concat());
    let slope = number(&found, "/terms/1/estimate");
    let intercept = number(&found, "/terms/0/estimate");
    close(
        number(&found, "/predictions/0/predicted"),
        intercept + 100.0 * slope,
        1e-12,
    );
}

/// Balanced one-way layout: the variance between groups is (MSB - MSW) / n.
#[test]
fn closed_form_mixed_model() {
    let folder = Folder::new();
    let mut text = "fruit,y\n".to_owned();
    let groups = [
        [1.0, 2.0, 3.0],
        [4.0, 6.0, 8.0],
        [2.0, 2.5, 3.0],
        [7.0, 8.0, 9.0],
    ];
    for (place, values) in groups.iter().enumerate() {
        values
            .iter()
            .for_each(|value| text += &format!("f{place},{value}\n"));
    }
    let table = folder.write("table.csv", &text);
    let found = json(&[
        "regress",
        &table,
        "--response",
        "y",
        "--terms",
        "1",
        "--random",
        "fruit",
    ]);
    let means = groups.map(|g| g.iter().sum::<f64>() / 3.0);
    let grand = means.iter().sum::<f64>() / 4.0;
    let between = means.iter().map(|m| (m - grand).powi(2)).sum::<f64>() * 3.0 / 3.0;
    let within = groups
        .iter()
        .zip(means)
        .flat_map(|(g, m)| g.map(|v| (v - m).powi(2)));
    let within = within.sum::<f64>() / 8.0;
    close(number(&found, "/variances/1/value").powi(2), within, 1e-7);
    close(
        number(&found, "/variances/0/value").powi(2),
        (between - within) / 3.0,
        1e-7,
    );
    close(number(&found, "/terms/0/df"), 3.0, 1e-5);
    close(number(&found, "/terms/0/se"), (between / 12.0).sqrt(), 1e-7);
}

/// Each table or request that cannot be used, and what the message must say.
#[test]
fn rejects_bad_input_with_its_place() {
    let folder = Folder::new();
    let table = folder.write(
        "table.csv",
        "y,a,b,c,one,slip,text\n1,1,2,3,7,1,u\n2,2,1,3,7,2,v\n3,3,5,8,7,x3,u\n4.5,4,4,8,7,4,v\n4,5,3,8,7,5,u\n7,6,6,12,7,6,v\n",
    );
    let regress = |terms: &str| {
        let output = run(&["regress", &table, "--response", "y", "--terms", terms]);
        let text = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        // Messages are wrapped to a page.
        let words: Vec<&str> = text.split_whitespace().collect();
        (output.status.code().unwrap(), words.join(" "))
    };
    for (terms, status, expected) in [
        ("a + velocty", 2, "no column \"velocty\""),
        ("a + (b", 2, "closing parenthesis"),
        ("a + slip", 2, "\"x3\" in row 3"),
        (
            "a * b * c * text",
            2,
            "table.csv: 6 rows are too few for 16 coefficients",
        ),
        (
            "a + b + c",
            0,
            "c has no estimate of its own: it is a + b in all rows",
        ),
        ("a + one", 0, "it is 7.000 in all rows"),
        ("a + log(b - 3)", 2, "log(b - 3) is NaN in row 1"),
        ("log(text)", 2, "column \"text\" holds text"),
        ("a + sine(b)", 2, "there is no function \"sine\""),
    ] {
        let (code, text) = regress(terms);
        assert_eq!(code, status, "{terms}: {text}");
        assert!(text.contains(expected), "{terms}: {text}");
    }
    let both = ["--terms", "a", "--random", "text", "--robust"];
    let output = run(&[&["regress", &table, "--response", "y"][..], &both].concat());
    assert!(String::from_utf8_lossy(&output.stderr).contains("no HC3 errors of mixed models"));
    let caret = run(&["regress", &table, "--formula", "y ~ a + * b"]);
    let text = String::from_utf8_lossy(&caret.stderr).into_owned();
    assert!(text.contains("y ~ a + * b\n          ^"), "{text}");
    let missing = folder.write("missing.csv", "y,a\n1,1\n2,NA\n3,3\n4,5\n,6\n");
    let found = json(&["regress", &missing, "--response", "y", "--terms", "a"]);
    assert_eq!(found["left_out"], 2);
    let messages = found["findings"].to_string();
    assert!(messages.contains("missing in line 3") && messages.contains("missing in line 6"));
    let constant = folder.write("constant.csv", "y,a\n1,1\n1,2\n1,3\n");
    let output = run(&["regress", &constant, "--response", "y", "--terms", "a"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("one value in all rows"));
}
