//! Reports from the command line.

#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::Path;
use windfall_files::text::number::value_and_sd;

fn windfall(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_windfall"));
    command.args(arguments).assert()
}

fn json(arguments: &[&str]) -> Value {
    let output = windfall(arguments).success().get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

/// The example campaign: four groups of twenty impacts.
fn campaign(folder: &Path) -> String {
    let directory = folder.join("campaign").display().to_string();
    windfall(&["simulate", "pendulum", "--example", &directory]).success();
    directory
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// Everything that the page names is there, nothing is fetched, every element is
/// closed, and the numbers are those of `fit`.
#[test]
fn writes_a_page_that_needs_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    let written = json(&["report", &directory, "--format", "json"]);
    let out = Path::new(&directory).join("report");
    let page = read(&out.join("report.html"));
    for fetched in ["src=", "@import", "url(", "<script", "<link"] {
        assert!(!page.contains(fetched), "{fetched}");
    }
    for tag in [
        "section",
        "figure",
        "table",
        "svg",
        "figcaption",
        "tspan",
        "text",
    ] {
        let opened =
            page.matches(&format!("<{tag}>")).count() + page.matches(&format!("<{tag} ")).count();
        let closed = page.matches(&format!("</{tag}>")).count();
        assert_eq!(opened, closed, "{tag}");
    }
    for data in page.split("<code>figures/").skip(1) {
        let name = data.split("</code>").next().unwrap();
        assert!(out.join("figures").join(name).exists(), "{name}");
    }
    for file in written["files"].as_array().unwrap() {
        assert!(Path::new(file.as_str().unwrap()).exists(), "{file}");
    }
    // The mean of each group stands in the page as `fit` gives it.
    let fitted = json(&["fit", &directory, "--format", "json"]);
    assert_eq!(
        written["impacts"],
        fitted["impacts"].as_array().unwrap().len()
    );
    let shown: Value = serde_json::from_str(&read(&out.join("results.json"))).unwrap();
    assert_eq!(shown["summary"], fitted["summary"]);
    for group in fitted["groups"].as_array().unwrap() {
        let k = &group["parameters"]["k"];
        let shown = value_and_sd(k["mean"].as_f64().unwrap(), k["sd"].as_f64());
        assert!(page.contains(&format!("<td>{shown} (")), "{shown}");
    }
    for said in [
        "force exceeded 1 N",
        "Kuwabara",
        "when the force returned to zero",
        "SHA-256",
    ] {
        assert!(page.contains(said), "{said}");
    }
    // No path of the machine.
    assert!(!page.contains(folder.path().to_str().unwrap()));
}

/// Figures are written with their data, as pictures of their theme; a report made
/// again replaces its own files and leaves others alone.
#[test]
fn replaces_its_own_files_only() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    let out = folder.path().join("out");
    let name = out.display().to_string();
    windfall(&["report", &directory, "--out", &name]).success();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    let figure = out.join("figures").join("kuwabara-kono-parameters");
    let light = read(&figure.with_extension("svg"));
    assert!(light.contains("fill=\"#fff\"") && light.contains(" N/m</tspan>"));
    let picture = std::fs::read(figure.with_extension("png")).unwrap();
    assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
    // One row for each impact, besides ellipses.
    let table = read(&figure.with_extension("csv"));
    let impacts = table.lines().filter(|l| l.contains(",apple,")).count();
    assert_eq!(impacts, 20);
    // Gain and delay of each, of all groups.
    let bench = read(&out.join("figures").join("bench.csv"));
    assert_eq!(
        bench.lines().filter(|l| l.contains(",impacts,")).count(),
        160
    );

    windfall(&["report", &directory, "--out", &name, "--theme", "dark"]).success();
    assert!(read(&figure.with_extension("svg")).contains("fill=\"#14171a\""));
    assert_eq!(read(&out.join("notes.txt")), "mine");
    let left = std::fs::read_dir(&out)
        .unwrap()
        .map(|e| e.unwrap().file_name());
    assert!(
        left.map(|n| n.into_string().unwrap())
            .all(|n| !n.contains("partial"))
    );
}

/// A report that cannot be written says so and changes nothing.
#[test]
fn refuses_what_it_cannot_report() {
    let folder = tempfile::tempdir().unwrap();
    let directory = campaign(folder.path());
    let blocked = folder.path().join("blocked");
    std::fs::write(&blocked, "a file").unwrap();
    let arguments = ["report", &directory, "--out", blocked.to_str().unwrap()];
    let message = windfall(&arguments)
        .failure()
        .code(1)
        .get_output()
        .stderr
        .clone();
    let message = String::from_utf8(message).unwrap();
    assert!(message.contains("blocked"), "{message}");
    assert_eq!(read(&blocked), "a file");

    windfall(&["report", folder.path().join("none").to_str().unwrap()]).failure();
}
