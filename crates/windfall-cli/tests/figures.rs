//! Figures of surfaces, laws and posteriors, and reports of every kind, from the
//! command line.

#![allow(clippy::unwrap_used)]

use std::path::Path;

/// The published design of the drop study (Kang et al. 2023, table 3).
const RUNS: &str = "run,k,e,c,force_N,interval_ms
1,1,2.25,3.5E-4,14.9,334\n2,0.44,1.8,2E-4,9.4,380\n3,0.65,2.25,6E-4,11.8,275
4,0.86,1.8,5E-4,11.2,310\n5,0.44,2.7,5E-4,13.6,282\n6,0.65,2.25,1E-4,13.6,385
7,0.44,1.8,5E-4,7.6,276\n8,0.3,2.25,3.5E-4,9.7,328\n9,0.86,2.7,2E-4,18.3,334
10,0.86,2.7,5E-4,15.1,287\n11,0.65,2.25,3.5E-4,13.1,326\n12,0.44,2.7,2E-4,14.3,362
13,0.65,1.5,3.5E-4,8.4,323\n14,0.65,3,3.5E-4,17.7,301\n15,0.86,1.8,2E-4,12.4,372\n";

fn windfall(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_windfall"));
    command.args(arguments).assert()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// Rows of a table of figures, by the names of the columns.
fn rows(path: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let text = read(path);
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = header.iter().zip(line.split(','));
        cells
            .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
            .collect()
    };
    lines.map(row).collect()
}

/// All figures in a directory: three files each, drawn of finite numbers, in the
/// colours asked for.
fn check_figures(directory: &Path, background: &str) -> Vec<String> {
    let files = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<String> = Vec::new();
    for file in files {
        let path = file.unwrap().path();
        if path.extension() != Some("svg".as_ref()) {
            continue;
        }
        let svg = read(&path);
        assert!(svg.contains(background), "{}", path.display());
        assert!(
            !svg.contains("NaN") && !svg.contains("inf"),
            "{}",
            path.display()
        );
        let picture = std::fs::read(path.with_extension("png")).unwrap();
        assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
        assert!(read(&path.with_extension("csv")).lines().count() > 1);
        names.push(path.file_stem().unwrap().to_str().unwrap().to_owned());
    }
    names.sort();
    names
}

/// Force by least squares on the factors coded by 0.44..0.86, 1.8..2.7 and 2e-4..5e-4,
/// in exact fractions outside of this program: 12.74 + 1.531967 A + 2.670492 B −
/// 0.730328 C, residual variance 0.281827 on 11; t 10.6247, 18.5207, −5.0651; at
/// (1, 3, 3.5e-4) 19.744098 ± 0.366458, at (0.3, 1.5, 3.5e-4) 5.735902 ± 0.366458.
#[test]
fn reference_figures_of_the_published_table() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("runs.csv");
    std::fs::write(&table, RUNS).unwrap();
    let figures = folder.path().join("figures");
    let mut arguments = vec!["surface", table.to_str().unwrap(), "--response", "force_N"];
    for factor in ["k", "e", "c"] {
        arguments.extend(["--factor", factor]);
    }
    for range in ["k=0.44..0.86", "e=1.8..2.7", "c=2e-4..5e-4"] {
        arguments.extend(["--range", range]);
    }
    arguments.extend(["--model", "linear", "--figures", figures.to_str().unwrap()]);
    windfall(&arguments).success();
    let names = check_figures(&figures, "#fff");
    let expected = [
        "contour-force_N",
        "effects-force_N",
        "model-force_N",
        "perturbation",
        "surface-force_N",
    ];
    assert_eq!(names, expected);

    // Ends of the grid over k and e, c at its centre.
    let number = |row: &std::collections::BTreeMap<String, String>, name: &str| -> f64 {
        row[name].parse().unwrap()
    };
    let grid = rows(&figures.join("contour-force_N.csv"));
    let own = grid
        .iter()
        .filter(|r| r["kind"] == "grid" && r["x_factor"] == "k" && r["y_factor"] == "e");
    let own: Vec<_> = own.collect();
    assert_eq!(own.len(), 81 * 81);
    for (row, k, e, value) in [
        (own[0], 0.3, 1.5, 5.735_901_639),
        (own[81 * 81 - 1], 1.0, 3.0, 19.744_098_361),
    ] {
        assert!((number(row, "x") - k).abs() < 1e-12 && (number(row, "y") - e).abs() < 1e-12);
        assert!((number(row, "value") - value).abs() < 1e-8, "{row:?}");
        assert!((number(row, "se") - 0.366_457_903).abs() < 1e-8, "{row:?}");
    }
    let runs = grid.iter().filter(|r| r["kind"] == "run").count();
    assert_eq!(runs, 3 * 15);

    // Slopes of the perturbation are the coefficients.
    let lines = rows(&figures.join("perturbation.csv"));
    for (factor, slope) in [
        ("k", 1.531_967_213),
        ("e", 2.670_491_803),
        ("c", -0.730_327_869),
    ] {
        let own: Vec<_> = lines.iter().filter(|r| r["series"] == factor).collect();
        let (first, last) = (own[0], own[own.len() - 1]);
        let rise = number(last, "y") - number(first, "y");
        let found = rise / (number(last, "x") - number(first, "x"));
        assert!((found - slope).abs() < 1e-8, "{factor}: {found}");
    }

    // t, the largest first; 2.200985 is Student's quantile for 11 in any table.
    let effects = rows(&figures.join("effects-force_N.csv"));
    for (row, t) in effects
        .iter()
        .zip([18.520_747_7, 10.624_701_5, -5.065_066_2])
    {
        assert!((number(row, "t") - t).abs() < 1e-6, "{row:?}");
        assert!((number(row, "critical_t") - 2.200_985).abs() < 1e-5);
        assert!(number(row, "bonferroni_t") > 2.201);
    }
}

