//! Length of files and functions, unfinished code, and what holds on one machine only.

use crate::error::Error;
use crate::source::{Function, Role, SourceFile, is_punct, tokens_of};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::path::Path;

/// Most lines of a source file outside tests.
pub const LONGEST_FILE: usize = 500;

/// Most lines of a function outside tests.
pub const LONGEST_FUNCTION: usize = 100;

/// Most source files in one folder.
pub const MOST_FILES: usize = 40;

/// Most lines of a crate outside tests.
pub const LARGEST_CRATE: usize = 15_000;

/// Beginnings of paths that exist on one machine. In two parts, so that this
/// file does not contain them.
const MACHINE_PATHS: &[(&str, &str)] = &[
    ("/ho", "me/"),
    ("/ro", "ot/"),
    ("/wo", "rk/"),
    ("/Us", "ers/"),
    ("/tmp", "/"),
    ("C:\\", "Users"),
];

/// Settings that send a package client to a host of one network.
const FOREIGN_REGISTRIES: &[(&str, &str)] = &[
    ("index-", "url"),
    ("find-", "links"),
    ("replace-", "with"),
    ("sparse+", "http"),
    ("trusted-", "host"),
];

/// The registry that `Cargo.lock` may name.
const PUBLIC_REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// A shipped source file that is too long.
pub fn check_length(file: &SourceFile) -> Option<String> {
    let (path, lines) = (file.path.display(), file.lines);
    (file.role == Role::Shipped && lines > LONGEST_FILE)
        .then(|| format!("{path}: {lines} lines outside tests, at most {LONGEST_FILE}: split it"))
}

/// Functions of a shipped source file that are too long.
pub fn check_functions(file: &SourceFile) -> impl Iterator<Item = String> + '_ {
    let functions = file.functions.iter().filter(|_| file.role == Role::Shipped);
    let long = functions.filter(|function| function.lines > LONGEST_FUNCTION);
    long.map(|Function { name, line, lines }| {
        let place = file.place(*line);
        format!(
            "{place}: `{name}` has {lines} lines, at most {LONGEST_FUNCTION}: split it by meaning"
        )
    })
}

/// Folders with too many source files, and crates with too many lines.
pub fn check_crowding(sources: &[SourceFile]) -> Vec<String> {
    let mut folders: BTreeMap<&Path, usize> = BTreeMap::new();
    let mut crates: BTreeMap<&str, usize> = BTreeMap::new();
    for file in sources.iter().filter(|file| file.role == Role::Shipped) {
        *folders
            .entry(file.path.parent().unwrap_or(&file.path))
            .or_default() += 1;
        *crates.entry(&file.package).or_default() += file.lines;
    }
    let crowded = folders.into_iter().filter(|(_, files)| *files > MOST_FILES);
    let large = crates
        .into_iter()
        .filter(|(_, lines)| *lines > LARGEST_CRATE);
    let folder = |(folder, files): (&Path, usize)| {
        let folder = folder.display();
        format!("{folder}: {files} source files, at most {MOST_FILES}: make folders by subject")
    };
    let package = |(package, lines)| {
        format!("{package}: {lines} lines outside tests, at most {LARGEST_CRATE}: split it")
    };
    crowded.map(folder).chain(large.map(package)).collect()
}

/// Tests that are switched off and code that is not written yet, in Rust text.
///
/// # Errors
/// [`Error::Source`] if the text is not made of Rust tokens.
pub fn check_unfinished(path: &Path, text: &str) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    collect_unfinished(tokens_of(path, text)?, &mut found);
    let message = |(line, found)| {
        let place = format!("{}:{line}", path.display());
        format!("{place}: {found}: finish it, or gate a slow test by an environment variable")
    };
    Ok(found.into_iter().map(message).collect())
}

