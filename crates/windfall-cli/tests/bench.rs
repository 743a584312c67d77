//! What all impacts of a campaign say of their bench.

use crate::counted::{fitted, windfall};
use serde_json::Value;
use std::path::Path;

/// Sixteen impacts on a pendulum of 0.01435 kg m².
fn campaign() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate pendulum --law kuwabara-kono(k=753599,c=1524) --specimens 4 --repeats 4 \
                --recordings campaign";
    let line = line.replace("                ", "");
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

/// Replaces a part of campaign.toml.
fn tell(folder: &Path, old: &str, new: &str) {
    let path = folder.join("campaign/campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{text}");
    std::fs::write(&path, text.replacen(old, new, 1)).unwrap();
}

/// What has the inertia estimated.
const INERTIA: &str = "[fit]\nestimate = [\"inertia\"]\n";

fn said(outcome: &Value) -> Vec<(String, String)> {
    let found = outcome["findings"].as_array().unwrap();
    let text = |own: &Value, key: &str| own[key].as_str().unwrap().to_owned();
    let found = found
        .iter()
        .map(|own| (text(own, "code"), text(own, "message")));
    found.filter(|own| own.0.starts_with("bench-")).collect()
}

#[test]
fn closed_form_gain_and_delay_of_a_bench_that_is_as_told() {
    let folder = campaign();
    let outcome = fitted(folder.path());
    assert_eq!(said(&outcome), []);
    let gain = &outcome["bench"]["force_gain"];
    assert_eq!(gain["impacts"], 16);
    let (value, sd) = (
        gain["value"].as_f64().unwrap(),
        gain["sd"].as_f64().unwrap(),
    );
    assert!((value - 1.0).abs() < 4.0 * sd && sd < 0.005, "{gain}");
    let (_, out, _) = windfall("fit campaign", folder.path());
    assert!(
        out.contains("By Newton's law, over 16 impacts: the force is"),
        "{out}"
    );
}

#[test]
fn recovers_an_inertia_that_is_not_what_the_file_says() {
    let folder = campaign();
    tell(
        folder.path(),
        "inertia = \"0.01435",
        "inertia = \"0.0150675",
    );
    let found = said(&fitted(folder.path()));
    let [(code, message), (cause, named)] = &found[..] else {
        panic!("{found:?}")
    };
    assert_eq!([code, cause], ["bench-gain", "bench-cause"]);
    assert!(
        named.contains("best explained by a force that reads"),
        "{named}"
    );
    assert!(
        message.contains("inertia") && message.contains("too large"),
        "{message}"
    );
}

/// Mean area of the loop of force over displacement, over the energy that the motion loses.
fn loop_over_loss(outcome: &Value) -> f64 {
    let impacts = outcome["impacts"].as_array().unwrap();
    let of = |own: &Value| {
        let derived = &own["derived"];
        let [area, lost] = ["hysteresis_energy", "absorbed_energy"].map(|n| derived[n].as_f64());
        area.unwrap() / lost.unwrap()
    };
    impacts.iter().map(of).sum::<f64>() / impacts.len() as f64
}

#[test]
fn recovers_a_force_that_is_late() {
    let folder = campaign();
    let before = loop_over_loss(&fitted(folder.path()));
    tell(
        folder.path(),
        "[channels.force]\n",
        "[channels.force]\ndelay = \"-40 us\"\n",
    );
    let outcome = fitted(folder.path());
    let found = said(&outcome);
    let codes: Vec<&str> = found.iter().map(|own| own.0.as_str()).collect();
    assert_eq!(codes, ["bench-delay", "bench-cause"], "{found:?}");
    assert!(found[1].1.contains("µs late"), "{found:?}");
    let told = found[0].1.split("is about ").nth(1).unwrap();
    let (percent, side) = told.split_once(" % of the absorbed energy too ").unwrap();
    let lost = 100.0 * (before - loop_over_loss(&outcome));
    let percent: f64 = percent.parse().unwrap();
    assert!(
        side.starts_with("small") && (percent / lost - 1.0).abs() < 0.1,
        "{percent} {lost}"
    );
}

