//! What a file of columns is, by its ending.

use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// Form of a table in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    /// Lines of text.
    Csv,
    /// Apache Parquet, compressed by Snappy.
    Parquet,
    /// An Arrow file (IPC), which programs map into memory as it is.
    Arrow,
}

/// Endings of names, and what they stand for.
const ENDINGS: [(&str, Container); 4] = [
    ("csv", Container::Csv),
    ("parquet", Container::Parquet),
    ("arrow", Container::Arrow),
    ("feather", Container::Arrow),
];

impl Container {
    /// The form that the ending of a file's name asks for.
    ///
    /// * `option`: the option that names the file, for the message
    ///
    /// # Errors
    /// It has none of the known endings.
    pub fn of_path(option: &str, path: &Path) -> Result<Self, Error> {
        let ending = path.extension().and_then(|own| own.to_str()).unwrap_or("");
        let known = ENDINGS
            .iter()
            .find(|(own, _)| ending.eq_ignore_ascii_case(own));
        known.map(|(_, container)| *container).ok_or_else(|| {
            let problem = "the ending of the name says what is written: .csv, .parquet or .arrow";
            unusable(format!("{option} {}", path.display()), problem)
        })
    }
}
