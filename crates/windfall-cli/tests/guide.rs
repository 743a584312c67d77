//! The guide is true: every command on its pages is run, in order, in an empty
//! folder, and prints and draws what the page shows; every link leads somewhere;
//! every law, key and finding of the source has its place.

#![cfg(unix)]
#![allow(clippy::unwrap_used)]

#[path = "guide/console.rs"]
mod console;
#[path = "guide/page.rs"]
mod page;

use assert_cmd::Command;
use console::{follow, line_matches, lines_match};
use page::{Page, code_spans, links, page, pages, source};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Pages that need no command: an introduction, tables to look things up in, rules, and Python, which
/// has tests of its own (`scripts/test-python`).
const WITHOUT_COMMANDS: [&str; 5] = [
    "introduction.md",
    "engines.md",
    "browser.md",
    "python.md",
    "numbers.md",
];

/// Pages about comparisons and about how windfall is made: their commands need other
/// programs, data or hours, and are not run; that they exist is checked.
fn is_background(name: &str) -> bool {
    name.starts_with("compared/") || name.starts_with("made/")
}

/// Follows the pages that a test is for, and demands that each has a command.
fn follow_all(chosen: impl Fn(&str) -> bool) {
    let pages: Vec<Page> = pages().into_iter().filter(|p| chosen(&p.name)).collect();
    assert!(!pages.is_empty());
    for page in pages {
        let commands = follow(&page);
        let free = WITHOUT_COMMANDS.contains(&page.name.as_str()) || is_background(&page.name);
        assert!(commands > 0 || free, "{} has no command", page.name);
    }
}

fn is_tutorial(name: &str) -> bool {
    name.starts_with("tutorial_")
}

fn is_machine(name: &str) -> bool {
    name.starts_with("machines_")
}

#[test]
fn reference_commands_of_the_pendulum_tutorial() {
    follow_all(|name| name == "tutorial_pendulum.md");
}

#[test]
fn reference_commands_of_the_drop_tutorial() {
    follow_all(|name| name == "tutorial_drop.md");
}

#[test]
fn reference_commands_of_the_apple_tutorial() {
    follow_all(|name| name == "tutorial_apple.md");
}

#[test]
fn reference_commands_of_the_laws() {
    follow_all(|name| name.starts_with("laws/"));
}

#[test]
fn reference_commands_of_the_machines() {
    follow_all(is_machine);
}

#[test]
fn reference_commands_of_all_other_pages() {
    follow_all(|name| !is_tutorial(name) && !is_machine(name) && !name.starts_with("laws/"));
    let tutorials: Vec<Page> = pages()
        .into_iter()
        .filter(|p| is_tutorial(&p.name))
        .collect();
    assert_eq!(tutorials.len(), 3, "each tutorial has its test above");
}

/// What the comparison calls equal, and what not.
#[test]
fn closed_form_left_out_parts_match_and_nothing_else_does() {
    for (shown, printed, equal) in [
        ("k 1.5", "k 1.5", true),
        ("k 1.5", "k 1.6", false),
        ("k 1.5", "k 1.50", false),
        ("k … N", "k 1.5 N", true),
        ("k … N", "k 1.5 J", false),
        ("… a … b", "x a y b", true),
        ("… a … b", "x b y a", false),
        ("a…", "ba", false),
    ] {
        assert_eq!(line_matches(shown, printed), equal, "{shown} {printed}");
    }
    assert!(lines_match(&["a", "…", "c"], &["a", "b", "b", "c"]));
    assert!(lines_match(&["a", "…"], &["a"]));
    assert!(!lines_match(&["a", "c"], &["a", "b", "c"]));
    assert!(!lines_match(&["…", "c"], &["a", "b"]));
    assert!(!lines_match(&["a"], &["a", "b"]));
}

/// Blocks are of known kinds, and a command stands nowhere but in a block that
/// is run.
#[test]
fn rejects_commands_that_nobody_runs() {
    for page in pages() {
        for block in &page.blocks {
            let place = format!("{}, line {}", page.name, block.line);
            let kind = block.kind();
            // "sh" are commands from before windfall is there: building it.
            let kinds = [
                "console", "toml", "csv", "text", "sh", "python", "r", "octave",
            ];
            assert!(kinds.contains(&kind), "{place}: a block of kind {kind:?}");
            if kind == "console" {
                continue;
            }
            for line in &block.lines {
                let line = line.trim_start().trim_start_matches("$ ");
                assert!(!line.starts_with("windfall "), "{place}: not run: {line}");
                let known = line.starts_with("cargo install --path") || line.starts_with("cd ");
                assert!(kind != "sh" || known, "{place}: not run: {line}");
            }
        }
        for (number, line) in &page.prose {
            assert!(
                is_background(&page.name) || !indented(line).starts_with("windfall "),
                "{}, line {number}",
                page.name
            );
        }
    }
}

