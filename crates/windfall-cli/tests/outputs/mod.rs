//! No output replaces an input, and hostile files do no harm.

mod forms;
#[allow(dead_code)]
mod options;
mod replaced;

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use windfall_files::provenance::digest_file;
use windfall_files::written::LIST;

fn windfall(arguments: &[String], folder: &Path) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), told)
}

fn typed(line: &str) -> Vec<String> {
    line.split(' ').map(str::to_owned).collect()
}

/// A folder with a fitted campaign, in which one recording is named by no impact, a
/// recording beside it, tables, a law card, laws, a scene that has run, its study, and
/// dropped fruit.
fn laboratory() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let law = "kuwabara-kono(k=753599,c=1524)";
    let made = |line: &str| {
        let (status, told) = windfall(&typed(line), path);
        assert_eq!(status, Some(0), "{line}: {told}");
    };
    let campaign = format!("simulate carriage --law {law} --mass 0.2kg --velocity 0.5m/s");
    made(&format!("{campaign} --specimens 2 --recordings campaign"));
    let recordings = names(&path.join("campaign/raw"));
    for copy in ["campaign/raw/unlisted.csv", "impact.csv"] {
        std::fs::copy(&recordings[0], path.join(copy)).unwrap();
    }
    made("fit campaign --card card.toml");
    std::fs::write(
        path.join("design.csv"),
        "A,B,y\n0,0,1\n1,0,2\n0,1,3\n1,1,5\n0,0.5,2\n1,0.5,4\n",
    )
    .unwrap();
    std::fs::write(
        path.join("fruit.csv"),
        "fruit,V,k\na,1,3\na,2,4.1\na,3,5\nb,1,4\nb,2,4.7\nb,3,6\nc,1,2\nc,2,3.3\nc,3,4\n",
    )
    .unwrap();
    made("new scene scene");
    let scene = path.join("scene/scene.toml");
    let text = std::fs::read_to_string(&scene).unwrap();
    let text = text
        .replace("count = 100", "count = 3")
        .replace("end = \"4 s\"", "end = \"0.1 s\"");
    std::fs::write(&scene, text).unwrap();
    made("scene run scene/scene.toml");
    let write = |name: &str, text: &str| std::fs::write(path.join(name), text).unwrap();
    let levels = "{ name = \"one\" }, { name = \"two\", set = { \"scene.seed\" = 2 } }";
    write(
        "scene/study.toml",
        &format!(
            "format = 1\ntitle = \"two\"\nscene = \"scene.toml\"\nreplicates = 1\n\
             [[vary]]\nname = \"seed\"\nlevels = [{levels}]\n"
        ),
    );
    write(
        "laws.toml",
        "format = 1\n[laws.own]\nforce = \"k*x^1.5\"\nparameters.k = { unit = \"N/m^1.5\", start = 4e5 }\n",
    );
    let law = "adams-impact(k=466143.6,e=1.91,c=0.556,d=1e-6)";
    made(&format!(
        "simulate drop drops --law {law} --mass 4.8g --height 100mm --height 500mm --drops 1"
    ));
    made("fit drops");
    folder
}

fn names(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    names.sort();
    names
}

/// Every file below a folder with its digest; a store, to which runs are added, as what it is.
fn files(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    for path in names(folder) {
        let name = path.file_name().unwrap_or_default();
        if path.is_dir() {
            found.extend(files(&path));
        } else if name == "results.sqlite" {
            let text = std::fs::read(&path).unwrap();
            found.insert(path, String::from_utf8_lossy(&text[..15]).into_owned());
        } else if name != LIST {
            let digest = digest_file(&path).unwrap_or_default();
            found.insert(path, digest);
        }
    }
    found
}

/// What cannot be written is refused before an hour of fits.
#[test]
fn rejects_outputs_before_the_work() {
    let laboratory = laboratory();
    let store = laboratory.path().join("campaign/results.sqlite");
    std::fs::remove_file(&store).unwrap();
    for line in [
        "fit campaign --figures campaign/raw",
        "fit campaign --card campaign/impacts.csv",
        "laws campaign --figures campaign/raw",
        "population campaign --card campaign/impacts.csv",
        "report campaign --out campaign/raw",
        "report campaign --out campaign",
    ] {
        let line = typed(line);
        let (status, told) = windfall(&line, laboratory.path());
        assert_eq!((status, store.exists()), (Some(2), false), "{told}");
    }
}

