//! Bruises by a regression, static loads, and `windfall scene study`, as a user meets them.

use super::{change, windfall};
use std::collections::BTreeMap;
use std::path::Path;
use windfall_files::written::LIST;

const REGRESSION: &str = "response = \"log(bruise_volume_mm3)\"
terms = [
  { term = \"(Intercept)\", estimate = 8 },
  { term = \"log(absorbed_energy_mJ / 1000)\", estimate = 1.1 },
  { term = \"temperature_C\", estimate = -0.02 },
  { term = \"log(radius_mm / 37.5)\", estimate = -0.5 },
]
ranges = [{ column = \"absorbed_energy_mJ\", low = 0, high = 100 }]
";

/// The template with few fruit, a regression of bruises and a property of the fruit.
fn scene(directory: &Path, changes: &[(&str, &str)]) {
    let own = [
        ("count = 100", "count = 15"),
        ("end = \"4 s\"", "end = \"1.5 s\""),
        ("least_peak_force = \"0.5 N\"", "least_peak_force = \"0 N\""),
        (
            "density = \"840 kg/m^3\"",
            "density = \"840 kg/m^3\"\nproperties = { temperature_C = { mean = 10 } }",
        ),
    ];
    super::scene(directory, &own);
    let path = directory.join("s/scene.toml");
    let mut text = std::fs::read_to_string(&path).unwrap();
    text += "[bruise]
regression = \"bruise.toml\"
limits = [\"50 mm^3\", \"300 mm^3\"]
";
    std::fs::write(&path, text).unwrap();
    change(&path, changes);
    std::fs::write(directory.join("s/bruise.toml"), REGRESSION).unwrap();
}

/// The columns of a table, by name.
fn table(path: &Path) -> BTreeMap<String, Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for line in lines {
        for (name, cell) in names.iter().zip(line.split(',')) {
            let column = columns.entry((*name).to_owned()).or_default();
            column.push(cell.to_owned());
        }
    }
    columns
}

fn numbers(table: &BTreeMap<String, Vec<String>>, name: &str) -> Vec<f64> {
    table[name]
        .iter()
        .map(|cell| cell.parse().unwrap_or(f64::NAN))
        .collect()
}

/// Largest bruises again from the table of contacts, by the formula written out.
#[test]
fn closed_form_bruises_of_a_regression_from_the_table_of_contacts() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), &[]);
    let (done, json, problem) = windfall(
        &["scene", "run", "s/scene.toml", "--format", "json"],
        folder.path(),
    );
    assert!(done, "{problem}");
    let run = folder.path().join("s/scene.run");
    let (events, fruit) = (
        table(&run.join("events.csv")),
        table(&run.join("fruit.csv")),
    );
    let radius: Vec<f64> = numbers(&fruit, "diameter_m")
        .iter()
        .map(|own| 0.5 * own)
        .collect();
    let mut largest = vec![0.0_f64; radius.len()];
    let (own, other) = (numbers(&events, "fruit"), numbers(&events, "partner_fruit"));
    for (row, energy) in numbers(&events, "absorbed_energy_J").iter().enumerate() {
        let share = match events["partner"][row].as_str() {
            "fruit" => 0.5,
            "pad" => 0.1,
            _ => 1.0,
        };
        let blow = events["static"][row] == "false";
        for number in [own[row], other[row]]
            .into_iter()
            .filter(|own| blow && !own.is_nan())
        {
            let place = number as usize - 1;
            let volume =
                (8.0 + 1.1 * (share * energy).ln() - 0.2 - 0.5 * (radius[place] / 0.0375).ln())
                    .exp();
            // A hundredth of the smallest limit is the least that counts.
            if volume > 0.5 {
                largest[place] = largest[place].max(volume);
            }
        }
    }
    let found = numbers(&fruit, "largest_bruise_mm3");
    assert!(largest.iter().any(|own| *own > 50.0));
    for (found, wanted) in found.iter().zip(&largest) {
        assert!((found - wanted).abs() <= 1e-9 * wanted, "{found} {wanted}");
    }
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let share = largest.iter().filter(|own| **own > 50.0).count() as f64 / largest.len() as f64;
    assert_eq!(
        json["bruise"]["limits"][0]["share"].as_f64().unwrap(),
        share
    );
    // Every fruit stands in each histogram.
    let histograms = json["histograms"].as_array().unwrap();
    assert_eq!(histograms.len(), 3);
    for own in histograms {
        let counts = own["fruit"].as_array().unwrap().iter();
        assert_eq!(counts.map(|own| own.as_u64().unwrap()).sum::<u64>(), 15);
    }
    assert!(run.join("histograms.svg").exists() && run.join("histograms.csv").exists());
    let codes = json["findings"].to_string();
    assert_eq!(
        codes.contains("bruise-range"),
        largest.iter().any(|own| *own > 200.0)
    );
    // Static loads: all that lasted long to the end, rests of contacts, and nothing else that was
    // short.
    let (load, force) = (numbers(&events, "load"), numbers(&events, "peak_force_N"));
    let duration = numbers(&events, "duration_s");
    let mut statics = 0;
    for (row, lasted) in events["static"].iter().enumerate() {
        statics += usize::from(lasted == "true");
        // A gentle load may have fallen so slowly that what follows is no rest yet.
        let at_the_end = events["lasting"][row] == "true" && duration[row] > 0.25;
        assert!(!at_the_end || lasted == "true" || force[row] < 5.0, "{row}");
        let lasts = events["lasting"][row] == "true" || duration[row] > 0.02;
        assert!(lasted == "false" || lasts || load[row] > 1.0);
    }
    let partners = json["partners"].as_array().unwrap();
    let sum = |key: &str| {
        partners
            .iter()
            .map(|own| own[key].as_u64().unwrap())
            .sum::<u64>()
    };
    assert!(statics > 0);
    assert_eq!(sum("static_loads"), statics as u64);
    assert_eq!(
        sum("contacts") + sum("static_loads"),
        json["contacts"].as_u64().unwrap()
    );
}

/// What `windfall regress` writes is what a scene reads.
#[test]
fn a_regression_of_windfall_is_read() {
    let folder = tempfile::tempdir().unwrap();
    scene(
        folder.path(),
        &[
            ("bruise.toml", "bruise.json"),
            ("end = \"1.5 s\"", "end = \"0.6 s\""),
        ],
    );
    let mut rows = "fruit,peak_force_N,temperature_C,bruise_volume_mm3\n".to_owned();
    for i in 0..24_i32 {
        let (fruit, force, temperature) = (i / 4, 20.0 + 7.0 * f64::from(i), f64::from(i % 5 * 4));
        let scatter = f64::from((i * 7) % 11) / 50.0 + f64::from(fruit % 3) / 5.0;
        let volume = (0.05 * force - 0.03 * temperature + scatter).exp();
        rows += &format!("f{fruit},{force},{temperature},{volume}\n");
    }
    std::fs::write(folder.path().join("bruises.csv"), rows).unwrap();
    let formula = "log(bruise_volume_mm3) ~ peak_force_N + temperature_C";
    for random in [&[][..], &["--random", "fruit"][..]] {
        let mut arguments = vec!["regress", "bruises.csv", "--formula", formula];
        arguments.extend(["--format", "json"].iter().chain(random));
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        for (place, term) in value["terms"].as_array().unwrap().iter().enumerate() {
            let variance = value["covariance"][place][place].as_f64().unwrap();
            let se = term["se"].as_f64().unwrap();
            assert!((variance.sqrt() / se - 1.0).abs() < 1e-9, "{term}");
        }
        std::fs::write(folder.path().join("s/bruise.json"), json).unwrap();
        let arguments = ["scene", "run", "s/scene.toml", "--format", "json"];
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        assert!(json.contains("largest bruise of a fruit"));
    }
}

#[test]
fn rejects_regressions_that_ask_for_what_is_not_there() {
    for (changes, words) in [
        (
            (
                "temperature_C = { mean = 10 }",
                "temperature = { mean = 10 }",
            ),
            "nothing says what the column \"temperature_C\" is",
        ),
        (
            (
                "limits = [\"50 mm^3\"",
                "susceptibility = \"3000 mm^3/J\"\nlimits = [\"50 mm^3\"",
            ),
            "leave out the susceptibility",
        ),
        (("mean = 10", "mean = 10, sd = -1"), "standard deviation"),
        (
            ("regression = \"bruise.toml\"", "regression = \"no.toml\""),
            "no.toml",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        scene(folder.path(), &[changes]);
        let (done, _, problem) = windfall(&["scene", "run", "s/scene.toml"], folder.path());
        assert!(!done && problem.contains(words), "{problem}");
    }
}

const STUDY: &str = "format = 1
scene = \"scene.toml\"
replicates = 2
[[vary]]
name = \"pad\"
levels = [
  { name = \"foam\" },
  { name = \"steel\", set = { \"walls.pad.material\" = \"steel\" } },
  { name = \"none\", set = { \"walls.pad.material\" = \"nothing\" } },
]
[[vary]]
name = \"height\"
levels = [
  { name = \"low\" },
  { name = \"high\", move = { names = [\"conveyor\", \"apples\"], by = [0, 0, 0.1] } },
]
";

/// A variant that fails takes nothing from the others, and nothing of before is left.
#[test]
fn a_study_keeps_what_works_and_nothing_stale() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), &[("end = \"1.5 s\"", "end = \"0.8 s\"")]);
    std::fs::write(folder.path().join("s/study.toml"), STUDY).unwrap();
    let old = folder
        .path()
        .join("s/study.study/variants/07_old/scene.json");
    std::fs::create_dir_all(old.parent().unwrap()).unwrap();
    std::fs::write(&old, "{}").unwrap();
    // Runs that no study made are somebody's own.
    let (done, _, problem) = windfall(&["scene", "study", "s/study.toml"], folder.path());
    assert!(!done && problem.contains("not written by windfall") && old.exists());
    std::fs::write(old.with_file_name(LIST), "any  scene.json\n").unwrap();
    let run = |threads: &str, out: &str| {
        let arguments = [
            "scene",
            "study",
            "s/study.toml",
            "--threads",
            threads,
            "--format",
            "json",
            "--out",
            out,
        ];
        let (done, json, problem) = windfall(&arguments, folder.path());
        assert!(done, "{problem}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        json
    };
    let json = run("2", "s/study.study");
    assert!(!old.exists());
    let variants = json["variants"].as_array().unwrap();
    let names: Vec<&str> = variants
        .iter()
        .map(|own| own["name"].as_str().unwrap())
        .collect();
    let all = [
        "foam, low",
        "foam, high",
        "steel, low",
        "steel, high",
        "none, low",
        "none, high",
    ];
    assert_eq!(names, all);
    for (own, name) in variants.iter().zip(all) {
        let failed = own["failed"].as_str();
        match name.starts_with("none") {
            true => assert!(failed.unwrap().contains("nothing"), "{own}"),
            false => {
                assert!(
                    failed.is_none() && own["contacts"].as_f64().unwrap() > 0.0,
                    "{own}"
                );
                let directory = own["directory"].as_str().unwrap();
                let kept = folder.path().join("s/study.study").join(directory);
                for replicate in ["replicate_1", "replicate_2"] {
                    for file in ["scene.toml", "events.csv", "fruit.csv", "scene.json"] {
                        assert!(kept.join(replicate).join(file).exists(), "{name} {file}");
                    }
                }
                for limit in own["limits"].as_array().unwrap() {
                    let share = limit["share"].as_f64().unwrap();
                    let [low, high] = [0, 1].map(|end| limit["interval"][end].as_f64().unwrap());
                    assert!((0.0..=1.0).contains(&share) && low < high, "{limit}");
                }
            }
        }
    }
    // Each level against the first, at two limits; of what failed there is no difference.
    let effects = json["effects"].as_array().unwrap();
    let shown: Vec<(&str, u64)> = effects
        .iter()
        .map(|own| {
            (
                own["level"].as_str().unwrap(),
                own["pairs"].as_u64().unwrap(),
            )
        })
        .collect();
    assert_eq!(
        shown,
        [("steel", 2), ("steel", 2), ("high", 2), ("high", 2)]
    );
    let codes = json["findings"].to_string();
    assert!(codes.contains("variant-failed") && codes.contains("law-certain"));
    let page = std::fs::read_to_string(folder.path().join("s/study.study/study.html")).unwrap();
    assert!(page.contains("steel, high") && page.contains("<svg") && !page.contains("<script"));
    // The same on one thread.
    let again = run("1", "other");
    assert_eq!(json["variants"], again["variants"]);
    assert_eq!(json["effects"], again["effects"]);
}

#[test]
fn rejects_studies_that_cannot_be_with_their_line() {
    for (old, new, words) in [
        (
            "walls.pad.material",
            "walls.pat.material",
            "did you mean \"pad\"",
        ),
        (
            "\"conveyor\", \"apples\"",
            "\"conveyer\"",
            "did you mean \"conveyor\"",
        ),
        ("replicates = 2", "replicates = 0", "1 to 10000 times"),
        ("scene = \"scene.toml\"", "scene = \"no.toml\"", "no.toml"),
        ("name = \"high\"", "name = \"low\"", "twice"),
        ("replicates", "replicate", "did you mean \"replicates\""),
    ] {
        let folder = tempfile::tempdir().unwrap();
        scene(folder.path(), &[]);
        assert!(STUDY.contains(old), "{old}");
        let path = folder.path().join("s/study.toml");
        std::fs::write(path, STUDY.replacen(old, new, 1)).unwrap();
        let (done, _, problem) = windfall(&["scene", "study", "s/study.toml"], folder.path());
        assert!(!done && problem.contains(words), "{problem}");
        assert!(!folder.path().join("s/study.study").exists());
    }
}
