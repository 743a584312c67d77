//! What inner crates may not touch: files, clock, environment, network, output;
//! and the files that front ends leave to the crate windfall.

use crate::source::{Mention, NamedPath, Role, SourceFile};

/// Parts of the standard library that reach outside, and why they are not for
/// inner crates.
const PATHS: &[(&str, &str)] = &[
    (
        "std::fs",
        "only the crate windfall opens files: take the content as an argument",
    ),
    (
        "std::env",
        "results must not depend on the environment: take an option",
    ),
    ("std::net", "only windfall-web knows the network"),
    (
        "std::process",
        "inner crates start and end no process: return an error",
    ),
    (
        "std::time::SystemTime",
        "inner crates read no clock: take the time as an argument",
    ),
    (
        "std::time::Instant",
        "inner crates read no clock: measure in a bench or an example",
    ),
    (
        "std::io::stdin",
        "inner crates read no input: take it as an argument",
    ),
    (
        "std::io::stdout",
        "inner crates print nothing: return a value or a finding",
    ),
    (
        "std::io::stderr",
        "inner crates print nothing: return a value or a finding",
    ),
];

/// What front ends leave to the crate windfall.
const FRONT_END_PATHS: &[(&str, &str)] = &[(
    "std::fs",
    "only the crate windfall opens files: call one of its workflows",
)];

/// Ends of paths that make, replace, rename or remove a file.
const WRITERS: &[[&str; 2]] = &[
    ["fs", "write"],
    ["fs", "rename"],
    ["fs", "copy"],
    ["fs", "hard_link"],
    ["fs", "remove_file"],
    ["fs", "remove_dir_all"],
    ["File", "create"],
    ["File", "create_new"],
    ["File", "options"],
    ["OpenOptions", "new"],
];

/// Source files that may do so: the writer itself, the cache of what can be calculated again,
/// uploads in pieces, and files that grow while a scene or an engine runs.
const WAY_OUT: &[&str] = &[
    "crates/files/src/cache.rs",
    "crates/files/src/write_file.rs",
    "crates/files/src/scratch.rs",
    "crates/files/src/written.rs",
    "crates/files/src/confined.rs",
    "crates/scene-run/src/run/growing.rs",
    "crates/scene-run/src/run/checkpoint.rs",
    "crates/scene-run/src/run/frames.rs",
    "crates/scene-run/src/run/tables.rs",
    "crates/scene-run/src/study/run.rs",
    "crates/engines/src/motion.rs",
    "crates/engines/src/running.rs",
    "crates/engines/src/ranks/part.rs",
];

/// Ends of paths that write CSV.
const CSV_WRITERS: &[[&str; 2]] = &[["csv", "Writer"], ["csv", "WriterBuilder"]];

/// The one source file that does: there cells are quoted, also those that a spreadsheet
/// would run.
const CSV_WAY_OUT: &str = "crates/files/src/table/write.rs";

/// Macros that print.
const MACROS: &[&str] = &["print", "println", "eprint", "eprintln", "dbg"];

/// Uses of the outside world in the shipped code of an inner crate.
pub fn check_inner(file: &SourceFile) -> Vec<String> {
    let mut violations = reaching(file, PATHS);
    let printing = file
        .macros
        .iter()
        .filter(|call| file.role == Role::Shipped && MACROS.contains(&call.name.as_str()));
    violations.extend(printing.map(|call| {
        let reason = "inner crates print nothing: return a value or a finding";
        format!("{}: {}!: {reason}", file.place(call.line), call.name)
    }));
    violations
}

/// Files opened in the shipped code of a front end.
pub fn check_front_end(file: &SourceFile) -> Vec<String> {
    reaching(file, FRONT_END_PATHS)
}

/// Code that creates or replaces files without the writer that protects inputs, and code that
/// writes CSV without the writer that quotes formulas.
pub fn check_writing(file: &SourceFile) -> Vec<String> {
    let reason = "use windfall_files::write_file, which never replaces an input";
    let mut found = writing(file, WRITERS, WAY_OUT, reason);
    let reason = "use windfall_files::table::write, which quotes formulas";
    found.extend(writing(file, CSV_WRITERS, &[CSV_WAY_OUT], reason));
    found
}

/// Uses of paths with these ends, outside of the files that may use them.
fn writing(file: &SourceFile, ends: &[[&str; 2]], ways_out: &[&str], reason: &str) -> Vec<String> {
    let free = ways_out
        .iter()
        .any(|own| file.path == std::path::Path::new(own));
    let shipped = file.role == Role::Shipped && !free && file.package != "windfall-test-data";
    let paths = file.paths.iter().filter(|_| shipped);
    let writes = paths.filter(|path| {
        // `csv::Writer::from_writer` has its end within.
        let segments: Vec<&str> = path.segments.iter().map(String::as_str).collect();
        let within = |end: &[&str; 2]| segments.windows(2).any(|pair| pair == end);
        // Behind another name, or none, its end could not be seen.
        let hides = |[module, _]: &[&str; 2]| match segments[..] {
            [.., last] if path.renamed => last == *module,
            [.., last, "*"] => last == *module,
            _ => false,
        };
        ends.iter().any(|end| within(end) || hides(end))
    });
    let message = |path: &NamedPath| {
        let found = path.segments.join("::");
        format!("{}: {found}: {reason}", file.place(path.line))
    };
    writes.map(message).collect()
}

