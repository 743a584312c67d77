//! Manual pages.

use crate::counted::windfall;
use std::collections::BTreeSet;

/// Commands below a command, by what its help lists.
fn listed(words: &str, folder: &std::path::Path, found: &mut BTreeSet<String>) {
    let (status, help, told) = windfall(format!("{words} --help").trim(), folder);
    assert_eq!(status, Some(0), "{told}");
    found.insert(format!("windfall {words}").trim().replace(' ', "-") + ".1");
    // Commands stand in lines of two spaces below headings other than those of options.
    let mut commands = words.is_empty();
    for line in help.lines() {
        if !line.starts_with(' ') {
            commands = line.ends_with(':')
                && !["Options:", "Arguments:", "Examples:"].contains(&line)
                && (words.is_empty() || line == "Commands:");
        }
        let name = line
            .strip_prefix("  ")
            .filter(|own| !own.starts_with([' ', '-']));
        let name = name.and_then(|own| own.split(' ').next());
        if let Some(name) = name.filter(|own| commands && *own != "help") {
            listed(format!("{words} {name}").trim(), folder, found);
        }
    }
}

#[test]
fn reference_every_command_that_the_help_lists_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let (status, said, told) = windfall("man --out pages --format csv", folder.path());
    assert_eq!(status, Some(0), "{told}");
    let written: BTreeSet<String> = said.lines().skip(1).map(name_of).collect();
    let mut commands = BTreeSet::new();
    listed("", folder.path(), &mut commands);
    assert!(commands.contains("windfall-scene-run.1"), "{commands:?}");
    assert_eq!(written, commands);
    let page = std::fs::read_to_string(folder.path().join("pages/windfall-fit.1")).unwrap();
    assert!(page.contains("\\-\\-figures"), "{page}");
    // Examples stand line by line.
    assert!(
        page.contains(".nf\n\\&Examples:\n\\&  windfall fit my\\-campaign\n"),
        "{page}"
    );
}

fn name_of(path: &str) -> String {
    let path = std::path::Path::new(path);
    path.file_name().unwrap().to_str().unwrap().to_owned()
}
