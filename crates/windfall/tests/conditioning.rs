//! Filters, drift, tip mass, rates and angles as campaign.toml asks for them.

#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::Path;
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::result::outcome::ImpactOutcome;

const MASS: f64 = 0.2;

/// A mass on a spring, half a period of contact: position (m), force (N).
fn motion(t: f64) -> (f64, f64) {
    let (omega, speed): (f64, f64) = (500.0, 0.5);
    let end = std::f64::consts::PI / omega;
    match t {
        t if t < 0.0 => (speed * t, 0.0),
        t if t < end => {
            let x = speed / omega * (omega * t).sin();
            (x, MASS * omega * omega * x)
        }
        t => (-speed * (t - end), 0.0),
    }
}

/// A campaign of one impact with a drift of 200 N/s, a ripple at 20 kHz, and a
/// force sensor behind a tip of 10 g.
fn campaign(directory: &Path, rig: &str, channels: &str, contact: &str) {
    std::fs::create_dir_all(directory.join("raw")).unwrap();
    let mut text = "time_s,force_N,position_m\n".to_owned();
    for i in 0..4000 {
        let t = f64::from(i) * 1e-5 - 0.015;
        let (x, force) = motion(t);
        let ripple = 0.5 * (std::f64::consts::TAU * 2e4 * t).sin();
        let sensor = force * (1.0 - 0.01 / MASS) + 200.0 * t + ripple;
        writeln!(text, "{t:.5},{sensor:.6},{x:.9}").unwrap();
    }
    std::fs::write(directory.join("raw/a.csv"), text).unwrap();
    let impacts = "id,specimen,file,release_angle_deg,rebound_angle_deg\na,a,a.csv,12.5,8\n";
    std::fs::write(directory.join("impacts.csv"), impacts).unwrap();
    let toml = format!(
        "format = 1\n[rig]\n{rig}\n[files]\ndirectory = \"raw\"\ntime = \"time_s\"\n\
         [channels.force]\ncolumn = \"force_N\"\nunit = \"N\"\n{channels}\n\
         [channels.position]\ncolumn = \"position_m\"\nunit = \"m\"\n\
         [contact]\nthreshold = \"6 N\"\n{contact}\n[fit]\nlaws = [\"kelvin-voigt(c=0)\"]\n"
    );
    std::fs::write(directory.join("campaign.toml"), toml).unwrap();
}

const CARRIAGE: &str = "kind = \"carriage\"\nmass = \"0.2 kg\"\ndriving_acceleration = \"0 m/s^2\"";

fn fit(rig: &str, channels: &str, contact: &str) -> Result<ImpactOutcome, String> {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), rig, channels, contact);
    let outcome = fit_campaign(
        dir.path(),
        &FitRequest::default(),
        &windfall_files::progress::quiet,
    );
    let mut outcome = outcome.map_err(|error| error.to_string())?;
    match outcome.failed.first() {
        Some(failure) => Err(failure.message.clone()),
        None => Ok(outcome.impacts.remove(0)),
    }
}

