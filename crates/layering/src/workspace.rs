//! Reads the workspace that the checks are made on.

use crate::arrow::Dependency;
use crate::error::Error;
use crate::source::{SourceFile, read_source};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The workspace as the checks see it.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// Its folder.
    pub root: PathBuf,
    /// Names of its packages.
    pub packages: Vec<String>,
    /// What its manifests declare.
    pub dependencies: Vec<Dependency>,
    /// Its Rust sources.
    pub sources: Vec<SourceFile>,
    /// Its text files, relative to the folder.
    pub texts: Vec<TextFile>,
}

/// A text file of the workspace.
#[derive(Clone, Debug)]
pub struct TextFile {
    /// Path relative to the workspace.
    pub path: PathBuf,
    /// Content.
    pub text: String,
}

/// A package and the folder of its manifest, relative to the workspace.
struct Package {
    name: String,
    folder: PathBuf,
}

/// Reads manifests, sources and text files of the workspace around `root`.
///
/// # Errors
/// [`Error`] if `cargo` or `git` fails, or a file cannot be read.
pub fn read_workspace(root: &Path) -> Result<Workspace, Error> {
    let metadata = cargo_metadata(root)?;
    let packages = packages(root, &metadata)?;
    let texts = read_texts(root)?;
    let sources = read_sources(&packages, &texts)?;
    Ok(Workspace {
        root: root.to_path_buf(),
        packages: packages.into_iter().map(|package| package.name).collect(),
        dependencies: dependencies(&metadata)?,
        sources,
        texts,
    })
}

fn cargo_metadata(root: &Path) -> Result<Value, Error> {
    // The cargo that runs the test, so that toolchains are not mixed.
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let arguments = [
        "metadata",
        "--format-version",
        "1",
        "--no-deps",
        "--offline",
    ];
    let output = run(root, &cargo, &arguments)?;
    Ok(serde_json::from_str(&output)?)
}

fn run(root: &Path, program: &str, arguments: &[&str]) -> Result<String, Error> {
    let failed = |message: String| Error::Command {
        command: format!("{program} {}", arguments.join(" ")),
        message,
    };
    let output = Command::new(program)
        .args(arguments)
        .current_dir(root)
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        return Err(failed(
            String::from_utf8_lossy(&output.stderr).trim().to_owned(),
        ));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn array<'a>(value: &'a Value, field: &'static str) -> Result<&'a Vec<Value>, Error> {
    value[field].as_array().ok_or(Error::Metadata { field })
}

fn text<'a>(value: &'a Value, field: &'static str) -> Result<&'a str, Error> {
    value[field].as_str().ok_or(Error::Metadata { field })
}

fn packages(root: &Path, metadata: &Value) -> Result<Vec<Package>, Error> {
    let mut packages = Vec::new();
    for package in array(metadata, "packages")? {
        let manifest = Path::new(text(package, "manifest_path")?);
        let folder = manifest.parent().unwrap_or(manifest);
        packages.push(Package {
            name: text(package, "name")?.to_owned(),
            folder: folder.strip_prefix(root).unwrap_or(folder).to_path_buf(),
        });
    }
    Ok(packages)
}

fn dependencies(metadata: &Value) -> Result<Vec<Dependency>, Error> {
    let mut dependencies = Vec::new();
    for package in array(metadata, "packages")? {
        for dependency in array(package, "dependencies")? {
            dependencies.push(Dependency {
                from: text(package, "name")?.to_owned(),
                to: text(dependency, "name")?.to_owned(),
                development: dependency["kind"].as_str() == Some("dev"),
            });
        }
    }
    Ok(dependencies)
}

/// Text files that git tracks or would track; binary files are left out.
fn read_texts(root: &Path) -> Result<Vec<TextFile>, Error> {
    let arguments = [
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ];
    let listing = run(root, "git", &arguments)?;
    let mut texts = Vec::new();
    for name in listing.split('\0').filter(|name| !name.is_empty()) {
        let path = PathBuf::from(name);
        let whole = root.join(&path);
        // A file deleted but not yet committed is still listed.
        if !whole.is_file() {
            continue;
        }
        let bytes = std::fs::read(&whole).map_err(|source| Error::Read {
            path: whole,
            source,
        })?;
        if let Ok(text) = String::from_utf8(bytes) {
            texts.push(TextFile { path, text });
        }
    }
    Ok(texts)
}

fn read_sources(packages: &[Package], texts: &[TextFile]) -> Result<Vec<SourceFile>, Error> {
    let mut sources = Vec::new();
    for file in texts
        .iter()
        .filter(|file| file.path.extension().is_some_and(|e| e == "rs"))
    {
        for package in packages {
            if let Ok(within) = file.path.strip_prefix(&package.folder) {
                sources.push(read_source(&file.path, within, &package.name, &file.text)?);
            }
        }
    }
    Ok(sources)
}
