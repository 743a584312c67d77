//! `[record]` of scene.toml.

use crate::file::key::Section;
use schemars::JsonSchema;
use serde::Deserialize;
use windfall_files::error::Error;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::TomlSource;

/// `[record]` of the file.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordFile {
    /// Time from frame to frame.
    pub frames: Option<Spanned<QuantityText>>,
}

/// Recorded frames.
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
    let table = Section {
        source,
        name: "[record]",
        at: 0..0,
    };
    let frames = table.above_zero(&record.frames, "frames", "s")?;
    Ok(RecordPlan { frames })
}
