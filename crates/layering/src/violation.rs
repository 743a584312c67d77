//! A broken rule, and what to do about it.

use std::fmt;
use std::path::PathBuf;

/// Line of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// File, relative to the workspace.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.path.display(), self.line)
    }
}

/// A broken rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Violation {
    /// A crate of the workspace has no row in the table of arrows.
    UnknownCrate {
        /// Package name.
        package: String,
    },
    /// A manifest declares an arrow that the design does not have.
    Dependency {
        /// Importing package.
        from: String,
        /// Imported package.
        to: String,
    },
    /// A source file names a crate that the design does not let it import.
    Import {
        /// Where.
        place: Place,
        /// Importing package.
        from: String,
        /// Imported package.
        to: String,
    },
    /// A dependency that does not belong in this crate.
    MisplacedDependency {
        /// Importing package.
        from: String,
        /// Imported package.
        to: String,
        /// Why it does not belong there.
        reason: &'static str,
    },
    /// Modules of one crate that import each other.
    ModuleCycle {
        /// Package name.
        package: String,
        /// Modules in the order of import; the last imports the first.
        modules: Vec<String>,
    },
    /// An inner crate touches the outside world.
    Forbidden {
        /// Where.
        place: Place,
        /// The path or macro found.
        found: String,
        /// Why it is not allowed and what to do.
        reason: &'static str,
    },
    /// A source file is too long.
    LongFile {
        /// File.
        path: PathBuf,
        /// Lines outside tests.
        lines: usize,
        /// Most lines allowed.
        limit: usize,
    },
    /// A function is too long.
    LongFunction {
        /// Where it begins.
        place: Place,
        /// Its name.
        name: String,
        /// Its lines.
        lines: usize,
        /// Most lines allowed.
        limit: usize,
    },
    /// A folder holds too many source files.
    CrowdedFolder {
        /// Folder.
        path: PathBuf,
        /// Source files in it.
        files: usize,
        /// Most files allowed.
        limit: usize,
    },
    /// A crate is too large.
    LargeCrate {
        /// Package name.
        package: String,
        /// Lines outside tests.
        lines: usize,
        /// Most lines allowed.
        limit: usize,
    },
    /// Unfinished or switched-off code.
    Unfinished {
        /// Where.
        place: Place,
        /// What was found.
        found: &'static str,
    },
    /// A path of one machine, or a package host of one network.
    Local {
        /// Where.
        place: Place,
        /// What was found.
        found: String,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownCrate { package } => write!(
                f,
                "{package} has no row in the table of arrows: add it to arrow.rs and ARCHITECTURE.md"
            ),
            Self::Dependency { from, to } => {
                write!(f, "{from}/Cargo.toml: {from} must not import {to}")
            }
            Self::Import { place, from, to } => {
                write!(f, "{place}: {from} must not import {to}")
            }
            Self::MisplacedDependency { from, to, reason } => {
                write!(f, "{from}/Cargo.toml: {to} does not belong there: {reason}")
            }
            Self::ModuleCycle { package, modules } => write!(
                f,
                "{package}: modules import each other: {} → {}; move what both need to a third",
                modules.join(" → "),
                modules.first().map_or("", String::as_str)
            ),
            Self::Forbidden {
                place,
                found,
                reason,
            } => write!(f, "{place}: {found}: {reason}"),
            Self::LongFile { path, lines, limit } => write!(
                f,
                "{}: {lines} lines outside tests, at most {limit}: split it",
                path.display()
            ),
            Self::LongFunction {
                place,
                name,
                lines,
                limit,
            } => write!(
                f,
                "{place}: `{name}` has {lines} lines, at most {limit}: split it by meaning"
            ),
            Self::CrowdedFolder { path, files, limit } => write!(
                f,
                "{}: {files} source files, at most {limit}: make folders by subject",
                path.display()
            ),
            Self::LargeCrate {
                package,
                lines,
                limit,
            } => write!(
                f,
                "{package}: {lines} lines outside tests, at most {limit}: split it"
            ),
            Self::Unfinished { place, found } => write!(
                f,
                "{place}: {found}: finish it, or gate a slow test by an environment variable"
            ),
            Self::Local { place, found } => {
                write!(f, "{place}: `{found}` holds on one machine only")
            }
        }
    }
}
