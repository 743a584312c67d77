//! Where text goes: results to standard output, messages to standard error.

use crate::args_format::Format;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes a result. A reader that has heard enough (`| head`) is no error.
pub fn write_result(text: &str) -> anyhow::Result<()> {
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

/// Writes a line to standard error; when that is closed there is no one to tell.
pub fn message(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Says what a simulation has written.
pub fn written(directory: &Path, recordings: usize, format: Format) -> anyhow::Result<()> {
    let directory = directory.display();
    match format {
        Format::Json => write_json(&serde_json::json!({
            "directory": directory.to_string(), "recordings": recordings, "simulated": true
        })),
        Format::Csv => write_result(&format!(
            "directory,recordings\n\"{directory}\",{recordings}\n"
        )),
        Format::Text => write_result(&format!(
            "{recordings} simulated recordings in {directory}\n\nNext:\n  windfall fit {directory}\n"
        )),
    }
}
