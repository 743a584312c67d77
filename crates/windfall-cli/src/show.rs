//! Where text goes: results to standard output, messages to standard error, both to a program
//! that called.

use crate::args::format::{Format, Shown};
use crate::caller::{is_called, take_down};
use crate::outcome::{Outcome, WrittenRecordings};
use crate::saying::{Saying, saying};
use crate::terminal;
use anyhow::Context;
use std::io::{ErrorKind, Write};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::option_value::unusable;
use windfall_files::provenance::VERSION;
use windfall_files::table::write::csv_text;
use windfall_files::text::quote::{command, path_word};
use windfall_files::text::table::for_terminal;
use windfall_files::write_file::{check_target, write_whole};
use windfall_simulate::motion::MotionOutcome;

/// Writes a result. A reader that has heard enough (`| head`) is no error.
pub fn write_result(text: &str) -> anyhow::Result<()> {
    if take_down(text, |said| &mut said.result) {
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes a result for people: folded to the terminal and in its colours, where there is one.
pub fn write_text(text: impl FnOnce() -> String) -> anyhow::Result<()> {
    match is_called() {
        true => write_result(&text()),
        false => write_result(&terminal::shown(&for_terminal(terminal::width(), text))),
    }
}

/// Does the work of a command and shows its result, also into a file where one is named; a
/// file that may not be written is refused before the work.
///
/// * `work`: what the command does
/// * `text`, `csv`: its result for people, and as a table
///
/// # Errors
/// Those of the work; the file has no known ending, or cannot be written.
pub fn show<T: Outcome, E: Into<anyhow::Error>>(
    shown: &Shown,
    work: impl FnOnce() -> Result<T, E>,
    text: impl Fn(&T) -> String,
    csv: impl Fn(&T) -> Result<String, Error>,
) -> anyhow::Result<T> {
    let kept = kept_form(shown)?;
    let outcome = work().map_err(Into::into)?;
    let formed = |format| {
        Ok::<_, anyhow::Error>(match format {
            Format::Json => json_of(&outcome)?,
            Format::Csv => csv(&outcome)?,
            Format::Text => text(&outcome),
        })
    };
    if let Some((path, format)) = kept {
        write_whole(path, formed(format)?.as_bytes())?;
        tell_written([path]);
    }
    match shown.format {
        Format::Text => write_text(|| text(&outcome))?,
        format => write_result(&formed(format)?)?,
    }
    Ok(outcome)
}

/// The file in which a result is kept, and its form there.
///
/// # Errors
/// Its ending is not known, or it may not be written.
pub fn kept_form(shown: &Shown) -> Result<Option<(&Path, Format)>, Error> {
    let path = shown.out.as_deref();
    path.map(|path| Ok((path, format_of(path)?))).transpose()
}

/// The form of a result in a file, by its ending.
fn format_of(path: &Path) -> Result<Format, Error> {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let format = match ending.to_str() {
        Some("csv") => Format::Csv,
        Some("json") => Format::Json,
        Some("txt") => Format::Text,
        _ => {
            let option = format!("--out {}", path.display());
            return Err(unusable(
                option,
                "expected an ending of .csv, .json or .txt",
            ));
        }
    };
    check_target(path)?;
    Ok(format)
}

/// A result as indented JSON, which begins with the version of windfall and the name of its
/// schema.
pub fn json_of<T: Outcome>(outcome: &T) -> anyhow::Result<String> {
    let text = outcome.json()?;
    let (_, fields) = text.split_once('{').context("a result is an object")?;
    let mut head = vec![("schema", T::SCHEMA)];
    // Some results are kept, and tell themselves what made them. Only keys of the object
    // itself are indented by two spaces.
    if !fields.contains("\n  \"windfall\": ") {
        head.insert(0, ("windfall", VERSION));
    }
    let head = head
        .iter()
        .map(|(key, value)| format!("\n  \"{key}\": \"{value}\""));
    let comma = if fields == "}" { "\n" } else { "," };
    Ok(format!(
        "{{{}{comma}{fields}\n",
        head.collect::<Vec<_>>().join(",")
    ))
}

/// Shows a motion: as text only its summary.
pub fn show_motion(
    shown: &Shown,
    (summary, samples): (String, usize),
    outcome: impl FnOnce() -> MotionOutcome,
    csv: impl Fn() -> Result<String, Error>,
) -> anyhow::Result<()> {
    let text = |_: &MotionOutcome| {
        format!("{summary}\nThe motion, {samples} samples: --format csv or json.\n")
    };
    show(shown, || Ok::<_, Error>(outcome()), text, |_| csv())?;
    Ok(())
}

/// [`message`] of what is useful to know, if the command may say so.
pub fn note(text: &str) {
    if saying() != Saying::Little {
        message(text);
    }
}

/// Says which files were written.
pub fn tell_written<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) {
    // Who is told much is told of all files in the end.
    for path in paths.into_iter().filter(|_| saying() != Saying::Much) {
        note(&format!("written: {}", path.as_ref().display()));
    }
}

/// Writes a line to standard error, if it is open.
pub fn message(text: &str) {
    if take_down(&format!("{text}\n"), |said| &mut said.messages) {
        return;
    }
    let _ = writeln!(std::io::stderr(), "{}", terminal::message_shown(text));
}

/// An error with its causes, each once: many messages contain their cause.
pub fn with_causes(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            text += &format!(": {cause}");
        }
    }
    text
}

/// Says what a simulation has written.
///
/// * `work`: writes recordings into the directory, and says how many
pub fn show_written<E: Into<anyhow::Error>>(
    shown: &Shown,
    directory: &Path,
    work: impl FnOnce() -> Result<usize, E>,
) -> anyhow::Result<()> {
    let work = || {
        work().map(|recordings| WrittenRecordings {
            directory: directory.display().to_string(),
            recordings,
            simulated: true,
        })
    };
    let csv = |own: &WrittenRecordings| {
        let row = vec![own.directory.clone(), own.recordings.to_string()];
        csv_text(&["directory", "recordings"], [row])
    };
    let text = |own: &WrittenRecordings| {
        format!(
            "{} simulated recordings in {}\n\nNext:\n  {}\n",
            own.recordings,
            own.directory,
            command(&["fit", &path_word(directory)])
        )
    };
    show(shown, work, text, csv)?;
    Ok(())
}

/// Names of files as CSV.
///
/// * `column`: name of the column
pub fn csv_of_names<N: ToString>(
    column: &str,
    names: impl IntoIterator<Item = N>,
) -> Result<String, Error> {
    csv_text(
        &[column],
        names.into_iter().map(|name| vec![name.to_string()]),
    )
}

/// Says what was not used; the text shows that itself.
pub fn tell_unused(format: Format, failed: &[FailureOutcome]) {
    if format != Format::Text {
        for failure in failed {
            message(&format!("not used: {}: {}", failure.id, failure.message));
        }
    }
}

/// Where nothing could be fitted, says of each recording why, before the error itself
/// is shown.
pub fn tell_failures(error: Error) -> Error {
    if let Error::NothingFitted { failures, .. } = &error {
        for failure in failures {
            message(&format!("not fitted: {}: {}", failure.id, failure.message));
        }
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_no_cause() {
        let cause = anyhow::anyhow!("the file ends early");
        let silent = cause.context("reading impacts.csv");
        assert_eq!(
            with_causes(&silent),
            "reading impacts.csv: the file ends early"
        );
        let cause = anyhow::anyhow!("the file ends early");
        let telling = cause.context("impacts.csv: the file ends early");
        assert_eq!(with_causes(&telling), "impacts.csv: the file ends early");
    }
}
