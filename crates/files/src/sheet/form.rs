//! What a table is written as, by the ending of its file's name.

use crate::error::Error;
use crate::option_value::unusable;
use std::path::Path;
use windfall_columnar::write::Container;

/// Form of a table in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Lines of text.
    Csv,
    /// Columns, for other programs.
    Columns(Container),
}

/// Endings of names, and what they stand for.
const ENDINGS: [(&str, Form); 4] = [
    ("csv", Form::Csv),
    ("parquet", Form::Columns(Container::Parquet)),
    ("arrow", Form::Columns(Container::Arrow)),
    ("feather", Form::Columns(Container::Arrow)),
];

impl Form {
    /// The form that the ending of a file's name asks for.
    ///
    /// * `option`: the option that names the file, for the message
    ///
    /// # Errors
    /// It has none of the known endings.
    pub fn of_path(option: &str, path: &Path) -> Result<Self, Error> {
        let ending = path.extension().and_then(|own| own.to_str()).unwrap_or("");
        let mut known = ENDINGS.iter();
        let known = known.find(|(own, _)| ending.eq_ignore_ascii_case(own));
        known.map(|(_, form)| *form).ok_or_else(|| {
            let problem = "the ending of the name says what is written: .csv, .parquet or .arrow";
            unusable(format!("{option} {}", path.display()), problem)
        })
    }
}
