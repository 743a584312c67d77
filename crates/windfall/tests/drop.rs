//! Campaigns of a drop rig.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::settings::template::{TemplateKind, write_template};
use windfall_drop::calibrate_settings::{RangeUnit, Target};
use windfall_drop::read::{DropCampaign, PlatePlan, drop_of, read_drop};
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::measured::{MeasuredItem, MeasuredOutcome, value_of};
use windfall_report::any_text::{csv_of_any, text_of_any};
use windfall_report::fit_any::fit_any;
use windfall_simulate::drops::{SimulateDropsRequest, simulate_drops};
use windfall_simulate::request::drop::{DropRequest, drop_plan};

fn template(folder: &Path) -> PathBuf {
    let directory = folder.join("campaign");
    write_template(TemplateKind::Drop, &directory).unwrap();
    directory
}

/// Replaces a text in a file of a campaign.
fn edit(directory: &Path, file: &str, from: &str, to: &str) {
    let path = directory.join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file} has no {from:?}:\n{text}");
    std::fs::write(path, text.replace(from, to)).unwrap();
}

/// Reads the template with one change.
fn changed(file: &str, from: &str, to: &str) -> Result<DropCampaign, String> {
    let folder = tempfile::tempdir().unwrap();
    let directory = template(folder.path());
    edit(&directory, file, from, to);
    read_drop(&directory).map_err(|error| error.to_string())
}

/// Message of the template with one change, from the name of the file on.
fn refused(file: &str, from: &str, to: &str) -> String {
    let message = changed(file, from, to).unwrap_err();
    let at = message.find("/campaign/").map_or(0, |at| at + 10);
    message[at..].to_owned()
}

/// The rig of Kang et al. (2023): 0.2 kg plate, 10 N/V, 4.8 g fruit, 500 mm; start
/// values from 10 mm, 1 MPa and 0.468 (its eqs. 7 to 12).
#[test]
fn reference_template_holds_the_study() {
    let folder = tempfile::tempdir().unwrap();
    let campaign = read_drop(&template(folder.path())).unwrap();
    let PlatePlan::Sprung {
        mass,
        stiffness: None,
        damping: None,
    } = campaign.rig.plate
    else {
        panic!("{:?}", campaign.rig.plate);
    };
    assert_eq!(mass.value, 0.2);
    assert_eq!(campaign.rig.gravity, 9.80665);
    let force = &campaign.shared.files.channels[0];
    assert!((force.scale - 10.0).abs() < 1e-12, "{} N/V", force.scale);
    let drop = drop_of(&campaign, &campaign.shared.entries[1]).unwrap();
    assert!((drop.height.value - 0.5).abs() < 1e-15 && (drop.height.sd - 1e-3).abs() < 1e-15);
    assert!((drop.mass.value - 4.76e-3).abs() < 1e-15 && (drop.mass.sd - 5e-5).abs() < 1e-15);

    let settings = &campaign.calibrate;
    let law = settings.law.as_ref().unwrap();
    assert_eq!(law.free, [0, 1, 2]);
    assert_eq!(law.law.values[3], Some(1e-6));
    assert_eq!(settings.target, Target::Height(0.5));
    let hertz = settings.hertz.unwrap();
    assert_eq!(
        (hertz.radius, hertz.modulus, hertz.poisson),
        (0.01, 1e6, 0.468)
    );
    // 0.868 N/mm^1.91 = 466143.5992 N/m^1.91 (check_values: DOMAIN 1.2).
    let k = &settings.ranges[0];
    assert!(matches!(k.unit, RangeUnit::OfExponent { exponent: 1, .. }));
    let si = k.si(0.868, &[0.0, 1.91, 0.0, 0.0]);
    assert!((si / 466_143.599_2 - 1.0).abs() < 1e-9, "{si}");
    assert_eq!(
        (settings.ranges[2].low, settings.ranges[2].unit.clone()),
        (0.1, RangeUnit::Si)
    );
}

