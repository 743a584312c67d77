//! A channel of a file by the name that a person gave.

use std::path::Path;
use windfall_files::error::Error;
use windfall_files::known_names::told_names;
use windfall_formats::contents::Contents;

/// Position of a channel by its whole name, or by the part behind "/" if that is unique.
///
/// * `asked_by`: who asks, in brackets with a blank before, for the message
///
/// # Errors
/// There is no such channel; the message names the nearest.
pub fn find_channel(
    contents: &Contents,
    name: &str,
    path: &Path,
    asked_by: &str,
) -> Result<usize, Error> {
    let names = || {
        contents
            .channels
            .iter()
            .map(|channel| channel.name.as_str())
    };
    let found = names().position(|known| known == name).or_else(|| {
        let tail = |known: &str| known.rsplit('/').next() == Some(name);
        let mut same = names().enumerate().filter(|(_, known)| tail(known));
        let first = same.next();
        first.filter(|_| same.next().is_none()).map(|(at, _)| at)
    });
    found.ok_or_else(|| Error::ColumnMissing {
        path: path.to_path_buf(),
        column: name.to_owned(),
        asked_by: asked_by.to_owned(),
        nearest: told_names(name, names()),
        columns: contents.channels.len(),
    })
}
