//! From a folder of recordings to a table of parameters: two commands and one edited file.

use assert_cmd::Command;
use serde_json::Value;
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

/// Recordings of a pendulum under names of a laboratory, with their times and units.
fn recordings(folder: &Path, specimens: usize) {
    let law = "kuwabara-kono(k=753599,c=1524)";
    let count = specimens.to_string();
    let made = [
        "simulate",
        "pendulum",
        "--law",
        law,
        "--specimens",
        &count,
        "--repeats",
        "2",
        "--recordings",
        "made",
    ];
    let (status, _, told) = windfall(&made, folder);
    assert_eq!(status, Some(0), "{told}");
    std::fs::create_dir(folder.join("recordings")).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(folder.join("made/raw"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    names.sort();
    for (place, path) in names.iter().enumerate() {
        let variety = ["Golden", "Gala"][place / 2 % 2];
        let name = format!("{variety}_f{:02}_50mm_{}.csv", place / 2, place % 2 + 1);
        std::fs::copy(path, folder.join("recordings").join(name)).unwrap();
    }
}

const NAMES: &str = "{variety}_f{fruit}_{height_mm}mm_{rep}.csv";

#[test]
fn recovers_the_law_from_a_folder_by_two_commands_and_one_edited_file() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    recordings(folder, 20);
    std::fs::write(folder.join("recordings/notes.txt"), "warm day").unwrap();
    let new = [
        "new",
        "pendulum",
        "bench",
        "--from",
        "recordings",
        "--names",
        NAMES,
        "--format",
        "json",
    ];
    let (status, out, told) = windfall(&new, folder);
    assert_eq!(status, Some(0), "{told}");
    let gathered: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&gathered["recordings"], &gathered["specimens"]),
        (&40.into(), &20.into())
    );
    assert!(
        gathered["left_out"][0]
            .as_str()
            .unwrap()
            .starts_with("notes.txt")
    );
    // What is missing is said, line by line.
    let (status, _, told) = windfall(&["fit", "bench"], folder);
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("campaign.toml, line") && told.contains("inertia"),
        "{told}"
    );
    let file = folder.join("bench/campaign.toml");
    let mut text = std::fs::read_to_string(&file).unwrap();
    let missing = gathered["missing"].as_array().unwrap();
    assert_eq!(
        text.matches("# WRITE YOURS: ").count(),
        missing.len(),
        "{text}"
    );
    let made = std::fs::read_to_string(folder.join("made/campaign.toml")).unwrap();
    for missing in missing {
        let key = missing.as_str().unwrap().rsplit(' ').next().unwrap();
        let starts = |line: &&str| line.starts_with(&format!("{key} ="));
        let known = made.lines().find(starts).unwrap();
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("# WRITE YOURS: {key} =")))
            .unwrap()
            .to_owned();
        text = text.replace(&line, known);
    }
    std::fs::write(&file, text).unwrap();
    let (status, out, told) = windfall(&["fit", "bench", "--format", "json"], folder);
    assert_eq!(status, Some(0), "{told}");
    let outcome: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(outcome["impacts"].as_array().unwrap().len(), 40);
    assert_eq!(outcome["failed"].as_array().unwrap().len(), 0);
    let groups: Vec<&str> = outcome["groups"]
        .as_array()
        .unwrap()
        .iter()
        .map(|g| g["group"].as_str().unwrap())
        .collect();
    assert_eq!(groups, ["Gala", "Golden"]);
    let k = outcome["summary"]["k"]["mean"].as_f64().unwrap();
    assert!((k / 753_599.0 - 1.0).abs() < 0.005, "{k}");
}

#[test]
fn rejects_names_that_no_recording_has_and_writes_nothing() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    recordings(folder, 1);
    let new = [
        "new",
        "pendulum",
        "bench",
        "--from",
        "recordings",
        "--names",
        "apple-{fruit}.csv",
    ];
    let (status, _, told) = windfall(&new, folder);
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("Golden_f00_50mm_1.csv") && !folder.join("bench").exists(),
        "{told}"
    );
}

/// A campaign of which some recordings come later.
fn begun(folder: &Path) -> Vec<std::path::PathBuf> {
    recordings(folder, 4);
    let raw = folder.join("made/raw");
    let mut names: Vec<_> = std::fs::read_dir(&raw)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    names.sort();
    let late = names.split_off(6);
    std::fs::create_dir(folder.join("late")).unwrap();
    let moved = late
        .iter()
        .map(|path| folder.join("late").join(path.file_name().unwrap()));
    let moved: Vec<_> = moved.collect();
    for (from, to) in late.iter().zip(&moved) {
        std::fs::rename(from, to).unwrap();
    }
    for table in ["impacts.csv", "specimens.csv"] {
        let path = folder.join("made").join(table);
        let text = std::fs::read_to_string(&path).unwrap();
        let kept = text
            .lines()
            .filter(|line| !line.starts_with("specimen-4") && !line.starts_with("specimen-04"));
        std::fs::write(
            &path,
            kept.map(|line| format!("{line}\n")).collect::<String>(),
        )
        .unwrap();
    }
    moved
}

