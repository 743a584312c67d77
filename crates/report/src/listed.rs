//! Tables that are too long for a page.

/// More rows than this stand in files beside the page alone.
pub const LISTED: usize = 400;

/// What a reader is told where a table is left out.
pub fn left_out(rows: usize, files: &str) -> Option<String> {
    let long = rows > LISTED;
    long.then(|| format!("Tables of more than {LISTED} rows are left to {files}."))
}
