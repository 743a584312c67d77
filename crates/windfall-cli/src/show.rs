//! Where text goes: results to standard output, messages to standard error.

use std::io::{ErrorKind, Write};

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
