//! campaign.toml of impacts repeated on one spot as it stands on disk, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use windfall_campaign::settings::file::{
    ChannelsFile, FilesFile, QuantityText, SummaryFile, TitleFile,
};
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatsFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// What falls.
    pub rig: Spanned<RepeatsRigFile>,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// Channels by what they hold.
    pub channels: Option<Spanned<ChannelsFile>>,
    /// How impacts are compared.
    #[serde(default)]
    pub repeats: ComparisonFile,
    /// Not used, but allowed as in other campaigns.
    #[serde(default)]
    pub summary: SummaryFile,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatsRigFile {
    /// "repeats".
    pub kind: Option<Spanned<String>>,
    /// Mass that falls, where impacts.csv gives heights and no masses.
    pub mass: Option<Spanned<QuantityText>>,
    /// Acceleration of gravity.
    pub gravity: Option<Spanned<QuantityText>>,
}

/// `[repeats]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ComparisonFile {
    /// Column of specimens.csv or impacts.csv that marks the reference.
    pub reference_column: Option<String>,
    /// Value of that column for a specimen that cannot be damaged.
    pub reference_value: Option<String>,
    /// Change of peak, duration and rise slope that does not matter; a part.
    pub margin: Option<Spanned<f64>>,
    /// Otherwise this many standard deviations of the reference's changes.
    pub margin_deviations: Option<Spanned<f64>>,
    /// Probability of calling a change where there is none.
    pub level: Option<Spanned<f64>>,
    /// "crossing" or "rise".
    pub alignment: Option<Spanned<String>>,
    /// Force of the crossing, as a part of the peak.
    pub crossing: Option<Spanned<f64>>,
    /// "log-normal" or "weibull".
    pub distribution: Option<Spanned<String>>,
    /// Sign patterns drawn where there are too many to enumerate.
    pub draws: Option<Spanned<u32>>,
    /// Seed of the draws.
    pub seed: Option<u64>,
}
