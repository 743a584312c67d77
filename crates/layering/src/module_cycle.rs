//! Modules of one crate that import each other.

use crate::source::{Mention, NamedPath, Role, SourceFile};
use std::collections::{BTreeMap, BTreeSet};

/// A module path inside a crate; empty for the root.
type Module = Vec<String>;

/// Cycles among the modules of one crate, each reported once.
///
/// `files` are the source files of the crate; those outside `src/` are left
/// out. A re-export (`pub use`) is no import of its own: it is followed to
/// where the name comes from. A module that names an item of the crate's root
/// imports the root.
pub fn check_module_cycles(package: &str, files: &[&SourceFile]) -> Vec<String> {
    let shipped: Vec<&SourceFile> = files
        .iter()
        .copied()
        .filter(|file| file.role == Role::Shipped)
        .collect();
    messages(package, &import_graph(&shipped))
}

/// Cycles among the folders of one crate: a folder, or a file that lies in none, counts
/// as one, and what the crate's root declares as nothing.
pub fn check_folder_cycles(package: &str, files: &[&SourceFile]) -> Vec<String> {
    let shipped: Vec<&SourceFile> = files
        .iter()
        .copied()
        .filter(|file| file.role == Role::Shipped && !file.module.is_empty())
        .collect();
    let folder = |module: &Module| module.iter().take(1).cloned().collect::<Module>();
    let mut graph: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for (module, imported) in import_graph(&shipped) {
        let from = folder(&module);
        let to = imported.iter().map(folder).filter(|to| *to != from);
        graph.entry(from.clone()).or_default().extend(to);
    }
    messages(package, &graph)
}

