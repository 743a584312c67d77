//! What campaign.toml may say, and the messages when it says it wrongly.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::settings::read::read_campaign;
use windfall_campaign::settings::template::{TemplateKind, template, write_template};

fn message_of(toml: &str) -> String {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("campaign.toml"), toml).unwrap();
    std::fs::write(
        scratch.path().join("impacts.csv"),
        "id,specimen,file\na,s,a.csv\n",
    )
    .unwrap();
    let error = read_campaign(scratch.path()).unwrap_err().to_string();
    error
        .split_once("campaign.toml")
        .map_or(error.clone(), |(_, text)| text.to_owned())
}

/// A template with one line replaced.
fn changed(kind: TemplateKind, from: &str, to: &str) -> String {
    let text = template(kind);
    assert!(text.contains(from), "the template has no {from}");
    text.replacen(from, to, 1)
}

#[test]
fn closed_form_templates_are_campaigns() {
    for kind in [TemplateKind::Pendulum, TemplateKind::Carriage] {
        let scratch = tempfile::tempdir().unwrap();
        let directory = scratch.path().join("campaign");
        write_template(kind, &directory).unwrap();
        let campaign = read_campaign(&directory).unwrap();
        assert_eq!(
            (
                campaign.shared.entries.len(),
                campaign.shared.specimens.len()
            ),
            (3, 2),
            "{kind:?}"
        );
        let again = write_template(kind, &directory).unwrap_err().to_string();
        assert!(again.ends_with(
            "exists already and is not overwritten; choose another name or remove it first"
        ));
    }
}

#[test]
fn closed_form_force_calibration() {
    // 11 mV/N behind a gain of 10, 0.55 V at zero: 1.65 V are 10 N.
    let toml = changed(
        TemplateKind::Pendulum,
        "gain = 1\noffset = \"0 V\"",
        "gain = 10\noffset = \"550 mV\"",
    );
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(
        scratch.path().join("campaign.toml"),
        toml.replace("group = \"variety\"", ""),
    )
    .unwrap();
    std::fs::write(
        scratch.path().join("impacts.csv"),
        "id,specimen,file\na,s,a.csv\n",
    )
    .unwrap();
    std::fs::create_dir(scratch.path().join("raw")).unwrap();
    std::fs::write(
        scratch.path().join("raw/a.csv"),
        "force_V,phase_a_V,phase_b_V\n1.65,0,0\n0.55,5,0\n",
    )
    .unwrap();
    let campaign = read_campaign(scratch.path()).unwrap();
    let recording = windfall_campaign::recording::read::read_recording(
        &campaign.shared.files,
        &campaign.shared.entries[0],
    )
    .unwrap();
    let force = &recording.channels[0].samples;
    assert!(
        (force[0] - 10.0).abs() < 1e-12 && force[1].abs() < 1e-12,
        "{force:?}"
    );
}

