//! What `windfall licences` says, compared with the crates that are built.
//!
//! `WINDFALL_LICENCES=write` replaces `licences/parts.csv` and `licences/texts.txt`.

use crate::counted::windfall;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

const HERE: &str = env!("CARGO_MANIFEST_DIR");
const RULE: &str = "\n================================\n";

/// Programs that are released: package, target, and what a part is called that only they hold.
const RELEASED: [(&str, &str, &str); 4] = [
    ("windfall-cli", "x86_64-unknown-linux-gnu", "Linux"),
    ("windfall-cli", "x86_64-pc-windows-gnu", "Windows"),
    ("windfall-python", "x86_64-unknown-linux-gnu", "Python"),
    ("windfall-python", "x86_64-pc-windows-gnu", "Python"),
];

/// Crates whose packages lack a text: a file with the text, from the top of the repository or
/// from the package of another crate of the same author.
const TEXT_ELSEWHERE: [(&str, &str); 3] = [
    ("flatbuffers", "LICENSE-APACHE"),
    ("maud", "LICENSE-APACHE"),
    ("pulp-wasm-simd-flag", "pulp/LICENSE"),
];

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    name: String,
    version: String,
    licence: String,
    /// What it is: a crate, a package of npm (in the page), or something else.
    kind: &'static str,
}

impl Part {
    fn new(name: &str, version: &str, licence: &str, kind: &'static str) -> Self {
        let own = |text: &str| {
            assert!(!text.contains([',', '"', '\n']), "{text}");
            text.to_owned()
        };
        Self {
            name: own(name),
            version: own(version),
            // How expressions were written before there was OR.
            licence: own(&licence.replace('/', " OR ")),
            kind,
        }
    }
}

/// Where the manifest of each crate lies, by name and version.
type Manifests = BTreeMap<(String, String), PathBuf>;

fn cargo(arguments: &[&str]) -> String {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(arguments)
        .arg("--locked")
        .current_dir(top())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
    String::from_utf8(output.stdout).unwrap()
}

fn top() -> PathBuf {
    Path::new(HERE).join("../..")
}

/// Crates of others that are linked into a program.
fn linked(package: &str, target: &str) -> BTreeSet<Part> {
    let edges = "normal,no-proc-macro";
    let shown = ["--prefix", "none", "--format", "{p}\t{l}"];
    let of = ["tree", "-p", package, "--target", target, "-e", edges];
    let text = cargo(&[&of[..], &shown].concat());
    let mut found = BTreeSet::new();
    for line in text.lines().filter(|own| !own.trim().is_empty()) {
        let (crate_and_version, licence) = line.split_once('\t').unwrap();
        let mut words = crate_and_version.split(' ');
        let name = words.next().unwrap();
        if name == "windfall" || name.starts_with("windfall-") {
            continue;
        }
        let version = words.next().unwrap().strip_prefix('v').unwrap();
        let licence = licence.trim_end_matches(" (*)").trim();
        assert!(!licence.is_empty(), "{name} has no licence");
        found.insert(Part::new(name, version, licence, "crate"));
    }
    assert!(found.len() > 100, "{package} for {target}: {found:?}");
    found
}

/// Crates with the only program that holds them.
fn crates() -> BTreeMap<Part, &'static str> {
    let mut by: BTreeMap<Part, Vec<usize>> = BTreeMap::new();
    for (number, (package, target, _)) in RELEASED.iter().enumerate() {
        for part in linked(package, target) {
            by.entry(part).or_default().push(number);
        }
    }
    let only = |programs: Vec<usize>| match programs[..] {
        [0, 2] => "Linux",
        [1, 3] => "Windows",
        [2, 3] => "Python",
        [0, 1, 2, 3] => "",
        _ => panic!("held by {programs:?} of {RELEASED:?}"),
    };
    by.into_iter()
        .map(|(part, own)| (part, only(own)))
        .collect()
}

fn manifests() -> Manifests {
    let mut found = Manifests::new();
    for target in ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"] {
        let text = cargo(&[
            "metadata",
            "--format-version",
            "1",
            "--filter-platform",
            target,
        ]);
        let all: serde_json::Value = serde_json::from_str(&text).unwrap();
        for own in all["packages"].as_array().unwrap() {
            let word = |key: &str| own[key].as_str().unwrap().to_owned();
            let folder = PathBuf::from(word("manifest_path"));
            let folder = folder.parent().unwrap().to_path_buf();
            found.insert((word("name"), word("version")), folder);
        }
    }
    found
}

fn folder_of(part: &Part, manifests: &Manifests) -> PathBuf {
    manifests[&(part.name.clone(), part.version.clone())].clone()
}

