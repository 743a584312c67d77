//! campaign.toml as it stands on disk, version 1.
//!
//! Every value keeps its place in the text, so that a message can name the line.
//! `campaign` turns it into what the program works with.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use windfall_cards::user_laws::file::LawsFile;
pub use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;

/// The version that this module reads.
pub const FORMAT: i64 = 1;

/// The whole file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CampaignFile {
    /// Version of the shape of this file.
    pub format: Option<Spanned<i64>>,
    /// Title and label.
    #[serde(default)]
    pub campaign: TitleFile,
    /// The rig.
    pub rig: Option<Spanned<RigFile>>,
    /// Where recordings are and how they tell the time.
    #[serde(default)]
    pub files: FilesFile,
    /// Channels by what they hold.
    pub channels: Option<Spanned<ChannelsFile>>,
    /// The encoder, where there is one.
    pub encoder: Option<Spanned<EncoderFile>>,
    /// What the instruments make of force and displacement.
    #[serde(default)]
    pub response: ResponseFile,
    /// How contacts are found.
    #[serde(default)]
    pub contact: ContactFile,
    /// What is fitted.
    #[serde(default)]
    pub fit: FitFile,
    /// The user's own laws.
    #[serde(default)]
    pub laws: LawsFile,
    /// How results are grouped.
    #[serde(default)]
    pub summary: SummaryFile,
    /// How fruit differ.
    #[serde(default)]
    pub population: PopulationFile,
}

/// `[population]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PopulationFile {
    /// Columns of impacts.csv or specimens.csv, or `log(column)`.
    #[serde(default)]
    pub covariates: Vec<String>,
}

/// `[campaign]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TitleFile {
    /// Title of tables and reports.
    pub title: Option<String>,
    /// Label shown with every result of simulated recordings.
    pub simulated: Option<String>,
    /// Remark on the campaign, shown with its results.
    pub note: Option<String>,
}

/// `[rig]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigFile {
    /// "pendulum" or "carriage".
    pub kind: Option<Spanned<String>>,
    /// Moment of inertia about the pivot.
    pub inertia: Option<Spanned<QuantityText>>,
    /// Pivot to contact.
    pub arm: Option<Spanned<QuantityText>>,
    /// Mass of arm and impactor, or of the carriage; or "from impulse".
    pub mass: Option<Spanned<QuantityText>>,
    /// Standard uncertainty of the mass.
    pub mass_sd: Option<Spanned<QuantityText>>,
    /// Pivot to centre of mass.
    pub centre_of_mass: Option<Spanned<QuantityText>>,
    /// Acceleration of gravity.
    pub gravity: Option<Spanned<QuantityText>>,
    /// Acceleration towards the fruit without contact.
    pub driving_acceleration: Option<Spanned<QuantityText>>,
    /// Standard uncertainty of that acceleration.
    pub driving_acceleration_sd: Option<Spanned<QuantityText>>,
}

/// `[files]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilesFile {
    /// Directory of the recordings, relative to the campaign.
    pub directory: Option<Spanned<String>>,
    /// Pattern of the names of recordings, by which further ones are listed.
    pub names: Option<Spanned<String>>,
    /// Column with the times.
    pub time: Option<Spanned<String>>,
    /// Unit of the times.
    pub time_unit: Option<Spanned<String>>,
    /// Sampling rate, where there is no column of times.
    pub rate: Option<Spanned<QuantityText>>,
    /// Format of the recordings, whatever their first bytes say.
    pub format: Option<Spanned<String>>,
    /// Between the cells of a text.
    pub separator: Option<Spanned<String>>,
    /// Before decimals.
    pub decimal: Option<Spanned<String>>,
    /// Between groups of three digits.
    pub thousands: Option<Spanned<String>>,
    /// Encoding of a text.
    pub encoding: Option<Spanned<String>>,
    /// Line with the names of the columns, from 1; 0 if there is none.
    pub header_line: Option<Spanned<u64>>,
    /// Beginning of lines that are passed over.
    pub comment: Option<Spanned<String>>,
    /// Words and numbers that stand for a missing sample, beside the usual words.
    #[serde(default)]
    pub missing: Vec<MissingText>,
    /// Number of lines at the end of a text that are not rows.
    #[serde(default)]
    pub footer: u64,
}

/// A word or number that stands for a missing sample.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "`missing` lists words and numbers, such as [\"OVLD\", 9999]"
)]
pub enum MissingText {
    /// A word, or a number in quotes.
    Word(String),
    /// A number.
    Number(f64),
}

/// `[channels.*]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChannelsFile {
    /// Contact force.
    pub force: Option<Spanned<ChannelFile>>,
    /// Position or displacement.
    pub position: Option<Spanned<ChannelFile>>,
    /// Displacement rate.
    pub velocity: Option<Spanned<ChannelFile>>,
    /// Acceleration.
    pub acceleration: Option<Spanned<ChannelFile>>,
    /// Angle of the arm.
    pub angle: Option<Spanned<ChannelFile>>,
    /// Decoded encoder count.
    pub count: Option<Spanned<ChannelFile>>,
    /// Encoder phase A.
    pub phase_a: Option<Spanned<ChannelFile>>,
    /// Encoder phase B.
    pub phase_b: Option<Spanned<ChannelFile>>,
}