fn reaching(file: &SourceFile, forbidden: &[(&str, &'static str)]) -> Vec<String> {
    let shipped = file.paths.iter().filter(|_| file.role == Role::Shipped);
    shipped
        .filter_map(|path| {
            let (_, reason) = forbidden.iter().find(|(part, _)| reaches(path, part))?;
            let found = path.segments.join("::");
            Some(format!("{}: {found}: {reason}", file.place(path.line)))
        })
        .collect()
}

/// Whether the path is inside `forbidden`, or imports a module or a glob that
/// would let it be named without saying so (`use std::time;`).
fn reaches(path: &NamedPath, forbidden: &str) -> bool {
    let forbidden: Vec<&str> = forbidden.split("::").collect();
    let named: Vec<&str> = path.segments.iter().map(String::as_str).collect();
    if named.starts_with(&forbidden) {
        return true;
    }
    let opened = match named.split_last() {
        Some((&"*", module)) => module,
        _ if path.mention != Mention::Inline => &named[..],
        _ => return false,
    };
    !opened.is_empty() && opened.len() < forbidden.len() && forbidden.starts_with(opened)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::read_source;
    use std::path::Path;

    /// Line and name of what is found.
    fn found_in(within: &str, text: &str) -> Vec<String> {
        let path = Path::new(within);
        let file = read_source(path, path, "windfall-signal", text);
        let found = check_inner(&file.unwrap()).into_iter().map(|violation| {
            let rest = violation.strip_prefix(&format!("{within}:")).unwrap();
            let (line, what) = rest.split_once(": ").unwrap();
            format!("{line}:{}", what.split_once(": ").unwrap().0)
        });
        found.collect()
    }

    fn found(text: &str) -> Vec<String> {
        found_in("src/a.rs", text)
    }

    #[test]
    fn rejects_files_clock_environment_and_output() {
        for (text, expected) in [
            (
                "fn f() { let _ = std::fs::read(\"a\"); }",
                "1:std::fs::read",
            ),
            ("use std::{f64, fs};", "1:std::fs"),
            ("use ::std::fs::File;", "1:std::fs::File"),
            ("use std::env;", "1:std::env"),
            (
                "\nuse std::time::{Duration, Instant};",
                "2:std::time::Instant",
            ),
            (
                "use std::time::SystemTime as Clock;",
                "1:std::time::SystemTime",
            ),
            ("use std::time;", "1:std::time"),
            ("use std::io::*;", "1:std::io::*"),
            ("fn f() { println!(\"a\") }", "1:println!"),
            ("fn f() { g(|| dbg!(1)) }", "1:dbg!"),
            (
                "fn f() { assert!(std::env::args().count() > 0) }",
                "1:std::env::args",
            ),
        ] {
            assert_eq!(found(text), [expected], "{text}");
        }
    }

    #[test]
    fn rejects_files_in_front_ends_but_not_output() {
        let text = "use std::fs; fn f() { println!(\"a\"); std::env::args(); }";
        let file = read_source(
            Path::new("src/a.rs"),
            Path::new("src/a.rs"),
            "windfall-cli",
            text,
        );
        let found = check_front_end(&file.unwrap());
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains(": std::fs: "), "{found:?}");
    }

    #[test]
    fn rejects_files_written_outside_of_the_one_way_out() {
        let found = |path: &str, text: &str| {
            let path = Path::new(path);
            check_writing(&read_source(path, Path::new("src/a.rs"), "a", text).unwrap()).len()
        };
        for text in [
            "fn f() { std::fs::write(p, t); }",
            "fn f() { File::create(p); }",
            "use std::fs::{rename, write};",
            "fn f() { std::fs::OpenOptions::new(); }",
            "use std::fs as disk; fn f() { disk::write(p, t); }",
            "use std::{fs::{File as F}, io}; fn f() { F::create(p); }",
            "use std::fs::*; fn f() { write(p, t); }",
        ] {
            assert!(found("crates/a/src/a.rs", text) > 0, "{text}");
            assert_eq!(found(WAY_OUT[0], text), 0, "{text}");
        }
        for text in [
            "fn f() { csv::Writer::from_writer(w); }",
            "use csv::{Reader, WriterBuilder};",
        ] {
            assert!(found("crates/a/src/a.rs", text) > 0, "{text}");
            assert_eq!(found(CSV_WAY_OUT, text), 0, "{text}");
        }
        let reading = "fn f() { std::fs::read(p); csv::Reader::from_reader(r); }";
        assert_eq!(found("crates/a/src/a.rs", reading), 0);
    }

    #[test]
    fn closed_form_harmless_code_passes() {
        for text in [
            "use std::time::Duration;",
            "use std::f64::consts::PI;",
            "use std::io::Read;",
            "fn f() -> String { format!(\"{}\", 1) }",
            "/// println!(\"{}\", std::env::args())\nfn f() {}",
            "#[cfg(test)] mod tests { use std::fs; fn f() { println!(\"\") } }",
            "use crate::time;",
        ] {
            assert_eq!(found(text), [] as [&str; 0], "{text}");
        }
    }

    #[test]
    fn closed_form_tests_and_examples_may_open_files() {
        for within in [
            "tests/a.rs",
            "examples/a.rs",
            "benches/a.rs",
            "src/a/tests.rs",
        ] {
            assert_eq!(
                found_in(within, "use std::fs;"),
                [] as [&str; 0],
                "{within}"
            );
        }
    }
}
