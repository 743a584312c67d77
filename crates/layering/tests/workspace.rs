//! The rules of the design, applied to the workspace as it is.
//!
//! Each check is shown to fail on bad snippets beside its code.

use std::path::Path;
use windfall_layering::arrow::{FRONT_ENDS, INNER, check_dependencies, check_imports};
use windfall_layering::error::Error;
use windfall_layering::forbidden::{check_front_end, check_inner};
use windfall_layering::module_cycle::{check_folder_cycles, check_module_cycles};
use windfall_layering::source::SourceFile;
use windfall_layering::tidiness::{
    check_crowding, check_functions, check_length, check_local, check_unfinished,
};
use windfall_layering::violation::Violation;
use windfall_layering::workspace::{Workspace, read_workspace};

fn workspace() -> Result<Workspace, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = root
        .canonicalize()
        .map_err(|source| Error::Read { path: root, source })?;
    read_workspace(&root)
}

fn assert_none(violations: &[Violation]) {
    let list: Vec<String> = violations.iter().map(ToString::to_string).collect();
    assert!(
        list.is_empty(),
        "{} broken rules:\n{}",
        list.len(),
        list.join("\n")
    );
}

#[test]
fn closed_form_workspace_is_seen_whole() -> Result<(), Error> {
    let workspace = workspace()?;
    for package in ["windfall-numerics", "windfall-contact", "windfall-signal"] {
        assert!(
            workspace.packages.iter().any(|name| name == package),
            "{package}"
        );
        let files = of_package(&workspace, package);
        assert!(
            files.iter().any(|file| file.module.is_empty()),
            "{package}: no root"
        );
        assert!(
            files.iter().any(|file| !file.module.is_empty()),
            "{package}: no modules"
        );
    }
    let named: usize = workspace.sources.iter().map(|file| file.paths.len()).sum();
    assert!(named > 100, "only {named} paths read");
    assert!(
        workspace
            .dependencies
            .iter()
            .any(|d| d.to == "windfall-numerics")
    );
    assert!(
        workspace
            .texts
            .iter()
            .any(|file| file.path.ends_with("Cargo.lock"))
    );
    Ok(())
}

#[test]
fn rejects_crate_arrows_that_the_design_lacks() -> Result<(), Error> {
    let workspace = workspace()?;
    let mut violations = check_dependencies(&workspace.packages, &workspace.dependencies);
    violations.extend(workspace.sources.iter().flat_map(check_imports));
    assert_none(&violations);
    Ok(())
}

#[test]
fn rejects_modules_that_import_each_other() -> Result<(), Error> {
    let workspace = workspace()?;
    let violations: Vec<Violation> = workspace
        .packages
        .iter()
        .flat_map(|package| {
            let files = of_package(&workspace, package);
            let mut found = check_module_cycles(package, &files);
            found.extend(check_folder_cycles(package, &files));
            found
        })
        .collect();
    assert_none(&violations);
    Ok(())
}

#[test]
fn rejects_files_clock_and_output_in_inner_crates() -> Result<(), Error> {
    let workspace = workspace()?;
    let files = |packages: &[&str]| -> Vec<&SourceFile> {
        let sources = workspace.sources.iter();
        sources
            .filter(|file| packages.contains(&file.package.as_str()))
            .collect()
    };
    let mut violations: Vec<Violation> = files(INNER).into_iter().flat_map(check_inner).collect();
    violations.extend(files(FRONT_ENDS).into_iter().flat_map(check_front_end));
    assert_none(&violations);
    Ok(())
}

#[test]
fn rejects_long_files_and_unfinished_code() -> Result<(), Error> {
    let workspace = workspace()?;
    let mut violations: Vec<Violation> =
        workspace.sources.iter().filter_map(check_length).collect();
    violations.extend(workspace.sources.iter().flat_map(check_functions));
    violations.extend(check_crowding(&workspace.sources));
    for file in &workspace.texts {
        if file
            .path
            .extension()
            .is_some_and(|extension| extension == "rs")
        {
            violations.extend(check_unfinished(&file.path, &file.text)?);
        }
    }
    assert_none(&violations);
    Ok(())
}

#[test]
fn rejects_what_holds_on_one_machine_only() -> Result<(), Error> {
    let workspace = workspace()?;
    let check = |file: &windfall_layering::workspace::TextFile| check_local(&file.path, &file.text);
    let violations: Vec<Violation> = workspace.texts.iter().flat_map(check).collect();
    assert_none(&violations);
    Ok(())
}

fn of_package<'a>(workspace: &'a Workspace, package: &str) -> Vec<&'a SourceFile> {
    workspace
        .sources
        .iter()
        .filter(|file| file.package == package)
        .collect()
}
