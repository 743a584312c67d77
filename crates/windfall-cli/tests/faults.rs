//! Recordings in which one thing is wrong: the cause is named, and no wrong value counts.
//! `bench/faults` does the same with thousands of impacts and three simulators.

use assert_cmd::Command;
use serde_json::Value;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Samples in a second.
const RATE: f64 = 200e3;
/// Output of the force sensor; V/N.
const SENSITIVITY: f64 = 0.011;
/// Stiffness of all impacts; N/m^1.5.
const STIFFNESS: f64 = 753_599.0;
const IMPACTS: usize = 3;
/// Column of the force, after two phases of the encoder.
const FORCE: usize = 2;

fn windfall(line: &str, folder: &Path) -> String {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(line.split(' ')).current_dir(folder).output();
    let output = output.unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    String::from_utf8(output.stdout).unwrap()
}

/// Impacts of a pendulum on one fruit: force and the two phases of an encoder, in volts.
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let law = format!("--law kuwabara-kono(k={STIFFNESS},c=1524)");
    let rig = "--inertia 0.01435kg*m^2 --arm 0.505m --mass 0.08kg --centre-of-mass 0.35m";
    let many = format!("--velocity 0.388m/s --specimens 1 --repeats {IMPACTS}");
    let line = format!("simulate pendulum {law} {rig} {many} --recordings campaign");
    windfall(&line, folder.path());
    folder
}

/// Rows of a recording, with the force in N.
type Rows = Vec<Vec<f64>>;

/// Changes all recordings.
fn change(folder: &Path, fault: impl Fn(&mut Rows)) {
    let files = std::fs::read_dir(folder.join("campaign/raw")).unwrap();
    let files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let (header, body) = text.split_once('\n').unwrap();
        let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let mut rows: Rows = body.lines().map(row).collect();
        rows.iter_mut().for_each(|row| row[FORCE] /= SENSITIVITY);
        fault(&mut rows);
        let mut out = header.to_owned() + "\n";
        for row in &mut rows {
            row[FORCE] *= SENSITIVITY;
            let cells: Vec<String> = row.iter().map(f64::to_string).collect();
            out += &(cells.join(",") + "\n");
        }
        std::fs::write(&file, out).unwrap();
    }
}

/// Rows in which the force is above half of its peak: first and last.
fn pulse(rows: &Rows) -> (usize, usize) {
    let peak = peak(rows);
    let high = |row: &Vec<f64>| row[FORCE] > 0.5 * peak;
    let first = rows.iter().position(high).unwrap();
    (first, rows.iter().rposition(high).unwrap())
}

fn peak(rows: &Rows) -> f64 {
    rows.iter().map(|row| row[FORCE]).fold(0.0, f64::max)
}

/// Fits impacts with a fault. Each names one of the causes; those that count are right to
/// within `largest`. `counts`: whether all or none count, where that is certain.
fn check(causes: &[&str], counts: Option<bool>, largest: f64, fault: impl Fn(&mut Rows)) {
    let laboratory = campaign();
    change(laboratory.path(), fault);
    let outcome = windfall("fit campaign --format json", laboratory.path());
    let outcome: Value = serde_json::from_str(&outcome).unwrap();
    let impacts = outcome["impacts"].as_array().unwrap();
    let failed = outcome["failed"].as_array().unwrap().len();
    assert_eq!(impacts.len() + failed, IMPACTS, "{outcome}");
    assert!(failed == 0 || counts == Some(false), "{outcome}");
    for impact in impacts {
        let list = |key: &str| impact[key].as_array().unwrap().clone();
        let out = list("left_out");
        let all: Vec<Value> = list("findings").into_iter().chain(out.clone()).collect();
        let k = impact["parameters"]["k"]["value"].as_f64().unwrap();
        let off = k / STIFFNESS - 1.0;
        if let Some(counts) = counts {
            assert_eq!(out.is_empty(), counts, "k is off by {off}: {all:#?}");
        }
        assert!(!out.is_empty() || off.abs() < largest, "{off}: {all:#?}");
        let named = |own: &Value| causes.contains(&own["code"].as_str().unwrap());
        assert!(causes.is_empty() || all.iter().any(named), "{all:#?}");
    }
}