/// Impacts.csv goes before specimens.csv, and both before [rig].
#[test]
fn closed_form_the_nearest_mass_and_height_count() {
    let drop = |file: &str, from: &str, to: &str| {
        let campaign = changed(file, from, to).unwrap();
        let drops = campaign.shared.entries.iter();
        drops
            .map(|entry| drop_of(&campaign, entry).unwrap())
            .collect::<Vec<_>>()
    };
    let header = "drop_height_mm\nc-100-1,fruit-1,c-100-1.csv,100";
    let more = "drop_height_mm,drop_height_sd_mm,mass_g,mass_sd_g\nc-100-1,fruit-1,c-100-1.csv,100,2,5,0.2";
    let found = {
        let folder = tempfile::tempdir().unwrap();
        let directory = template(folder.path());
        edit(&directory, "impacts.csv", header, more);
        edit(&directory, "impacts.csv", "csv,500", "csv,500,,,");
        let campaign = read_drop(&directory).unwrap();
        let drops = campaign.shared.entries.iter();
        drops
            .map(|entry| drop_of(&campaign, entry).unwrap())
            .collect::<Vec<_>>()
    };
    let close = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-12);
    close(found[0].height.sd, 2e-3);
    close(found[0].mass.value, 5e-3);
    close(found[0].mass.sd, 2e-4);
    close(found[1].height.sd, 1e-3);
    close(found[1].mass.value, 4.76e-3);
    let of_rig = drop("campaign.toml", "# mass = \"4.8 g\" ", "mass = \"4.8 g\" ");
    close(of_rig[0].mass.value, 4.82e-3);
    let in_metres = drop("impacts.csv", "drop_height_mm", "drop_height_m");
    close(in_metres[1].height.value, 500.0);
}

#[test]
fn rejects_a_drop_without_mass_or_height() {
    assert_eq!(
        refused("specimens.csv", "4.76", ""),
        "impacts.csv, line 3: the mass of \"c-500-1\" is not known: column \"mass_g of \
         specimens.csv or impacts.csv\" is blank or in no unit of it; fill it in, or give one value \
         for all drops in campaign.toml: [rig] mass = \"4.8 g\""
    );
    let message = refused("impacts.csv", "csv,500", "csv,");
    assert!(
        message.starts_with("impacts.csv, line 3: the drop height of \"c-500-1\" is not known"),
        "{message}"
    );
    let message = refused("impacts.csv", "drop_height_mm", "height");
    assert!(
        message.contains("line 2") && message.contains("is not there"),
        "{message}"
    );
    assert!(
        message.contains("drop_height_mm of impacts.csv"),
        "{message}"
    );
    assert!(message.contains("[rig] height = \"500 mm\""), "{message}");
    assert_eq!(
        refused("impacts.csv", "csv,500", "csv,-500"),
        "impacts.csv, line 3, column \"drop_height_mm\": \"-500\" is not a number above zero; \
         leave the cell blank where it is not known"
    );
    let message = refused("specimens.csv", "4.76", "heavy");
    assert!(
        message.starts_with("specimens.csv, line 3, column \"mass_g\": \"heavy\""),
        "{message}"
    );
}

#[test]
fn rejects_what_the_rig_cannot_be() {
    let rig = |from: &str, to: &str| refused("campaign.toml", from, to);
    let plate = "plate_mass = \"0.2 kg\"  ";
    let message = rig(plate, "plate_damping = \"52 N s/m\"  ");
    assert!(
        message.contains("plate_mass") && message.contains("rigid"),
        "{message}"
    );
    let message = rig(plate, "plate = \"rigid\"\nplate_mass = \"0.2 kg\"  ");
    assert!(
        message.contains("a rigid plate has no such value"),
        "{message}"
    );
    let message = rig(
        plate,
        "plate_mass = \"0.2 kg\"\nplate_stiffness_sd = \"5 N/mm\" ",
    );
    assert!(message.contains("without its value"), "{message}");
    let message = rig(
        "# effective_mass_factor = 0.818 ",
        "effective_mass_factor = 1.2 ",
    );
    assert!(message.contains("a central impact"), "{message}");
    let message = rig("mass_sd = \"0.05 g\" ", "mass_sd = \"-1 g\" ");
    assert!(message.contains("must not be below zero"), "{message}");
    assert!(
        matches!(
            changed("campaign.toml", plate, "plate = \"rigid\"  ")
                .unwrap()
                .rig
                .plate,
            PlatePlan::Rigid
        ),
        "rigid"
    );
}