fn collect_unfinished(tokens: TokenStream, found: &mut Vec<(usize, &'static str)>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    for (i, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(word) if is_punct(tokens.get(i + 1), '!') => {
                let line = word.span().start().line;
                if word == "todo" {
                    found.push((line, "todo!"));
                } else if word == "unimplemented" {
                    found.push((line, "unimplemented!"));
                }
            }
            TokenTree::Group(group) => {
                if i > 0 && is_punct(tokens.get(i - 1), '#') && names_ignore(group.stream()) {
                    found.push((group.span().start().line, "an ignored test"));
                }
                collect_unfinished(group.stream(), found);
            }
            _ => {}
        }
    }
}

/// Files that code includes from outside of its crate, whose package would lack them.
///
/// * `path`: of the code, in `crates/NAME/src`
pub fn check_included(path: &Path, text: &str) -> Vec<String> {
    let depth = path.iter().skip_while(|own| *own != "src").count() - 1;
    let lines = text.lines().zip(1..);
    let outside = lines.filter_map(|(line, number)| {
        let (_, after) = line
            .split_once("include_str!(\"")
            .or_else(|| line.split_once("include_bytes!(\""))?;
        let (file, _) = after.split_once('"')?;
        let place = format!("{}:{number}", path.display());
        (file.matches("../").count() > depth)
            .then(|| format!("{place}: `{file}` is not in the package of the crate"))
    });
    outside.collect()
}

/// Whether an attribute is `ignore` or, as in `cfg_attr(…, ignore)`, sets it.
fn names_ignore(attribute: TokenStream) -> bool {
    let tokens: Vec<TokenTree> = attribute.into_iter().collect();
    match (tokens.first(), tokens.get(1)) {
        (Some(TokenTree::Ident(word)), _) if word == "ignore" => true,
        (Some(TokenTree::Ident(word)), Some(TokenTree::Group(group))) if word == "cfg_attr" => {
            group
                .stream()
                .into_iter()
                .any(|token| matches!(token, TokenTree::Ident(word) if word == "ignore"))
        }
        _ => false,
    }
}

/// Paths of one machine and package hosts of one network, in any text file.
pub fn check_local(path: &Path, text: &str) -> Vec<String> {
    let lines = text.lines().zip(1..);
    let found = lines.filter_map(|(line, number)| {
        let found = local_part(path, line)?;
        let place = format!("{}:{number}", path.display());
        Some(format!("{place}: `{found}` holds on one machine only"))
    });
    found.collect()
}

fn local_part(path: &Path, line: &str) -> Option<String> {
    if path.ends_with("Cargo.lock") {
        let foreign = line.starts_with("source = ") && !line.contains(PUBLIC_REGISTRY);
        return foreign.then(|| line.to_owned());
    }
    let machine = MACHINE_PATHS
        .iter()
        .map(|(a, b)| format!("{a}{b}"))
        .find(|start| begins_a_path(line, start));
    machine.or_else(|| {
        FOREIGN_REGISTRIES
            .iter()
            .map(|(a, b)| format!("{a}{b}"))
            .find(|setting| line.contains(setting))
    })
}

