//! Campaigns of a drop rig.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use windfall::error::Error;
use windfall::read_calibrate::{RangeUnit, Target};
use windfall::read_drop::{DropCampaign, PlatePlan, drop_of, read_drop};
use windfall::workflow_new::{TemplateKind, write_template};

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
fn changed(file: &str, from: &str, to: &str) -> Result<DropCampaign, Error> {
    let folder = tempfile::tempdir().unwrap();
    let directory = template(folder.path());
    edit(&directory, file, from, to);
    read_drop(&directory)
}

/// Message of the template with one change, from the name of the file on.
fn refused(file: &str, from: &str, to: &str) -> String {
    let message = changed(file, from, to).unwrap_err().to_string();
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
