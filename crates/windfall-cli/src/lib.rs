//! The `windfall` command: parses arguments, calls one workflow, displays.
//!
//! Results go to standard output, messages and progress to standard error.
//! Exit status: 0 success, 1 the work failed, 2 the request was wrong.
//!
//! [`main`] is the program. [`call`] runs a command in the process of another program, which
//! hears what the command would have printed:
//!
//! ```
//! use std::ops::ControlFlow;
//! use std::sync::Arc;
//!
//! let words = ["radius", "--diameters", "70 mm,68 mm,72 mm", "--format", "json"];
//! let answer = windfall_cli::call(words, Arc::new(|_, _| ControlFlow::Continue(())));
//! assert_eq!(answer.status, 0);
//! assert!(answer.said.result.contains("mean_radius"));
//! ```

mod args;
mod caller;
mod command;
mod outcome;
mod progress;
mod saying;
mod show;
mod terminal;

pub use crate::caller::{Said, Watch};

use args::common::{Arguments, Command};
use args::groups::grouped;
use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, FromArgMatches};
use saying::{Saying, say};
use std::ffi::OsString;
use std::time::{Duration, Instant};
use windfall_files::allowed::{Allowed, allow};
use windfall_files::inputs::{UsedFiles, guard_inputs};
use windfall_numerics::unit::nearest_name::nearest_names;

/// The program: does what its command line says, and prints.
///
/// * `words`: the command line, beginning with the name of the program
///
/// Help and errors of the command line end the process.
pub fn main(words: impl IntoIterator<Item = impl Into<OsString>>) -> u8 {
    let parsed = parse(words.into_iter().map(Into::into));
    run(parsed.unwrap_or_else(|error| error.exit()))
}

/// What a command that another program called has said, and how it ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// What it would have printed.
    pub said: Said,
    /// Exit status: 0 success, 1 the work failed, 2 the request was wrong.
    pub status: u8,
}

/// Runs a command of windfall in this process; nothing is printed.
///
/// * `words`: what would stand on the command line after `windfall`
/// * `watch`: is told of progress by the commands that show it, and may stop them
///
/// Calls may be made from several threads at once. What one of them allows (`--force`,
/// `--also-read`) holds for it alone: such a call waits for the others, and they for it.
/// Commands that last until they are interrupted are refused.
pub fn call(words: impl IntoIterator<Item = impl Into<OsString>>, watch: Watch) -> Answer {
    let words = words.into_iter().map(Into::into);
    let words = std::iter::once(OsString::from("windfall")).chain(words);
    let (status, said) = caller::called(watch, || match parse(words) {
        Ok(arguments) if arguments.command.is_endless() => {
            show::message("error: this lasts until it is interrupted; run it in a terminal");
            2
        }
        Ok(arguments) => run(arguments),
        Err(error) => show_parser(&error),
    });
    Answer { said, status }
}

/// The commands with their arguments and their help.
pub fn commands() -> clap::Command {
    Arguments::command()
}

fn parse(words: impl IntoIterator<Item = OsString>) -> Result<Arguments, clap::Error> {
    let words: Vec<OsString> = words.into_iter().collect();
    caller::begin(&words);
    let matches = grouped(Arguments::command()).try_get_matches_from(&words);
    Arguments::from_arg_matches(&matches.map_err(|error| with_nearest(error, &words))?)
}

/// An unknown command with those that it may be meant for, also where one letter of three is
/// missing.
fn with_nearest(mut error: clap::Error, words: &[OsString]) -> clap::Error {
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidSubcommand) else {
        return error;
    };
    let arguments = Arguments::command();
    let mut above = &arguments;
    for word in words.iter().skip(1) {
        above = above.find_subcommand(word).unwrap_or(above);
    }
    let names = above.get_subcommands().map(clap::Command::get_name);
    let nearest = nearest_names(unknown, names);
    let nearest: Vec<String> = nearest.into_iter().map(str::to_owned).collect();
    if !nearest.is_empty() {
        let known = ContextValue::Strings(nearest);
        error.insert(ContextKind::SuggestedSubcommand, known);
    }
    error
}

/// Shows help, or what is wrong with a command line.
fn show_parser(error: &clap::Error) -> u8 {
    let text = error.render().to_string();
    if error.use_stderr() {
        show::message(text.trim_end());
        return 2;
    }
    u8::from(show::write_result(&text).is_err())
}

/// Runs a command, and shows what it returns or why it failed; the exit status.
fn run(arguments: Arguments) -> u8 {
    let saying = arguments.saying();
    say(saying);
    let _allowance = allow(Allowed {
        force: arguments.force,
        also_read: arguments.also_read,
    });
    // A server confines what it writes to its workspace.
    let serves = matches!(arguments.command, Command::Serve(_));
    let guarded = (!serves).then(guard_inputs);
    let begun = Instant::now();
    let status = match run_command(arguments.command) {
        Ok(()) => 0,
        Err(error) => {
            show::message(&format!("error: {}", show::with_causes(&error)));
            status_of(&error)
        }
    };
    if let (Saying::Much, Some(guarded)) = (saying, guarded) {
        tell_much(&guarded.files(), begun.elapsed());
    }
    status
}

/// Says what a command has read and written, and how long it took.
fn tell_much(files: &UsedFiles, time: Duration) {
    for path in &files.read {
        show::message(&format!("read: {}", path.display()));
    }
    for path in &files.written {
        show::message(&format!("wrote: {}", path.display()));
    }
    show::message(&format!("took {:.3} s", time.as_secs_f64()));
}

fn run_command(command: Command) -> anyhow::Result<()> {
    match command {
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
        Command::Schema(arguments) => command::schema::run(&arguments),
        Command::Completions { shell } => {
            let mut command = Arguments::command();
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut command, "windfall", &mut text);
            show::write_result(&String::from_utf8_lossy(&text))
        }
        Command::Man(arguments) => command::man::run(&arguments),
        Command::Licences(arguments) => command::licences::run(&arguments),
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
#[path = "../tests/called.rs"]
#[allow(clippy::unwrap_used)]
mod called;

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
