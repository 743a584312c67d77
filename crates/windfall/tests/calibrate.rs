//! `calibrate` on features written into impacts.csv: the law that they came from,
//! the line that two of them leave, the tables of the study.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_contact::effective::hertz_stiffness;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop::calibrate::outcome::CalibrateOutcome;
use windfall_drop::calibrate::run::{CalibrateRequest, calibrate};
use windfall_drop::calibrate::text::{csv_of_calibration, text_of_calibration};
use windfall_drop::calibrate_settings::Way;
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_drop_rig::simulate::simulate_drop;

const RANGES: &str = r#"ranges = { k = ["0.3 N/mm^e", "1 N/mm^e"], e = [1.5, 3.0], c = ["1e-4 N s/mm", "6e-4 N s/mm"] }"#;

fn write(directory: &Path, calibrate: &str, impacts: &str) {
    let campaign = format!(
        r#"format = 1
[rig]
kind = "drop"
mass = "4.8 g"
plate_mass = "0.2 kg"
plate_stiffness = "645.8 N/mm"
plate_damping = "0.05247 N s/mm"
[files]
time = "time_s"
[channels.force]
column = "force_V"
sensitivity = "0.1 V/N"
[fit]
law = 'adams-impact(d="0.001 mm")'
[calibrate]
{calibrate}
{RANGES}
"#
    );
    std::fs::write(directory.join("campaign.toml"), campaign).unwrap();
    std::fs::write(directory.join("impacts.csv"), impacts).unwrap();
    std::fs::write(directory.join("specimens.csv"), "id\ns1\n").unwrap();
}