#[test]
fn rejects_what_cannot_be_calibrated() {
    let settings = |from: &str, to: &str| refused("campaign.toml", from, to);
    let message = settings("e = [1.5, 3.0]", "d = [1.5, 3.0]");
    assert!(
        message.contains("no free parameter of this name") && message.contains("k, e, c"),
        "{message}"
    );
    let message = settings("\"0.3 N/mm^e\"", "\"0.3 N/m^e\"");
    assert!(message.contains("same unit, the lower first"), "{message}");
    let message = settings("\"0.3 N/mm^e\"", "\"0.3 N/mm^1.91\"");
    assert!(
        message.contains("the exponent in the unit of this parameter"),
        "{message}"
    );
    let message = settings("e = [1.5, 3.0]", "e = [3.0, 1.5]");
    assert!(message.contains("the lower first"), "{message}");
    let message = settings("# start = 'adams-impact(", "start = 'hertz(k=2) # ");
    assert!(message.contains("line"), "{message}");
    let message = settings("target_height = \"500 mm\" ", "target_drop = \"c-500-9\" ");
    assert!(
        message.contains("no drop of this id (did you mean \"c-500-1\"?)"),
        "{message}"
    );
    let message = settings("bounces = 2 ", "bounces = 0 ");
    assert!(message.contains("from 1 to 100"), "{message}");
    let message = settings("poisson = 0.468", "poisson = 0.7");
    assert!(message.contains("from -1 to 0.5"), "{message}");
    let message = settings("# ways = [\"waveform\", ", "ways = [\"waveforms\", ");
    assert!(message.contains("did you mean \"waveform\"?"), "{message}");
    let message = settings(
        "static_level = \"before-first\" ",
        "static_level = \"3 V\" ",
    );
    assert!(
        message.contains("[bounces] static_level") && message.contains("follow"),
        "{message}"
    );
    let message = settings("# release = 0.5 ", "release = 1.5 ");
    assert!(message.contains("above 0 and below 1"), "{message}");
    let message = settings("threshold = \"auto\" ", "threshold = \"3 V\" ");
    assert!(message.contains("[bounces] threshold"), "{message}");
}

/// Rig and law of Kang et al. (2023): Table 6 and eqs. (5) and (6).
fn study(heights: &[&str]) -> DropRequest {
    DropRequest {
        laws: None,
        law: "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")"
            .to_owned(),
        mass: "4.8 g".to_owned(),
        heights: heights.iter().map(|height| (*height).to_owned()).collect(),
        plate_mass: Some("0.2 kg".to_owned()),
        plate_stiffness: Some("645.8 N/mm".to_owned()),
        plate_damping: Some("52.47 N s/m".to_owned()),
        effective_mass_factor: 1.0,
        gravity: "9.80665 m/s^2".to_owned(),
        impacts: 2,
        end: "force-zero".to_owned(),
    }
}

fn bench(drops: usize) -> SimulateDropsRequest {
    SimulateDropsRequest {
        drops,
        mass_spread: 0.06,
        mass_sd: "0.02 g".to_owned(),
        height_sd: "1 mm".to_owned(),
        spread: Vec::new(),
        hold: Vec::new(),
        sensitivity: "0.1 V/N".to_owned(),
        noise: "0.03 N".to_owned(),
        bits: 12,
        range: "5 V".to_owned(),
        lowest: None,
        sampling_rate: "10 kHz".to_owned(),
        duration: "1.5 s".to_owned(),
        seed: 1,
    }
}

fn simulated(folder: &Path, drop: &DropRequest, bench: &SimulateDropsRequest) -> PathBuf {
    let directory = folder.join("campaign");
    simulate_drops(&directory, &drop_plan(drop).unwrap(), bench).unwrap();
    directory
}

fn fitted(directory: &Path) -> MeasuredOutcome {
    match fit_any(
        directory,
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    )
    .unwrap()
    {
        AnyOutcome::Measured(outcome) => *outcome,
        AnyOutcome::Impacts(_) => panic!("not a campaign of drops"),
    }
}

fn value(item: &MeasuredItem, name: &str) -> (f64, f64) {
    let found = value_of(item, name).unwrap_or_else(|| panic!("{} has no {name}", item.id));
    (found.value, found.sd.unwrap_or(0.0))
}

