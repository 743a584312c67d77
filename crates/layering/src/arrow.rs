//! Which crate may import which.

use crate::source::{Role, SourceFile};
use crate::violation::{Place, Violation};

/// Crates of the workspace and what each may import, innermost first: the
/// arrows of the design. A crate is added here when it gets its first content.
pub const ARROWS: &[(&str, &[&str])] = &[
    ("windfall-numerics", &[]),
    ("windfall-statistics", &["windfall-numerics"]),
    ("windfall-design", &[]),
    ("windfall-contact", &["windfall-numerics"]),
    (
        "windfall-signal",
        &["windfall-statistics", "windfall-numerics"],
    ),
    (
        "windfall-identify",
        &[
            "windfall-contact",
            "windfall-signal",
            "windfall-statistics",
            "windfall-numerics",
        ],
    ),
    (
        "windfall-drop-rig",
        &[
            "windfall-statistics",
            "windfall-identify",
            "windfall-signal",
            "windfall-contact",
            "windfall-numerics",
        ],
    ),
    ("windfall-scene", &["windfall-contact", "windfall-numerics"]),
    ("windfall-formats", &[]),
    (
        "windfall-files",
        &[
            "windfall-statistics",
            "windfall-formats",
            "windfall-numerics",
        ],
    ),
    ("windfall-draw", &["windfall-files"]),
    (
        "windfall-cards",
        &["windfall-files", "windfall-contact", "windfall-numerics"],
    ),
    (
        "windfall-tables",
        &[
            "windfall-design",
            "windfall-draw",
            "windfall-files",
            "windfall-statistics",
        ],
    ),
    (
        "windfall-campaign",
        &[
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-formats",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
            "windfall-statistics",
            "windfall-numerics",
        ],
    ),
    (
        "windfall-inspect",
        &[
            "windfall-campaign",
            "windfall-draw",
            "windfall-files",
            "windfall-formats",
        ],
    ),
    (
        "windfall-simulate",
        &[
            "windfall-drop-rig",
            "windfall-campaign",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
        ],
    ),
    (
        "windfall-population",
        &[
            "windfall-campaign",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-tables",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
        ],
    ),
    (
        "windfall-drop",
        &[
            "windfall-design",
            "windfall-drop-rig",
            "windfall-campaign",
            "windfall-tables",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
            "windfall-statistics",
            "windfall-numerics",
        ],
    ),
    (
        "windfall-scene-run",
        &[
            "windfall-campaign",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-scene",
            "windfall-identify",
            "windfall-contact",
            "windfall-statistics",
            "windfall-numerics",
        ],
    ),
    (
        "windfall-engines",
        &[
            "windfall-scene-run",
            "windfall-files",
            "windfall-scene",
            "windfall-contact",
        ],
    ),
    (
        "windfall-report",
        &[
            "windfall-drop",
            "windfall-campaign",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
        ],
    ),
    (
        "windfall-workspace",
        &[
            "windfall-report",
            "windfall-drop",
            "windfall-scene-run",
            "windfall-campaign",
            "windfall-draw",
            "windfall-files",
            "windfall-formats",
            "windfall-identify",
            "windfall-signal",
        ],
    ),
    (
        "windfall",
        &[
            "windfall-drop-rig",
            "windfall-report",
            "windfall-drop",
            "windfall-population",
            "windfall-simulate",
            "windfall-campaign",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
            "windfall-formats",
            "windfall-identify",
            "windfall-contact",
            "windfall-signal",
        ],
    ),
    (
        "windfall-web",
        &[
            "windfall-draw",
            "windfall-workspace",
            "windfall-report",
            "windfall-drop",
            "windfall-population",
            "windfall-tables",
            "windfall-inspect",
            "windfall-scene-run",
            "windfall-campaign",
            "windfall-cards",
            "windfall-files",
        ],
    ),
    (
        "windfall-cli",
        &[
            "windfall-web",
            "windfall-engines",
            "windfall-scene-run",
            "windfall-report",
            "windfall-drop",
            "windfall-population",
            "windfall-simulate",
            "windfall-inspect",
            "windfall-campaign",
            "windfall-tables",
            "windfall-cards",
            "windfall-draw",
            "windfall-files",
        ],
    ),
    ("windfall-python", &["windfall"]),
    (TEST_DATA, &[]),
    ("windfall-layering", &[]),
];

/// Finds the data of tests: any crate may import it for them, and for nothing else.
const TEST_DATA: &str = "windfall-test-data";

/// Crates that compute: they print nothing, open no file, read no clock and
/// know neither formats nor HTTP nor Python.
pub const INNER: &[&str] = &[
    "windfall-numerics",
    "windfall-statistics",
    "windfall-contact",
    "windfall-signal",
    "windfall-identify",
    "windfall-drop-rig",
    "windfall-design",
    "windfall-scene",
];

/// Crates that face people and programs: they parse, call a workflow, display.
pub const FRONT_ENDS: &[&str] = &["windfall-web", "windfall-cli", "windfall-python"];

/// Dependencies that stand for something an inner crate must not know.
const OUTER_DEPENDENCIES: &[(&str, &str)] = &[
    ("csv", "only the crate windfall knows file formats"),
    ("toml", "only the crate windfall knows file formats"),
    ("serde_json", "only the crate windfall knows file formats"),
    ("rusqlite", "only the crate windfall keeps results"),
    ("clap", "only windfall-cli parses arguments"),
    ("indicatif", "only windfall-cli draws progress bars"),
    (
        "anyhow",
        "libraries have error enums; anyhow is for windfall-cli",
    ),
    ("axum", "only windfall-web knows HTTP"),
    ("tokio", "only windfall-web knows HTTP"),
    ("pyo3", "only windfall-python knows Python"),
    ("numpy", "only windfall-python knows Python"),
];

