//! Inputs of commands that run at once. What is guarded is guarded in the whole program: this
//! test is one of its own.

#![allow(clippy::unwrap_used)]

use windfall_files::inputs::{check_output, guard_inputs, protect};

#[test]
fn rejects_inputs_of_commands_that_run_and_of_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, "1").unwrap();
        path
    };
    let (early, late) = (file("early"), file("late"));
    protect(&early);
    assert!(check_output(&early).is_ok());

    let first = guard_inputs();
    assert!(check_output(&early).is_ok());
    protect(&early);
    assert!(check_output(&early).is_err());
    let second = guard_inputs();
    protect(&late);
    assert!(check_output(&early).is_err() && check_output(&late).is_err());
    // What was noted before the second began is none of its inputs.
    drop(first);
    assert!(check_output(&early).is_ok() && check_output(&late).is_err());
    // An input noted by the older of two is kept when the newer one ends.
    let third = guard_inputs();
    protect(&early);
    drop(third);
    assert!(check_output(&early).is_err());
    drop(second);
    assert!(check_output(&early).is_ok() && check_output(&late).is_ok());
}
