//! The rules of the design, applied to the workspace as it is.
//!
//! Each check is shown to fail on bad snippets beside its code.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::LazyLock;
use windfall_layering::arrow::{check_dependencies, is_front_end, is_inner};
use windfall_layering::forbidden::{check_front_end, check_inner, check_writing};
use windfall_layering::module_cycle::{check_folder_cycles, check_module_cycles};
use windfall_layering::source::{Role, SourceFile};
use windfall_layering::tidiness::{
    check_crowding, check_functions, check_included, check_length, check_local, check_unfinished,
};
use windfall_layering::workspace::{Workspace, read_workspace};

/// Read once for all tests.
static WORKSPACE: LazyLock<Workspace> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    read_workspace(&root.canonicalize().unwrap()).unwrap()
});

fn assert_none(violations: &[String]) {
    let (count, list) = (violations.len(), violations.join("\n"));
    assert!(violations.is_empty(), "{count} broken rules:\n{list}");
}

#[test]
fn closed_form_workspace_is_seen_whole() {
    let workspace = &*WORKSPACE;
    for package in ["windfall-numerics", "windfall-contact", "windfall-signal"] {
        assert!(
            workspace.packages.iter().any(|name| name == package),
            "{package}"
        );
        let files = of_package(workspace, package);
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
}

#[test]
fn rejects_crate_arrows_that_the_design_lacks() {
    let workspace = &*WORKSPACE;
    assert_none(&check_dependencies(
        &workspace.packages,
        &workspace.dependencies,
    ));
}

#[test]
fn rejects_modules_that_import_each_other() {
    let workspace = &*WORKSPACE;
    let violations: Vec<String> = workspace
        .packages
        .iter()
        .flat_map(|package| {
            let files = of_package(workspace, package);
            let mut found = check_module_cycles(package, &files);
            found.extend(check_folder_cycles(package, &files));
            found
        })
        .collect();
    assert_none(&violations);
}

#[test]
fn rejects_files_clock_and_output_in_inner_crates() {
    let workspace = &*WORKSPACE;
    let files = |of: fn(&str) -> bool| {
        let sources = workspace.sources.iter();
        sources.filter(move |file| of(&file.package))
    };
    let mut violations: Vec<String> = files(is_inner).flat_map(check_inner).collect();
    violations.extend(files(is_front_end).flat_map(check_front_end));
    assert_none(&violations);
}

#[test]
fn rejects_files_written_outside_of_the_one_way_out() {
    let violations: Vec<String> = WORKSPACE.sources.iter().flat_map(check_writing).collect();
    assert_none(&violations);
}

#[test]
fn rejects_long_files_and_unfinished_code() {
    let workspace = &*WORKSPACE;
    let mut violations: Vec<String> = workspace.sources.iter().filter_map(check_length).collect();
    violations.extend(workspace.sources.iter().flat_map(check_functions));
    violations.extend(check_crowding(&workspace.sources));
    for file in &workspace.texts {
        if file
            .path
            .extension()
            .is_some_and(|extension| extension == "rs")
        {
            violations.extend(check_unfinished(&file.path, &file.text).unwrap());
        }
    }
    assert_none(&violations);
}

#[test]
fn rejects_files_that_a_package_lacks() {
    let workspace = &*WORKSPACE;
    let shipped = workspace.sources.iter().filter(|file| {
        let library = file.role == Role::Shipped;
        library && file.path.starts_with("crates") && file.package != "windfall-layering"
    });
    let mut violations = Vec::new();
    for file in shipped {
        let text = workspace.texts.iter().find(|own| own.path == file.path);
        violations.extend(check_included(&file.path, &text.unwrap().text));
    }
    assert_none(&violations);
}

#[test]
fn rejects_what_holds_on_one_machine_only() {
    let workspace = &*WORKSPACE;
    let check = |file: &windfall_layering::workspace::TextFile| check_local(&file.path, &file.text);
    let violations: Vec<String> = workspace.texts.iter().flat_map(check).collect();
    assert_none(&violations);
}

fn of_package<'a>(workspace: &'a Workspace, package: &str) -> Vec<&'a SourceFile> {
    workspace
        .sources
        .iter()
        .filter(|file| file.package == package)
        .collect()
}