#[test]
fn recovers_the_law_without_a_fault() {
    check(&[], Some(true), 0.005, |_| {});
}

#[test]
fn recovers_the_law_under_a_slow_drift() {
    // Half a newton over the recording was enough to lose the whole baseline.
    for rise in [0.5, 1.0, -1.0] {
        check(&[], Some(true), 0.02, |rows| {
            let count = rows.len() as f64;
            let shift = |i: usize| rise * (i as f64 / count - 0.5);
            (0..rows.len()).for_each(|i| rows[i][FORCE] += shift(i));
        });
    }
}

#[test]
fn recovers_the_law_under_the_hum_of_the_mains() {
    for phase in [0.0, 0.5 * PI, PI] {
        check(&[], None, 0.05, |rows| {
            let angle = |i: usize| 2.0 * PI * 50.0 * i as f64 / RATE + phase;
            (0..rows.len()).for_each(|i| rows[i][FORCE] += angle(i).sin());
        });
    }
}

#[test]
fn recovers_the_law_after_a_knock_on_the_bench() {
    for size in [0.9, 1.5] {
        check(&["bump"], None, 0.02, |rows| {
            let (first, _) = pulse(rows);
            let (centre, size) = (first as f64 - 400.0, size * peak(rows));
            let knock = |i: usize| size * (-((i as f64 - centre) / 30.0).powi(2)).exp();
            (0..rows.len()).for_each(|i| rows[i][FORCE] += knock(i));
        });
    }
}

#[test]
fn recovers_the_law_beside_single_wrong_samples() {
    for place in [50, 700] {
        check(&["glitch"], None, 0.02, |rows| {
            rows[place][FORCE] += 30.0;
        });
    }
}

#[test]
fn rejects_a_recording_that_begins_in_contact() {
    check(&["contact-at-start"], Some(false), 0.0, |rows| {
        let (first, _) = pulse(rows);
        rows.drain(..first);
    });
}

#[test]
fn rejects_a_force_at_the_end_of_its_range() {
    for part in [0.6, 0.4] {
        check(&["clipped"], Some(false), 0.0, |rows| {
            let limit = part * peak(rows);
            rows.iter_mut()
                .for_each(|row| row[FORCE] = row[FORCE].min(limit));
        });
    }
}

#[test]
fn rejects_rows_that_are_missing_in_contact() {
    for lost in [50, 200] {
        let causes = ["gap-in-contact", "impulse-mismatch"];
        check(&causes, Some(false), 0.0, |rows| {
            let (first, last) = pulse(rows);
            let middle = usize::midpoint(first, last);
            rows.drain(middle..middle + lost);
        });
    }
}

#[test]
fn rejects_a_force_that_comes_late() {
    for late in [30, 60] {
        check(&["late-channel"], Some(false), 0.0, |rows| {
            for i in (late..rows.len()).rev() {
                rows[i][FORCE] = rows[i - late][FORCE];
            }
        });
    }
}

#[test]
fn rejects_a_force_in_other_units() {
    for factor in [4.448, 1.0 / 9.81] {
        let causes = ["impulse-contradicts-momentum", "contradicts-others"];
        check(&causes, Some(false), 0.0, |rows| {
            rows.iter_mut().for_each(|row| row[FORCE] *= factor);
        });
    }
}

#[test]
fn recovers_the_law_in_noise_whose_samples_agree() {
    // Twice the threshold of the noise alone, with a memory of fifty samples.
    check(&[], None, 0.2, |rows| {
        let (mut state, mut noise) = (12_345_u64, 0.0);
        for row in rows {
            let mut push = -6.0;
            for _ in 0..12 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                push += (state >> 11) as f64 / (1_u64 << 53) as f64;
            }
            noise = 0.98 * noise + 0.2 * push;
            row[FORCE] += 2.0 * noise;
        }
    });
}