/// Texts of licences at the top of a package, in the order of their names. Where MIT may be
/// chosen, the text of Apache-2.0 is left out.
fn own_texts(folder: &Path, licence: &str) -> Vec<String> {
    let words = [
        "license",
        "licence",
        "copying",
        "copyright",
        "notice",
        "unlicense",
    ];
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|own| own.unwrap().path())
        .filter(|own| {
            let name = own.file_name().unwrap().to_string_lossy().to_lowercase();
            own.is_file() && words.iter().any(|word| name.starts_with(word))
        })
        .collect();
    files.sort();
    let named = |path: &Path, word: &str| {
        let name = path.file_name().unwrap().to_string_lossy().to_lowercase();
        name.contains(word)
    };
    let chosen = licence.split(" OR ").any(|own| own == "MIT");
    if chosen && files.iter().any(|own| named(own, "mit")) {
        files.retain(|own| !named(own, "apache"));
    }
    files.iter().map(|own| read(own)).collect()
}

fn read(path: &Path) -> String {
    let text = std::fs::read(path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    String::from_utf8_lossy(&text).into_owned()
}

fn texts_of(part: &Part, manifests: &Manifests) -> Vec<String> {
    let own = own_texts(&folder_of(part, manifests), &part.licence);
    if !own.is_empty() {
        return own;
    }
    let elsewhere = TEXT_ELSEWHERE.iter().find(|(name, _)| *name == part.name);
    let (_, file) = elsewhere.unwrap_or_else(|| {
        panic!("the package of {part:?} has no text: say in TEXT_ELSEWHERE where it is")
    });
    let text = match file.split_once('/') {
        None => read(&top().join(file)),
        Some((other, file)) => {
            let folder = manifests.iter().find(|((name, _), _)| name == other);
            read(&folder.unwrap().1.join(file))
        }
    };
    vec![text]
}

/// What is no crate: source in C, a font, what the compiler adds, and the parts of the page.
fn others(manifests: &Manifests, crates: &BTreeMap<Part, &'static str>) -> Vec<Other> {
    let crate_of = |name: &str| crates.keys().find(|own| own.name == name).unwrap();
    let sqlite = folder_of(crate_of("libsqlite3-sys"), manifests);
    let header = read(&sqlite.join("sqlite3/sqlite3.h"));
    let version = between(&header, "#define SQLITE_VERSION        \"", "\"");
    let blessing = between(&header, "/*\n", "****")
        .replace("** ", "")
        .replace("**", "");
    let zstd = crate_of("zstd-sys");
    let zstd_version = zstd.version.split_once("+zstd.").unwrap().1;
    let zstd_text = read(&folder_of(zstd, manifests).join("zstd/LICENSE"));
    let ours = |name: &str| read(&top().join(name));
    let font = std::fs::read(top().join("crates/draw/fonts/LiberationSans-Regular.ttf")).unwrap();
    let (rust, run_time) = ("Rust standard library", "run time");
    let (gcc, gcc_licence) = ("libgcc", "GPL-3.0-or-later WITH GCC-exception-3.1");
    let windows = |name: &str| ours(&format!("crates/windfall-cli/licences/{name}"));
    let mut found = vec![
        (
            Part::new("SQLite", version, "blessing", "library in C"),
            "",
            blessing,
        ),
        (
            Part::new("Zstandard", zstd_version, "BSD-3-Clause", "library in C"),
            "",
            zstd_text,
        ),
        (
            Part::new(
                "Liberation Sans",
                &version_of_font(&font),
                "OFL-1.1",
                "font",
            ),
            "",
            ours("crates/draw/fonts/LICENSE-OFL"),
        ),
        (
            Part::new(rust, "", "MIT OR Apache-2.0", run_time),
            "",
            ours("LICENSE-APACHE"),
        ),
        (
            Part::new(gcc, "", gcc_licence, run_time),
            "Windows",
            windows("gcc-exception.txt"),
        ),
        (
            Part::new("mingw-w64 runtime", "", "ZPL-2.1", run_time),
            "Windows",
            windows("mingw-w64.txt"),
        ),
    ];
    let page = ours("crates/windfall-web/assets/licences.md");
    for section in page.split("\n## ").skip(1) {
        let (heading, text) = section.split_once('\n').unwrap();
        let (name, rest) = heading.split_once(" - ").unwrap();
        let (version, licence) = rest.split_once(" (").unwrap();
        let part = Part::new(name, version, licence.trim_end_matches(')'), "npm");
        found.push((part, "", text.to_owned()));
    }
    found
}

/// The version that a font tells, in two bytes for each letter.
fn version_of_font(font: &[u8]) -> String {
    let wide: Vec<u8> = "Version ".bytes().flat_map(|own| [0, own]).collect();
    let place = font.windows(wide.len()).position(|own| own == wide);
    let letters = font[place.unwrap() + wide.len()..].chunks(2);
    let letters = letters.map(|own| char::from(own[1]));
    letters
        .take_while(|own| own.is_ascii_digit() || *own == '.')
        .collect()
}

type Other = (Part, &'static str, String);

fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let start = text.find(before).unwrap() + before.len();
    let length = text[start..].find(after).unwrap();
    &text[start..start + length]
}

/// Both files as they must be.
fn files() -> (String, String) {
    let (crates, manifests) = (crates(), manifests());
    let mut lines = BTreeSet::new();
    // Texts that differ only in their white space are one.
    let mut texts: BTreeMap<String, (String, BTreeSet<String>)> = BTreeMap::new();
    let mut add = |part: &Part, only: &str, own: Vec<String>| {
        let Part {
            name,
            version,
            licence,
            kind,
        } = part;
        lines.insert(format!("{name},{version},{licence},{kind},{only}\n"));
        for text in own {
            let words: Vec<&str> = text.split_whitespace().collect();
            let first = (tidy(&text), BTreeSet::new());
            let entry = texts.entry(words.join(" ")).or_insert(first);
            entry
                .1
                .insert(format!("{name} {version}").trim().to_owned());
        }
    };
    for (part, only) in &crates {
        add(part, only, texts_of(part, &manifests));
    }
    for (part, only, text) in others(&manifests, &crates) {
        add(&part, only, vec![text]);
    }
    // In the order of the first part that a text belongs to.
    let mut sections: Vec<(Vec<String>, String)> = texts
        .into_values()
        .map(|(text, parts)| (parts.into_iter().collect(), text))
        .collect();
    sections.sort();
    let sections = sections
        .into_iter()
        .map(|(parts, text)| format!("{}\n\n{text}", parts.join(", ")));
    let lines: String = lines.into_iter().collect();
    (
        format!("name,version,licence,kind,only\n{lines}"),
        sections.collect::<Vec<_>>().join(RULE),
    )
}

/// Lines without what stands at their ends, and no blank lines around them.
fn tidy(text: &str) -> String {
    let lines = text.replace(['\r', '\u{c}', '\u{feff}'], "");
    let lines: Vec<&str> = lines.lines().map(str::trim_end).collect();
    assert!(!lines.contains(&RULE.trim()), "{text}");
    lines.join("\n").trim_matches('\n').to_owned() + "\n"
}

#[test]
fn reference_parts_and_licences_are_those_of_what_is_built() {
    let (parts, texts) = files();
    for (name, new) in [("parts.csv", parts), ("texts.txt", texts)] {
        let path = Path::new(HERE).join("licences").join(name);
        if std::env::var("WINDFALL_LICENCES").is_ok_and(|own| own == "write") {
            std::fs::write(&path, &new).unwrap();
        }
        let present = std::fs::read_to_string(&path).unwrap_or_default();
        let first = present.lines().zip(new.lines()).find(|(a, b)| a != b);
        assert!(
            present == new,
            "licences/{name} is not of the crates that are built ({first:?}); run this test \
             with WINDFALL_LICENCES=write and read the difference"
        );
    }
}

#[test]
fn reference_every_part_that_is_shown_has_a_text() {
    let folder = tempfile::tempdir().unwrap();
    let (status, said, told) = windfall("licences --texts --format json", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let mut with_text = BTreeSet::new();
    for own in said["texts"].as_array().unwrap() {
        // Some packages also have a file that only names the licences.
        if own["text"].as_str().unwrap().len() < 100 {
            continue;
        }
        with_text.extend(
            own["parts"]
                .as_str()
                .unwrap()
                .split(", ")
                .map(str::to_owned),
        );
    }
    let parts = said["parts"].as_array().unwrap().iter();
    let parts: BTreeSet<String> = parts
        .map(|own| {
            format!(
                "{} {}",
                own["name"].as_str().unwrap(),
                own["version"].as_str().unwrap()
            )
        })
        .map(|own| own.trim().to_owned())
        .collect();
    assert_eq!(with_text, parts);
    let (_, shown, _) = windfall("licences", folder.path());
    assert_eq!(shown.lines().count(), parts.len() + 2);
    let (_, csv, _) = windfall("licences --format csv", folder.path());
    assert_eq!(csv.lines().count(), parts.len() + 1);
}
