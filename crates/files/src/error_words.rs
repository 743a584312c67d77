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

pub(crate) fn nearest_columns(nearest: &[String], columns: usize) -> String {
    match nearest {
        [] => format!("the header has {columns} columns"),
        some => format!(
            "nearest in the header: {} ({columns} columns in all)",
            some.iter()
                .map(|name| format!("\"{name}\""))
                .collect::<Vec<_>>()
                .join(", ")
        ),
    }
}