/// A declared dependency.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dependency {
    /// Importing package.
    pub from: String,
    /// Imported package.
    pub to: String,
    /// For tests, examples and benches only.
    pub development: bool,
}

/// Declared dependencies, and crates without a row in the table.
///
/// Development dependencies between windfall's crates count like others; those
/// on outside crates are free, since tests may read fixtures.
#[must_use]
pub fn check_dependencies(packages: &[String], dependencies: &[Dependency]) -> Vec<Violation> {
    let unknown = packages
        .iter()
        .filter(|package| allowed(package).is_none())
        .map(|package| Violation::UnknownCrate {
            package: package.clone(),
        });
    unknown
        .chain(dependencies.iter().filter_map(check_dependency))
        .collect()
}

fn check_dependency(dependency: &Dependency) -> Option<Violation> {
    let Dependency {
        from,
        to,
        development,
    } = dependency;
    if is_ours(to) {
        let for_tests = *development && to == TEST_DATA;
        let forbidden = !for_tests && !allowed(from).unwrap_or(&[]).contains(&to.as_str());
        return forbidden.then(|| Violation::Dependency {
            from: from.clone(),
            to: to.clone(),
        });
    }
    if *development || !INNER.contains(&from.as_str()) {
        return None;
    }
    let (_, reason) = OUTER_DEPENDENCIES.iter().find(|(name, _)| name == to)?;
    Some(Violation::MisplacedDependency {
        from: from.clone(),
        to: to.clone(),
        reason,
    })
}

/// Crates of the workspace named in a source file.
#[must_use]
pub fn check_imports(file: &SourceFile) -> Vec<Violation> {
    let mut violations = Vec::new();
    for path in &file.paths {
        let to = path.segments[0].replace('_', "-");
        // A crate's tests and examples import the crate itself, and a program
        // the library beside it.
        let forbidden = is_ours(&to)
            && to != file.package
            && !(to == TEST_DATA && file.role == Role::Outside)
            && !allowed(&file.package).unwrap_or(&[]).contains(&to.as_str());
        if forbidden {
            let place = Place {
                path: file.path.clone(),
                line: path.line,
            };
            violations.push(Violation::Import {
                place,
                from: file.package.clone(),
                to,
            });
        }
    }
    violations
}

fn is_ours(name: &str) -> bool {
    allowed(name).is_some()
}

fn allowed(package: &str) -> Option<&'static [&'static str]> {
    ARROWS
        .iter()
        .find(|(name, _)| *name == package)
        .map(|(_, allowed)| *allowed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::read_source;
    use std::path::Path;

    fn arrow(from: &str, to: &str, development: bool) -> Vec<Violation> {
        let dependency = Dependency {
            from: from.to_owned(),
            to: to.to_owned(),
            development,
        };
        check_dependencies(&[], &[dependency])
    }

    #[test]
    fn closed_form_table_has_no_cycle() {
        // Each crate imports only crates above it in the table.
        for (i, (name, allowed)) in ARROWS.iter().enumerate() {
            for to in *allowed {
                let position = ARROWS.iter().position(|(other, _)| other == to);
                assert!(position.is_some_and(|p| p < i), "{name} → {to}");
            }
        }
        assert!(INNER.iter().all(|name| allowed(name).is_some()));
    }

    #[test]
    fn rejects_arrows_that_the_design_lacks() {
        assert_eq!(
            arrow("windfall-numerics", "windfall-contact", false).len(),
            1
        );
        assert_eq!(arrow("windfall-signal", "windfall-contact", true).len(), 1);
        assert_eq!(arrow("windfall-scene", "windfall-signal", false).len(), 1);
        assert_eq!(arrow("windfall-identify", "windfall", false).len(), 1);
        assert_eq!(arrow("windfall-cli", "windfall-identify", false).len(), 1);
        assert_eq!(arrow("windfall-identify", "windfall-contact", false), []);
        assert_eq!(arrow("windfall-cli", "windfall-files", false), []);
    }

    #[test]
    fn rejects_formats_in_inner_crates() {
        assert_eq!(arrow("windfall-signal", "csv", false).len(), 1);
        assert_eq!(arrow("windfall-signal", "serde_json", true), []);
        assert_eq!(arrow("windfall-files", "csv", false), []);
    }

    #[test]
    fn rejects_a_crate_without_a_row() {
        let found = check_dependencies(&["windfall-utils".to_owned()], &[]);
        assert!(matches!(&found[..], [Violation::UnknownCrate { .. }]));
    }

    #[test]
    fn rejects_a_use_line_against_the_arrows() {
        let text = "use windfall_contact::law::Hertz;\nfn f() { windfall_identify::fit::result() }";
        let path = Path::new("crates/contact/src/a.rs");
        let file = read_source(path, Path::new("src/a.rs"), "windfall-contact", text).unwrap();
        let found = check_imports(&file);
        let place = Place {
            path: path.to_path_buf(),
            line: 2,
        };
        let from = "windfall-contact".to_owned();
        let to = "windfall-identify".to_owned();
        assert_eq!(found, [Violation::Import { place, from, to }]);
    }
}
