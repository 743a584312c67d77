//! `windfall surface` of runs in random groups, and the split-plot designs that it reads.

#![allow(clippy::unwrap_used)]

use crate::on_table;
use crate::surface_blocks::{OF_REACTION, SURFACE};
use serde_json::Value;

/// Yield of a reaction as in `surface_blocks`, over four days of our own.
const DAYS: &str = "\
Time,Temp,day,Yield\n80,170,B1,80.5\n80,180,B1,81.5\n90,170,B1,82\n90,180,B2,83.5\n\
85,175,B2,83.9\n85,175,B1,84.3\n85,175,B3,84\n85,175,B3,79.7\n85,175,B3,79.8\n85,175,B2,79.5\n\
92.07,175,B4,78.4\n77.93,175,B4,75.6\n85,182.07,B4,78.5\n85,167.93,B2,77\n";

fn close(found: &Value, expected: f64) {
    on_table::close(found, expected, 1e-6);
}

/// Against lme4 1.1-31 and pbkrtest 0.5.2 in R 4.2 (`Yield ~ A*B + I(A^2) + I(B^2) + (1 | day)`).
#[test]
fn reference_reaction_over_four_days() {
    let options = [
        "--random",
        "day",
        "--grid",
        "Time,Temp",
        "--grid-points",
        "2",
    ];
    let found = on_table::json(DAYS, &[&SURFACE[..], &OF_REACTION, &options].concat());
    let model = &found["responses"][0];
    let terms = model["terms"].as_array().unwrap();
    for (own, (name, coded, se, df)) in terms.iter().zip([
        (
            "(Intercept)",
            81.647257692476,
            1.542277591643,
            4.18059493571,
        ),
        ("A", 1.204695919403, 0.781661811673, 5.29096486243),
        ("B", 1.210065465605, 0.819941543782, 5.56707892543),
        ("AB", 0.669228020638, 1.163047829921, 5.50964153105),
        ("A^2", -1.007086205588, 1.172026730508, 7.48152867233),
        ("B^2", -1.141523885542, 0.91974227465, 6.04298409711),
    ]) {
        assert_eq!(own["term"], name);
        close(&own["coded"], coded);
        close(&own["se"], se);
        if name != "(Intercept)" {
            close(&own["df_denominator"], df);
            close(&own["f"], (coded / se).powi(2));
        }
        assert_eq!(own["ss"], Value::Null);
    }
    close(&model["model"]["f"], 1.29230933824);
    close(&model["model"]["p"], 0.381633188509);
    let random = &model["random"];
    close(&random["model_df_denominator"], 5.67493526256);
    close(&random["variances"][0]["value"], 2.095060842);
    close(&random["variances"][1]["value"], 2.088915431);
    close(&model["sigma"], 2.08891543105);
    close(&model["log_likelihood"], -25.1410910236);
    assert_eq!(model["lack_of_fit"], Value::Null);
    let codes = found["findings"].as_array().unwrap().iter();
    assert!(codes.into_iter().any(|own| own["code"] == "random-groups"));
    let far = [77.93, 182.07, 76.02087598149761, 4.380553445236416];
    let row = &found["grid"]["rows"][2];
    (0..4).for_each(|place| close(&row[place], far[place]));
}

/// One measurement on a day of its own scatters more than the mean is uncertain, and more than
/// one within days does.
#[test]
fn a_further_observation_reckons_with_its_day() {
    let goal = [
        "--goal",
        "Yield = maximum",
        "--hold",
        "Time=85",
        "--hold",
        "Temp=175",
    ];
    let width = |random: &str| {
        let arguments = [&SURFACE[..], &OF_REACTION, &goal, &["--random", random]].concat();
        let found = on_table::json(DAYS, &arguments);
        let own = &found["optimum"]["responses"][0];
        own["high"].as_f64().unwrap() - own["low"].as_f64().unwrap()
    };
    assert!(
        width("day") > 1.1 * width("none"),
        "{} {}",
        width("day"),
        width("none")
    );
}

