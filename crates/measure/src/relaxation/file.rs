//! campaign.toml of stress relaxation as it stands on disk, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use windfall_campaign::settings::file::{
    ChannelsFile, FilesFile, QuantityText, SummaryFile, TitleFile,
};
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelaxationFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// The testing machine.
    pub rig: RelaxationRigFile,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// Channels by what they hold.
    pub channels: Option<Spanned<ChannelsFile>>,
    /// How the hold is found and fitted.
    #[serde(default)]
    pub relaxation: HoldFile,
    /// How results are grouped.
    #[serde(default)]
    pub summary: SummaryFile,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelaxationRigFile {
    /// "relaxation".
    pub kind: Option<Spanned<String>>,
}

/// `[relaxation]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HoldFile {
    /// Force from which the fruit counts as touched.
    pub touch_force: Option<Spanned<QuantityText>>,
    /// Elements of the Maxwell model; chosen for each recording if left out.
    pub elements: Option<Spanned<i64>>,
    /// Duration of the ramp before the hold, where recordings do not show it.
    pub ramp: Option<Spanned<QuantityText>>,
    /// Power of time by which the elastic force grows during the ramp.
    pub exponent: Option<Spanned<f64>>,
}
