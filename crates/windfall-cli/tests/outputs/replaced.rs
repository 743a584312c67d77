//! All outputs × spellings × targets, from the list of outputs: whatever is typed, no file
//! that was there is changed.

use super::options::{Kind, Output, WRITTEN};
use super::{files, laboratory, names, typed, windfall};
use std::collections::BTreeMap;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::SystemTime;
use windfall_files::written::LIST;

/// Files that only some commands read: one of each kind.
const OTHERS: &[&str] = &[
    "impact.csv",
    "design.csv",
    "card.toml",
    "laws.toml",
    "campaign/campaign.toml",
    "campaign/impacts.csv",
    "campaign/results.sqlite",
    "campaign/raw/unlisted.csv",
    "drops/raw/drop-100-1.csv",
    "scene/scene.toml",
    "scene/scene.run/events.csv",
    "scene/scene.run/frames.bin",
];

/// A laboratory whose files somebody else made, and what they are.
struct Kept {
    folder: tempfile::TempDir,
    digests: BTreeMap<PathBuf, String>,
    stamps: BTreeMap<PathBuf, (u64, Option<SystemTime>)>,
    typed: usize,
}

fn stamp(found: &Metadata) -> (u64, Option<SystemTime>) {
    (found.len(), found.modified().ok())
}

impl Kept {
    fn new() -> Self {
        let folder = laboratory();
        let digests = files(folder.path());
        // Not even what windfall has simulated is its own.
        for path in digests.keys() {
            let _ = std::fs::remove_file(path.with_file_name(LIST));
        }
        let stamps = digests.keys().map(|path| {
            let found = std::fs::metadata(path).unwrap();
            (path.clone(), stamp(&found))
        });
        Self {
            stamps: stamps.collect(),
            digests,
            folder,
            typed: 0,
        }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Types a line: every file is there as it was, apart from runs that are added to a store.
    fn keeps(&mut self, line: &str, output: &str) -> Option<i32> {
        let own = typed(line)
            .into_iter()
            .map(|word| word.replace("{}", output));
        let line: Vec<String> = own.collect();
        let (status, told) = windfall(&line, self.path());
        self.typed += 1;
        for (path, before) in &mut self.stamps {
            let found = std::fs::metadata(path);
            let found = found.unwrap_or_else(|_| panic!("{line:?}: {path:?} is gone: {told}"));
            if stamp(&found) != *before {
                // Its digest tells, in `check`.
                check(path, &self.digests[path], &format!("{line:?}: {told}"));
                *before = stamp(&found);
            }
        }
        assert!(!told.contains("panicked"), "{line:?}: {told}");
        status
    }

    /// [`Kept::keeps`] of what must be refused.
    fn refuses(&mut self, line: &str, output: &str) {
        let status = self.keeps(line, output);
        assert_eq!(status, Some(2), "{line} with {output}");
    }

    /// Every file has its digest, and nothing unfinished lies about.
    fn end(self) {
        for (path, digest) in &self.digests {
            check(path, digest, "at the end");
        }
        let mut strays = files(self.path()).into_keys();
        let partial = |path: &PathBuf| path.display().to_string().contains("partial");
        assert_eq!(strays.find(partial), None);
    }
}

fn check(path: &Path, digest: &str, told: &str) {
    let now = files(path.parent().unwrap());
    assert_eq!(now[path], digest, "{path:?} has changed: {told}");
}

/// Whether the file system takes names of another case for the same.
fn ignores_case(folder: &Path) -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| folder.join("CAMPAIGN").exists())
}

/// The same place by other words.
fn words(folder: &Path, target: &str) -> Vec<String> {
    let mut out = vec![
        target.to_owned(),
        format!("./{target}"),
        format!("campaign/../{target}"),
        format!("campaign/raw/../../{target}"),
        folder.join(target).display().to_string(),
    ];
    if ignores_case(folder) {
        out.push(target.to_uppercase());
    }
    out
}

/// Links of a name to a file: a hard one and a symbolic one, each in a folder of its own.
fn links(folder: &Path, target: &str, name: &str) -> Vec<PathBuf> {
    let whole = folder.join(target);
    let mut found = Vec::new();
    for kind in ["hard", "symbolic"] {
        let within = tempfile::Builder::new().prefix(kind).tempdir_in(folder);
        let link = within.unwrap().keep().join(name);
        link_to(kind, &whole, &link);
        found.push(link);
    }
    found
}

/// Symbolic links are hard ones where there are none.
fn link_to(kind: &str, whole: &Path, link: &Path) {
    #[cfg(unix)]
    if kind == "symbolic" {
        std::os::unix::fs::symlink(whole, link).unwrap();
        return;
    }
    let _ = kind;
    std::fs::hard_link(whole, link).unwrap();
}