fn messages(package: &str, graph: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<String> {
    let one = |cycle: Vec<&Module>| {
        let first = cycle.first().copied();
        let names: Vec<String> = cycle.into_iter().chain(first).map(name_of).collect();
        format!(
            "{package}: modules import each other: {}; move what both need to a third",
            names.join(" → ")
        )
    };
    cycles(graph).into_iter().map(one).collect()
}

fn name_of(module: &Module) -> String {
    if module.is_empty() {
        "the crate root".to_owned()
    } else {
        module.join("::")
    }
}

/// Which modules each module imports.
fn import_graph(files: &[&SourceFile]) -> BTreeMap<Module, BTreeSet<Module>> {
    let modules: BTreeSet<Module> = files.iter().map(|file| file.module.clone()).collect();
    let exports = export_table(files, &modules);
    let mut graph: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for file in files {
        let imported = graph.entry(file.module.clone()).or_default();
        for path in file
            .paths
            .iter()
            .filter(|path| path.mention != Mention::Exported)
        {
            if let Some(target) = target_of(&file.module, path, &modules) {
                let module = follow(target, &modules, &exports);
                if module != file.module {
                    imported.insert(module);
                }
            }
        }
    }
    graph
}

/// Where re-exported names come from: full path of the name → full path of the
/// item.
fn export_table(files: &[&SourceFile], modules: &BTreeSet<Module>) -> BTreeMap<Module, Module> {
    let mut exports = BTreeMap::new();
    for file in files {
        for path in file
            .paths
            .iter()
            .filter(|path| path.mention == Mention::Exported)
        {
            let target = target_of(&file.module, path, modules);
            if let (Some(target), Some(name)) = (target, path.segments.last()) {
                let mut exported = file.module.clone();
                exported.push(name.clone());
                exports.insert(exported, target);
            }
        }
    }
    exports
}

/// Full path inside the crate that `path` means when named in `module`, or
/// `None` if it leads out of the crate.
fn target_of(module: &Module, path: &NamedPath, modules: &BTreeSet<Module>) -> Option<Module> {
    let mut segments = path.segments.iter().peekable();
    let mut full = module.clone();
    match segments.peek().map(|segment| segment.as_str())? {
        "crate" => {
            segments.next();
            full.clear();
        }
        "self" => {
            segments.next();
        }
        "super" => {
            while segments.next_if(|segment| *segment == "super").is_some() {
                full.pop();
            }
        }
        child => {
            full.push(child.to_owned());
            if !modules.contains(&full) {
                return None;
            }
            segments.next();
        }
    }
    full.extend(segments.cloned());
    let known = path.mention != Mention::Spliced || modules.contains(&full);
    known.then_some(full)
}

/// The module that holds what `target` names, behind any re-exports.
fn follow(
    target: Module,
    modules: &BTreeSet<Module>,
    exports: &BTreeMap<Module, Module>,
) -> Module {
    let mut target = target;
    // Each re-export is followed once, so that a loop of them ends.
    for _ in 0..=exports.len() {
        let holder = longest_module(&target, modules);
        let item = target
            .iter()
            .take(holder.len() + 1)
            .cloned()
            .collect::<Module>();
        match exports.get(&item) {
            Some(origin) => target = origin.clone(),
            None => return holder,
        }
    }
    longest_module(&target, modules)
}

fn longest_module(target: &[String], modules: &BTreeSet<Module>) -> Module {
    (0..=target.len())
        .rev()
        .map(|length| target[..length].to_vec())
        .find(|module| modules.contains(module))
        .unwrap_or_default()
}

/// Cycles of the graph: for each module that can reach itself and is not yet in
/// a reported cycle, the shortest way back.
fn cycles(graph: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<&Module>> {
    let mut found: Vec<Vec<&Module>> = Vec::new();
    for start in graph.keys() {
        if found.iter().all(|cycle| !cycle.contains(&start)) {
            found.extend(shortest_cycle(graph, start));
        }
    }
    found
}

fn shortest_cycle<'a>(
    graph: &'a BTreeMap<Module, BTreeSet<Module>>,
    start: &'a Module,
) -> Option<Vec<&'a Module>> {
    let mut ways: Vec<Vec<&Module>> = vec![vec![start]];
    let mut seen: BTreeSet<&Module> = BTreeSet::new();
    while !ways.is_empty() {
        let mut longer = Vec::new();
        for way in &ways {
            for next in way
                .last()
                .and_then(|last| graph.get(*last))
                .into_iter()
                .flatten()
            {
                if next == start {
                    return Some(way.clone());
                }
                if seen.insert(next) {
                    longer.push(way.iter().copied().chain([next]).collect());
                }
            }
        }
        ways = longer;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::read_source;
    use std::path::Path;

    fn read(files: &[(&str, &str)]) -> Vec<SourceFile> {
        let one = |(path, text): &(&str, &str)| {
            read_source(Path::new(path), Path::new(path), "a", text).unwrap()
        };
        files.iter().map(one).collect()
    }

    fn check(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let files = read(files);
        let found = check_module_cycles("a", &files.iter().collect::<Vec<_>>());
        found.iter().map(|violation| cycle(violation)).collect()
    }

    /// The modules of a cycle, each once.
    fn cycle(violation: &str) -> Vec<String> {
        let cycle = violation.strip_prefix("a: modules import each other: ");
        let cycle = cycle.unwrap().split(';').next().unwrap();
        let mut names: Vec<String> = cycle.split(" → ").map(str::to_owned).collect();
        assert_eq!(names.first(), names.last());
        names.pop();
        names
    }

    #[test]
    fn rejects_folders_that_import_each_other() {
        let files = read(&[
            ("src/lib.rs", "pub mod fit;\npub mod rig;"),
            ("src/fit/mod.rs", "pub mod plan;\npub mod run;"),
            ("src/fit/plan.rs", "use crate::rig::Rig;"),
            ("src/fit/run.rs", "pub fn run() {}"),
            ("src/rig.rs", "use crate::fit::run::run;"),
        ]);
        let all: Vec<&SourceFile> = files.iter().collect();
        assert_eq!(check_module_cycles("a", &all), [] as [&str; 0]);
        let found = check_folder_cycles("a", &all);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(cycle(&found[0]), ["fit", "rig"]);
    }

    #[test]
    fn rejects_two_modules_that_import_each_other() {
        let found = check(&[
            ("src/lib.rs", "pub mod fit;\npub mod rig;"),
            ("src/fit.rs", "use crate::rig::Rig;"),
            ("src/rig.rs", "fn f() { crate::fit::fit() }"),
        ]);
        assert_eq!(found, [["fit", "rig"]]);
    }

    #[test]
    fn rejects_a_cycle_of_three_through_super_and_re_exports() {
        let found = check(&[
            (
                "src/lib.rs",
                "pub mod a; pub mod b; pub mod c; pub use c::Third;",
            ),
            ("src/a.rs", "use super::b::B;"),
            ("src/b.rs", "use crate::{Third, f64};"),
            ("src/c.rs", "use crate::a;"),
        ]);
        assert_eq!(found, [["a", "b", "c"]]);
    }

    #[test]
    fn rejects_a_child_that_imports_its_importing_parent() {
        let found = check(&[
            ("src/lib.rs", "pub mod fit;"),
            ("src/fit.rs", "mod step;\nfn f() { step::go() }"),
            ("src/fit/step.rs", "use super::Fit;"),
        ]);
        assert_eq!(found, [["fit", "fit::step"]]);
    }

    #[test]
    fn rejects_a_root_that_its_own_modules_import() {
        let found = check(&[
            ("src/lib.rs", "pub mod rig;\npub struct Error(rig::Cause);"),
            ("src/rig.rs", "use crate::Error;"),
        ]);
        assert_eq!(found, [["the crate root", "rig"]]);
    }

    #[test]
    fn rejects_a_cycle_through_a_macro_that_splices_module_names() {
        let registry = "macro_rules! registry { ($($m:ident,)*) => { $(pub use crate::$m::Law;)* } }\nregistry! { hertz, tsuji, }";
        let found = check(&[
            ("src/lib.rs", "pub mod hertz; pub mod kind; pub mod tsuji;"),
            ("src/kind.rs", registry),
            ("src/hertz.rs", "use crate::kind::Kind;"),
            ("src/tsuji.rs", "use std::f64::consts::PI;"),
        ]);
        assert_eq!(found, [["hertz", "kind"]]);
    }

    #[test]
    fn closed_form_one_way_imports_pass() {
        let found = check(&[
            (
                "src/lib.rs",
                "pub mod error; pub mod fit; pub mod rig; pub use error::Error;\npub use fit::fit;",
            ),
            ("src/error.rs", "pub enum Error {}"),
            ("src/rig.rs", "use crate::Error; use std::fmt;"),
            (
                "src/fit.rs",
                "use crate::{Error, rig::Rig}; fn f() { rig::Rig::new(); f64::sqrt(1.0); }",
            ),
            ("tests/fit.rs", "use a::fit;"),
        ]);
        assert_eq!(found, [] as [[&str; 0]; 0]);
    }

    #[test]
    fn closed_form_tests_may_import_either_way() {
        let found = check(&[
            ("src/fit.rs", "use crate::rig::Rig;"),
            (
                "src/rig.rs",
                "#[cfg(test)] mod tests { use crate::fit::fit; }",
            ),
        ]);
        assert_eq!(found, [] as [[&str; 0]; 0]);
    }
}