#[test]
fn rejects_groups_that_are_none() {
    let one = DAYS
        .replace("B2", "B1")
        .replace("B3", "B1")
        .replace("B4", "B1");
    for (table, options, said) in [
        (
            DAYS,
            &["--random", "week"][..],
            "there is no column \"week\"",
        ),
        (
            DAYS,
            &["--random", "Time"],
            "Time is a factor or a response",
        ),
        (
            DAYS,
            &["--random", "Yield"],
            "Yield is a factor or a response",
        ),
        (
            DAYS,
            &["--random", "1 + Temp | day"],
            "means of groups alone can vary",
        ),
        (
            DAYS,
            &["--random", "0 | day"],
            "means of groups alone can vary",
        ),
        (
            DAYS,
            &["--random", "day", "--block", "day"],
            "fixed or random",
        ),
        (
            DAYS,
            &["--random", "day", "--anova", "1"],
            "tested after all others",
        ),
        (&one, &["--random", "day"], "1 groups with rows"),
    ] {
        let (status, _, told) =
            on_table::run(table, &[&SURFACE[..], &OF_REACTION, options].concat());
        assert_ne!(status, Some(0), "{options:?}: {told}");
        assert!(told.contains(said), "{options:?}: {told}");
    }
}

/// A design, its file, a response that only depends on the settings and the whole plot, and back.
#[test]
fn whole_plots_of_a_design_are_read_from_its_column() {
    let folder = tempfile::tempdir().unwrap();
    let windfall = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("windfall").unwrap();
        let output = command
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{told}");
        String::from_utf8(output.stdout).unwrap()
    };
    let design = [
        "design",
        "split-plot",
        "--factor",
        "T=2..20 degC",
        "--factor",
        "h=10..40 cm",
        "--hard",
        "T",
        "--whole-plots",
        "9",
        "--runs",
        "27",
        "--seed",
        "5",
        "--out",
        "plots.csv",
    ];
    let shown = windfall(&design);
    assert!(
        shown.contains("Reset the hard-to-change factors"),
        "{shown}"
    );
    let text = std::fs::read_to_string(folder.path().join("plots.csv")).unwrap();
    let mut run = 0_u32;
    let lines = text.lines().map(|line| match line {
        line if line.starts_with('#') => line.to_owned(),
        line if line.starts_with("run,") => format!("{line},y"),
        line => {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |place: usize| cells[place].parse::<f64>().unwrap();
            let (plot, t, h) = (number(3), number(5), number(6));
            run += 1;
            let scatter = f64::from(run * 37 % 11) / 11.0 - 0.5;
            format!(
                "{line},{}",
                5.0 + 0.4 * t - 0.1 * h + 3.0 * (plot * 2.3).sin() + scatter
            )
        }
    });
    let lines: Vec<String> = lines.collect();
    std::fs::write(folder.path().join("runs.csv"), lines.join("\n")).unwrap();
    let asked = [
        "surface",
        "runs.csv",
        "--response",
        "y",
        "--model",
        "linear",
    ];
    let found: Value =
        serde_json::from_str(&windfall(&[&asked[..], &["--format", "json"]].concat())).unwrap();
    let model = &found["responses"][0];
    assert_eq!(model["random"]["groups"][0][0], "whole_plot");
    assert_eq!(model["random"]["groups"][0][1], 9);
    // The hard factor is judged by whole plots, the other by runs.
    let df = |place: usize| model["terms"][place]["df_denominator"].as_f64().unwrap();
    assert!(df(1) < 7.5 && df(2) > 15.0, "{} {}", df(1), df(2));
    let plain: Value = serde_json::from_str(&windfall(
        &[&asked[..], &["--random", "none", "--format", "json"]].concat(),
    ))
    .unwrap();
    let codes = |own: &Value| own["findings"].to_string().contains("whole-plots-left-out");
    assert!(codes(&plain) && !codes(&found));
    let se = |own: &Value| own["responses"][0]["terms"][1]["se"].as_f64().unwrap();
    assert!(
        se(&found) > 1.3 * se(&plain),
        "{} {}",
        se(&found),
        se(&plain)
    );
    let figures = [&asked[..], &["--figures", "figures", "--format", "csv"]].concat();
    windfall(&figures);
    for name in ["model-y", "profiles-y", "random-effects-y", "contour-y"] {
        let path = folder.path().join("figures").join(format!("{name}.svg"));
        assert!(path.is_file(), "{name}");
    }
}