/// Whether `start` occurs where a path begins, not inside a longer one or an
/// address.
fn begins_a_path(line: &str, start: &str) -> bool {
    line.match_indices(start).any(|(at, _)| {
        line[..at]
            .chars()
            .next_back()
            .is_none_or(|before| !(before.is_alphanumeric() || "._-/~}".contains(before)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::read_source;

    /// Line and name of what is found.
    fn unfinished(text: &str) -> Vec<String> {
        let found = check_unfinished(Path::new("a.rs"), text).unwrap();
        let short = |violation: String| {
            let rest = violation.strip_prefix("a.rs:").unwrap().to_owned();
            let end = rest.find(": finish").unwrap();
            rest[..end].replacen(": ", ":", 1)
        };
        found.into_iter().map(short).collect()
    }

    #[test]
    fn rejects_unfinished_code() {
        for (text, expected) in [
            ("#[test]\n#[ignore]\nfn f() {}", "2:an ignored test"),
            ("#[ignore = \"slow\"]\nfn f() {}", "1:an ignored test"),
            ("#[cfg_attr(unix, ignore)]\nfn f() {}", "1:an ignored test"),
            ("mod tests {\n  fn f() { todo!() }\n}", "2:todo!"),
            ("fn f() { unimplemented!(\"later\") }", "1:unimplemented!"),
        ] {
            assert_eq!(unfinished(text), [expected], "{text}");
        }
        for text in [
            "// todo!()\nfn ignore() { ignore() }",
            "#[doc = \"ignore\"]\nfn f() {}",
        ] {
            assert_eq!(unfinished(text), [] as [&str; 0], "{text}");
        }
    }

    #[test]
    fn rejects_files_of_other_crates() {
        let found = |path: &str, file: &str| {
            let text = format!("const A: &str = include_str!(\"{file}\");");
            check_included(Path::new(path), &text).len()
        };
        assert_eq!(found("crates/a/src/lib.rs", "a.md"), 0);
        assert_eq!(found("crates/a/src/lib.rs", "../a.md"), 0);
        assert_eq!(found("crates/a/src/lib.rs", "../../b/a.md"), 1);
        assert_eq!(found("crates/a/src/b/c.rs", "../../a.md"), 0);
        assert_eq!(found("crates/a/src/b/c.rs", "../../../a.md"), 1);
    }

    #[test]
    fn rejects_a_file_that_is_too_long() {
        let read = |text: &str| {
            read_source(Path::new("src/a.rs"), Path::new("src/a.rs"), "a", text).unwrap()
        };
        let long = "fn f() {}\n".repeat(LONGEST_FILE + 1);
        assert!(check_length(&read(&long)).is_some());
        let tests = format!("fn f() {{}}\n#[cfg(test)]\nmod tests {{\n{long}}}\n");
        assert_eq!(read(&tests).lines, 1);
        assert!(check_length(&read(&tests)).is_none());
    }

    #[test]
    fn rejects_a_function_that_is_too_long() {
        let lines = |count: usize| {
            let body = "    g();\n".repeat(count - 2);
            let text = format!("trait T {{ fn a(&self); }}\nimpl T {{\nfn f() {{\n{body}}}\n}}\n");
            let path = Path::new("src/a.rs");
            check_functions(&read_source(path, path, "a", &text).unwrap()).count()
        };
        assert_eq!(lines(LONGEST_FUNCTION), 0);
        assert_eq!(lines(LONGEST_FUNCTION + 1), 1);
    }

    #[test]
    fn rejects_crowded_folders_and_large_crates() {
        let read = |path: String, text: &str| {
            read_source(Path::new(&path), Path::new(&path), "a", text).unwrap()
        };
        let files = |count: usize, text: &str| -> Vec<SourceFile> {
            (0..count)
                .map(|i| read(format!("src/f{i}.rs"), text))
                .collect()
        };
        assert_eq!(check_crowding(&files(MOST_FILES, "")), [] as [&str; 0]);
        let crowded = check_crowding(&files(MOST_FILES + 1, ""));
        assert!(crowded.len() == 1 && crowded[0].contains("41 source files"));
        let half = "fn f() {}\n".repeat(LARGEST_CRATE / 2);
        assert_eq!(check_crowding(&files(2, &half)), [] as [&str; 0]);
        let large = check_crowding(&files(3, &half));
        assert!(large.len() == 1 && large[0].contains("22500 lines"));
    }

    #[test]
    fn rejects_paths_and_hosts_of_one_machine() {
        let local = |name: &str, text: &str| check_local(Path::new(name), text).len();
        for (a, b) in MACHINE_PATHS {
            assert_eq!(local("a.md", &format!("see `{a}{b}me/file`")), 1, "{a}");
            assert_eq!(
                local("a.md", &format!("see https://example.org{a}{b}x")),
                0,
                "{a}"
            );
        }
        for (a, b) in FOREIGN_REGISTRIES {
            assert_eq!(local("a.toml", &format!("{a}{b} = 1")), 1, "{a}");
        }
        let lock = |source: &str| local("Cargo.lock", &format!("source = \"{source}\""));
        assert_eq!(lock(PUBLIC_REGISTRY), 0);
        assert_eq!(lock("registry+https://example.org/index"), 1);
        assert_eq!(lock("git+https://example.org/fork"), 1);
    }
}