/// One channel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChannelFile {
    /// Column in the file; `{name}` is filled from impacts.csv.
    pub column: Option<Spanned<String>>,
    /// Unit of the column.
    pub unit: Option<Spanned<String>>,
    /// Output of the sensor per physical unit.
    pub sensitivity: Option<Spanned<QuantityText>>,
    /// Gain of the amplifier behind it.
    pub gain: Option<Spanned<f64>>,
    /// What the column shows at zero.
    pub offset: Option<Spanned<QuantityText>>,
    /// -1 where the column counts the other way.
    pub sign: Option<Spanned<i64>>,
    /// Column of times of this channel alone.
    pub time: Option<Spanned<String>>,
    /// By how much the channel shows an event later than the clock says.
    pub delay: Option<Spanned<QuantityText>>,
    /// Standard deviation of its noise, sample by sample, in place of what recordings show.
    pub noise_sd: Option<Spanned<QuantityText>>,
    /// Cut-off of a zero-phase low-pass filter.
    pub low_pass: Option<Spanned<QuantityText>>,
    /// Cut-off of a zero-phase high-pass filter.
    pub high_pass: Option<Spanned<QuantityText>>,
    /// Order of the filters.
    pub filter_order: Option<Spanned<i64>>,
    /// Mass between force sensor and fruit.
    pub tip_mass: Option<Spanned<QuantityText>>,
}

/// `[encoder]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EncoderFile {
    /// Counts per revolution after ×4 decoding.
    pub counts_per_revolution: Option<Spanned<f64>>,
    /// Displacement per count, for a wheel or a linear scale.
    pub count_length: Option<Spanned<QuantityText>>,
    /// Distance of its disc from the axis, over the radius of the lines.
    pub eccentricity: Option<Spanned<QuantityText>>,
    /// What the times beside decoded counts mean: "sampled" or "events".
    pub times: Option<Spanned<String>>,
}

/// `[response]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseFile {
    /// Corner of a filter of first order that the force passes.
    pub force_filter: Option<Spanned<QuantityText>>,
    /// Natural frequency of the force sensor.
    pub sensor_frequency: Option<Spanned<QuantityText>>,
    /// Its damping ratio.
    pub sensor_damping: Option<Spanned<QuantityText>>,
    /// Natural frequency of the arm's bending.
    pub arm_frequency: Option<Spanned<QuantityText>>,
    /// Its damping ratio.
    pub arm_damping: Option<Spanned<QuantityText>>,
    /// Bending of the arm by a force at rest.
    pub arm_compliance: Option<Spanned<QuantityText>>,
}

/// `[contact]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactFile {
    /// Force threshold, or "auto".
    pub threshold: Option<Spanned<QuantityText>>,
    /// What is taken off the force: its mean before contact ("remove"), a
    /// straight line through what is before and after ("drift"), nothing ("keep").
    pub baseline: Option<Spanned<String>>,
    /// Part of the threshold below which a contact is over.
    pub release: Option<Spanned<f64>>,
    /// Contacts closer than this are one.
    pub minimum_gap: Option<Spanned<QuantityText>>,
    /// How the displacement rate is made.
    pub rate: Option<Spanned<String>>,
    /// Least time between the two edges of a rate from edge times.
    pub rate_window: Option<Spanned<QuantityText>>,
    /// What is kept before the contact at least.
    pub pre_trigger: Option<Spanned<QuantityText>>,
    /// What is kept after the contact at least.
    pub post_trigger: Option<Spanned<QuantityText>>,
    /// Which of several contacts is used: "first" or "strongest".
    pub contact: Option<Spanned<String>>,
    /// What is kept before the contact, as a part of its duration.
    pub margin_before: Option<Spanned<f64>>,
    /// What is kept after the contact, as a part of its duration.
    pub margin_after: Option<Spanned<f64>>,
    /// Free motion kept on either side, as a part of the contact's duration; 1.
    pub free_flight: Option<Spanned<f64>>,
}

/// `[fit]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitFile {
    /// One law.
    pub law: Option<Spanned<String>>,
    /// Several laws.
    pub laws: Option<Vec<Spanned<String>>>,
    /// Parameters that are estimated although they have a value.
    pub free: Option<Vec<Spanned<String>>>,
    /// What is known of parameters before the data: "2.4e5 ± 0.3e5 N/m^1.5".
    #[serde(default)]
    pub prior: BTreeMap<String, Spanned<QuantityText>>,
    /// Values outside of which parameters are not searched: "0 … 50 N s/m".
    #[serde(default)]
    pub bounds: BTreeMap<String, Spanned<QuantityText>>,
    /// Quantities of the bench that are estimated over all impacts.
    pub estimate: Option<Vec<Spanned<String>>>,
    /// Quantities in the cost function.
    pub quantities: Option<Vec<Spanned<String>>>,
    /// "inverse-variance" or "inverse-mean".
    pub weights: Option<Spanned<String>>,
    /// "automatic" or "white".
    pub noise: Option<Spanned<String>>,
    /// "asymptotic", "profile", "bootstrap" or "posterior".
    pub intervals: Option<Spanned<String>>,
    /// Resampled recordings of a bootstrap.
    pub replicates: Option<Spanned<u64>>,
    /// Draws of each chain of a posterior.
    pub draws: Option<Spanned<u64>>,
    /// Chains of a posterior.
    pub chains: Option<Spanned<u64>>,
    /// Seed of bootstrap and posterior.
    pub seed: Option<Spanned<u64>>,
    /// "auto", "free" or "fixed".
    pub initial_velocity: Option<Spanned<String>>,
    /// "auto", "free" or "fixed".
    pub onset: Option<Spanned<String>>,
    /// "auto", "free" or "fixed".
    pub displacement_offset: Option<Spanned<String>>,
    /// "force-zero" or "gap-zero".
    pub end: Option<Spanned<String>>,
}

/// `[summary]`
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SummaryFile {
    /// Column of specimens.csv or impacts.csv.
    pub group: Option<Spanned<String>>,
}