/// With goals: the desirability, the optimum on the contours, and its family; dark.
#[test]
fn closed_form_figures_with_goals() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("runs.csv");
    std::fs::write(&table, RUNS).unwrap();
    let figures = folder.path().join("figures");
    let mut arguments = vec!["surface", table.to_str().unwrap()];
    for factor in ["k", "e", "c"] {
        arguments.extend(["--factor", factor]);
    }
    let models = "A + B + C + AB + AC + BC + B^2";
    arguments.extend(["--response", "force_N", "--model", "A + B + C"]);
    arguments.extend(["--response", "interval_ms", "--model", models]);
    arguments.extend(["--goal", "force_N = target 11.3"]);
    arguments.extend(["--goal", "interval_ms = target 299", "--theme", "dark"]);
    arguments.extend(["--figures", figures.to_str().unwrap()]);
    windfall(&arguments).success();
    let names = check_figures(&figures, "#14171a");
    for name in [
        "contour-desirability",
        "contour-interval_ms",
        "desirability-factors",
        "surface-desirability",
    ] {
        assert!(names.iter().any(|own| own == name), "{name} in {names:?}");
    }
    let places = rows(&figures.join("contour-desirability.csv"));
    let grid = places.iter().filter(|r| r["kind"] == "grid");
    for row in grid {
        let value: f64 = row["value"].parse().unwrap();
        assert!((0.0..=1.0).contains(&value));
    }
    assert_eq!(places.iter().filter(|r| r["kind"] == "optimum").count(), 3);
    assert!(places.iter().any(|r| r["kind"] == "as good"));
}

/// A theme without figures is a request that means nothing.
#[test]
fn refuses_a_theme_without_figures() {
    let arguments = ["surface", "runs.csv", "--response", "y", "--theme", "dark"];
    windfall(&arguments).failure().code(2);
}

/// A campaign of the first impacts of the example.
fn few_impacts(folder: &Path, impacts: usize) -> String {
    let directory = folder.join("campaign").display().to_string();
    windfall(&["simulate", "pendulum", "--example", &directory]).success();
    let table = Path::new(&directory).join("impacts.csv");
    let lines: Vec<String> = read(&table).lines().map(str::to_owned).collect();
    let kept = lines[..=impacts].join("\n") + "\n";
    std::fs::write(&table, kept).unwrap();
    directory
}

#[test]
fn laws_as_figures() {
    let folder = tempfile::tempdir().unwrap();
    let directory = few_impacts(folder.path(), 5);
    let figures = folder.path().join("figures");
    let laws = ["--law", "kuwabara-kono", "--law", "hertz"];
    let drawn = ["--figures", figures.to_str().unwrap(), "--format", "json"];
    let shown = windfall(&[&["laws", &directory][..], &laws, &drawn].concat()).success();
    let outcome: serde_json::Value = serde_json::from_slice(&shown.get_output().stdout).unwrap();
    let names = check_figures(&figures, "#fff");
    assert_eq!(names.len(), 2, "{names:?}");
    // What the figure shows is what the command says, and differences of impacts add
    // up to that of the campaign.
    let shown = rows(&figures.join("laws.csv"));
    for law in outcome["laws"].as_array().unwrap() {
        let own = |panel: &str| -> Vec<f64> {
            let own = shown
                .iter()
                .filter(|r| r["panel"] == panel && law["law"] == r["law"]);
            own.map(|r| r["value"].parse().unwrap()).collect()
        };
        assert_eq!(own("campaign"), [law["aicc"].as_f64().unwrap()]);
        assert_eq!(own("impact").len(), 5);
    }
    let hertz = &outcome["laws"][1];
    assert_eq!(hertz["law"], "hertz");
    let (low, high) = (hertz["aicc_low"].as_f64(), hertz["aicc_high"].as_f64());
    let own = hertz["aicc"].as_f64().unwrap();
    assert!(low.unwrap() < own && own < high.unwrap());
    let each = hertz["impacts"].as_array().unwrap().iter();
    let sum: f64 = each.map(|impact| impact["aicc"].as_f64().unwrap()).sum();
    assert!((sum - own).abs() < 1e-6 * own, "{sum} {own}");
}

