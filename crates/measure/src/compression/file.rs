//! campaign.toml of slow compressions as it stands on disk, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use windfall_campaign::settings::file::{
    ChannelsFile, FilesFile, QuantityText, SummaryFile, TitleFile,
};
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompressionFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// The testing machine.
    pub rig: Spanned<CompressionRigFile>,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// Channels by what they hold.
    pub channels: Option<Spanned<ChannelsFile>>,
    /// How yield and stiffness are found.
    #[serde(default)]
    pub compression: YieldFile,
    /// What is fitted.
    #[serde(default)]
    pub fit: LawsFile,
    /// How results are grouped.
    #[serde(default)]
    pub summary: SummaryFile,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompressionRigFile {
    /// "compression".
    pub kind: Option<Spanned<String>>,
    /// Plates that deform the fruit: 1 or 2.
    pub plates: Option<Spanned<i64>>,
    /// Poisson's ratio of the fruit.
    pub poisson_ratio: Option<Spanned<f64>>,
    /// Radius of a spherical indenter; a plane plate if left out.
    pub indenter_radius: Option<Spanned<QuantityText>>,
    /// Stiffness in series with the fruit.
    pub machine_stiffness: Option<Spanned<QuantityText>>,
}

/// `[compression]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct YieldFile {
    /// Force from which the fruit counts as touched.
    pub touch_force: Option<Spanned<QuantityText>>,
    /// Length without a rise at a yield, as a part of the deformation so far.
    pub yield_window: Option<Spanned<f64>>,
    /// Length of the local stiffness, as a part of the force.
    pub stiffness_window: Option<Spanned<f64>>,
    /// Part of the largest stiffness at which the tissue has softened.
    pub softening: Option<Spanned<f64>>,
    /// Part of the largest force below which a fall is a rupture.
    pub rupture: Option<Spanned<f64>>,
    /// "largest-stiffness", a part of the yield force ("50 %") or a deformation
    /// ("0.5 mm").
    pub fit_to: Option<Spanned<String>>,
}

/// `[fit]` where only laws are fitted.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawsFile {
    /// One law.
    pub law: Option<Spanned<String>>,
    /// Several laws.
    pub laws: Option<Vec<Spanned<String>>>,
    /// Parameters that are estimated although they have a value.
    pub free: Option<Vec<Spanned<String>>>,
}
