//! Commands that another program calls, one after another and at once.

use crate::{Answer, Watch, call};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

fn on() -> Watch {
    Arc::new(|_, _| ControlFlow::Continue(()))
}

/// Calls with the words of a line; "{}" stands for the folder.
fn line(folder: &Path, text: &str) -> Answer {
    let folder = folder.display().to_string();
    call(
        text.split(' ').map(|word| word.replace("{}", &folder)),
        on(),
    )
}

const TABLE: &str = "x,y\n1,2.1\n2,3.9\n3,6.2\n4,7.8\n5,10.1\n";
const EXPORT: &str = "inspect {}/table.csv --export {}/export.csv";
const FORCED: &str = "inspect {}/table.csv --export {}/export.csv --force";

/// One test at a time: what a call reads, others may not replace while it runs.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn folder_with_table() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("table.csv"), TABLE).unwrap();
    folder
}

#[test]
fn repeats_what_is_said_on_every_thread() {
    let _alone = alone();
    let folder = folder_with_table();
    let good = "regress {}/table.csv --formula y~x --format json";
    let alone = line(folder.path(), good);
    assert_eq!((alone.status, alone.said.messages.as_str()), (0, ""));
    let value: serde_json::Value = serde_json::from_str(&alone.said.result).unwrap();
    assert_eq!(value["terms"][1]["term"], "x");
    let bad = line(folder.path(), "regress {}/table.csv --formula y~z");
    assert!(bad.status == 2 && bad.said.messages.starts_with("error: "));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..8 {
                    assert_eq!(line(folder.path(), good), alone);
                    let found = line(folder.path(), "regress {}/table.csv --formula y~z");
                    assert_eq!(found, bad);
                }
            });
        }
    });
}

#[test]
fn rejects_what_the_parser_refuses_and_what_has_no_end() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let unknown = line(folder.path(), "regress --no-such");
    assert!(unknown.status == 2 && unknown.said.messages.contains("--no-such"));
    assert_eq!(unknown.said.result, "");
    for endless in ["serve {}", "fit {} --watch"] {
        let refused = line(folder.path(), endless);
        assert_eq!(refused.status, 2);
        assert!(refused.said.messages.contains("until it is interrupted"));
    }
    let help = line(folder.path(), "regress --help");
    assert!(help.status == 0 && help.said.result.contains("--formula"));
    assert_eq!(help.said.messages, "");
}

#[test]
fn rejects_files_of_others_in_every_call_that_does_not_say_force() {
    let _alone = alone();
    let folder = folder_with_table();
    let export = folder.path().join("export.csv");
    for _ in 0..2 {
        std::fs::write(&export, "mine").unwrap();
        assert_ne!(line(folder.path(), EXPORT).status, 0);
        assert_eq!(std::fs::read(&export).unwrap(), b"mine");
        assert_eq!(line(folder.path(), FORCED).status, 0);
        assert_ne!(std::fs::read(&export).unwrap(), b"mine");
    }
    // Also while another call may replace them.
    let other = folder_with_table();
    std::fs::write(&export, "mine").unwrap();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for _ in 0..50 {
                std::fs::write(other.path().join("export.csv"), "theirs").unwrap();
                assert_eq!(line(other.path(), FORCED).status, 0);
            }
        });
        for _ in 0..50 {
            assert_ne!(line(folder.path(), EXPORT).status, 0);
        }
    });
    assert_eq!(std::fs::read(&export).unwrap(), b"mine");
}

#[test]
fn rejects_inputs_of_the_same_call_alone() {
    let _alone = alone();
    let folder = folder_with_table();
    let table = folder.path().join("table.csv");
    let own = line(
        folder.path(),
        "inspect {}/table.csv --export {}/table.csv --force",
    );
    assert!(own.said.messages.contains("input"), "{own:?}");
    assert_eq!(std::fs::read(&table).unwrap(), TABLE.as_bytes());
    // An input of an earlier call is a file like any other.
    std::fs::write(folder.path().join("other.csv"), "a,b\n1,2\n2,3\n").unwrap();
    let over = line(
        folder.path(),
        "inspect {}/other.csv --export {}/table.csv --force",
    );
    assert_eq!(over.status, 0, "{over:?}");
    assert_ne!(std::fs::read(&table).unwrap(), TABLE.as_bytes());
}

#[test]
fn rejects_directories_that_another_call_named() {
    let _alone = alone();
    let (folder, laws) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let table = laws.path().join("force.csv");
    std::fs::write(&table, "displacement_m,force_N\n0,0\n0.001,10\n0.002,40\n").unwrap();
    let text = format!("[laws.spring]\ntable = {:?}\n", table.display().to_string());
    std::fs::write(folder.path().join("laws.toml"), text).unwrap();
    let also = laws.path().display();
    for _ in 0..2 {
        let refused = line(folder.path(), "card show --laws {}/laws.toml");
        assert!(refused.said.messages.contains("--also-read"), "{refused:?}");
        let shown = format!("card show --laws {{}}/laws.toml --also-read {also}");
        let shown = line(folder.path(), &shown);
        assert_eq!(shown.status, 0, "{shown:?}");
    }
}

#[test]
fn rejects_to_go_on_when_the_caller_stops_it() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let made = line(folder.path(), "simulate pendulum --example {}/campaign");
    assert_eq!(made.status, 0, "{made:?}");
    let campaign = folder.path().join("campaign");
    let words = ["fit", campaign.to_str().unwrap()];
    let stopped = call(words, Arc::new(|_, _| ControlFlow::Break(())));
    assert_eq!((stopped.status, stopped.said.result.as_str()), (1, ""));
    assert!(!campaign.join("results.sqlite").exists());
    // What was fitted until then is kept.
    let after_twenty = |done, _| match done < 20 {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    let stopped = call(words, Arc::new(after_twenty));
    assert_eq!((stopped.status, stopped.said.result.as_str()), (1, ""));
    let told = Arc::new(Mutex::new(Vec::new()));
    let list = Arc::clone(&told);
    let fitted = call(
        words,
        Arc::new(move |done, all| {
            list.lock().unwrap().push((done, all));
            ControlFlow::Continue(())
        }),
    );
    assert_eq!(fitted.status, 0);
    let messages = &fitted.said.messages;
    let unchanged = messages
        .split(", ")
        .find_map(|part| part.split_once(" unchanged"));
    let unchanged: usize = unchanged.unwrap().0.parse().unwrap();
    assert!((20..30).contains(&unchanged), "{messages}");
    let told = told.lock().unwrap();
    let last = told.iter().max().unwrap();
    assert!(last.0 == last.1 && last.1 > 1, "{told:?}");
}