#[test]
fn recovers_recordings_that_are_added_later() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    let late = begun(folder);
    let listed = std::fs::read_to_string(folder.join("made/impacts.csv")).unwrap();
    let late: Vec<String> = late.iter().map(|path| path.display().to_string()).collect();
    let words = [
        &["add", "made"],
        &late.iter().map(String::as_str).collect::<Vec<_>>()[..],
    ]
    .concat();
    let (status, out, told) = windfall(&words, folder);
    assert_eq!(status, Some(0), "{told}");
    assert!(
        out.starts_with(&format!("{} impacts added", late.len())),
        "{out}"
    );
    let now = std::fs::read_to_string(folder.join("made/impacts.csv")).unwrap();
    assert!(
        now.starts_with(&listed) && now.lines().count() == 9,
        "{now}"
    );
    // What is listed already is told from what would replace a recording.
    std::fs::write(&late[0], "force_V,phase_a_V,phase_b_V\n0,0,0\n").unwrap();
    let (status, out, _) = windfall(&words, folder);
    assert_eq!(status, Some(0));
    let known = format!("{} recordings are listed already", late.len() - 1);
    assert!(
        out.starts_with("0 impacts added")
            && out.contains("exists already")
            && out.contains(&known),
        "{out}"
    );
    let (status, out, told) = windfall(&["fit", "made", "--format", "json"], folder);
    assert_eq!(status, Some(0), "{told}");
    let outcome: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(outcome["impacts"].as_array().unwrap().len(), 8);
}

#[test]
fn recovers_each_recording_that_lands_while_one_watches() {
    use std::io::{BufRead, BufReader};
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    let late = begun(folder);
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_windfall"))
        .args(["fit", "made", "--watch"])
        .current_dir(folder)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut errors = BufReader::new(child.stderr.take().unwrap()).lines();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut until = |what: &str| loop {
        let line = lines.next().unwrap().unwrap();
        if line.contains(what) {
            return line;
        }
    };
    until("All 6 impacts count");
    for (place, path) in late.iter().enumerate() {
        std::fs::copy(
            path,
            folder.join("made/raw").join(path.file_name().unwrap()),
        )
        .unwrap();
        let id = path.file_stem().unwrap().to_string_lossy().into_owned();
        let line = until(&format!("{id}: k "));
        assert!(line.contains("N/m^1.5"), "{line}");
        until(&format!("All {} impacts count; mean k", 7 + place));
    }
    // One that lands while campaign.toml is broken is told of once that is mended.
    let campaign = folder.join("made/campaign.toml");
    let text = std::fs::read_to_string(&campaign).unwrap();
    std::fs::write(&campaign, "[").unwrap();
    std::fs::copy(&late[0], folder.join("made/raw/meanwhile.csv")).unwrap();
    while !errors.next().unwrap().unwrap().contains("campaign.toml") {}
    std::fs::write(&campaign, text).unwrap();
    until("meanwhile: k ");
    // A recording with nothing in it is said, and stops nothing.
    std::fs::write(
        folder.join("made/raw/empty.csv"),
        "force_V,phase_a_V,phase_b_V\n",
    )
    .unwrap();
    until("empty: NOT FITTED");
    child.kill().unwrap();
    child.wait().unwrap();
}

/// A recording of eight samples under a header.
fn small(path: &Path, header: &str) {
    let columns = header.split(';').count();
    let rows = (0..8).map(|i| {
        let cells = (0..columns).map(|c| format!("{}.5", i * (c + 1)));
        cells.collect::<Vec<_>>().join(";") + "\n"
    });
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, format!("{header}\n{}", rows.collect::<String>())).unwrap();
}