/// Draws are kept and drawn, and lie about the estimate.
#[test]
fn posterior_as_figure() {
    let folder = tempfile::tempdir().unwrap();
    let directory = few_impacts(folder.path(), 1);
    let out = folder.path().join("out");
    let posterior = ["--intervals", "posterior", "--out", out.to_str().unwrap()];
    windfall(&[&["report", &directory][..], &posterior].concat()).success();
    let names = check_figures(&out.join("figures"), "#fff");
    let name = names
        .iter()
        .find(|name| name.ends_with("-posterior"))
        .unwrap();
    let text = read(&out.join("results.json"));
    let results: serde_json::Value = serde_json::from_str(&text).unwrap();
    let impact = &results["impacts"][0];
    let draws = impact["intervals"]["drawn"]["k"].as_array().unwrap();
    assert!((400..=500).contains(&draws.len()), "{}", draws.len());
    let (k, sd) = (
        &impact["parameters"]["k"]["value"],
        &impact["parameters"]["k"]["sd"],
    );
    let (k, sd) = (k.as_f64().unwrap(), sd.as_f64().unwrap());
    let mean = draws.iter().map(|d| d.as_f64().unwrap()).sum::<f64>() / draws.len() as f64;
    assert!((mean - k).abs() < sd, "{mean} {k} ± {sd}");
    assert!(read(&out.join("report.html")).contains(&format!("figures/{name}.csv")));
}

/// A report of every kind: methods, tables, figures, every input with its digest, and
/// nothing fetched.
#[test]
fn reports_of_every_other_kind() {
    let folder = tempfile::tempdir().unwrap();
    let law = "kuwabara-kono(k=300000, c=20000)";
    let drop = "hertz(k=500000)";
    let kinds: [(&str, Vec<&str>, &str); 4] = [
        (
            "compression",
            vec!["--law", law, "--rate", "1 mm/s", "--yield-force", "30 N"],
            "Newey and West",
        ),
        (
            "tap",
            vec!["--frequency", "640 Hz", "--fruit", "2"],
            "spheroidal",
        ),
        (
            "repeats",
            vec!["--fruit", "6", "--energy", "0.05 J", "--energy", "0.4 J"],
            "flipped signs",
        ),
        (
            "drop",
            vec![
                "--law", drop, "--mass", "5 g", "--height", "300 mm", "--drops", "2",
            ],
            "taken as rigid",
        ),
    ];
    for (kind, arguments, said) in kinds {
        let campaign = folder.path().join(kind);
        let name = campaign.to_str().unwrap();
        windfall(&[&["simulate", kind, name][..], &arguments].concat()).success();
        windfall(&["report", name]).success();
        let report = campaign.join("report");
        let page = read(&report.join("report.html"));
        for words in [said, "SHA-256", "Methods", "How to cite", "<figure"] {
            assert!(page.contains(words), "{kind}: {words}");
        }
        for fetched in ["src=", "@import", "url(", "<script", "<link"] {
            assert!(!page.contains(fetched), "{kind}: {fetched}");
        }
        assert!(!page.contains(folder.path().to_str().unwrap()), "{kind}");
        assert!(
            !check_figures(&report.join("figures"), "#fff").is_empty(),
            "{kind}"
        );
        for data in page.split("<code>figures/").skip(1) {
            let name = data.split("</code>").next().unwrap();
            assert!(report.join("figures").join(name).exists(), "{kind}: {name}");
        }
        let inputs = read(&report.join("inputs.csv"));
        let recordings = std::fs::read_dir(campaign.join("raw")).unwrap().count();
        assert!(inputs.lines().count() > recordings, "{kind}: {inputs}");
        assert!(read(&report.join("impacts.csv")).lines().count() > 1);
    }
}

/// Where nothing can be fitted, the user sees what failed and why.
#[test]
fn says_what_failed_where_nothing_could_be_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let directory = few_impacts(folder.path(), 2);
    for file in std::fs::read_dir(Path::new(&directory).join("raw")).unwrap() {
        std::fs::write(file.unwrap().path(), "nothing\n").unwrap();
    }
    let shown = windfall(&["report", &directory]).failure().code(1);
    let messages = String::from_utf8(shown.get_output().stderr.clone()).unwrap();
    assert_eq!(messages.matches("not fitted: ").count(), 2, "{messages}");
    assert!(
        messages.contains("the 2 messages above say why"),
        "{messages}"
    );
    assert!(!Path::new(&directory).join("report").exists());
}