/// Spellings of a file for an output of that kind, with what to remove afterwards.
fn spellings(folder: &Path, target: &str, kind: Kind) -> (Vec<String>, Vec<PathBuf>) {
    let path = Path::new(target);
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let with = |path: &Path, ending: &str| path.with_extension(ending).display().to_string();
    let (mut out, mut made) = (Vec::new(), Vec::new());
    match kind {
        Kind::Picture => {
            for picture in ["svg", "png"] {
                if ending == "csv" {
                    out.extend(words(folder, &with(path, picture)));
                }
                for name in [format!("x.{picture}"), "x.csv".to_owned()] {
                    let links = links(folder, target, &name);
                    out.extend(links.iter().map(|own| with(own, picture)));
                    made.extend(links);
                }
            }
        }
        Kind::Ending(endings) => {
            if endings.contains(&&*ending) {
                out.extend(words(folder, target));
            }
            for ending in endings {
                let links = links(folder, target, &format!("x.{ending}"));
                out.extend(links.iter().map(|own| own.display().to_string()));
                made.extend(links);
            }
        }
        _ => {
            out.extend(words(folder, target));
            let links = links(folder, target, path.file_name().unwrap().to_str().unwrap());
            out.extend(links.iter().map(|own| own.display().to_string()));
            made.extend(links);
        }
    }
    (out, made)
}

fn remove(made: &[PathBuf]) {
    for path in made {
        std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }
}

fn of_kind(wanted: impl Fn(Kind) -> bool) -> impl Iterator<Item = &'static Output> {
    WRITTEN.iter().filter(move |own| wanted(own.2))
}

fn is_file(kind: Kind) -> bool {
    matches!(kind, Kind::File | Kind::Ending(_) | Kind::Picture)
}

#[test]
fn rejects_every_input_as_a_file_to_write() {
    let mut kept = Kept::new();
    let folder = kept.path().to_path_buf();
    for &(_, _, kind, line, inputs) in of_kind(is_file) {
        for target in inputs {
            let (spellings, made) = spellings(&folder, target, kind);
            for spelling in &spellings {
                kept.refuses(line, spelling);
                // Not even when it is said.
                let free = !line.starts_with("design");
                if free {
                    kept.refuses(&format!("{line} --force"), spelling);
                }
            }
            remove(&made);
        }
        // What is no input stays as well, unless it is said.
        for target in OTHERS.iter().filter(|own| !inputs.contains(own)) {
            let (spellings, made) = spellings(&folder, target, kind);
            let ends = [spellings.first(), spellings.last()];
            for spelling in ends.into_iter().flatten() {
                kept.refuses(line, spelling);
            }
            remove(&made);
        }
        for directory in ["campaign/raw", "campaign", "scene"] {
            let status = kept.keeps(line, directory);
            assert_ne!(status, Some(0), "{line} with {directory}");
        }
    }
    assert!(kept.typed > 600, "{} lines", kept.typed);
    kept.end();
}

/// The folder of the recordings of a line that reads a campaign.
fn recordings(inputs: &[&str]) -> Option<PathBuf> {
    let raw = inputs.iter().map(|own| Path::new(own).parent().unwrap());
    raw.filter(|own| own.ends_with("raw"))
        .map(Path::to_path_buf)
        .next()
}

#[test]
fn rejects_recordings_as_a_place_to_write() {
    let mut kept = Kept::new();
    let folder = kept.path().to_path_buf();
    for &(_, _, kind, line, inputs) in WRITTEN {
        let Some(raw) = recordings(inputs) else {
            continue;
        };
        let raw = raw.display().to_string();
        let link = folder.join("to-raw");
        #[cfg(unix)]
        std::os::unix::fs::symlink(folder.join(&raw), &link).unwrap();
        let mut places = words(&folder, &raw);
        places.extend(words(&folder, &format!("{raw}/below")));
        places.extend(["to-raw", "to-raw/below"].map(str::to_owned));
        for place in places {
            let place = match is_file(kind) {
                true => format!("{place}/new.toml"),
                false => place,
            };
            kept.refuses(line, &place);
            kept.refuses(&format!("{line} --force"), &place);
        }
        let _ = std::fs::remove_file(&link);
    }
    // Its tables are not replaced by those of the report.
    for place in words(&folder, "campaign") {
        for force in ["", " --force"] {
            kept.refuses(&format!("report campaign --out {{}}{force}"), &place);
        }
    }
    kept.end();
}