/// A line of an indented block, without the prompt; empty where it is none.
fn indented(line: &str) -> &str {
    let code = line.strip_prefix("    ").unwrap_or_default();
    code.trim_start_matches("$ ")
}

/// Commands that are named in a sentence, or shown and not run, exist, with the flags
/// that they have.
#[test]
fn rejects_names_of_commands_that_do_not_exist() {
    let mut asked = BTreeSet::new();
    for page in pages() {
        for (number, line) in &page.prose {
            for span in code_spans(line).into_iter().chain([indented(line)]) {
                if let Some(command) = span.strip_prefix("windfall ") {
                    asked.insert((command.to_owned(), format!("{}, line {number}", page.name)));
                }
            }
        }
    }
    assert!(asked.len() > 10);
    for (command, place) in asked {
        let words: Vec<&str> = command.split_whitespace().collect();
        let is_name = |word: &&&str| word.chars().all(|c| c.is_ascii_lowercase());
        let mut names: Vec<&str> = words.iter().take_while(is_name).copied().collect();
        names.truncate(2);
        let mut help = help_of(&names);
        while help.is_none() && names.len() > 1 {
            names.pop();
            help = help_of(&names);
        }
        let help = help.unwrap_or_else(|| panic!("{place}: there is no `windfall {command}`"));
        for flag in words.iter().filter(|word| word.starts_with("--")) {
            assert!(
                help.contains(flag),
                "{place}: `windfall {command}` has no {flag}"
            );
        }
    }
}

fn help_of(names: &[&str]) -> Option<String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_windfall"));
    let output = command.args(names).arg("--help").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    output.status.success().then_some(text)
}

/// Every page is in the summary, and every link within the guide leads to a file
/// and a heading that are there.
#[test]
fn rejects_links_that_lead_nowhere() {
    let pages = pages();
    let listed: BTreeSet<String> = pages.iter().map(|page| page.name.clone()).collect();
    for file in files_below(&source(), "md") {
        let name = file.strip_prefix(source()).unwrap().display().to_string();
        assert!(
            name == "SUMMARY.md" || listed.contains(&name),
            "SUMMARY.md lacks {name}"
        );
    }
    let mut drawn = BTreeSet::new();
    for page in &pages {
        let folder = Path::new(&page.name).parent().unwrap();
        let prose: Vec<&str> = page.prose.iter().map(|(_, line)| line.as_str()).collect();
        for target in links(&prose.join("\n")) {
            if target.starts_with("https://") {
                continue;
            }
            let (file, heading) = target.split_once('#').unwrap_or((target.as_str(), ""));
            let name = match file {
                "" => PathBuf::from(&page.name),
                file => folder.join(file),
            };
            let path = source().join(&name);
            assert!(path.is_file(), "{}: {target} is not there", page.name);
            drawn.insert(path.canonicalize().unwrap());
            if !heading.is_empty() {
                let text = std::fs::read_to_string(&path).unwrap();
                let headings = text.lines().filter(|line| line.starts_with('#'));
                let mut anchors = headings.map(anchor);
                assert!(anchors.any(|a| a == heading), "{}: {target}", page.name);
            }
        }
    }
    for picture in files_below(&source(), "svg") {
        let picture = picture.canonicalize().unwrap();
        assert!(
            drawn.contains(&picture),
            "{}: on no page",
            picture.display()
        );
    }
}

/// The name that the book gives a heading.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = text
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

fn files_below(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => files.extend(files_below(&path, ending)),
            false if path.extension().is_some_and(|e| e == ending) => files.push(path),
            false => {}
        }
    }
    files.sort();
    files
}