/// Deviations of k and c, and what the bench adds to the mean of k.
fn deviations(outcome: &Value) -> (f64, f64, Option<f64>) {
    let own = &outcome["impacts"][0]["parameters"];
    let sd = |name: &str| own[name]["sd"].as_f64().unwrap() / own[name]["value"].as_f64().unwrap();
    let mean = &outcome["summary"]["k"];
    let common = mean["common_sd"].as_f64();
    (
        sd("k"),
        sd("c"),
        common.map(|sd| sd / mean["mean"].as_f64().unwrap()),
    )
}

#[test]
fn closed_form_an_uncertain_inertia_is_in_every_interval_and_not_averaged_out() {
    let folder = campaign();
    let exact = fitted(folder.path());
    assert_eq!(deviations(&exact).2, None);
    tell(folder.path(), "kg m^2\"", "kg m^2 ± 2 %\"");
    let outcome = fitted(folder.path());
    let (k, c, common) = deviations(&outcome);
    // The displacement is fitted far better than the force: k and c follow the inertia.
    assert!(
        (k - 0.02).abs() < 2e-3 && (c - 0.02).abs() < 2e-3,
        "{k} {c}"
    );
    let common = common.unwrap();
    assert!((common - 0.02).abs() < 1e-3, "{common}");
    let (_, out, _) = windfall("fit campaign", folder.path());
    assert!(out.contains("shifts all impacts together"), "{out}");
    // The card's median of all fruit is no better known than the bench.
    let (status, _, told) = windfall("fit campaign --card card.toml", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let card: toml::Table =
        toml::from_str(&std::fs::read_to_string(folder.path().join("card.toml")).unwrap()).unwrap();
    let k = &card["parameters"]["k"];
    let relative = k["sd"].as_float().unwrap() / k["value"].as_float().unwrap();
    assert!(relative >= 0.019, "{relative}");
}

/// A displacement that is λ times as long at the same times is that of k and c over √λ.
#[test]
fn closed_form_an_eccentric_encoder_scales_all_displacements_alike() {
    let folder = campaign();
    tell(
        folder.path(),
        "[encoder]\n",
        "[encoder]\neccentricity = \"2 %\"\n",
    );
    let (k, c, common) = deviations(&fitted(folder.path()));
    let expected = 0.5 * 0.02 / 2f64.sqrt();
    for own in [k, c, common.unwrap()] {
        assert!((own / expected - 1.0).abs() < 0.08, "{own} {expected}");
    }
}

#[test]
fn recovers_inertia_gain_and_delay_that_are_asked_for() {
    let estimate = |folder: &Path, names: &str| {
        tell(folder, "[fit]\n", &format!("[fit]\nestimate = [{names}]\n"));
        fitted(folder)
    };
    let value = |outcome: &Value, name: &str| {
        let own = &outcome["estimated"][name];
        let of = |key: &str| own[key].as_f64().unwrap_or_else(|| panic!("{own}"));
        (of("value"), of("sd"))
    };
    let folder = campaign();
    tell(
        folder.path(),
        "inertia = \"0.01435",
        "inertia = \"0.0150675",
    );
    tell(
        folder.path(),
        "[channels.force]\n",
        "[channels.force]\ndelay = \"-40 us\"\n",
    );
    let outcome = estimate(folder.path(), "\"inertia\", \"force.delay\"");
    let (inertia, sd) = value(&outcome, "inertia");
    assert!(
        (inertia - 0.01435).abs() < 4.0 * sd && sd < 1e-4,
        "{inertia} {sd}"
    );
    let (delay, sd) = value(&outcome, "force.delay");
    assert!(delay.abs() < 4.0 * sd && sd < 2e-5, "{delay} {sd}");
    assert_eq!(said(&outcome), []);
    // One recording of the campaign is fitted on the bench of all of them.
    let raw = std::fs::read_dir(folder.path().join("campaign/raw")).unwrap();
    let mut names: Vec<_> = raw.map(|file| file.unwrap().file_name()).collect();
    names.sort();
    let name = names[0].to_string_lossy().into_owned();
    let (status, out, told) = windfall(
        &format!("fit campaign/raw/{name} --format json"),
        folder.path(),
    );
    assert_eq!(status, Some(0), "{told}");
    let one: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(one["estimated"], outcome["estimated"]);
    assert_eq!(
        one["impacts"][0]["parameters"],
        outcome["impacts"][0]["parameters"]
    );
    // A paper's methods say where the value is from.
    let (status, _, told) = windfall("report campaign", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let report = folder.path().join("campaign/report/report.html");
    let report = std::fs::read_to_string(report).unwrap();
    assert!(
        report.contains("estimated from all impacts together")
            && report.contains("inertia = 0.0143")
    );
    // What is given with an uncertainty is averaged with what the impacts say.
    tell(folder.path(), "kg m^2\"", "kg m^2 ± 5 %\"");
    let (both, narrower) = value(&fitted(folder.path()), "inertia");
    assert!(
        (both - inertia).abs() < 0.01 * inertia && narrower <= 7e-5,
        "{both} {narrower}"
    );
}

#[test]
fn rejects_instruments_that_cannot_have_made_the_recordings() {
    let slow = "sensor_frequency = \"1 Hz\"\nsensor_damping = \"0.5\"\n";
    let soft = "arm_frequency = \"1 kHz\"\narm_damping = \"0.1\"\narm_compliance = \"1 m/N\"\n";
    for (lines, channel) in [(slow, "force"), (soft, "displacement")] {
        let folder = campaign();
        let told = format!("[response]\n{lines}[contact]\n");
        tell(folder.path(), "[contact]\n", &told);
        let (status, out, told) = windfall("fit campaign", folder.path());
        assert_eq!(status, Some(1), "{told}");
        let said = format!("the {channel} would be recorded");
        assert!(out.contains(&said), "{out}");
    }
}

#[test]
fn rejects_an_estimate_of_instruments_that_do_nothing() {
    for quantity in ["sensor_frequency", "arm_frequency", "force_filter"] {
        let folder = campaign();
        let told = format!("[fit]\nestimate = [\"{quantity}\"]\n");
        tell(folder.path(), "[fit]\n", &told);
        let (status, _, told) = windfall("fit campaign", folder.path());
        assert_eq!(status, Some(2), "{told}");
        assert!(told.contains("16 impacts leave does not show it"), "{told}");
    }
}

#[test]
fn rejects_what_the_bench_cannot_tell() {
    let unknown = [
        (r#"["arm"]"#, "expected one of inertia"),
        (r#"["encoder.eccentricity"]"#, "two marks at a known angle"),
        (r#""inertia""#, "expected a list in brackets"),
        (r#"["mass"]"#, "its inertia can be estimated"),
        (
            r#"["inertia", "force.gain"]"#,
            "determine one number for inertia and force.gain",
        ),
        (
            r#"["sensor_frequency", "arm_frequency"]"#,
            "beside sensor_frequency already",
        ),
        (
            r#"["sensor_damping"]"#,
            "expected one of inertia, mass, force.gain, force.delay, force_filter, sensor_frequency, arm_frequency. It is estimated with sensor_frequency",
        ),
    ];
    let unknown =
        unknown.map(|(names, said)| ("[fit]\n", format!("[fit]\nestimate = {names}\n"), said));
    let others = [
        ("kg m^2\"", "kg m^2 ± 0.0002\"", "has no unit"),
        ("kg m^2\"", "kg m^2 ± -1 %\"", "is negative"),
        ("kg m^2\"", "kg m^2 ± 200 %\"", "uncertainty of 200 %"),
        (
            "[contact]\n",
            "[contact]\npre_trigger = \"2 ± 1 ms\"\n",
            "takes no ±",
        ),
        (
            "[encoder]\n",
            "[encoder]\neccentricity = \"20 %\"\n",
            "by more than a tenth",
        ),
        (
            "[contact]\n",
            "[response]\nsensor_frequency = \"2 kHz\"\n[contact]\n",
            "without sensor_damping",
        ),
        (
            "[contact]\n",
            "[response]\narm_compliance = \"0.1 um/N\"\n[contact]\n",
            "without arm_frequency",
        ),
        (
            "[contact]\n",
            "[response]\nsensor_frequency = \"2 kHz\"\nsensor_damping = \"1.5\"\n[contact]\n",
            "must be between 0 and 1",
        ),
        (
            "[contact]\n",
            "[response]\nforce_filter = \"0 Hz\"\n[contact]\n",
            "must be above zero",
        ),
        (
            "[contact]\n",
            "[response]\nforce_filter = \"5 ms\"\n[contact]\n",
            "force_filter",
        ),
    ];
    let others = others.map(|(old, new, said)| (old, new.to_owned(), said));
    for (old, new, said) in unknown.into_iter().chain(others) {
        let folder = campaign();
        tell(folder.path(), old, &new);
        let (status, _, told) = windfall("fit campaign", folder.path());
        assert_eq!(status, Some(2), "{new}: {told}");
        assert!(
            told.contains(said) && told.contains("campaign.toml, line"),
            "{new}: {told}"
        );
    }
    // A value that its own uncertainty keeps from what the impacts say.
    let folder = campaign();
    tell(
        folder.path(),
        "inertia = \"0.01435 kg m^2",
        "inertia = \"0.0150675 ± 0.00001 kg m^2",
    );
    tell(folder.path(), "[fit]\n", INERTIA);
    let (status, _, told) = windfall("fit campaign", folder.path());
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("campaign.toml says inertia") && told.contains("leave ± out"),
        "{told}"
    );
    // Too few impacts.
    let folder = campaign();
    tell(folder.path(), "[fit]\n", INERTIA);
    let path = folder.path().join("campaign/impacts.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let few: Vec<&str> = text.lines().take(4).collect();
    std::fs::write(&path, few.join("\n") + "\n").unwrap();
    let (status, _, told) = windfall("fit campaign", folder.path());
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("at least 5 are needed"), "{told}");
}

#[test]
fn recovers_a_law_that_is_not_that_of_the_fruit() {
    let folder = campaign();
    let fit = |law: &str| {
        let line = format!("fit campaign --law {law} --format json");
        let (_, out, told) = windfall(&line, folder.path());
        let outcome: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{told}"));
        outcome["findings"].to_string().contains("law-misfit")
    };
    assert!(!fit("kuwabara-kono"));
    assert!(fit("tsuji"));
}

#[test]
fn closed_form_medians_of_a_population_are_no_better_known_than_the_bench() {
    let folder = campaign();
    let half_width = || {
        let (status, out, told) = windfall("population campaign --format json", folder.path());
        assert_eq!(status, Some(0), "{told}");
        let outcome: Value = serde_json::from_str(&out).unwrap();
        let median = &outcome["parameters"][0]["median"];
        let of = |key: &str| median[key].as_f64().unwrap_or_else(|| panic!("{median}"));
        ((of("high") / of("low")).ln() / 2.0, of("value"))
    };
    let (exact, value) = half_width();
    tell(folder.path(), "kg m^2\"", "kg m^2 ± 2 %\"");
    let (uncertain, again) = half_width();
    assert!((again / value - 1.0).abs() < 1e-9, "{value} {again}");
    // Two per cent by nearly two deviations.
    assert!(exact < 0.01 && uncertain > 0.038, "{exact} {uncertain}");
}

#[test]
fn says_nothing_of_a_bench_that_is_coarse_or_slow() {
    for (rate, counts) in [
        ("10 kHz", "360000"),
        ("20 kHz", "2000"),
        ("50 kHz", "20000"),
        ("5 kHz", "8000"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let law = "kuwabara-kono(k=753599, c=1524)";
        let mut command = assert_cmd::Command::cargo_bin("windfall").unwrap();
        let made = command.current_dir(folder.path()).args([
            "simulate",
            "pendulum",
            "--law",
            law,
            "--specimens",
            "100",
            "--encoder",
            "counts",
            "--counts-per-revolution",
            counts,
            "--rate",
            rate,
            "--noise",
            "0.1 N",
            "--velocity",
            "1 m/s",
            "--recordings",
            "campaign",
        ]);
        assert!(made.output().unwrap().status.success());
        let outcome = fitted(folder.path());
        let codes = outcome["findings"].to_string();
        let false_alarm = codes.contains("bench-") || codes.contains("law-misfit");
        assert!(!false_alarm, "{rate} {counts}: {codes}");
    }
}

#[test]
fn the_deviation_of_an_estimate_does_not_depend_on_what_is_told() {
    let estimate = |told: &str| {
        let folder = campaign();
        tell(
            folder.path(),
            "inertia = \"0.01435",
            &format!("inertia = \"{told}"),
        );
        tell(
            folder.path(),
            "[fit]\n",
            "[fit]\nestimate = [\"inertia\"]\n",
        );
        let outcome = fitted(folder.path());
        let own = &outcome["estimated"]["inertia"];
        let far = outcome["findings"].to_string().contains("bench-far");
        (
            own["value"].as_f64().unwrap(),
            own["sd"].as_f64().unwrap(),
            far,
        )
    };
    let (value, sd, far) = estimate("0.01435");
    assert!(!far);
    for told in ["0.007175", "0.0287"] {
        let (again, as_sure, far) = estimate(told);
        assert!(
            (again - value).abs() < 0.2 * sd && far,
            "{told}: {again} {value} {sd}"
        );
        assert!((as_sure / sd - 1.0).abs() < 0.3, "{told}: {as_sure} {sd}");
    }
}

/// Impacts of a carriage whose mass is to come from them.
fn unweighed(specimens: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let law = "kuwabara-kono(k=753599,c=1524)";
    let line = format!(
        "simulate carriage --law {law} --mass 0.3kg --velocity 1m/s --specimens {specimens} \
         --unweighed --recordings campaign"
    );
    let (status, _, told) = windfall(&line, folder.path());
    assert_eq!(status, Some(0), "{told}");
    folder
}

#[test]
fn a_mass_from_impulse_follows_the_sensitivity() {
    let folder = unweighed(8);
    let path = folder.path().join("campaign/campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let uncertain = |text: &str| {
        let line = text
            .lines()
            .find(|line| line.starts_with("sensitivity"))
            .unwrap();
        let value = line.split('"').nth(1).unwrap();
        text.replacen(value, &format!("{value} ± 1 %"), 1)
    };
    std::fs::write(&path, uncertain(&text)).unwrap();
    let (_, _, common) = deviations(&fitted(folder.path()));
    // k of a mass and a force that both read 1 % more is 1 % more.
    assert!((common.unwrap() - 0.01).abs() < 2e-3, "{common:?}");
    tell(
        folder.path(),
        "[fit]\n",
        "[fit]\nestimate = [\"force.gain\"]\n",
    );
    let (status, _, told) = windfall("fit campaign", folder.path());
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("impulse of this force already"), "{told}");
}

/// Changes the force of a recording, its first column; V.
fn change_force(folder: &Path, name: &str, fault: impl Fn(f64) -> f64) {
    let path = folder.join("campaign/raw").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let (header, body) = text.split_once('\n').unwrap();
    let row = |line: &str| {
        let (force, position) = line.split_once(',').unwrap();
        format!("{},{position}\n", fault(force.parse().unwrap()))
    };
    let rows: String = body.lines().map(row).collect();
    std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
}

/// The mass of the campaign is that of the impacts that count: one is clipped, one has another
/// unit, one is excluded.
#[test]
fn conserves_a_mass_from_impulse_without_impacts_that_do_not_count() {
    let folder = unweighed(12);
    change_force(folder.path(), "specimen-01.csv", |force| force.min(0.8));
    change_force(folder.path(), "specimen-02.csv", |force| 2.0 * force);
    let path = folder.path().join("campaign/impacts.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    let table = |rows: &[&str]| {
        let marked = rows.iter().map(|row| match row.split(',').next() {
            Some("id") => format!("{row},exclude\n"),
            Some("specimen-03") => format!("{row},yes\n"),
            _ => format!("{row},\n"),
        });
        std::fs::write(&path, marked.collect::<String>()).unwrap();
        fitted(folder.path())
    };
    let all = table(&rows);
    let good = table(&[&rows[..1], &rows[4..]].concat());
    assert_eq!(all["effective_mass"], good["effective_mass"]);
    assert_eq!(all["effective_mass"]["impacts"], 9);
    let findings = all["findings"].as_array().unwrap().iter();
    let none: Vec<&str> = findings
        .filter(|own| own["code"] == "no-mass")
        .filter_map(|own| own["message"].as_str()?.split(' ').next())
        .collect();
    assert_eq!(none, ["specimen-01", "specimen-02", "specimen-03"]);
}