/// Files that a line writes into a new folder, below it.
fn written(folder: &Path, line: &str, place: &str) -> Vec<PathBuf> {
    let (status, told) = windfall(&typed(&line.replace("{}", place)), folder);
    assert_eq!(status, Some(0), "{line}: {told}");
    let place = folder.join(place);
    let found = files(&place).into_keys();
    let found = found.map(|path| path.strip_prefix(&place).unwrap().to_path_buf());
    found.collect()
}

/// Files of somebody else under the names that a line writes.
fn of_others(folder: &Path, place: &str, names: &[PathBuf]) -> BTreeMap<PathBuf, String> {
    for name in names {
        let path = folder.join(place).join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "mine").unwrap();
    }
    files(&folder.join(place))
}

/// Types a line that would replace them: they stay.
fn refuses_others(folder: &Path, line: &str, place: &str, before: &BTreeMap<PathBuf, String>) {
    let (status, told) = windfall(&typed(&line.replace("{}", place)), folder);
    assert_eq!(status, Some(2), "{line}: {told}");
    assert!(told.contains("not written by windfall"), "{line}: {told}");
    let after = files(&folder.join(place));
    for (path, digest) in before {
        assert_eq!(after.get(path), Some(digest), "{line}: {path:?}");
    }
}

/// Folders in which every name that will be written is a file of somebody else, or leads to
/// an input.
#[test]
fn rejects_files_of_others_and_inputs_behind_the_names_in_a_folder() {
    let mut kept = Kept::new();
    let folder = kept.path().to_path_buf();
    for (number, &(_, _, _, line, inputs)) in of_kind(|kind| kind == Kind::Folder).enumerate() {
        let names = written(&folder, line, &format!("fresh{number}"));
        assert!(!names.is_empty(), "{line}");
        let place = format!("mine{number}");
        let before = of_others(&folder, &place, &names);
        refuses_others(&folder, line, &place, &before);
        for target in inputs {
            for kind in ["hard", "symbolic"] {
                let trap = folder.join("trap");
                for name in &names {
                    let link = trap.join(name);
                    std::fs::create_dir_all(link.parent().unwrap()).unwrap();
                    link_to(kind, &folder.join(target), &link);
                }
                let status = kept.keeps(&format!("{line} --force"), "trap");
                // A study makes its folder anew: it removes the links.
                let anew = line.starts_with("scene study");
                assert!(anew || status == Some(2), "{line}: {target} {status:?}");
                std::fs::remove_dir_all(trap).unwrap();
            }
        }
    }
    kept.end();
}

#[test]
fn rejects_what_is_there_as_a_new_folder() {
    let mut kept = Kept::new();
    let folder = kept.path().to_path_buf();
    for &(_, _, _, line, _) in of_kind(|kind| kind == Kind::NewFolder) {
        for target in [
            "campaign",
            "campaign/raw",
            "scene",
            "scene/scene.run",
            "impact.csv",
        ] {
            for place in words(&folder, target) {
                for force in ["", " --force"] {
                    kept.refuses(&format!("{line}{force}"), &place);
                }
            }
        }
    }
    kept.end();
}

/// Files that somebody else made stay, unless `--force` is said. What windfall wrote it
/// replaces.
#[test]
fn rejects_files_that_windfall_did_not_write() {
    let laboratory = laboratory();
    let folder = laboratory.path();
    for (number, &(command, _, kind, line, _)) in of_kind(is_file).enumerate() {
        if command.starts_with("design") {
            continue;
        }
        let file = match kind {
            Kind::Ending(endings) => format!("{{}}/x.{}", endings[0]),
            Kind::Picture => "{}/x.svg".to_owned(),
            _ => "{}/x.toml".to_owned(),
        };
        let line = line.replace("{}", &file);
        let [ours, mine] = ["ours", "mine"].map(|name| format!("{name}{number}"));
        std::fs::create_dir(folder.join(&ours)).unwrap();
        let names = written(folder, &line, &ours);
        assert_eq!(written(folder, &line, &ours), names);
        let before = of_others(folder, &mine, &names);
        refuses_others(folder, &line, &mine, &before);
        assert_eq!(written(folder, &format!("{line} --force"), &mine), names);
        assert_ne!(files(&folder.join(&mine)), before, "{line}");
    }
}

/// A design is only ever written as a new file.
#[test]
fn rejects_a_design_in_the_place_of_any_file() {
    let mut kept = Kept::new();
    let raw = names(&kept.path().join("campaign/raw"));
    let line = "design factorial --factor A=0..1 --factor B=0..1 --out {} --force";
    for target in OTHERS
        .iter()
        .map(|own| (*own).to_owned())
        .chain([raw[0].display().to_string()])
    {
        kept.refuses(line, &target);
    }
    kept.end();
}
