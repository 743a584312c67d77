//! What messages say by the case.

use crate::found::FailureOutcome;

/// What stands above the message that nothing could be fitted.
pub(crate) fn why_nothing(failures: &[FailureOutcome]) -> String {
    match failures.len() {
        0 => ": the campaign has no recordings".to_owned(),
        1 => "; the message above says why".to_owned(),
        n => format!("; the {n} messages above say why"),
    }
}

/// What helps where the system refuses; empty where its own words say enough.
pub(crate) fn what_to_do(action: &str, source: &std::io::Error) -> &'static str {
    use std::io::ErrorKind::{PermissionDenied, QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    match (source.kind(), action) {
        // Our own words.
        _ if source.raw_os_error().is_none() => "",
        (StorageFull | QuotaExceeded, _) => "; free some space, or write to another disk",
        (PermissionDenied, "read") => "; you have no right to read it",
        (PermissionDenied | ReadOnlyFilesystem, "write" | "create") => {
            "; the directory is read-only for you: choose another place for what is written"
        }
        _ => "",
    }
}

/// The columns of a file, of many the first that are named.
pub(crate) fn nearest_columns(nearest: &[String], columns: usize) -> String {
    let names: Vec<String> = nearest.iter().map(|name| format!("\"{name}\"")).collect();
    match names.len() {
        0 => format!("the header has {columns} columns"),
        all if all == columns => format!("the columns are {}", names.join(", ")),
        _ => format!("the nearest of {columns} columns are {}", names.join(", ")),
    }
}