#[test]
fn closed_form_channels_of_foreign_headers_in_new_campaigns_and_added_recordings() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    small(
        &folder.join("french/a.csv"),
        "Temps (s);Force (g);Course (mm);Température (°C)",
    );
    let (status, out, told) = windfall(&["new", "carriage", "new", "--from", "french"], folder);
    assert_eq!(status, Some(0), "{told}");
    // An empty template takes the channels of what is added first, by the same rule.
    windfall(&["new", "carriage", "later"], folder);
    let (status, added, told) = windfall(&["add", "later", "french"], folder);
    assert_eq!(status, Some(0), "{told}");
    for (name, said) in [("new", out), ("later", added)] {
        assert!(
            said.contains("position is \"Course (mm)\", by its unit alone"),
            "{said}"
        );
        assert!(said.contains("g of \"Force (g)\" are gf"), "{said}");
        assert!(
            said.contains("nothing is taken from \"Température (°C)\""),
            "{said}"
        );
        assert!(said.contains("[rig] mass"), "{said}");
        let text = std::fs::read_to_string(folder.join(name).join("campaign.toml")).unwrap();
        for line in [
            "[channels.force]\ncolumn = \"Force (g)\"\nunit = \"gf\"\n",
            "[channels.position]\ncolumn = \"Course (mm)\"\nunit = \"mm\"\n",
            "time = \"Temps (s)\"\ntime_unit = \"s\"\n",
        ] {
            assert!(text.contains(line), "{text}");
        }
    }
}

#[test]
fn closed_form_quantities_are_those_that_the_recordings_have() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    for (header, quantities) in [
        ("Time (s);Acc (m/s^2)", "quantities = [\"acceleration\"]"),
        ("Time (s);Force (N)", "quantities = [\"force\"]"),
        (
            "Time (s);Force (N);Travel (mm)",
            "quantities = [\"displacement\", \"force\"]",
        ),
    ] {
        let name = header.len().to_string();
        small(&folder.join(&name).join("a.csv"), header);
        let campaign = format!("of-{name}");
        let line = ["new", "carriage", &campaign, "--from", &name];
        let (status, _, told) = windfall(&line, folder);
        assert_eq!(status, Some(0), "{told}");
        let text = std::fs::read_to_string(folder.join(&campaign).join("campaign.toml")).unwrap();
        assert!(text.contains(quantities), "{header}: {text}");
    }
}

#[test]
fn rejects_to_guess_between_two_columns_of_one_unit() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    small(
        &folder.join("two/a.csv"),
        "Zeit [s];Kraft [N];Taster A [mm];Taster B [mm]",
    );
    let (status, out, told) = windfall(&["new", "carriage", "new", "--from", "two"], folder);
    assert_eq!(status, Some(0), "{told}");
    assert!(
        out.contains("could be \"Taster A [mm]\" or \"Taster B [mm]\""),
        "{out}"
    );
    assert!(out.contains("[channels.position] column"), "{out}");
    let text = std::fs::read_to_string(folder.join("new/campaign.toml")).unwrap();
    let line = "# WRITE YOURS: column = \"Taster A [mm]\"    # or Taster B [mm]\n";
    assert!(text.contains(line), "{text}");
    let (status, _, told) = windfall(&["fit", "new"], folder);
    assert_eq!(status, Some(2), "{told}");
}

/// With a preset the columns are those of the program, where names and units leave a doubt: here
/// the travel, not the crosshead. The columns are those of an export of testXpert, the numbers our own.
#[test]
fn reference_columns_by_a_preset() {
    let folder = tempfile::tempdir().unwrap();
    let from = folder.path().join("exports");
    std::fs::create_dir(&from).unwrap();
    let mut text = "\"Section\",6,\"mm\"\n\"Temps\",\"Traverse absolue\",\"Force standard\",\
                    \"Course standard\"\n\"s\",\"mm\",\"N\",\"mm\"\n"
        .to_owned();
    for i in 0..50 {
        let x = 0.01 * f64::from(i);
        text += &format!("{:.2},{:.3},{:.3},{x:.3}\n", x, x - 70.0, 100.0 * x);
    }
    std::fs::write(from.join("a.TRA"), text).unwrap();
    let made = |preset: &[&str], name: &str| {
        let directory = folder.path().join(name);
        let mut command = assert_cmd::Command::cargo_bin("windfall").unwrap();
        command.args(["new", "compression"]).arg(&directory);
        command.arg("--from").arg(&from).args(preset);
        let output = command.output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        let file = std::fs::read_to_string(directory.join("campaign.toml"));
        (file.unwrap_or_default(), error)
    };
    let (guessed, _) = made(&[], "guessed");
    assert!(
        guessed.contains("could be _Traverse absolue_ or _Course standard_"),
        "{guessed}"
    );
    let (told, _) = made(&["--preset", "zwick-roell"], "told");
    assert!(
        told.contains("column = \"Course standard\"")
            && told.contains("column = \"Force standard\"")
    );
    assert!(!told.contains("Traverse absolue"), "{told}");
    let (_, error) = made(&["--preset", "zwick"], "wrong");
    assert!(error.contains("zwick-roell"), "{error}");
    let mut command = assert_cmd::Command::cargo_bin("windfall").unwrap();
    let listed = command.args(["inspect", "--presets"]).output().unwrap();
    let listed = String::from_utf8(listed.stdout).unwrap();
    assert!(listed.contains("a-hilhorst/Tensile-test-Analysis") && listed.contains("MIT"));
}

