//! No output replaces an input, and hostile files do no harm.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use windfall_files::provenance::digest_file;

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

/// A folder with a fitted campaign, in which one recording is named by no impact, and a
/// recording beside it.
fn laboratory() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let law = "kuwabara-kono(k=753599,c=1524)";
    let campaign = format!("simulate carriage --law {law} --mass 0.2kg --velocity 0.5m/s");
    let campaign = typed(&format!("{campaign} --specimens 2 --recordings campaign"));
    assert_eq!(windfall(&campaign, folder.path()).0, Some(0));
    let recordings = names(&folder.path().join("campaign/raw"));
    for copy in ["campaign/raw/unlisted.csv", "impact.csv"] {
        std::fs::copy(&recordings[0], folder.path().join(copy)).unwrap();
    }
    assert_eq!(windfall(&typed("fit campaign"), folder.path()).0, Some(0));
    std::fs::write(
        folder.path().join("design.csv"),
        "A,B,y\n0,0,1\n1,0,2\n0,1,3\n1,1,5\n",
    )
    .unwrap();
    folder
}

fn names(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    names.sort();
    names
}

/// Inputs with their digests; the store, to which runs are added, as what it is.
fn inputs(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut files = names(&folder.join("campaign/raw"));
    for name in ["campaign.toml", "specimens.csv", "impacts.csv"] {
        files.push(folder.join("campaign").join(name));
    }
    files.extend(["impact.csv", "design.csv"].map(|name| folder.join(name)));
    let mut found: BTreeMap<PathBuf, String> = files
        .into_iter()
        .map(|path| (path.clone(), digest_file(&path).unwrap_or_default()))
        .collect();
    let store = folder.join("campaign/results.sqlite");
    let kind = std::fs::read(&store).unwrap();
    found.insert(store, String::from_utf8_lossy(&kind[..15]).into_owned());
    found
}

/// The same file under other names; links are made in `links`.
fn spellings(target: &str, folder: &Path, links: &Path) -> Vec<String> {
    let whole = folder.join(target);
    let ending = whole.extension().unwrap_or_default().to_owned();
    let link = |name: &str| links.join(name).with_extension(&ending);
    let mut out = vec![
        target.to_owned(),
        format!("./{target}"),
        format!("campaign/../{target}"),
        format!("campaign/raw/../../{target}"),
        whole.display().to_string(),
    ];
    let (hard, symbolic) = (link("hard"), link("symbolic"));
    let _ = std::fs::remove_file(&hard);
    let _ = std::fs::remove_file(&symbolic);
    if std::fs::hard_link(&whole, &hard).is_ok() {
        out.push(hard.display().to_string());
    }
    #[cfg(unix)]
    if std::os::unix::fs::symlink(&whole, &symbolic).is_ok() {
        out.push(symbolic.display().to_string());
    }
    out
}

/// Types a command with every spelling of every target, and compares all inputs.
fn keeps_inputs(command: &str, targets: &[String]) {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let links = folder.join("links");
    std::fs::create_dir(&links).unwrap();
    let before = inputs(folder);
    for target in targets {
        for spelling in spellings(target, folder, &links) {
            let line = typed(command).into_iter();
            let line: Vec<String> = line.map(|word| word.replace("{}", &spelling)).collect();
            let (status, told) = windfall(&line, folder);
            assert_eq!(inputs(folder), before, "{line:?}: {status:?} {told}");
            assert_ne!(
                status,
                Some(0),
                "{line:?} replaced nothing, and says so: {told}"
            );
            assert!(!told.contains("panicked"), "{told}");
        }
    }
    let strays = ["", "campaign", "campaign/raw"].map(|below| names(&folder.join(below)));
    let partial = |path: &&PathBuf| path.display().to_string().contains(".partial");
    assert_eq!(strays.iter().flatten().find(partial), None);
}

fn files() -> Vec<String> {
    let first = {
        let laboratory = laboratory();
        let raw = names(&laboratory.path().join("campaign/raw"));
        raw[0].file_name().unwrap().to_string_lossy().into_owned()
    };
    let own = [
        "campaign.toml",
        "specimens.csv",
        "impacts.csv",
        "results.sqlite",
    ];
    let own = own.map(|name| format!("campaign/{name}"));
    let raw = [first, "unlisted.csv".to_owned()].map(|name| format!("campaign/raw/{name}"));
    own.into_iter().chain(raw).collect()
}

#[test]
fn rejects_a_card_in_the_place_of_an_input() {
    keeps_inputs("fit campaign --card {}", &files());
    keeps_inputs("fit campaign --refit --card {}", &files()[..1]);
}

#[test]
fn rejects_figures_among_recordings() {
    let raw = ["campaign/raw".to_owned()];
    keeps_inputs("fit campaign --figures {}", &raw);
    keeps_inputs("fit campaign/raw/specimen-01.csv --figures {}", &raw);
    keeps_inputs("laws campaign --figures {}", &raw);
    keeps_inputs("report campaign --out {}", &raw);
}

#[test]
fn rejects_a_report_in_the_place_of_its_campaign() {
    keeps_inputs("report campaign --out {}", &["campaign".to_owned()]);
}

/// What cannot be written is refused before an hour of fits.
#[test]
fn rejects_outputs_before_the_work() {
    let laboratory = laboratory();
    let store = laboratory.path().join("campaign/results.sqlite");
    std::fs::remove_file(&store).unwrap();
    for output in ["--figures campaign/raw", "--card campaign/impacts.csv"] {
        let line = typed(&format!("fit campaign {output}"));
        let (status, told) = windfall(&line, laboratory.path());
        assert_eq!((status, store.exists()), (Some(2), false), "{told}");
    }
}

/// Figures of one recording of a campaign, and their data.
#[test]
fn rejects_a_plot_whose_data_would_replace_the_recording() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let links = folder.join("links");
    std::fs::create_dir(&links).unwrap();
    let before = inputs(folder);
    for spelling in spellings("impact.csv", folder, &links) {
        for ending in ["svg", "png"] {
            let plot = Path::new(&spelling).with_extension(ending);
            let line = [
                typed("inspect impact.csv --plot"),
                vec![plot.display().to_string()],
            ];
            let (status, told) = windfall(&line.concat(), folder);
            assert_eq!(inputs(folder), before, "{line:?}: {told}");
            assert_eq!(status, Some(2), "{line:?}: {told}");
        }
    }
}

#[test]
fn rejects_a_design_in_the_place_of_any_file() {
    let design = "design factorial --factor A=0..1 --factor B=0..1 --out {}";
    keeps_inputs(design, &[files(), vec!["design.csv".to_owned()]].concat());
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
