//! No output replaces an input, and hostile files do no harm.

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
/// recording beside it, a table, a law card, a scene that has run, and dropped fruit.
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
    made("new scene scene");
    let scene = path.join("scene/scene.toml");
    let text = std::fs::read_to_string(&scene).unwrap();
    let text = text
        .replace("count = 100", "count = 3")
        .replace("end = \"4 s\"", "end = \"0.1 s\"");
    std::fs::write(&scene, text).unwrap();
    made("scene run scene/scene.toml");
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

/// The same file or folder under other names; links are made in `links`.
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

/// Types a command with every spelling of every target, also with `--force`: nothing that
/// was there is changed, and the command says so.
fn keeps(folder: &Path, command: &str, targets: &[String], forces: &[&str]) {
    let links = tempfile::tempdir_in(folder).unwrap();
    let before = files(folder);
    for target in targets {
        for spelling in spellings(target, folder, links.path()) {
            for force in forces {
                let line = typed(&format!("{command}{force}")).into_iter();
                // "{}.svg": a picture whose data would have that name.
                let own = |word: String| match word.strip_prefix("{}.") {
                    Some(ending) => Path::new(&spelling)
                        .with_extension(ending)
                        .display()
                        .to_string(),
                    None => word.replace("{}", &spelling),
                };
                let line: Vec<String> = line.map(own).collect();
                let (status, told) = windfall(&line, folder);
                assert_eq!(status, Some(2), "{line:?}: {told}");
                let after = files(folder);
                for (path, digest) in &before {
                    assert_eq!(after.get(path), Some(digest), "{line:?}: {path:?}: {told}");
                }
            }
        }
    }
    let mut strays = files(folder).into_keys();
    let partial = |path: &PathBuf| path.display().to_string().contains("partial");
    assert_eq!(strays.find(partial), None);
}

/// Inputs and tables of a campaign, and its store.
fn own_files(folder: &Path) -> Vec<String> {
    let raw = names(&folder.join("campaign/raw"));
    let first = raw[0].file_name().unwrap().to_string_lossy();
    let own = [
        "campaign.toml",
        "specimens.csv",
        "impacts.csv",
        "results.sqlite",
    ];
    let own = own.map(|name| format!("campaign/{name}"));
    let raw = [&first, "unlisted.csv"].map(|name| format!("campaign/raw/{name}"));
    own.into_iter().chain(raw).collect()
}

/// Commands that write one file, and the ending of its name.
const FILE_COMMANDS: &[(&str, &str)] = &[
    ("fit campaign --card {}", "toml"),
    ("population campaign --card {}", "toml"),
    (
        "card transfer --file card.toml --from 40mm,plane --to 40mm,20mm --card {}",
        "toml",
    ),
    (
        "simulate impact --law hertz(k=9e5) --mass 0.2kg --velocity 1m/s --plot {}",
        "svg",
    ),
    (
        "simulate impact --law hertz(k=9e5) --mass 0.2kg --velocity 1m/s --plot {}",
        "png",
    ),
    ("inspect impact.csv --plot {}", "svg"),
    ("inspect impact.csv --plot {}", "png"),
    ("scene picture scene/scene.run --out {}", "svg"),
];

/// Commands that write into a folder.
const FOLDER_COMMANDS: &[&str] = &[
    "fit campaign --figures {}",
    "laws campaign --figures {}",
    "report campaign --out {}",
    "surface design.csv --factor A --factor B --response y --model A+B --figures {}",
    "scene run scene/scene.toml --out {}",
    "scene export scene/scene.toml --engine chrono --out {}",
    "scene export scene/scene.toml --engine yade --out {}",
    "scene vtk scene/scene.run --out {}",
];

#[test]
fn rejects_an_input_as_a_file_to_write() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let own = own_files(folder);
    for (command, ending) in FILE_COMMANDS {
        let (command, targets) = match *ending {
            "toml" if command.contains("--file") => {
                ((*command).to_owned(), vec!["card.toml".to_owned()])
            }
            "toml" => ((*command).to_owned(), own.clone()),
            _ if command.contains("inspect") => {
                let picture = command.replace("{}", &format!("{{}}.{ending}"));
                (picture, vec!["impact.csv".to_owned()])
            }
            _ => continue,
        };
        keeps(folder, &command, &targets, &["", " --force"]);
    }
}

#[test]
fn rejects_recordings_and_campaigns_as_folders_to_write_into() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    for command in FOLDER_COMMANDS {
        let raw = ["campaign/raw".to_owned()];
        // Recordings are inputs of the commands that read the campaign.
        let reads = command.contains("campaign");
        keeps(
            folder,
            command,
            if reads { &raw } else { &[] },
            &["", " --force"],
        );
    }
    let campaign = ["campaign".to_owned()];
    keeps(
        folder,
        "report campaign --out {}",
        &campaign,
        &["", " --force"],
    );
}

/// Files of the names that a command writes, which somebody else made: they stay, unless
/// `--force` is said.
#[test]
fn rejects_files_that_windfall_did_not_write() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let written = |command: &str, place: &str| {
        let line = typed(&command.replace("{}", place));
        windfall(&line, folder)
    };
    let commands = FILE_COMMANDS.iter().map(|(command, ending)| {
        let target = command.replace("{}", &format!("{{}}/x.{ending}"));
        (target, true)
    });
    let folders = FOLDER_COMMANDS.iter().map(|own| ((*own).to_owned(), false));
    for (number, (command, file)) in commands.chain(folders).enumerate() {
        let [place, mine] = ["ours", "mine"].map(|name| format!("{name}{number}"));
        std::fs::create_dir(folder.join(&place)).unwrap();
        let (status, told) = written(&command, &place);
        assert_eq!(status, Some(0), "{command}: {told}");
        // What windfall wrote it replaces.
        let again = command.replace("scene.toml", "scene.toml --restart");
        let again = if command.contains("scene run") {
            again
        } else {
            command.clone()
        };
        assert_eq!(written(&again, &place).0, Some(0), "{command}");
        let names: Vec<PathBuf> = files(&folder.join(&place)).into_keys().collect();
        for path in &names {
            let same = Path::new(&mine).join(path.strip_prefix(folder.join(&place)).unwrap());
            std::fs::create_dir_all(folder.join(&same).parent().unwrap()).unwrap();
            std::fs::write(folder.join(same), "mine").unwrap();
        }
        assert!(!names.is_empty(), "{command}");
        let before = files(&folder.join(&mine));
        let (status, told) = written(&again, &mine);
        assert_eq!(status, Some(2), "{command}: {told}");
        assert!(told.contains("not written by windfall"), "{told}");
        let after = files(&folder.join(&mine));
        for (path, digest) in &before {
            assert_eq!(after.get(path), Some(digest), "{command}: {path:?}");
        }
        let (status, told) = written(&format!("{again} --force"), &mine);
        assert_eq!(status, Some(0), "{command}: {told}");
        assert!(!file || files(&folder.join(&mine)) != before, "{command}");
    }
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

#[test]
fn rejects_a_design_in_the_place_of_any_file() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    let design = "design factorial --factor A=0..1 --factor B=0..1 --out {}";
    let table = vec!["design.csv".to_owned()];
    keeps(
        folder,
        design,
        &[own_files(folder), table].concat(),
        &["", " --force"],
    );
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
