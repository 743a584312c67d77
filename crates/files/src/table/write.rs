//! Tables as CSV text.

use crate::error::Error;
use std::path::Path;

/// A number as a cell of CSV, with all digits; blank where there is none.
pub fn number_cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// CSV text from a header and rows.
pub fn csv_text(
    header: &[String],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> Result<String, Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |error: csv::Error| Error::FileAccess {
        path: Path::new("the table in memory").to_path_buf(),
        action: "write",
        source: std::io::Error::other(error.to_string()),
    };
    writer.write_record(header).map_err(failed)?;
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| failed(error.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
