//! campaign.toml of taps as it stands on disk, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use windfall_campaign::settings::file::{
    ChannelFile, FilesFile, QuantityText, SummaryFile, TitleFile,
};
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AcousticFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// What is known of the fruit.
    pub rig: Spanned<AcousticRigFile>,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// The channel.
    pub channels: Option<Spanned<SoundFile>>,
    /// How taps and resonances are found.
    #[serde(default)]
    pub acoustic: ResonanceFile,
    /// How results are grouped.
    #[serde(default)]
    pub summary: SummaryFile,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AcousticRigFile {
    /// "acoustic".
    pub kind: Option<Spanned<String>>,
    /// Standard uncertainty of the masses in specimens.csv.
    pub mass_sd: Option<Spanned<QuantityText>>,
    /// Density of all fruit that have none in specimens.csv.
    pub density: Option<Spanned<QuantityText>>,
    /// Standard uncertainty of densities.
    pub density_sd: Option<Spanned<QuantityText>>,
}

/// `[channels]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoundFile {
    /// Microphone, accelerometer or piezo film.
    pub sound: Option<Spanned<ChannelFile>>,
}

/// `[acoustic]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResonanceFile {
    /// "150 Hz … 2500 Hz".
    pub band: Option<Spanned<String>>,
    /// Left out after the begin of a tap.
    pub hit: Option<Spanned<QuantityText>>,
    /// Longest part of a tap that is evaluated.
    pub longest: Option<Spanned<QuantityText>>,
    /// Amplitude of a peak over the highest, at least.
    pub least_prominence: Option<Spanned<f64>>,
    /// Quality of a mode of the fruit, at least.
    pub least_quality: Option<Spanned<f64>>,
    /// Difference of frequencies of two taps that show one mode, as a part.
    pub agreement: Option<Spanned<f64>>,
    /// Part of the taps that must show a mode.
    pub least_share: Option<Spanned<f64>>,
    /// Distance of the second peak of a split mode, as a part.
    pub doublet: Option<Spanned<f64>>,
    /// "reject" or "keep" what all fruit show alike.
    pub shared: Option<Spanned<String>>,
}