fn law(k: f64, e: f64, c: f64, d: f64) -> Law {
    let text = format!(r#"adams-impact(k="{k} N/mm^{e}", e={e}, c="{c} N s/mm", d="{d} mm")"#);
    parse_law(&text).unwrap().complete().unwrap()
}

fn sprung() -> DropRig {
    DropRig {
        mass: 0.0048,
        effective_mass_factor: 1.0,
        gravity: 9.80665,
        plate: Some(Plate {
            mass: 0.2,
            stiffness: 645_800.0,
            damping: 52.47,
        }),
    }
}

/// First support peak and interval of the study's optimum on its plate
/// (papers.json, `central_sphere_reference`, rows opt and optH, columns S1max and
/// dt_start).
const HEIGHTS: [(f64, f64, f64); 5] = [
    (100.0, 5.8171542, 211.8162),
    (200.0, 9.785603, 306.4289),
    (300.0, 13.1792842, 380.1112),
    (400.0, 16.2295441, 442.7415),
    (500.0, 19.0398267, 498.2278),
];

fn impacts(heights: &[(f64, f64, f64)]) -> String {
    let mut text = "id,specimen,file,drop_height_mm,peak_force_1_N,peak_force_1_sd_N,\
                    interval_1_ms,interval_1_sd_ms\n"
        .to_owned();
    for (height, peak, interval) in heights {
        text += &format!("d{height},s1,none,{height},{peak},0.05,{interval},0.5\n");
    }
    text
}

fn calibrated(calibrate_lines: &str, impacts: &str) -> CalibrateOutcome {
    let directory = tempfile::tempdir().unwrap();
    write(directory.path(), calibrate_lines, impacts);
    let request = CalibrateRequest {
        tables: Some(directory.path().join("tables")),
        figures: Some(windfall_draw::files::FigureFolder::of(
            &directory.path().join("figures"),
        )),
        ..CalibrateRequest::default()
    };
    let outcome = calibrate(directory.path(), &request, &windfall_files::progress::quiet).unwrap();
    for name in [
        "table_3_design.csv",
        "table_6_optimum.txt",
        "what_closes.csv",
    ] {
        assert!(
            directory.path().join("tables").join(name).exists(),
            "{name}"
        );
    }
    assert!(directory.path().join("results.sqlite").exists());
    outcome
}

/// An independent program's features of the study's optimum at five heights: the
/// calibration finds that law, and the next experiment would narrow it.
#[test]
fn reference_law_of_five_heights() {
    let outcome = calibrated("", &impacts(&HEIGHTS));
    let features = outcome.features.as_ref().unwrap();
    assert!(features.converged);
    assert_eq!(features.rank, 3);
    for (parameter, expected) in features.parameters.iter().zip([0.868, 1.91, 0.556]) {
        let off = parameter.written.value / expected - 1.0;
        assert!(off.abs() < 2e-4, "{parameter:?}");
    }
    assert_eq!(features.parameters[0].written.unit, "N/mm^e");
    // 0.868 * 1000^1.91
    assert!((features.parameters[0].value / 466_143.6 - 1.0).abs() < 2e-3);
    assert!(features.parameters.iter().all(|p| p.sd.is_some()));
    let next = outcome.next.as_ref().unwrap();
    let best = next.candidates[0].sds[0].unwrap();
    assert!(best < next.now[0].unwrap());
    // One height alone leaves a line, and the program says so.
    assert_eq!(outcome.closing[0].rank, 2);
    assert!(outcome.closing[0].sds.iter().all(Option::is_none));
    assert!(outcome.closing.iter().skip(1).all(|row| row.rank == 3));
    let family = outcome.family.as_ref().unwrap();
    assert_eq!(family.dimension, 1);
    for member in &family.members {
        let at = member
            .heights
            .iter()
            .find(|at| (at.height - 0.5).abs() < 1e-9)
            .unwrap();
        let peak = at.features.get("peak_support_force_1").unwrap();
        assert!((peak / 19.0398267 - 1.0).abs() < 1e-6, "{peak}");
    }
    let text = text_of_calibration(&outcome);
    assert!(text.contains("one of a family"), "{text}");
    assert!(outcome.findings.iter().any(|f| f.code == "one-of-a-family"));
    println!("{text}");
    let csv = csv_of_calibration(&outcome).unwrap();
    assert_eq!(csv.lines().count(), 7, "{csv}");
}

/// The design's levels are the study's to all digits, and each of its runs is what
/// the simulator gives at that point.
#[test]
fn reference_design_of_the_study() {
    let start = r#"start = 'adams-impact(k="5.4 N/mm^2", e=2, c="4e-4 N s/mm", d="0.001 mm")'"#;
    let outcome = calibrated(start, &impacts(&HEIGHTS[4..]));
    let design = outcome.design.as_ref().unwrap();
    assert_eq!(design.runs.len(), 15);
    assert!((design.alpha - 8f64.powf(0.25)).abs() < 1e-12);
    // Half-ranges of papers.json; c in N s/m.
    let halves = [0.20811124512547619, 0.4459526681260204, 0.14865088937534015];
    for (factor, half) in design.factors.iter().zip(halves) {
        assert!((factor.half / half - 1.0).abs() < 1e-12, "{factor:?}");
    }
    for run in &design.runs {
        let own = law(run.levels[0], run.levels[1], 1e-3 * run.levels[2], 1e-3);
        let summary = simulate_drop(&own, &sprung(), 0.5, 2, EndRule::ForceZero).unwrap();
        let expected = [summary.impacts[0].peak_support_force, summary.intervals[0]];
        for (found, expected) in run.responses.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-8);
        }
    }
    // Table 2 by an independent program (papers.json, rows table2).
    let depth = design.depth.as_ref().unwrap();
    for ((d, found), (depth, peak, interval)) in depth.rows.iter().zip([
        (1e-4, 36.4848334, 0.5652914),
        (1e-5, 36.4286612, 0.5646128),
        (1e-6, 36.4230029, 0.564545),
    ]) {
        assert!((d / depth - 1.0).abs() < 1e-12);
        assert!((found[0] / peak - 1.0).abs() < 1e-6);
        assert!((found[1] / interval - 1.0).abs() < 1e-6);
    }
    // The settings that it finds meet the targets in the simulator too, and are one
    // of a family.
    for response in &design.optimum.responses {
        assert!(response.difference.unwrap().abs() < 0.02, "{response:?}");
    }
    assert!(design.family.len() > 4);
    let family = |code: &str| outcome.findings.iter().filter(|f| f.code == code).count();
    assert_eq!(family("one-of-a-family"), 2);
    // No term is left that explains nothing, none is gone that a higher one needs.
    for surface in &design.surfaces {
        for row in &surface.anova {
            let higher = surface.anova.iter().any(|other| {
                let letters = row.term.chars().filter(char::is_ascii_alphabetic);
                other.term.len() > row.term.len()
                    && letters.clone().all(|letter| other.term.contains(letter))
            });
            assert!(row.p < 0.1 || higher, "{}: {row:?}", surface.response);
        }
    }
}

