//! What scene.toml and study.toml may say, for editors.

use crate::file::bruise::{PREDICTORS, SAME_SPOTS};
use crate::file::scene::SceneFile;
use crate::study::file::StudyFile;
use windfall_files::text::file_schema::{FileSchema, file_schema};

/// Of a scene.
pub fn scene_schema() -> FileSchema {
    file_schema::<SceneFile>("scene.toml of windfall")
        .words(("BruiseFile", "predictor"), &PREDICTORS)
        .words(("BruiseFile", "same_spot"), &SAME_SPOTS)
}

/// Of variants of a scene.
pub fn study_schema() -> FileSchema {
    file_schema::<StudyFile>("study.toml of windfall")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_its_key() {
        assert_eq!(scene_schema().missing(), &[] as &[String]);
    }
}
