//! What campaign.toml of compressions, holds, taps and repeated impacts may say, for editors.

use crate::compression::file::CompressionFile;
use crate::relaxation::file::RelaxationFile;
use crate::repeats::file::RepeatsFile;
use crate::repeats::read::{ALIGNMENTS, FAMILIES};
use crate::taps::file::AcousticFile;
use crate::taps::read::COMMON;
use windfall_files::text::file_schema::{FileSchema, file_schema};

/// Of slow compressions.
pub fn compression_schema() -> FileSchema {
    file_schema::<CompressionFile>("campaign.toml of windfall: slow compressions")
        .words(("CompressionRigFile", "kind"), &[("compression", ())])
}

/// Of deformations that are held.
pub fn relaxation_schema() -> FileSchema {
    file_schema::<RelaxationFile>("campaign.toml of windfall: stress relaxation")
        .words(("RelaxationRigFile", "kind"), &[("relaxation", ())])
}

/// Of taps.
pub fn acoustic_schema() -> FileSchema {
    file_schema::<AcousticFile>("campaign.toml of windfall: taps")
        .words(("AcousticRigFile", "kind"), &[("acoustic", ())])
        .words(("ResonanceFile", "shared"), &COMMON)
}

/// Of impacts repeated on one spot.
pub fn repeats_schema() -> FileSchema {
    file_schema::<RepeatsFile>("campaign.toml of windfall: repeated impacts")
        .words(("RepeatsRigFile", "kind"), &[("repeats", ())])
        .words(("ComparisonFile", "alignment"), &ALIGNMENTS)
        .words(("ComparisonFile", "distribution"), &FAMILIES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_its_key() {
        for schema in [
            compression_schema(),
            relaxation_schema(),
            acoustic_schema(),
            repeats_schema(),
        ] {
            assert_eq!(schema.missing(), &[] as &[String]);
        }
    }
}
