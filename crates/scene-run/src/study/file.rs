//! The schema of a study, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// The scene, beside this file.
    pub scene: Spanned<String>,
    pub title: Option<String>,
    /// Runs of each variant, with other seeds and resampled laws.
    pub replicates: Option<Spanned<usize>>,
    /// What is varied.
    #[serde(default)]
    pub vary: Vec<Spanned<VaryFile>>,
}

/// `[[vary]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VaryFile {
    /// What is varied.
    pub name: Spanned<String>,
    /// Its levels; differences are to the first.
    pub levels: Vec<Spanned<LevelFile>>,
}

/// A level.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelFile {
    pub name: String,
    /// New values, by the path of their key.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub set: BTreeMap<String, Spanned<toml::Value>>,
    /// What is moved.
    #[serde(rename = "move")]
    pub shift: Option<Spanned<MoveFile>>,
}

/// `move`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveFile {
    /// Names of walls, kinds of fruit and sinks.
    pub names: Vec<String>,
    /// By how much; m.
    pub by: [f64; 3],
}
