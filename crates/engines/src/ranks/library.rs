//! Where the library of LAMMPS is, and whether it can be used.

use crate::program::{Program, last_lines, wrong};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;

/// Names of the library; a system that knows one of them opens it by its name.
const NAMES: [&str; 2] = ["liblammps.so.0", "liblammps.so"];

/// The library that belongs to a program: beside it or in the directory lib next to its own, or
/// one that the system knows; the first that can be opened and has its version.
///
/// * `own`: windfall itself, which opens it on trial, as another process
/// * `given`: the library, where it is said
///
/// # Errors
/// Why none can be used, for each that was tried.
pub(crate) fn find_library(
    program: &Program,
    own: &Path,
    given: Option<&Path>,
) -> Result<PathBuf, String> {
    let tried = match given {
        Some(given) => vec![absolute(given)],
        None => candidates(&program.path),
    };
    let mut problems = Vec::new();
    for library in tried {
        match version_of(program, own, &library) {
            Ok(version) if program.date().is_none_or(|date| date == version) => {
                return Ok(library);
            }
            Ok(version) => problems.push(format!(
                "{} is version {version}, {} is {}",
                library.display(),
                program.path.display(),
                program.version
            )),
            Err(problem) => problems.push(format!("{}: {problem}", library.display())),
        }
    }
    Err(problems.join("; "))
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}

fn candidates(program: &Path) -> Vec<PathBuf> {
    let program = std::fs::canonicalize(program).unwrap_or_else(|_| program.to_path_buf());
    let beside = program.parent().map(Path::to_path_buf);
    let above = beside.as_deref().and_then(Path::parent);
    let libraries = above.map(|own| own.join("lib"));
    let folders = beside.iter().chain(&libraries);
    let files = folders.flat_map(|folder| NAMES.map(|name| folder.join(name)));
    let there = files.filter(|own| own.is_file());
    // By name the system looks where programs find it.
    there.chain(NAMES.map(PathBuf::from)).collect()
}

/// The version of a library that can be opened, as year, month and day.
fn version_of(program: &Program, own: &Path, library: &Path) -> Result<u32, String> {
    let own = own.display().to_string();
    let library = library.display().to_string();
    let words = [&own, "scene", "rank", "--try", "--library", &library];
    let output = program
        .started(&words.map(str::to_owned), program.scratch.path())
        .output();
    let output = output.map_err(|error| error.to_string())?;
    let said = String::from_utf8_lossy(&output.stdout);
    let version = said.lines().find_map(|line| line.strip_prefix(VERSION));
    match version.and_then(|own| own.trim().parse().ok()) {
        Some(version) if output.status.success() => Ok(version),
        _ => {
            let problem = String::from_utf8_lossy(&output.stderr);
            Err(last_lines(problem.trim_start_matches("error: ")))
        }
    }
}

/// What stands before the version that is printed on trial.
pub(crate) const VERSION: &str = "LAMMPS library ";

/// The error of a library that was named and cannot be used.
pub(crate) fn unusable(program: &Program, problem: &str) -> Error {
    wrong(
        program.engine,
        format!(
            "its library cannot be used ({problem}): --engine-library names that of {}; without it \
             and with --engine-frames contacts are found outside of the ranks",
            program.path.display()
        ),
    )
}
