//! What campaign.toml of drops may say, for editors.

use crate::calibrate_settings::WAYS;
use crate::file::DropFile;
use crate::read::PLATES;
use windfall_campaign::settings::fit::ENDS;
use windfall_files::text::file_schema::{FileSchema, file_schema};

/// Of fruit that fall on a plate.
pub fn drop_schema() -> FileSchema {
    file_schema::<DropFile>("campaign.toml of windfall: drops on a plate")
        .words(("DropRigFile", "kind"), &[("drop", ())])
        .words(("DropRigFile", "plate"), &PLATES)
        .words(("DropFitFile", "end"), &ENDS)
        .words(("CalibrateFile", "ways"), &WAYS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_its_key() {
        assert_eq!(drop_schema().missing(), &[] as &[String]);
    }
}
