//! Where text goes: results to standard output, messages to standard error, both to a program
//! that called.

use crate::args::format::Format;
use crate::caller::take_down;
use std::io::{ErrorKind, Write};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::table::write::csv_text;
use windfall_files::text::quote::{command, path_word};

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

/// Writes a value as indented JSON.
pub fn write_json<T: serde::Serialize>(value: &T) -> anyhow::Result<()> {
    write_result(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// Writes a result in the form that was chosen.
pub fn show<T: serde::Serialize>(
    format: Format,
    outcome: &T,
    text: impl Fn(&T) -> String,
    csv: impl Fn(&T) -> Result<String, Error>,
) -> anyhow::Result<()> {
    match format {
        Format::Json => write_json(outcome),
        Format::Csv => write_result(&csv(outcome)?),
        Format::Text => write_result(&text(outcome)),
    }
}

/// Writes a motion: as text only its summary.
pub fn show_motion(
    format: Format,
    (summary, samples): (String, usize),
    json: impl Fn() -> serde_json::Value,
    csv: impl Fn() -> Result<String, Error>,
) -> anyhow::Result<()> {
    match format {
        Format::Json => write_json(&json()),
        Format::Csv => write_result(&csv()?),
        Format::Text => write_result(&format!(
            "{summary}\nThe motion, {samples} samples: --format csv or json.\n"
        )),
    }
}

/// Writes a line to standard error, if it is open.
pub fn message(text: &str) {
    if take_down(&format!("{text}\n"), |said| &mut said.messages) {
        return;
    }
    let _ = writeln!(std::io::stderr(), "{text}");
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
pub fn written(directory: &Path, recordings: usize, format: Format) -> anyhow::Result<()> {
    let word = path_word(directory);
    let directory = directory.display();
    match format {
        Format::Json => write_json(&serde_json::json!({
            "directory": directory.to_string(), "recordings": recordings, "simulated": true
        })),
        Format::Csv => {
            let row = vec![directory.to_string(), recordings.to_string()];
            write_result(&csv_text(&["directory", "recordings"], [row])?)
        }
        Format::Text => write_result(&format!(
            "{recordings} simulated recordings in {directory}\n\nNext:\n  {}\n",
            command(&["fit", &word])
        )),
    }
}

/// Names of files as CSV.
///
/// * `column`: name of the column
pub fn write_names(column: &str, names: &[String]) -> anyhow::Result<()> {
    let rows = names.iter().map(|name| vec![name.clone()]);
    write_result(&csv_text(&[column], rows)?)
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
