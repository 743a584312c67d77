//! `[record]` of scene.toml.

use crate::file::key::needed;
use serde::Deserialize;
use toml::Spanned;
use windfall_files::error::Error;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::toml_source::{TomlSource, invalid, optional_quantity};

/// `[record]` as it stands on disk.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordFile {
    /// Time from frame to frame.
    pub frames: Option<Spanned<QuantityText>>,
}

/// What is kept to be seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordPlan {
    /// Time from frame to frame, where frames are kept; s.
    pub frames: Option<f64>,
}

/// What `[record]` says.
///
/// # Errors
/// A time that is none, or not above zero.
pub fn record_of(source: &TomlSource, record: &RecordFile) -> Result<RecordPlan, Error> {
    const TABLE: &str = "[record]";
    let key = needed(
        TABLE,
        "frames",
        "time from frame to frame",
        "s",
        "frames = \"20 ms\"",
    );
    let interval = optional_quantity(source, record.frames.as_ref(), &key)?;
    if let (Some(value), Some(text)) = (interval, &record.frames) {
        let usable = value > 0.0 && value.is_finite();
        if !usable {
            let problem = "it must be a time above zero, such as \"20 ms\"".to_owned();
            let word = &text.get_ref().0;
            return Err(invalid(
                source,
                &text.span(),
                (TABLE, "frames"),
                word,
                problem,
            ));
        }
    }
    Ok(RecordPlan { frames: interval })
}