#[test]
fn rejects_a_person_who_stands_on_the_sensor_with_what_was_found() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("raw")).unwrap();
    // Stands, and jumps three times: flies for a quarter of a second and lands.
    let force = |time: f64| {
        let stands = 400.0 + 30.0 * (0.9 * time).sin();
        [2.7, 6.2, 9.9]
            .iter()
            .fold(stands, |force, lands| match time - lands {
                -0.25..0.0 => 0.0,
                after @ 0.0..0.3 => force + 900.0 * (PI * after / 0.3).sin(),
                _ => force,
            })
    };
    let row = |i: u32| {
        let time = 4e-3 * f64::from(i);
        format!("{time:.3},{:.4}\n", force(time))
    };
    let rows: String = (0..3000).map(row).collect();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("raw/r.csv", format!("time_s,force_N\n{rows}"));
    let rig = "[rig]\nkind = \"carriage\"\nmass = \"1 kg\"\ndriving_acceleration = \"0 m/s^2\"";
    let files = "[files]\ndirectory = \"raw\"\ntime = \"time_s\"";
    let channel = "[channels.force]\ncolumn = \"force_N\"\nunit = \"N\"";
    let fit = "[fit]\nlaws = [\"kelvin-voigt\"]\nquantities = [\"force\"]";
    let campaign = format!("format = 1\n{rig}\n{files}\n{channel}\n{fit}\n");
    write("campaign.toml", campaign);
    write(
        "impacts.csv",
        "id,specimen,file\nown,person,r.csv\n".to_owned(),
    );
    let fit = |line: &[&str]| {
        let mut command = Command::cargo_bin("windfall").unwrap();
        let output = command.args(line).current_dir(folder.path()).output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    let outcome: Value = serde_json::from_str(&fit(&["fit", ".", "--format", "json"])).unwrap();
    let failed = &outcome["failed"][0];
    let message = failed["message"].as_str().unwrap();
    assert!(
        message.contains("Likeliest cause: a static load"),
        "{outcome}"
    );
    let findings = failed["findings"].as_array().unwrap();
    let has = |code: &str| findings.iter().any(|own| own["code"] == code);
    assert!(has("contact") && has("contact-at-start"), "{failed}");
    // The second time the same, although the store keeps no findings of failures.
    let text = fit(&["fit", "."]);
    assert!(text.contains("0 of 1 impacts count"), "{text}");
    assert!(text.contains("contact-at-start: "), "{text}");
}

/// Steps of the encoder of a quarter of the penetration are no second motion.
#[test]
fn reference_a_coarse_encoder_takes_no_impact_out() {
    let laboratory = tempfile::tempdir().unwrap();
    let law = format!("--law kuwabara-kono(k={STIFFNESS},c=1524)");
    let rig = "--inertia 0.01435kg*m^2 --arm 0.505m --mass 0.08kg --centre-of-mass 0.35m";
    let encoder = "--encoder counts --counts-per-revolution 20000 --noise 0.3N";
    let line = format!(
        "simulate pendulum {law} {rig} {encoder} --velocity 0.388m/s --specimens 1 --repeats 6 \
         --recordings campaign"
    );
    windfall(&line, laboratory.path());
    let outcome = windfall("fit campaign --format json", laboratory.path());
    let outcome: Value = serde_json::from_str(&outcome).unwrap();
    let impacts = outcome["impacts"].as_array().unwrap();
    assert_eq!(impacts.len(), 6);
    for impact in impacts {
        assert_eq!(impact["left_out"], Value::Array(vec![]), "{}", impact["id"]);
        let noise = impact["derived"]["motion_noise"].as_f64().unwrap();
        assert!(noise > 2e-5, "{noise}");
    }
}