/// k = 5.396954 N/mm^1.5 for a fruit of 10 mm and E* of 1.28 MPa (eq. 12 of the
/// study as recomputed in papers.json).
#[test]
fn reference_hertz_stiffness_of_the_study() {
    let k = hertz_stiffness(1.28e6, 0.01) / 1000f64.powf(1.5);
    assert!((k - 5.396954).abs() < 1e-6, "{k}");
    let lines = "hertz = { radius = \"10 mm\", modulus = \"1 MPa\", poisson = 0.4677071733467426 }";
    let outcome = calibrated(lines, &impacts(&HEIGHTS[3..]));
    let found = outcome.start.hertz_stiffness.unwrap() / 1000f64.powf(1.5);
    assert!((found - 5.396954).abs() < 1e-4, "{found}");
    let rows = outcome.closing.iter();
    let prior = rows.clone().find(|row| row.with.contains("Hertz")).unwrap();
    assert!((prior.sds[0].unwrap() - 0.3).abs() < 0.01, "{prior:?}");
}

/// How far the published responses are from those of a central sphere, and of one
/// with an effective mass of 0.818 (DOMAIN: 52 % and 8 % relative RMS).
#[test]
fn reference_published_responses_are_no_target() {
    let runs = [
        (1.0, 2.25, 3.5e-4, 14.9, 334.0),
        (0.44, 1.8, 2e-4, 9.4, 380.0),
        (0.65, 2.25, 6e-4, 11.8, 275.0),
        (0.86, 1.8, 5e-4, 11.2, 310.0),
        (0.44, 2.7, 5e-4, 13.6, 282.0),
        (0.65, 2.25, 1e-4, 13.6, 385.0),
        (0.44, 1.8, 5e-4, 7.6, 276.0),
        (0.3, 2.25, 3.5e-4, 9.7, 328.0),
        (0.86, 2.7, 2e-4, 18.3, 334.0),
        (0.86, 2.7, 5e-4, 15.1, 287.0),
        (0.65, 2.25, 3.5e-4, 13.1, 326.0),
        (0.44, 2.7, 2e-4, 14.3, 362.0),
        (0.65, 1.5, 3.5e-4, 8.4, 323.0),
        (0.65, 3.0, 3.5e-4, 17.7, 301.0),
        (0.86, 1.8, 2e-4, 12.4, 372.0),
    ];
    let rms = |factor: f64| {
        let rig = DropRig {
            effective_mass_factor: factor,
            ..sprung()
        };
        let mut sum = 0.0;
        for (k, e, c, force, interval) in runs {
            let own = law(k, e, c, 1e-3);
            let found = simulate_drop(&own, &rig, 0.5, 2, EndRule::ForceZero).unwrap();
            sum += (found.impacts[0].peak_contact_force / force - 1.0).powi(2);
            sum += (1e3 * found.intervals[0] / interval - 1.0).powi(2);
        }
        (sum / 30.0).sqrt()
    };
    let (central, lighter) = (rms(1.0), rms(0.818));
    println!("central {central:.4}, effective mass factor 0.818 {lighter:.4}");
    assert!((central - 0.52).abs() < 0.01, "{central}");
    assert!((lighter - 0.08).abs() < 0.01, "{lighter}");
}

#[test]
fn rejects_what_cannot_be_calibrated() {
    let directory = tempfile::tempdir().unwrap();
    let problem = |calibrate_lines: &str, impacts: &str, ways: Vec<Way>| {
        write(directory.path(), calibrate_lines, impacts);
        let request = CalibrateRequest {
            ways,
            ..CalibrateRequest::default()
        };
        calibrate(directory.path(), &request, &windfall_files::progress::quiet)
            .unwrap_err()
            .to_string()
    };
    let lonely = "id,specimen,file,drop_height_mm,peak_force_1_N\nd1,s1,none,500,19\n";
    let text = problem("", lonely, Vec::new());
    assert!(text.contains("no first peak and interval"), "{text}");
    let text = problem("target_height = \"700 mm\"", &impacts(&HEIGHTS), Vec::new());
    assert!(text.contains("drops from 0.7000 m"), "{text}");
    // A design needs a range of every free parameter.
    write(directory.path(), "", &impacts(&HEIGHTS));
    let path = directory.path().join("campaign.toml");
    let whole = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, whole.replace(RANGES, "")).unwrap();
    let request = CalibrateRequest {
        ways: vec![Way::Design],
        ..CalibrateRequest::default()
    };
    let error =
        calibrate(directory.path(), &request, &windfall_files::progress::quiet).unwrap_err();
    assert!(
        error.to_string().contains("parameter k has no range"),
        "{error}"
    );
}