fn derived(outcome: &ImpactOutcome, name: &str) -> f64 {
    outcome
        .derived
        .get(name)
        .copied()
        .flatten()
        .unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn recovers_the_peak_with_all_that_campaign_toml_can_take_off() {
    let largest = MASS * 500.0 * 0.5;
    let plain = fit(CARRIAGE, "", "").unwrap();
    let channels = "low_pass = \"4 kHz\"\nfilter_order = 6\ntip_mass = \"10 g\"";
    let contact = "baseline = \"drift\"\nrate = \"smoothing-spline\"\nrelease = 0.8\n\
                   minimum_gap = \"1 ms\"";
    let clean = fit(CARRIAGE, channels, contact).unwrap();
    let error = |outcome: &ImpactOutcome| (derived(outcome, "peak_force") / largest - 1.0).abs();
    assert!(error(&plain) > 0.02, "{}", error(&plain));
    assert!(error(&clean) < 2e-3, "{}", error(&clean));
    let codes: Vec<&str> = clean.findings.iter().map(|f| f.code.as_str()).collect();
    for code in ["filtered", "drift-removed", "tip-mass"] {
        assert!(codes.contains(&code), "{codes:?}");
    }
    // Elastic: what goes in comes out.
    let energy = 0.5 * MASS * 0.25;
    assert!((derived(&clean, "loading_energy") / energy - 1.0).abs() < 0.01);
    assert!(derived(&clean, "hysteresis_energy").abs() < 0.01 * energy);
}

#[test]
fn conserves_the_loop_in_the_figure() {
    let dir = tempfile::tempdir().unwrap();
    campaign(dir.path(), CARRIAGE, "", "baseline = \"drift\"");
    let figures = dir.path().join("figures");
    let request = FitRequest {
        figures: Some(windfall_draw::files::FigureFolder::of(&figures)),
        ..FitRequest::default()
    };
    fit_campaign(dir.path(), &request, &windfall_files::progress::quiet).unwrap();
    let svg = std::fs::read_to_string(figures.join("a.svg")).unwrap();
    assert!(svg.contains("kelvin-voigt") && svg.ends_with("</svg>\n"));
    // The fourth panel is the loop: F = 50 N/mm x, up and down.
    let table = std::fs::read_to_string(figures.join("a.csv")).unwrap();
    let loops = table
        .lines()
        .filter(|line| line.starts_with("4,kelvin-voigt,"));
    let points: Vec<(f64, f64)> = loops
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (cells[2].parse().unwrap(), cells[4].parse().unwrap())
        })
        .collect();
    let largest = points.iter().map(|(_, force)| *force).fold(0.0, f64::max);
    // The displacement counts from where the force crossed its threshold.
    let touch = points[0].0 - points[0].1 / 50.0;
    for (x, force) in points.iter().filter(|(_, force)| *force > 10.0) {
        assert!(
            (force / (x - touch) / 50.0 - 1.0).abs() < 0.25,
            "{x} {force}"
        );
    }
    assert!((largest / 50.0 - 1.0).abs() < 0.06, "{largest}");
}

/// E = m g l (1 − cos θ) with m l = 0.05 kg m, and v = √(2 E r²/I).
#[test]
fn closed_form_energies_from_angles() {
    let pendulum = "kind = \"pendulum\"\ninertia = \"0.05 kg m^2\"\narm = \"0.5 m\"\n\
                    mass = \"0.25 kg\"\ncentre_of_mass = \"0.2 m\"\ngravity = \"9.81 m/s^2\"";
    let outcome = fit(pendulum, "", "").unwrap();
    let energy = |degrees: f64| 0.25 * 9.81 * 0.2 * (1.0 - degrees.to_radians().cos());
    let close = |name: &str, expected: f64| {
        assert!(
            (derived(&outcome, name) / expected - 1.0).abs() < 1e-9,
            "{name}"
        );
    };
    close("impact_energy_from_angle", energy(12.5));
    close("absorbed_energy_from_angles", energy(12.5) - energy(8.0));
    close(
        "impact_velocity_from_angle",
        (2.0 * energy(12.5) / 0.2).sqrt(),
    );
    // The recording shows 0.5 m/s.
    assert!(outcome.findings.iter().any(|f| f.code == "angle-disagrees"));
}

#[test]
fn rejects_what_cannot_be_done() {
    for (channels, contact, expected) in [
        ("low_pass = \"60 kHz\"", "", "half the sampling rate"),
        ("low_pass = \"4 N\"", "", "low_pass"),
        ("filter_order = 3", "", "filters nothing"),
        (
            "low_pass = \"4 kHz\"\nfilter_order = 30",
            "",
            "from 1 to 10",
        ),
        ("tip_mass = \"0.3 kg\"", "", "tip mass"),
        ("tip_mass = \"-1 g\"", "", "above zero"),
        ("", "rate = \"edge-time\"", "did you mean \"edge-times\""),
        ("", "release = 1.5", "part of the threshold"),
        ("", "minimum_gap = \"-1 ms\"", "below zero"),
        ("", "pre_trigger = \"-1 ms\"", "below zero"),
        ("", "post_trigger = \"3 mm\"", "post_trigger"),
        ("", "rate_window = \"0.3 ms\"", "belongs to rate"),
        (
            "",
            "rate = \"edge-times\"\nrate_window = \"-1 s\"",
            "below zero",
        ),
        ("", "baseline = \"line\"", "\"drift\""),
    ] {
        let message = fit(CARRIAGE, channels, contact).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
}