/// A column of truth.csv whose cells are lists.
fn truth(directory: &Path, column: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(directory.join("truth.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let index = reader
        .headers()
        .unwrap()
        .iter()
        .position(|name| name == column)
        .unwrap();
    let numbers = |cell: &str| {
        cell.split(' ')
            .map(|number| number.parse().unwrap())
            .collect()
    };
    reader
        .records()
        .map(|row| numbers(&row.unwrap()[index]))
        .collect()
}

/// Volts of 12 bits with noise, unknown release, fruit that differ, heights
/// that are set to a millimetre: intervals, restitutions and the plate come back.
#[test]
fn recovers_bounces_restitution_and_plate() {
    let folder = tempfile::tempdir().unwrap();
    let directory = simulated(folder.path(), &study(&["200 mm", "500 mm"]), &bench(3));
    let outcome = fitted(&directory);
    assert_eq!((outcome.impacts.len(), outcome.failed.len()), (6, 0));
    let onsets = truth(&directory, "onset_times_s");
    let restitutions = truth(&directory, "restitutions");
    let peaks = truth(&directory, "peak_support_forces_N");
    for (drop, item) in outcome.impacts.iter().enumerate() {
        for (bounce, end) in ["", "_2"].iter().enumerate() {
            let (interval, sd) = value(item, &format!("interval{end}"));
            let exact = onsets[drop][bounce + 1] - onsets[drop][bounce];
            assert!(
                (interval - exact).abs() < 4.0 * sd && sd < 2e-4,
                "{}: {interval} ± {sd}, {exact}",
                item.id
            );
            let (peak, sd) = value(item, &format!("peak_force{end}"));
            assert!(
                (peak - peaks[drop][bounce]).abs() < 5.0 * sd,
                "{}: {peak} ± {sd}",
                item.id
            );
            for method in ["restitution", "restitution_by_impulse"] {
                let (e, sd) = value(item, &format!("{method}{end}"));
                let exact = restitutions[drop][bounce];
                assert!(
                    (e - exact).abs() < 4.0 * sd && sd < 0.02,
                    "{}: {method}{end} {e} ± {sd}, {exact}",
                    item.id
                );
            }
        }
        // 1.5 s hold three impacts from 500 mm; from 200 mm the last are lost in noise.
        let bounces = value(item, "bounces").0;
        assert!(
            if drop < 3 {
                bounces >= 5.0
            } else {
                bounces == 3.0
            },
            "{bounces}"
        );
    }
    let plate = outcome
        .whole
        .iter()
        .find(|item| item.id == "from the ringing")
        .unwrap();
    for (name, exact, material) in [
        ("plate_stiffness", 645_800.0, 0.002),
        ("plate_damping", 52.47, 0.01),
        ("natural_frequency", (645_800.0_f64 / 0.2).sqrt(), 0.001),
    ] {
        let (found, sd) = value(plate, name);
        assert!((found - exact).abs() < 4.0 * sd, "{name}: {found} ± {sd}");
        assert!((found / exact - 1.0).abs() < material, "{name}: {found}");
    }
    let rows: Vec<&str> = outcome.whole.iter().map(|item| item.id.as_str()).collect();
    assert_eq!(rows, ["200 mm", "500 mm", "all drops", "from the ringing"]);
    // Every bounce is a part with its own impact speed.
    let bounces: f64 = outcome
        .impacts
        .iter()
        .map(|item| value(item, "bounces").0)
        .sum();
    assert_eq!(outcome.parts.len() as f64, bounces);
    let (first, second) = (
        value(&outcome.parts[0], "impact_velocity").0,
        value(&outcome.parts[1], "impact_velocity").0,
    );
    assert!((first - (2.0 * 9.80665 * 0.2_f64).sqrt()).abs() < 1e-12 && second < first);
    // Nothing has changed: all from the store, and the same.
    let again = fitted(&directory);
    assert!(again.status.up_to_date);
    assert_eq!(
        (again.impacts, again.parts),
        (outcome.impacts, outcome.parts)
    );
}

/// A cart or a stiff anvil: no ringing is looked for.
#[test]
fn recovers_bounces_on_a_rigid_plate() {
    let folder = tempfile::tempdir().unwrap();
    let rigid = DropRequest {
        plate_mass: None,
        plate_stiffness: None,
        plate_damping: None,
        ..study(&["300 mm"])
    };
    let directory = simulated(folder.path(), &rigid, &bench(1));
    let outcome = fitted(&directory);
    let exact = truth(&directory, "restitutions")[0][0];
    let (e, sd) = value(&outcome.impacts[0], "restitution");
    assert!((e - exact).abs() < 4.0 * sd, "{e} ± {sd}, {exact}");
    assert!(outcome.whole.is_empty());

    // The table of results has each column once: number and word "bounces" are two.
    let csv = csv_of_any(&AnyOutcome::Measured(Box::new(outcome))).unwrap();
    let mut columns: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    assert!(
        columns.contains(&"bounces") && columns.contains(&"bounces_text"),
        "{columns:?}"
    );
    let all = columns.len();
    columns.sort_unstable();
    columns.dedup();
    assert_eq!(columns.len(), all);
}

#[test]
fn repeats_the_same_recordings_for_the_same_seed() {
    let folder = tempfile::tempdir().unwrap();
    let recording = |name: &str, seed| {
        let directory = folder.path().join(name);
        let bench = SimulateDropsRequest { seed, ..bench(1) };
        simulate_drops(&directory, &drop_plan(&study(&["500 mm"])).unwrap(), &bench).unwrap();
        std::fs::read(directory.join("raw/drop-500-1.csv")).unwrap()
    };
    let first = recording("first", 7);
    assert_eq!(first, recording("second", 7));
    assert_ne!(first, recording("third", 8));
}

/// What is poor in a recording is said in the text that a person reads.
#[test]
fn rejects_poor_recordings_in_words() {
    let check = |code: &str,
                 words: &str,
                 drop: &DropRequest,
                 bench: &SimulateDropsRequest,
                 spoil: &dyn Fn(&Path)| {
        let folder = tempfile::tempdir().unwrap();
        let directory = simulated(folder.path(), drop, bench);
        spoil(&directory);
        let outcome = fitted(&directory);
        let text = text_of_any(&AnyOutcome::Measured(Box::new(outcome)));
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            line.contains(&format!("{code}: ")) && line.contains(words),
            "{code}:\n{text}"
        );
    };
    let (drop, usual) = (study(&["500 mm"]), bench(1));
    let with = |change: &dyn Fn(&mut SimulateDropsRequest)| {
        let mut bench = usual.clone();
        change(&mut bench);
        bench
    };
    let none: &dyn Fn(&Path) = &|_| {};
    let clipped = with(&|bench| bench.range = "1 V".to_owned());
    check("bounce_clipped", "larger range", &drop, &clipped, none);
    let short = with(&|bench| bench.duration = "0.7 s".to_owned());
    check("not_valid", "one impact on the plate", &drop, &short, none);
    let slow = with(&|bench| bench.sampling_rate = "1500 Hz".to_owned());
    check("slow_sampling", "samples in contact", &drop, &slow, none);
    let soft = DropRequest {
        plate_damping: Some("4 N s/m".to_owned()),
        ..study(&["20 mm"])
    };
    check("still_ringing", "still rings", &soft, &usual, none);
    // Half the volts per newton: every impulse is double of what m v (1 + e) is.
    check(
        "force_scale",
        "volts per newton",
        &drop,
        &usual,
        &|directory| {
            edit(
                directory,
                "campaign.toml",
                "sensitivity = \"0.1 V/N\"",
                "sensitivity = \"0.05 V/N\"",
            );
        },
    );
    // A transmitter that warms up: 30 mV in the recording, 0.3 N.
    check(
        "static_level_drifts",
        "follow",
        &drop,
        &usual,
        &|directory| {
            let path = directory.join("raw/drop-500-1.csv");
            let text = std::fs::read_to_string(&path).unwrap();
            let mut lines = text.lines();
            let mut drifting = lines.next().unwrap().to_owned() + "\n";
            for (i, line) in lines.enumerate() {
                let volts: f64 = line.parse().unwrap();
                drifting += &format!("{}\n", volts + 2e-6 * i as f64);
            }
            std::fs::write(&path, drifting).unwrap();
        },
    );
}