#[test]
fn rejects_names_that_put_two_fruit_under_one_id() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    recordings(folder, 2);
    for (name, other) in [("f00", "f01"), ("f01", "f00")] {
        // Both varieties have a fruit of each number.
        for entry in std::fs::read_dir(folder.join("recordings")).unwrap() {
            let path = entry.unwrap().path();
            let own = path.file_name().unwrap().to_string_lossy().into_owned();
            if own.contains(name) {
                let _ = std::fs::copy(&path, path.with_file_name(own.replace(name, other)));
            }
        }
    }
    let by_id = "{variety}_f{specimen}_{height_mm}mm_{rep}.csv";
    let new = |names| {
        [
            "new",
            "pendulum",
            "bench",
            "--from",
            "recordings",
            "--names",
            names,
        ]
    };
    let (status, _, told) = windfall(&new(by_id), folder);
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("two fruit with one id") && told.contains("{sample}"),
        "{told}"
    );
    let (status, _, told) = windfall(&new(NAMES), folder);
    assert_eq!(status, Some(0), "{told}");
    // Both of these would be Gala-00-1.
    let clash = folder.join("Gala-00_f1_50mm_1.csv");
    let any = folder.join("recordings/Gala_f00_50mm_1.csv");
    std::fs::copy(&any, &clash).unwrap();
    let second = folder.join("Gala_f00-1_50mm_1.csv");
    std::fs::copy(&any, &second).unwrap();
    let (status, out, told) = windfall(
        &[
            "add",
            "bench",
            "Gala-00_f1_50mm_1.csv",
            "Gala_f00-1_50mm_1.csv",
            "--names",
            NAMES,
        ],
        folder,
    );
    assert_eq!(status, Some(0), "{told}");
    let said = out + &told;
    assert!(said.contains("two fruit with one id"), "{said}");
    assert!(!folder.join("bench/raw/Gala_f00-1_50mm_1.csv").exists());
}

#[test]
fn added_recordings_leave_the_rows_that_a_person_wrote() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    recordings(folder, 1);
    windfall(&["new", "pendulum", "bench"], folder);
    let bench = folder.join("bench");
    let impacts = bench.join("impacts.csv");
    let text = std::fs::read_to_string(&impacts).unwrap() + "mine,fruit-1,a.csv,1\n";
    std::fs::write(&impacts, text).unwrap();
    let before = ["specimens.csv", "campaign.toml"].map(|name| bench.join(name));
    let before = before.map(|path| (std::fs::read_to_string(&path).unwrap(), path));
    let (status, _, told) = windfall(&["add", "bench", "recordings", "--names", NAMES], folder);
    assert_eq!(status, Some(0), "{told}");
    let [(specimens, path), (settings, campaign)] = before;
    let now = std::fs::read_to_string(path).unwrap();
    assert!(
        now.contains("fruit-1,Golden") && now.contains("fruit-2,Golden"),
        "{now}"
    );
    assert!(now.lines().count() > specimens.lines().count(), "{now}");
    assert_eq!(std::fs::read_to_string(campaign).unwrap(), settings);
}

#[test]
fn rejects_recordings_before_they_are_copied() {
    let laboratory = tempfile::tempdir().unwrap();
    let folder = laboratory.path();
    recordings(folder, 1);
    windfall(&["new", "pendulum", "bench"], folder);
    let impacts = folder.join("bench/impacts.csv");
    let add = ["add", "bench", "recordings", "--names", NAMES];
    // As a spreadsheet may save it.
    let table = "\u{feff}id,specimen,file\n";
    let bytes: Vec<u8> = table.encode_utf16().flat_map(u16::to_le_bytes).collect();
    std::fs::write(&impacts, bytes).unwrap();
    let (status, _, told) = windfall(&add, folder);
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("impacts.csv") && told.contains("UTF-8"),
        "{told}"
    );
    let raw = folder.join("bench/raw");
    let copied = std::fs::read_dir(raw).map_or(0, |files| {
        let recordings = files.filter(|file| {
            let name = file.as_ref().unwrap().file_name();
            name.to_string_lossy().ends_with(".csv")
        });
        recordings.count()
    });
    assert_eq!(copied, 0);
    // Nothing of what was named could be added.
    std::fs::write(&impacts, &table[3..]).unwrap();
    std::fs::write(folder.join("other.txt"), "nothing\n").unwrap();
    let (status, out, told) = windfall(&["add", "bench", "other.txt", "--names", NAMES], folder);
    assert_eq!(status, Some(1), "{out}{told}");
    assert!(told.contains("could be added"), "{out}{told}");
}
