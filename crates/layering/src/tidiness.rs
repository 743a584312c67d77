//! Length of files and functions, unfinished code, and what holds on one machine only.

use crate::error::Error;
use crate::source::{Role, SourceFile, tokens_of};
use crate::violation::{Place, Violation};
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
#[must_use]
pub fn check_length(file: &SourceFile) -> Option<Violation> {
    (file.role == Role::Shipped && file.lines > LONGEST_FILE).then(|| Violation::LongFile {
        path: file.path.clone(),
        lines: file.lines,
        limit: LONGEST_FILE,
    })
}

/// Functions of a shipped source file that are too long.
pub fn check_functions(file: &SourceFile) -> impl Iterator<Item = Violation> + '_ {
    let functions = file.functions.iter().filter(|_| file.role == Role::Shipped);
    let long = functions.filter(|function| function.lines > LONGEST_FUNCTION);
    long.map(|function| Violation::LongFunction {
        place: Place {
            path: file.path.clone(),
            line: function.line,
        },
        name: function.name.clone(),
        lines: function.lines,
        limit: LONGEST_FUNCTION,
    })
}

/// Folders with too many source files, and crates with too many lines.
#[must_use]
pub fn check_crowding(sources: &[SourceFile]) -> Vec<Violation> {
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
    crowded
        .map(|(folder, files)| Violation::CrowdedFolder {
            path: folder.to_path_buf(),
            files,
            limit: MOST_FILES,
        })
        .chain(large.map(|(package, lines)| Violation::LargeCrate {
            package: package.to_owned(),
            lines,
            limit: LARGEST_CRATE,
        }))
        .collect()
}

/// Tests that are switched off and code that is not written yet, in Rust text.
///
/// # Errors
/// [`Error::Source`] if the text is not made of Rust tokens.
pub fn check_unfinished(path: &Path, text: &str) -> Result<Vec<Violation>, Error> {
    let mut found = Vec::new();
    collect_unfinished(tokens_of(path, text)?, &mut found);
    Ok(found
        .into_iter()
        .map(|(line, found)| Violation::Unfinished {
            place: Place {
                path: path.to_path_buf(),
                line,
            },
            found,
        })
        .collect())
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

fn is_punct(token: Option<&TokenTree>, sign: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == sign)
}

/// Paths of one machine and package hosts of one network, in any text file.
#[must_use]
pub fn check_local(path: &Path, text: &str) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let place = || Place {
            path: path.to_path_buf(),
            line: i + 1,
        };
        if let Some(found) = local_part(path, line) {
            violations.push(Violation::Local {
                place: place(),
                found,
            });
        }
    }
    violations
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

    fn unfinished(text: &str) -> Vec<String> {
        check_unfinished(Path::new("a.rs"), text)
            .unwrap()
            .iter()
            .map(|violation| match violation {
                Violation::Unfinished { place, found } => format!("{}:{found}", place.line),
                other => panic!("{other}"),
            })
            .collect()
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
        assert_eq!(check_crowding(&files(MOST_FILES, "")), []);
        assert!(matches!(
            check_crowding(&files(MOST_FILES + 1, ""))[..],
            [Violation::CrowdedFolder { .. }]
        ));
        let half = "fn f() {}\n".repeat(LARGEST_CRATE / 2);
        assert_eq!(check_crowding(&files(2, &half)), []);
        assert!(matches!(
            check_crowding(&files(3, &half))[..],
            [Violation::LargeCrate { .. }]
        ));
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
