//! Recordings that hold several impacts: a row of impacts.csv for each.

use assert_cmd::Command;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

fn windfall(line: &[&str], folder: &Path) -> (Option<i32>, String, String) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(line).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// Mass of the carriage; kg.
const MASS: f64 = 0.2;
/// Its speed before contact; m/s.
const SPEED: f64 = 0.5;
/// Dissipation of the law; N s/m^1.5.
const DAMPING: f64 = 1200.0;
/// Between samples; s.
const INTERVAL: f64 = 1e-4;
/// Steps of the integrator between samples.
const STEPS: usize = 50;

/// Uniform numbers of a fixed sequence, of mean 0 and variance 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt()
    }
}

/// A carriage that runs into a fruit, is turned back by hand and runs into the next, for each
/// of the stiffnesses of Kuwabara and Kono's law: time, force and position, in s, N and mm.
fn recording(stiffnesses: &[f64], seed: u64) -> String {
    let (mut force, mut position) = (Vec::new(), Vec::new());
    for stiffness in stiffnesses {
        let (mut x, mut v) = (-0.01, SPEED);
        if let [.., before, last] = position[..] {
            // From rebound to approach, on a smooth way back.
            let (count, back): (usize, f64) = (600, last - before);
            for i in 1..count {
                let s = i as f64 / count as f64;
                let (s2, s3) = (s * s, s * s * s);
                let ends = (2.0 * s3 - 3.0 * s2 + 1.0) * last + (3.0 * s2 - 2.0 * s3) * x;
                let slopes = (s3 - 2.0 * s2 + s) * back + (s3 - s2) * SPEED * INTERVAL;
                position.push(ends + slopes * count as f64);
                force.push(0.0);
            }
        }
        while x > -0.01 || v > 0.0 {
            let push = |x: f64, v: f64| {
                let depth = f64::max(x, 0.0);
                (stiffness * depth.powf(1.5) + DAMPING * depth.sqrt() * v).max(0.0)
            };
            position.push(x);
            force.push(push(x, v));
            for _ in 0..STEPS {
                let dt = INTERVAL / STEPS as f64;
                let half = v - 0.5 * dt * push(x, v) / MASS;
                x += dt * half;
                v = half - 0.5 * dt * push(x, half) / MASS;
            }
        }
    }
    let mut noise = Noise(seed);
    let mut text = "time_s,force_N,position_mm\n".to_owned();
    for (i, (force, position)) in force.iter().zip(&position).enumerate() {
        let time = i as f64 * INTERVAL;
        let (force, position) = (
            force + 0.1 * noise.next(),
            1e3 * position + 2e-3 * noise.next(),
        );
        let _ = writeln!(text, "{time:.4},{force:.4},{position:.5}");
    }
    text
}

#[test]
fn recovers_each_of_several_contacts_in_a_recording() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    std::fs::create_dir(folder.join("recordings")).unwrap();
    let write = |name: &str, stiffnesses: &[f64], seed| {
        let path = folder.join("recordings").join(name);
        std::fs::write(path, recording(stiffnesses, seed)).unwrap();
    };
    write("Gala_f1_a.csv", &[5e5, 7e5, 9e5], 1);
    write("Gala_f2_a.csv", &[6e5], 2);
    let names = "{variety}_f{fruit}_{rep}.csv";
    let new = [
        "new",
        "carriage",
        "bench",
        "--from",
        "recordings",
        "--names",
        names,
        "--format",
        "json",
    ];
    let (status, out, told) = windfall(&new, folder);
    assert_eq!(status, Some(0), "{told}");
    let gathered: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (
            &gathered["recordings"],
            &gathered["impacts"],
            &gathered["specimens"]
        ),
        (&2.into(), &4.into(), &2.into())
    );
    // What was assumed is said, and stands in campaign.toml.
    let assumed = gathered["assumed"].to_string();
    assert!(
        assumed.contains("1 of 2 recordings hold several (3 in Gala_f1_a.csv)"),
        "{assumed}"
    );
    let file = folder.join("bench/campaign.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(
        text.starts_with("# Assumed: every contact is an impact of its own"),
        "{text}"
    );

    let text = text
        .replace("# WRITE YOURS: mass = \"0.5 kg\"", "mass = \"0.2 kg\"")
        .replace("# WRITE YOURS: ", "")
        .replace(
            "laws = [\"kuwabara-kono\", \"hunt-crossley\"]",
            "laws = [\"kuwabara-kono\"]",
        );
    std::fs::write(&file, text).unwrap();
    let (status, out, told) = windfall(&["fit", "bench", "--format", "json"], folder);
    assert_eq!(status, Some(0), "{told}");
    let outcome: Value = serde_json::from_str(&out).unwrap();
    let impacts = outcome["impacts"].as_array().unwrap();
    let expected = [
        ("Gala_f1_a-1", 5e5),
        ("Gala_f1_a-2", 7e5),
        ("Gala_f1_a-3", 9e5),
        ("Gala_f2_a", 6e5),
    ];
    assert_eq!(impacts.len(), expected.len(), "{told}");
    for (impact, (id, stiffness)) in impacts.iter().zip(expected) {
        assert_eq!(impact["id"], id);
        let k = &impact["parameters"]["k"];
        let (k, sd) = (k["value"].as_f64().unwrap(), k["sd"].as_f64().unwrap());
        assert!(
            (k - stiffness).abs() < 4.0 * sd && sd < 0.03 * stiffness,
            "{id}: {k} ± {sd}"
        );
        // Each row says which contact it is of: nothing is left to choose.
        let findings = impact["findings"].to_string();
        assert!(!findings.contains("several-contacts"), "{findings}");
    }

    // The same folder again adds nothing.
    let listed = std::fs::read_to_string(folder.join("bench/impacts.csv")).unwrap();
    let (status, out, told) = windfall(&["add", "bench", "recordings"], folder);
    assert_eq!(status, Some(0), "{told}");
    assert!(out.starts_with("0 impacts added") && out.contains("2 recordings are listed already"));
    assert_eq!(
        std::fs::read_to_string(folder.join("bench/impacts.csv")).unwrap(),
        listed
    );
    // A later recording is divided likewise.
    write("Kanzi_f1_a.csv", &[8e5, 4e5], 3);
    let (status, out, told) = windfall(&["add", "bench", "recordings"], folder);
    assert_eq!(status, Some(0), "{told}");
    assert!(
        out.starts_with("2 impacts added, of which 1 specimens are new"),
        "{out}"
    );
    assert!(out.contains("2 in Kanzi_f1_a.csv"), "{out}");
    let now = std::fs::read_to_string(folder.join("bench/impacts.csv")).unwrap();
    assert!(
        now.starts_with(&listed) && now.contains("Kanzi_f1_a-2,Kanzi-1,"),
        "{now}"
    );
}

#[test]
fn rejects_a_row_for_several_contacts_by_name_of_the_columns_to_set() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    std::fs::write(folder.join("r.csv"), recording(&[5e5, 7e5], 1)).unwrap();
    let line = "fit r.csv --rig carriage --mass 0.2 --law kuwabara-kono --time time_s \
                --channel force=force_N:N --channel position=position_mm:mm";
    let line: Vec<&str> = line.split_whitespace().collect();
    let (_, out, told) = windfall(&line, folder);
    let words = format!("{out}{told}")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    assert!(
        words.contains("a row of its own in impacts.csv, with from_s and to_s around it"),
        "{words}"
    );
}
