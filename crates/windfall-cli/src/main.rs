//! The `windfall` command: parses arguments, calls one workflow, displays.
//!
//! Results go to standard output, messages and progress to standard error.
//! Exit status: 0 success, 1 the work failed, 2 the request was wrong.

mod args;
mod command;
mod show;

use args::common::{Arguments, Command};
use args::groups::grouped;
use clap::{CommandFactory, FromArgMatches};
use std::process::ExitCode;
use windfall_files::confined::also_read;
use windfall_files::inputs::guard_inputs;
use windfall_files::written::replace_files_of_others;

fn main() -> ExitCode {
    let matches = grouped(Arguments::command()).get_matches();
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    // A server confines what it writes to its workspace.
    if !matches!(arguments.command, Command::Serve(_)) {
        guard_inputs();
    }
    if arguments.force {
        replace_files_of_others();
    }
    also_read(arguments.also_read);
    let outcome = match arguments.command {
        Command::New(arguments) => command::new::run(&arguments),
        Command::Add(arguments) => command::add::run(&arguments),
        Command::Inspect(arguments) => command::inspect::run(&arguments),
        Command::Design(arguments) => command::design::run(&arguments),
        Command::Fit(arguments) => command::fit::run(&arguments),
        Command::Laws(arguments) => command::laws::run(&arguments),
        Command::Plan(arguments) => command::plan::run(&arguments),
        Command::Population(arguments) => command::population::run(&arguments),
        Command::Report(arguments) => command::report::run(&arguments),
        Command::Serve(arguments) => command::serve::run(&arguments),
        Command::Calibrate(arguments) => command::calibrate::run(&arguments),
        Command::Scene(command) => command::scene::run(&command),
        Command::Simulate(arguments) => command::simulate::run(&arguments),
        Command::Summary(arguments) => command::compare::run_summary(&arguments),
        Command::Compare(arguments) => command::compare::run_compare(&arguments),
        Command::Regress(arguments) => command::regress::run(&arguments),
        Command::Surface(arguments) => command::surface::run(&arguments),
        Command::Radius(arguments) => command::geometry::run_radius(&arguments),
        Command::Bounces(arguments) => command::bounces::run(&arguments),
        Command::Bruise(arguments) => command::bruise::run(&arguments),
        Command::Explain(arguments) => command::explain::run(&arguments),
        Command::Card(arguments) => command::card::run(&arguments),
        Command::Completions { shell } => {
            let mut command = Arguments::command();
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut command, "windfall", &mut text);
            show::write_result(&String::from_utf8_lossy(&text))
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            show::message(&format!("error: {}", show::with_causes(&error)));
            ExitCode::from(status_of(&error))
        }
    }
}

/// 1 when the work failed, 2 when the request was wrong.
fn status_of(error: &anyhow::Error) -> u8 {
    match error.downcast_ref::<windfall_files::error::Error>() {
        Some(known) if known.is_request() => 2,
        _ => 1,
    }
}

#[cfg(test)]
#[path = "../tests/outputs/options.rs"]
#[allow(dead_code)]
mod options;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::{READ, WRITTEN};
    use clap::ValueHint;
    use std::any::TypeId;
    use std::collections::BTreeSet;
    use std::path::PathBuf;

    /// Arguments of a command, and of those below it, that are paths.
    fn paths(command: &clap::Command, name: &str, found: &mut BTreeSet<(String, String)>) {
        for own in command.get_arguments() {
            let path = own.get_value_parser().type_id() == TypeId::of::<PathBuf>();
            let hints = [ValueHint::FilePath, ValueHint::DirPath, ValueHint::AnyPath];
            if path || hints.contains(&own.get_value_hint()) {
                let long = own.get_long().map(|long| format!("--{long}"));
                let long = long.unwrap_or_else(|| own.get_id().to_string());
                assert!(found.insert((name.to_owned(), long)));
            }
        }
        for own in command.get_subcommands() {
            let name = format!("{name} {}", own.get_name());
            paths(own, name.trim(), found);
        }
    }

    /// An output option that the generated tests of outputs do not know fails here.
    #[test]
    fn reference_every_path_is_known_as_written_or_read() {
        let mut found = BTreeSet::new();
        paths(&Arguments::command(), "", &mut found);
        let written = WRITTEN.iter().map(|own| (own.0, own.1));
        let known = written.chain(READ.iter().copied());
        let known = known.map(|(command, option)| (command.to_owned(), option.to_owned()));
        let known: BTreeSet<_> = known.collect();
        assert_eq!(known.len(), WRITTEN.len() + READ.len());
        let new: Vec<_> = found.difference(&known).collect();
        let gone: Vec<_> = known.difference(&found).collect();
        assert!(
            new.is_empty() && gone.is_empty(),
            "tests/outputs/options.rs lacks {new:?}, and has too many {gone:?}"
        );
    }
}
