//! No command calculates with the rig of a template.

use assert_cmd::Command;
use std::path::Path;

fn windfall(line: &[&str], folder: &Path) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command.args(line).current_dir(folder).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), told)
}

/// Whether a command refuses the rig, and nothing else.
fn refused((status, told): &(Option<i32>, String)) -> bool {
    *status == Some(2) && told.contains("the rig is still the example")
}

#[test]
fn rejects_to_calculate_with_the_rig_of_a_template() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    for kind in ["pendulum", "carriage", "drop", "repeats"] {
        let (status, told) = windfall(&["new", kind, kind], folder);
        assert_eq!(status, Some(0), "{told}");
    }
    let lines: [&[&str]; 11] = [
        &["fit", "pendulum"],
        &["fit", "carriage", "--refit"],
        &["fit", "carriage", "--shard", "1/2", "--out", "a.csv"],
        &["laws", "carriage"],
        &["population", "carriage"],
        &["report", "carriage"],
        &["fit", "drop"],
        &["report", "drop"],
        &["calibrate", "drop"],
        &["fit", "repeats"],
        &["report", "repeats"],
    ];
    for line in lines {
        let found = windfall(line, folder);
        assert!(refused(&found), "{line:?}: {found:?}");
        let named = format!("{}/campaign.toml, line ", line[1]);
        assert!(found.1.contains(&named), "{line:?}: {}", found.1);
    }
    // Somebody says that it is his: the recordings are what is missing now.
    for (kind, example, own) in [
        ("carriage", "\"0.5 kg\"  ", "\"500 g\"  "),
        ("repeats", "# that falls", "#"),
    ] {
        let path = folder.join(kind).join("campaign.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(example), "{text}");
        std::fs::write(&path, text.replace(example, own)).unwrap();
        let found = windfall(&["fit", kind], folder);
        assert!(
            !refused(&found) && found.1.contains("nothing could be fitted"),
            "{found:?}"
        );
    }
}

/// Where the tables have all energies, nothing is calculated with the mass of `[rig]`.
#[test]
fn closed_form_repeats_with_energies_are_not_asked_for_a_mass() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    windfall(&["new", "repeats", "again"], folder);
    let table = |energy: &str| {
        let table = format!(
            "id,specimen,file,energy_J,drop_height_m\na,ball,a.csv,0.1,0.05\nb,ball,b.csv,{energy},0.05\n"
        );
        std::fs::write(folder.join("again/impacts.csv"), table).unwrap();
        windfall(&["fit", "again"], folder)
    };
    assert!(refused(&table("")));
    let found = table("0.1");
    assert!(
        !refused(&found) && found.1.contains("nothing could be fitted"),
        "{found:?}"
    );
}
