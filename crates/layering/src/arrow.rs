//! Which crate may import which.

/// Crates of the workspace, without the `windfall-` of their names, and what each
/// may import, innermost first: the arrows of the design.
const ARROWS: &[(&str, &str)] = &[
    ("numerics", ""),
    ("distribution", "numerics"),
    ("mixed", "distribution numerics"),
    ("statistics", "mixed distribution numerics"),
    ("design", ""),
    ("contact", "numerics"),
    ("signal", "distribution numerics"),
    ("repeat", "signal distribution numerics"),
    ("compression", "contact signal distribution numerics"),
    ("identify", "contact signal distribution numerics"),
    ("drop-rig", "distribution identify signal contact numerics"),
    ("scene", "contact numerics"),
    ("source", ""),
    ("columnar", ""),
    ("formats", "source"),
    (
        "files",
        "columnar statistics distribution formats source numerics",
    ),
    ("draw", "files"),
    ("cards", "files contact numerics"),
    ("tables", "design draw files statistics mixed distribution"),
    (
        "campaign",
        "cards draw files formats source identify contact signal statistics distribution numerics",
    ),
    (
        "measure",
        "campaign draw files repeat compression contact signal numerics",
    ),
    (
        "inspect",
        "campaign draw files formats numerics distribution",
    ),
    (
        "simulate",
        "drop-rig campaign cards draw files identify contact signal",
    ),
    (
        "population",
        "campaign cards draw files tables identify contact signal",
    ),
    (
        "drop",
        "design drop-rig measure campaign tables cards draw files identify contact signal statistics mixed numerics",
    ),
    (
        "scene-run",
        "campaign cards draw files scene identify contact statistics distribution numerics",
    ),
    (
        "plan",
        "tables cards draw files repeat signal statistics mixed distribution numerics",
    ),
    ("lammps", ""),
    ("engines", "lammps scene-run files scene contact"),
    (
        "report",
        "drop measure campaign cards draw files identify contact signal statistics distribution",
    ),
    (
        "workspace",
        "report drop scene-run inspect measure campaign draw files formats identify signal numerics",
    ),
    (
        "windfall",
        "drop-rig report drop population simulate measure campaign cards draw files formats identify contact signal",
    ),
    (
        "web",
        "draw workspace report drop population tables inspect scene-run measure campaign cards files",
    ),
    (
        "cli",
        "web workspace engines scene-run report drop population plan simulate inspect measure campaign tables cards draw files numerics",
    ),
    ("python", "cli campaign files formats"),
    ("test-data", ""),
    ("layering", ""),
];

/// Finds the data of tests: any crate may import it for them, and for nothing else.
const TEST_DATA: &str = "test-data";

/// Crates that compute: they print nothing, open no file, read no clock and
/// know neither formats nor HTTP nor Python.
const INNER: &str = "numerics distribution mixed statistics contact signal repeat identify compression drop-rig design scene";

/// Crates that face people and programs: they parse, call a workflow, display.
const FRONT_ENDS: &str = "web cli python";

/// Whether the package computes, and knows nothing of the outside world.
pub fn is_inner(package: &str) -> bool {
    holds(INNER, short(package))
}

/// Whether the package faces people and programs.
pub fn is_front_end(package: &str) -> bool {
    holds(FRONT_ENDS, short(package))
}

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

/// Declared dependencies that the table lacks, and crates without a row in it.
///
/// Development dependencies between windfall's crates count like others; those
/// on outside crates are free, since tests may read fixtures. What no manifest
/// declares, the compiler lets no file import.
pub fn check_dependencies(packages: &[String], dependencies: &[Dependency]) -> Vec<String> {
    let unknown = packages.iter().filter(|package| allowed(package).is_none());
    unknown
        .map(|package| {
            format!("{package} has no row in the table of arrows: add it to arrow.rs and ARCHITECTURE.md")
        })
        .chain(dependencies.iter().filter_map(check_dependency))
        .collect()
}

fn check_dependency(dependency: &Dependency) -> Option<String> {
    let Dependency {
        from,
        to,
        development,
    } = dependency;
    if allowed(to).is_some() {
        let for_tests = *development && short(to) == TEST_DATA;
        let missing = !for_tests && !holds(allowed(from).unwrap_or(""), short(to));
        return missing.then(|| format!("{from}/Cargo.toml: {from} must not import {to}"));
    }
    if *development || !is_inner(from) {
        return None;
    }
    let (_, reason) = OUTER_DEPENDENCIES.iter().find(|(name, _)| name == to)?;
    Some(format!(
        "{from}/Cargo.toml: {to} does not belong there: {reason}"
    ))
}

fn allowed(package: &str) -> Option<&'static str> {
    // Only packages of windfall have a row; no outside crate may pass for one.
    let ours = package == "windfall" || package.starts_with("windfall-");
    let row = ARROWS
        .iter()
        .find(|(name, _)| ours && *name == short(package));
    row.map(|(_, allowed)| *allowed)
}

fn short(package: &str) -> &str {
    package.strip_prefix("windfall-").unwrap_or(package)
}

fn holds(list: &str, name: &str) -> bool {
    list.split(' ').any(|listed| listed == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrow(from: &str, to: &str, development: bool) -> Vec<String> {
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
            for to in allowed.split_whitespace() {
                let position = ARROWS.iter().position(|(other, _)| *other == to);
                assert!(position.is_some_and(|p| p < i), "{name} → {to}");
            }
        }
        for name in INNER.split(' ') {
            assert!(ARROWS.iter().any(|(row, _)| *row == name), "{name}");
        }
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
        assert_eq!(
            arrow("windfall-identify", "windfall-contact", false),
            [] as [&str; 0]
        );
        assert_eq!(
            arrow("windfall-cli", "windfall-files", false),
            [] as [&str; 0]
        );
    }

    #[test]
    fn rejects_formats_in_inner_crates() {
        assert_eq!(arrow("windfall-signal", "csv", false).len(), 1);
        assert_eq!(
            arrow("windfall-signal", "serde_json", true),
            [] as [&str; 0]
        );
        assert_eq!(arrow("windfall-files", "csv", false), [] as [&str; 0]);
    }

    #[test]
    fn rejects_a_crate_without_a_row() {
        let found = check_dependencies(&["windfall-utils".to_owned()], &[]);
        assert!(found.len() == 1 && found[0].contains("no row"), "{found:?}");
    }
}
