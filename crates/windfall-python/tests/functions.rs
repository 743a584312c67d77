//! Functions of the package, one for each command, from the definitions of the command line.
//!
//! `python/windfall/_commands.py` is compared with what they say now; `WINDFALL_PYTHON=write`
//! replaces it.

#![allow(clippy::unwrap_used)]

mod python_text;

use clap::{Arg, ArgAction, Command, ValueHint};
use python_text::{docstring, literal, name, quoted};
use std::any::TypeId;
use std::fmt::Write;
use std::path::PathBuf;

const FILE: &str = "python/windfall/_commands.py";

/// Commands without a function, and why.
const NO_FUNCTION: &[(&str, &str)] = &[
    ("serve", "it lasts until it is interrupted"),
    ("scene rank", "LAMMPS starts it"),
    ("completions", "it is for shells"),
    ("man", "it is for shells"),
];

/// Functions whose name is not that of their command: `fit` takes arrays.
const OTHER_NAMES: &[(&str, &str)] = &[("fit", "fit_campaign")];

/// Arguments that no function takes: every function asks for JSON, and comes to an end.
const NO_ARGUMENT: &[&str] = &[
    "format",
    "watch",
    "help",
    "version",
    "force",
    "also_read",
    "quiet",
    "verbose",
];

/// Arguments that name a table: a data frame will do.
const TABLES: &[(&str, &str)] = &[
    ("", "table"),
    ("", "tables"),
    ("plan", "from"),
    ("regress", "predict"),
    ("design", "candidates"),
    ("design", "augment"),
];

const HEAD: &str = "\
# Written by tests/functions.rs from the definitions of the command line; do not edit.
\"\"\"One function for each command of windfall.\"\"\"

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from windfall._call import Path, Table, Value, call
from windfall._result import Result
";

#[test]
fn reference_functions_are_those_of_the_command_line() {
    let mut all = windfall_cli::commands();
    all.build();
    let mut found = Vec::new();
    collect(&all, "", &mut found);
    let functions: Vec<String> = found
        .iter()
        .map(|(name, own)| function(name, own))
        .collect();
    let mut names: Vec<String> = found.iter().map(|(name, _)| function_name(name)).collect();
    names.sort();
    let mut text = format!("{HEAD}\n__all__ = [\n");
    for name in names {
        writeln!(text, "    \"{name}\",").unwrap();
    }
    text += "]\n";
    for function in functions {
        text += "\n\n";
        text += &function;
    }
    if std::env::var("WINDFALL_PYTHON").is_ok_and(|own| own == "write") {
        std::fs::write(FILE, &text).unwrap();
    }
    let present = std::fs::read_to_string(FILE).unwrap_or_default();
    let both = present.lines().zip(text.lines());
    let first = both.clone().find(|(present, new)| present != new);
    assert!(
        present == text,
        "{FILE} is not what the command line says ({first:?}); run this test with \
         WINDFALL_PYTHON=write and read the difference"
    );
}

/// Commands that do something, with their full names.
fn collect<'a>(command: &'a Command, above: &str, found: &mut Vec<(String, &'a Command)>) {
    for own in command.get_subcommands() {
        let name = format!("{above} {}", own.get_name()).trim().to_owned();
        if own.get_name() == "help" || NO_FUNCTION.iter().any(|(left, _)| *left == name) {
            continue;
        }
        match own.has_subcommands() {
            true => collect(own, &name, found),
            false => found.push((name, own)),
        }
    }
}

fn function_name(command: &str) -> String {
    let other = OTHER_NAMES.iter().find(|(own, _)| *own == command);
    other.map_or_else(|| name(command), |(_, other)| (*other).to_owned())
}