#[test]
fn rejects_what_campaign_toml_must_not_say() {
    use TemplateKind::{Carriage, Pendulum};
    let cases = [
        (
            Pendulum,
            "arm = \"0.505 m\"",
            "arms = \"0.505 m\"",
            "there is no key \"arms\" here (did you mean \"arm\"?); known keys: ",
        ),
        (
            Pendulum,
            "arm = \"0.505 m\"",
            "arm = \"0.505 kg\"",
            "[rig] arm = \"0.505 kg\": \"0.505 kg\" is a mass (kg), but a length in m was expected",
        ),
        (
            Pendulum,
            "arm = \"0.505 m\"",
            "arm = \"-1 m\"",
            "[rig] arm = \"-1 m\": must be above zero, for example: arm = \"0.505 m\"",
        ),
        (
            Pendulum,
            "centre_of_mass = \"0.3 m\"",
            "",
            "[rig] needs `centre_of_mass` (distance from pivot to the centre of mass); add for example: centre_of_mass = \"0.35 m\"",
        ),
        (
            Pendulum,
            "sensitivity = \"11 mV/N\"",
            "sensitivity = \"11 mV/m\"",
            "[channels.force] sensitivity = \"11 mV/m\": ",
        ),
        (
            Pendulum,
            "counts_per_revolution = 360000",
            "",
            "[encoder] needs `counts_per_revolution`",
        ),
        (
            Pendulum,
            "laws = [\"kuwabara-kono\"]",
            "laws = [\"kuwabara-kona\"]",
            "[fit] laws = \"kuwabara-kona\": ",
        ),
        (
            Pendulum,
            "laws = [\"kuwabara-kono\"]",
            "laws = [\"hertz(k=1)\", \"hertz\"]",
            "[fit] laws = \"hertz\": this law is named twice",
        ),
        (
            Pendulum,
            "# free = [\"n\"]",
            "free = [\"kk\"]",
            "[fit] free = \"kk\": no law here has a parameter of that name",
        ),
        (
            Pendulum,
            "\"displacement\", \"force\"",
            "\"displacment\", \"force\"",
            "[fit] quantities = \"displacment\": expected any of displacement, rate, force, acceleration (did you mean \"displacement\"?)",
        ),
        (
            Pendulum,
            "onset = \"auto\"",
            "onset = \"freed\"",
            "[fit] onset = \"freed\": expected \"auto\" or \"free\" or \"fixed\" (did you mean \"free\"?)",
        ),
        (
            Pendulum,
            "format = 1",
            "format = 2",
            "format = 2, but this windfall reads format = 1",
        ),
        (Pendulum, "format = 1", "", "the file needs `format`"),
        (Pendulum, "format = 1", "format = = 1", ""),
        (
            Pendulum,
            "rate = \"200 kHz\"",
            "rate = \"200 kg\"",
            "[files] rate = \"200 kg\": ",
        ),
        (
            Pendulum,
            "directory = \"raw\"",
            "directory = \"${WINDFALL_NO_SUCH_VARIABLE}/raw\"",
            "[files] directory uses the environment variable WINDFALL_NO_SUCH_VARIABLE, which is not set; set it, for example: export WINDFALL_NO_SUCH_VARIABLE=/path/to/recordings",
        ),
        (
            Pendulum,
            "column = \"force_V\"",
            "column = \"{run}: Force (N)\"",
            "column = \"{run}: Force (N)\" uses {run}, but impacts.csv has no column \"run\"",
        ),
        (
            Pendulum,
            "group = \"variety\"",
            "group = \"level\"",
            "[summary] group = \"level\": neither specimens.csv nor impacts.csv has this column; they have: id, specimen, file",
        ),
        (
            Carriage,
            "mass = \"0.5 kg\"",
            "",
            "[rig] needs `mass` (mass of the moving body); add for example: mass = \"0.5 kg\"   or   mass = \"from impulse\"",
        ),
        (
            Carriage,
            "unit = \"mm\"",
            "unit = \"millimetre\"",
            "[channels.position] unit = \"millimetre\": unknown unit \"millimetre\"",
        ),
        (
            Carriage,
            "threshold = \"auto\"",
            "threshold = \"0 N\"",
            "[contact] threshold = \"0 N\": must be above zero",
        ),
    ];
    let mut wrong = Vec::new();
    for (kind, from, to, expected) in cases {
        // The tables of this test have no groups.
        let toml = match to.contains("group") {
            true => changed(kind, from, to),
            false => changed(kind, from, to).replace("group = \"variety\"", ""),
        };
        let found = message_of(&toml);
        let line = faulty_line(&toml, to, expected);
        let place = line.map_or(": ".to_owned(), |line| format!(", line {line}: "));
        if !found.starts_with(&(place.clone() + expected)) {
            wrong.push(format!("expected: {place}{expected}\n   found: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Where the fault is: the line that was put in, or the head of the table that
/// lacks one; the column of a channel stands under its table's head.
fn faulty_line(toml: &str, to: &str, expected: &str) -> Option<usize> {
    if expected.starts_with("the file") {
        return Some(1);
    }
    let table = match to.is_empty() {
        true => expected
            .split(' ')
            .next()
            .filter(|word| word.starts_with('['))?,
        false => to,
    };
    let at = toml.find(table).unwrap();
    Some(1 + toml[..at].matches('\n').count())
}

#[test]
fn rejects_a_directory_without_a_campaign() {
    let error = read_campaign(Path::new("no/such/place"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("there is no such file; a campaign directory holds a campaign.toml"),
        "{error}"
    );
}
