//! Rows of a table in words: how many were used and left out, and in which lines they stand.

use serde::Serialize;

/// Lines named in a message.
const NAMED: usize = 8;

/// Rows that were used, and rows that were left out for missing cells.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct RowCount {
    /// Rows that were used.
    pub rows: usize,
    /// Rows that were left out for missing cells.
    pub left_out: usize,
    /// The same by the groups that they belong to.
    pub left_out_by: Vec<GroupLoss>,
}

/// Rows of a group that were left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct GroupLoss {
    /// The group; "" where the category itself is missing.
    pub group: String,
    /// Rows that were left out.
    pub left_out: usize,
    /// Rows that there were.
    pub rows: usize,
}

/// How many rows there are, and how many were left out.
pub(crate) fn rows_text(count: &RowCount) -> String {
    let (rows, left_out) = (count.rows, count.left_out);
    if left_out == 0 {
        return format!("{rows} rows");
    }
    let groups = count
        .left_out_by
        .iter()
        .map(|own| match own.group.is_empty() {
            true => format!("{} of none", own.left_out),
            false => format!("{}: {} of {}", own.group, own.left_out, own.rows),
        });
    let groups: Vec<String> = groups.collect();
    let groups = match groups.is_empty() {
        true => String::new(),
        false => format!(" ({})", groups.join(", ")),
    };
    let all = rows + left_out;
    format!("{rows} of {all} rows, {left_out} left out{groups}")
}

/// Lines in words, not too many.
pub(crate) fn lines_text(lines: &[usize]) -> String {
    let named: Vec<String> = lines.iter().take(NAMED).map(usize::to_string).collect();
    let more = match lines.len() > NAMED {
        true => format!(" and {} more", lines.len() - NAMED),
        false => String::new(),
    };
    let word = if lines.len() == 1 { "line" } else { "lines" };
    format!("{word} {}{more}", named.join(", "))
}