fn function(command: &str, own: &Command) -> String {
    let taken = |argument: &&Arg| {
        let id = argument.get_id().as_str();
        !argument.is_hide_set() && !NO_ARGUMENT.contains(&id)
    };
    let (places, options): (Vec<&Arg>, Vec<&Arg>) = own
        .get_arguments()
        .filter(taken)
        .partition(|argument| argument.is_positional());
    let mut text = format!("def {}(\n", function_name(command));
    for argument in &places {
        writeln!(text, "    {},", parameter(command, argument)).unwrap();
    }
    text += "    *,\n";
    for argument in &options {
        writeln!(text, "    {},", parameter(command, argument)).unwrap();
    }
    text += "    force: bool = False,\n    also_read: Path | Sequence[Path] = (),\n";
    text += "    progress: bool = False,\n) -> Result:\n";
    text += &docstring(&described(command, own, places.iter().chain(&options)));
    let json = own.get_arguments().any(|own| own.get_id() == "format");
    let places: Vec<String> = places.iter().map(|own| python_name(own)).collect();
    writeln!(text, "    return call(\n        {},", quoted(command)).unwrap();
    writeln!(text, "        [{}],", places.join(", ")).unwrap();
    text += "        {\n";
    for own in &options {
        let option = format!("--{}", own.get_long().unwrap());
        writeln!(
            text,
            "            {}: {},",
            quoted(&option),
            python_name(own)
        )
        .unwrap();
    }
    text += "        },\n";
    let json = if json { "True" } else { "False" };
    writeln!(text, "        json={json},\n        force=force,").unwrap();
    text += "        also_read=also_read,\n        progress=progress,\n    )\n";
    text
}

fn python_name(argument: &Arg) -> String {
    name(argument.get_long().unwrap_or(argument.get_id().as_str()))
}

fn parameter(command: &str, argument: &Arg) -> String {
    let name = python_name(argument);
    let one = one_value(command, argument);
    if argument.get_action().takes_values() {
        let kind = match (is_optional(argument), is_several(argument)) {
            (true, _) => format!("{one} | bool"),
            (false, true) => format!("{one} | Sequence[{one}]"),
            (false, false) => one,
        };
        return match argument.is_required_set() {
            true => format!("{name}: {kind}"),
            false => format!("{name}: {kind} | None = None"),
        };
    }
    assert!(
        matches!(argument.get_action(), ArgAction::SetTrue),
        "{name}"
    );
    format!("{name}: bool = False")
}

/// Whether an option may stand without its value.
fn is_optional(argument: &Arg) -> bool {
    argument
        .get_num_args()
        .is_some_and(|own| own.min_values() == 0 && own.max_values() == 1)
}

fn is_several(argument: &Arg) -> bool {
    let many = argument
        .get_num_args()
        .is_some_and(|own| own.max_values() > 1);
    let repeated = matches!(argument.get_action(), ArgAction::Append);
    many || repeated || argument.get_value_delimiter().is_some()
}

fn one_value(command: &str, argument: &Arg) -> String {
    let values = argument.get_possible_values();
    if !values.is_empty() && argument.get_action().takes_values() {
        return literal(values.iter().map(|own| own.get_name()));
    }
    let kind = argument.get_value_parser().type_id();
    let hints = [ValueHint::FilePath, ValueHint::DirPath, ValueHint::AnyPath];
    if kind == TypeId::of::<PathBuf>() || hints.contains(&argument.get_value_hint()) {
        let id = python_name(argument);
        let id = id.trim_end_matches('_');
        let table = |(of, name): &(&str, &str)| command.starts_with(of) && *name == id;
        return if TABLES.iter().any(table) {
            "Table"
        } else {
            "Path"
        }
        .to_owned();
    }
    let whole = [
        TypeId::of::<usize>(),
        TypeId::of::<u64>(),
        TypeId::of::<u32>(),
    ];
    match () {
        () if kind == TypeId::of::<f64>() => "float",
        () if whole.iter().any(|own| kind == *own) => "int",
        () => "Value",
    }
    .to_owned()
}

/// What the function does, and what its parameters mean, in the words of the command's help.
fn described<'a>(
    command: &str,
    own: &Command,
    arguments: impl Iterator<Item = &'a &'a Arg>,
) -> Vec<String> {
    let about = own.get_about().map(ToString::to_string).unwrap_or_default();
    let mut paragraphs = vec![format!("{about}.")];
    paragraphs.push(format!("The command `windfall {command}`."));
    for argument in arguments {
        let help = argument
            .get_help()
            .map(ToString::to_string)
            .unwrap_or_default();
        let values = argument.get_default_values().iter();
        let values: Vec<String> = values
            .map(|own| own.to_string_lossy().into_owned())
            .collect();
        let default = match values.is_empty() || !argument.get_action().takes_values() {
            true => String::new(),
            false => format!(" [default: {}]", values.join(", ")),
        };
        paragraphs.push(format!("* `{}`: {help}{default}", python_name(argument)));
    }
    paragraphs
}
