//! The `windfall` command: parses arguments, calls one workflow, displays.

fn main() {}