/// Every law of the registry has a page with its formula, source and a picture,
/// and a line in the table of engines.
#[test]
fn reference_every_law_has_its_page() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_windfall"));
    let output = command
        .args(["card", "show", "--laws", "--format", "json"])
        .output()
        .unwrap();
    let listed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let laws = listed["laws"].as_array().unwrap();
    assert!(laws.len() >= 12);
    let engines = page("engines.md").text;
    for law in laws {
        let name = law["name"].as_str().unwrap();
        let page = page(&format!("laws/{name}.md"));
        for key in ["formula", "source"] {
            let text = law[key].as_str().unwrap();
            assert!(
                page.text.contains(text),
                "laws/{name}.md lacks the {key} {text}"
            );
        }
        assert!(
            page.text.contains(&format!("]({name}.svg)")),
            "{name}: no picture"
        );
        assert!(
            engines.contains(&format!("](laws/{name}.md)")),
            "engines.md: {name}"
        );
    }
}

/// Sources of the program, without their tests.
fn sources() -> Vec<(String, String)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut sources = Vec::new();
    for entry in std::fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path().join("src");
        for file in files_below(&folder, "rs") {
            let text = std::fs::read_to_string(&file).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap().to_owned();
            sources.push((file.display().to_string(), code));
        }
    }
    sources
}

/// The text in quotes that `text` begins with.
fn quoted(text: &str) -> Option<&str> {
    text.trim_start().strip_prefix('"')?.split('"').next()
}

/// Codes of findings in a source file: those of a `code` function, and those that
/// are handed over as the first text of a call or as a field.
fn codes(source: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for body in source.split("fn code(&self) -> &'static str {").skip(1) {
        let body = body.split("\n    }").next().unwrap();
        let arms = body.split("=>").skip(1);
        found.extend(arms.filter_map(|arm| quoted(arm.trim_start().trim_start_matches('{'))));
    }
    for call in ["finding(", "tell(", "FindingOutcome::new(", "code:"] {
        for given in source.split(call).skip(1) {
            // Some calls have the outcome that the finding goes into first.
            let given = given.trim_start();
            found.extend(quoted(given.strip_prefix("compared,").unwrap_or(given)));
        }
    }
    let is_code = |text: &&str| {
        text.chars()
            .all(|c| c.is_ascii_lowercase() || "-_".contains(c))
    };
    found
        .into_iter()
        .filter(is_code)
        .map(str::to_owned)
        .collect()
}

#[test]
fn reference_every_finding_is_explained() {
    let mut all = BTreeSet::new();
    for (_, source) in sources() {
        all.extend(codes(&source));
    }
    let known = [
        "at-bound",
        "began_in_contact",
        "fruit-differ",
        "influential",
        "no-mass",
    ];
    assert!(known.iter().all(|code| all.contains(*code)) && all.len() > 150);
    let page = page("findings.md");
    let rows: Vec<&str> = page
        .text
        .lines()
        .filter(|line| line.starts_with('|'))
        .collect();
    let explained = |code: &String| {
        rows.iter()
            .any(|row| code_spans(row).contains(&code.as_str()))
    };
    let missing: Vec<&String> = all.iter().filter(|code| !explained(code)).collect();
    assert!(
        missing.is_empty(),
        "findings.md does not explain {missing:?}"
    );
    // What the first column names is there.
    for row in rows {
        let first = row.split('|').nth(1).unwrap();
        for code in code_spans(first) {
            assert!(
                all.contains(code),
                "findings.md explains {code}, which is none"
            );
        }
    }
}

/// Keys of the structs that are read from campaign.toml.
fn keys(source: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut renamed: Option<&str> = None;
    for line in source.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("#[serde(rename = ") {
            renamed = quoted(rest);
        }
        if let Some((name, _)) = line
            .strip_prefix("pub ")
            .and_then(|rest| rest.split_once(": "))
            && line.ends_with(',')
        {
            found.insert(renamed.take().unwrap_or(name).to_owned());
        }
    }
    found
}

#[test]
fn reference_every_key_of_a_campaign_is_explained() {
    let page = page("campaign.md");
    let readers = [
        "campaign/src/settings",
        "measure/src/taps",
        "measure/src/compression",
        "drop/src",
        "cards/src/user_laws",
        "measure/src/repeats",
        "measure/src/relaxation",
    ];
    for reader in readers {
        let file = format!("{reader}/file.rs");
        let (_, source) = sources()
            .into_iter()
            .find(|(name, _)| name.ends_with(&file))
            .unwrap();
        let keys = keys(&source);
        assert!(keys.len() >= 8, "{file}: {keys:?}");
        for key in keys {
            let places = [format!("`{key}`"), format!("[{key}]"), format!("[{key}.")];
            assert!(
                places.iter().any(|place| page.text.contains(place)),
                "campaign.md does not explain {key} of {file}"
            );
        }
    }
}
