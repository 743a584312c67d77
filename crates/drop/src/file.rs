//! campaign.toml of a drop rig as it stands on disk, version 1.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use windfall_campaign::settings::file::{
    ChannelsFile, FilesFile, QuantityText, SummaryFile, TitleFile,
};
use windfall_cards::user_laws::file::LawsFile;
use windfall_files::text::spanned::Spanned;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DropFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// What falls on what.
    pub rig: Spanned<DropRigFile>,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// Channels by what they hold.
    pub channels: Option<Spanned<ChannelsFile>>,
    /// How bounces are found.
    #[serde(default)]
    pub bounces: BouncesFile,
    /// The law that is calibrated.
    #[serde(default)]
    pub fit: DropFitFile,
    /// How it is calibrated.
    #[serde(default)]
    pub calibrate: CalibrateFile,
    /// The user's own laws.
    #[serde(default)]
    pub laws: LawsFile,
    /// How results are grouped.
    #[serde(default)]
    pub summary: SummaryFile,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DropRigFile {
    /// "drop".
    pub kind: Option<Spanned<String>>,
    /// Acceleration of gravity; on an incline, its part along the track.
    pub gravity: Option<Spanned<QuantityText>>,
    /// Mass of the fruit, where the tables have none.
    pub mass: Option<Spanned<QuantityText>>,
    /// Standard uncertainty of masses.
    pub mass_sd: Option<Spanned<QuantityText>>,
    /// Drop height, where impacts.csv has none.
    pub height: Option<Spanned<QuantityText>>,
    /// Standard uncertainty of drop heights.
    pub height_sd: Option<Spanned<QuantityText>>,
    /// "rigid", where the plate does not move.
    pub plate: Option<Spanned<String>>,
    /// Mass of plate and whatever moves with it.
    pub plate_mass: Option<Spanned<QuantityText>>,
    /// Its standard uncertainty.
    pub plate_mass_sd: Option<Spanned<QuantityText>>,
    /// Stiffness under the plate; from the ringing where it is left out.
    pub plate_stiffness: Option<Spanned<QuantityText>>,
    /// Its standard uncertainty.
    pub plate_stiffness_sd: Option<Spanned<QuantityText>>,
    /// Damping under the plate; from the ringing where it is left out.
    pub plate_damping: Option<Spanned<QuantityText>>,
    /// Its standard uncertainty.
    pub plate_damping_sd: Option<Spanned<QuantityText>>,
    /// Part of the mass that the contact feels.
    pub effective_mass_factor: Option<Spanned<f64>>,
}

/// `[bounces]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BouncesFile {
    /// Force above which a contact begins, or "auto".
    pub threshold: Option<Spanned<QuantityText>>,
    /// Part of the threshold below which it is over.
    pub release: Option<Spanned<f64>>,
    /// Contacts closer than this are one.
    pub minimum_gap: Option<Spanned<QuantityText>>,
    /// Least impulse of a bounce, as a part of m v of the drop.
    pub least_impulse: Option<Spanned<f64>>,
    /// "before-first", "follow", or the force of the plate at rest.
    pub static_level: Option<Spanned<QuantityText>>,
    /// Cycles over which the logarithmic decrement is taken.
    pub ringing_cycles: Option<Spanned<u32>>,
}

/// `[fit]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DropFitFile {
    /// The law, with the parameters that are held.
    pub law: Option<Spanned<String>>,
    /// Parameters that are estimated although they have a value.
    pub free: Option<Vec<Spanned<String>>>,
    /// "force-zero" or "gap-zero".
    pub end: Option<Spanned<String>>,
}

/// `[calibrate]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibrateFile {
    /// "waveform", "features", "design"; all that apply where it is left out.
    pub ways: Option<Vec<Spanned<String>>>,
    /// The law with start values of its free parameters.
    pub start: Option<Spanned<String>>,
    /// What Hertz's contact gives start values from.
    pub hertz: Option<Spanned<HertzFile>>,
    /// Bounces of each drop that are used.
    pub bounces: Option<Spanned<u32>>,
    /// Height whose drops are the target of features and design.
    pub target_height: Option<Spanned<QuantityText>>,
    /// The one drop that is the target.
    pub target_drop: Option<Spanned<String>>,
    /// Width of the targets, as a part of them.
    pub tolerance: Option<Spanned<f64>>,
    /// Lowest and highest value of each free parameter.
    pub ranges: Option<BTreeMap<String, Spanned<[QuantityText; 2]>>>,
    /// Seed of whatever is drawn.
    pub seed: Option<u64>,
}

/// `hertz` in `[calibrate]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HertzFile {
    /// Radius of the fruit where it touches.
    pub radius: Option<Spanned<QuantityText>>,
    /// Its Young's modulus.
    pub modulus: Option<Spanned<QuantityText>>,
    /// Its Poisson's ratio.
    pub poisson: Option<Spanned<f64>>,
}
