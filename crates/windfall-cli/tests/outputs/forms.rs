//! A result in a file is what the command shows, and JSON says what it is.

use super::laboratory;
use super::options::{FORMS, Kind, WRITTEN};
use crate::counted::windfall;
use std::path::Path;

fn shown(line: &str, folder: &Path) -> String {
    let (status, shown, told) = windfall(line, folder);
    assert_eq!(status, Some(0), "{line}: {told}");
    shown
}

#[test]
fn a_result_in_a_file_is_what_is_shown() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let forms = Kind::Ending(FORMS);
    let lines = WRITTEN.iter().filter(|own| own.2 == forms);
    let mut count = 0;
    for (command, _, _, line, _) in lines {
        for (ending, format) in [("csv", "csv"), ("json", "json"), ("txt", "text")] {
            let name = format!("{}.{ending}", command.replace(' ', "-"));
            let line = line.replace("{}", &name);
            let told = shown(&format!("{line} --format {format}"), folder);
            let kept = std::fs::read_to_string(folder.join(&name)).unwrap();
            assert_eq!(kept, told, "{line}");
            assert!(!kept.trim().is_empty(), "{line}");
        }
        count += 1;
    }
    assert!(count >= 27, "{count} commands");
}

/// A scene that every engine can represent.
const DROP: &str = r#"format = 1
materials = ["apple", "steel"]
[scene]
time_step = "20 us"
end = "0.1 s"
[[contacts]]
between = ["apple", "steel"]
law = "kelvin-voigt(k=6000, c=25)"
annuli = 1
friction = 0.5
[[contacts]]
between = ["apple", "apple"]
law = "kelvin-voigt(k=3000, c=12)"
annuli = 1
friction = 0.5
[[fruit]]
material = "apple"
count = 1
diameter = "70 mm"
density = "840 kg/m^3"
drop = { place = [0, 0, 0.2] }
[[walls]]
name = "floor"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
"#;

/// A table of bruises is always CSV.
#[test]
fn a_table_of_bruises_is_kept_as_csv() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let table = "bruise_width_mm,bruise_depth_mm\n10,3\n";
    std::fs::write(folder.join("bruises.csv"), table).unwrap();
    let told = shown("bruise --table bruises.csv --out volumes.csv", folder);
    let kept = std::fs::read_to_string(folder.join("volumes.csv")).unwrap();
    assert_eq!(kept, told);
    let (status, _, told) = windfall("bruise --table bruises.csv --out v.json", folder);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains(".csv"), "{told}");
    let (status, ..) = windfall("bruise --table bruises.csv --out bruises.csv", folder);
    assert_eq!(status, Some(2));
}

/// Commands whose files have names of their own.
const OTHERS: &[&str] = &[
    "new pendulum fresh --format json",
    "add campaign --format json",
    "fit campaign --format json",
    "fit drops --format json",
    "fit campaign --shard 1/2 --out part.csv --format json",
    "report campaign --format json",
    "inspect --presets --format json",
    "design ccd --factor A=0..1 --factor B=0..1 --format json",
    "simulate repeats repeats --format json",
    "simulate pendulum --law hertz(k=9e5) --format json",
    "simulate drop --law hertz(k=9e5) --mass 5g --height 100mm --sampling-rate 10kHz --format json",
    "simulate drop --law hertz(k=9e5) --mass 5g --height 100mm --radius 10mm --offset 3mm --format json",
    "scene run scene/scene.toml --restart --format json",
    "scene study scene/study.toml --format json",
    "scene picture scene/scene.run --format json",
    "scene vtk scene/scene.run --format json",
    "scene table scene/scene.run fruit --out fruit.parquet --format json",
    "scene export scene/drop.toml --engine lammps --format json",
    "scene export scene/scene.toml --engine yade --format json",
    "card show --laws --format json",
    "card show --library --format json",
    "compare design.csv --measured y --predicted B --format json",
    "plan achieved fruit.csv --formula k~V+(1|fruit) --format json",
];

#[test]
fn json_says_its_version_and_its_schema_once() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    std::fs::write(folder.join("scene/drop.toml"), DROP).unwrap();
    let forms = Kind::Ending(FORMS);
    let lines = WRITTEN.iter().filter(|own| own.2 == forms);
    let lines = lines.map(|own| format!("{} --format json", own.3.replace("{}", "other.txt")));
    for line in lines.chain(OTHERS.iter().map(|&own| own.to_owned())) {
        let text = shown(&line, folder);
        let parsed: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(parsed["windfall"], env!("CARGO_PKG_VERSION"), "{line}");
        let schema = parsed["schema"].as_str().unwrap();
        let (name, version) = schema.split_once('/').unwrap();
        assert!(!name.is_empty() && version.parse::<u32>().is_ok(), "{line}");
        for key in ["windfall", "schema"] {
            let own = format!("\n  \"{key}\": ");
            assert_eq!(text.matches(&own).count(), 1, "{line}: {key}");
        }
    }
}

#[test]
fn quiet_says_nothing_and_verbose_says_which_files() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let line = "fit campaign --refit --out fits.csv";
    let (status, usual, told) = windfall(line, folder);
    assert_eq!(status, Some(0));
    assert!(
        told.contains("2 fitted") && !told.contains("read:"),
        "{told}"
    );
    let (status, quiet, told) = windfall(&format!("{line} -q"), folder);
    assert_eq!((status, told.as_str()), (Some(0), ""));
    assert_eq!(quiet, usual);
    let (status, _, told) = windfall(&format!("{line} -v"), folder);
    assert_eq!(status, Some(0));
    for said in [
        "read: campaign/campaign.toml",
        "read: campaign/raw/specimen-01.csv",
        "wrote: campaign/results.sqlite",
        "wrote: fits.csv",
        "took ",
    ] {
        assert!(told.contains(said), "{said}: {told}");
    }
    // What went wrong is said even so.
    let (status, _, told) = windfall("fit nowhere -q", folder);
    assert_eq!(status, Some(2));
    assert!(told.starts_with("error: "), "{told}");
    assert_eq!(windfall("fit campaign -q -v", folder).0, Some(2));
}

/// The JSON of a card that is shown is a card.
#[test]
fn a_card_that_is_shown_as_json_is_a_card() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let first = shown(
        "card show --file card.toml --out card.json --format json",
        folder,
    );
    let again = shown("card show --file card.json --format json", folder);
    assert_eq!(first, again);
}