/// A new scene: its folder, its file and the text of it.
fn scene() -> (tempfile::TempDir, PathBuf, String) {
    let folder = tempfile::tempdir().unwrap();
    let made = windfall(&typed("new scene scene"), folder.path());
    assert_eq!(made.0, Some(0));
    let file = folder.path().join("scene/scene.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    (folder, file, text)
}

/// A name that would be a line of code in an exported deck.
#[test]
fn rejects_names_of_more_than_one_line_in_a_scene() {
    let (folder, file, text) = scene();
    for (key, named) in [("materials", "apple"), ("title", ""), ("name", "floor")] {
        for hostile in ["\\nimport os", "\\r\\nx", "\\u2028x", "\\u0085x", "\\u0000"] {
            let found = text
                .lines()
                .position(|line| line.starts_with(&format!("{key} = ")));
            let line = found.unwrap();
            let quote = text.lines().nth(line).unwrap().find('"').unwrap() + 1;
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            lines[line].insert_str(quote, hostile);
            std::fs::write(&file, lines.join("\n")).unwrap();
            let (status, told) = windfall(&typed("scene run scene/scene.toml"), folder.path());
            assert_eq!(status, Some(2), "{key} {named} {hostile}: {told}");
            let place = format!("scene.toml, line {}", line + 1);
            assert!(told.contains(&place) && told.contains(key), "{told}");
            assert!(told.contains("one line"), "{told}");
        }
    }
}

#[cfg(unix)]
#[test]
fn rejects_tables_of_laws_without_an_end() {
    let laboratory = laboratory();
    let laws = laboratory.path().join("laws.toml");
    let directory = laboratory.path().display().to_string();
    for table in ["/dev/zero", directory.as_str()] {
        let text = format!("format = 1\n[laws.endless]\ntable = \"{table}\"\n");
        std::fs::write(&laws, text).unwrap();
        let line = typed("fit campaign --laws laws.toml --law endless");
        let (status, told) = windfall(&line, laboratory.path());
        assert_eq!(status, Some(2), "{told}");
        assert!(told.contains("not a regular file"), "{told}");
    }
}

#[cfg(unix)]
#[test]
fn rejects_pipes_and_devices_among_recordings_and_tables() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let raw = names(&folder.join("campaign/raw"));
    std::fs::remove_file(&raw[0]).unwrap();
    let made = std::process::Command::new("mkfifo").arg(&raw[0]).status();
    assert!(made.unwrap().success());
    let (status, told) = windfall(&typed("fit campaign"), folder);
    assert_eq!(status, Some(0), "{told}");
    assert!(told.contains("1 could not be fitted"), "{told}");
    for name in ["impacts.csv", "campaign.toml"] {
        let file = folder.join("campaign").join(name);
        std::fs::remove_file(&file).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
        let (status, told) = windfall(&typed("fit campaign"), folder);
        assert_eq!(status, Some(2), "{told}");
        let place = format!("{name}: this is not a regular file");
        assert!(told.contains(&place), "{told}");
    }
}

#[test]
fn rejects_more_fruit_than_any_memory_holds() {
    let (folder, file, text) = scene();
    let line = text.lines().position(|line| line.starts_with("count = "));
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line.unwrap()] = "count = 1000000000000";
    std::fs::write(&file, lines.join("\n")).unwrap();
    let (status, told) = windfall(&typed("scene run scene/scene.toml"), folder.path());
    assert_eq!(status, Some(2), "{told}");
    assert!(
        told.contains("count") && told.contains("at most 10000000 fruit"),
        "{told}"
    );
}

/// One digit of a stored document in another: refused by name, and mended by `--refit`.
#[test]
fn rejects_a_store_in_which_a_digit_changed() {
    let laboratory = laboratory();
    let store = laboratory.path().join("campaign/results.sqlite");
    let json = |arguments: &str| {
        let mut command = Command::cargo_bin("windfall").unwrap();
        let command = command
            .args(typed(arguments))
            .current_dir(laboratory.path());
        let output = command.output().unwrap();
        let outcome: Option<serde_json::Value> = serde_json::from_slice(&output.stdout).ok();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        (
            output.status.code(),
            outcome.map(|o| o["impacts"].clone()),
            told,
        )
    };
    let fit = "fit campaign --format json";
    let (_, before, _) = json(fit);
    let good = std::fs::read(&store).unwrap();
    let documents = String::from_utf8_lossy(&good).matches("\"value\":").count();
    assert!(documents > 10, "{documents} numbers");
    let mut refused = 0;
    for (at, window) in good.windows(8).enumerate() {
        let digit = at + 9;
        if window != b"\"value\":" || !good[digit].is_ascii_digit() {
            continue;
        }
        let mut changed = good.clone();
        changed[digit] = b'0' + (changed[digit] - b'0' + 1) % 10;
        std::fs::write(&store, &changed).unwrap();
        let (status, found, told) = json(fit);
        match status {
            Some(0) => assert_eq!(found, before, "byte {digit}: {told}"),
            _ => {
                assert!(
                    told.contains("is not what was written"),
                    "byte {digit}: {told}"
                );
                refused += 1;
            }
        }
    }
    assert!(refused > 5, "{refused} refused");
    let (status, found, told) = json("fit campaign --refit --format json");
    assert_eq!((status, found), (Some(0), before.clone()), "{told}");
    let (status, found, told) = json(fit);
    assert_eq!((status, found), (Some(0), before), "{told}");
}
