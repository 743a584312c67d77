//! What can be wrong with a campaign and its recordings.

use std::path::PathBuf;
use windfall_files::error::{Fault, Place};
use windfall_files::text::number::plain;

/// What can be wrong with a campaign and its recordings.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// Nothing says when samples were taken.
    #[error(
        "{path}: nothing says when the samples of \"{column}\" were taken; give the column of \
         times or the sampling rate in campaign.toml: [files] time = \"time_s\"   or   \
         rate = \"200 kHz\"", path = path.display()
    )]
    TimesUnknown {
        /// The file.
        path: PathBuf,
        /// The channel.
        column: String,
    },
    /// Samples that the instrument could not give.
    #[error(
        "{path}: {samples} sample(s) of \"{column}\" are missing, the first at {at} s ({first}); \
         choose a range of time without them (from_s and to_s in impacts.csv), or mend the \
         recording", path = path.display()
    )]
    SampleMissing {
        /// The file.
        path: PathBuf,
        /// The channel.
        column: String,
        /// How many.
        samples: usize,
        /// Time of the first; s.
        at: f64,
        /// What stands in its place, and where.
        first: String,
    },
    /// Nothing shows whether a mark stands before decimals or between groups of digits.
    #[error("{path}: {doubt}", path = path.display())]
    DecimalOrThousands {
        /// The file.
        path: PathBuf,
        /// Where, and how to settle it.
        doubt: String,
    },
    /// A quantity of the bench that the impacts do not determine.
    #[error(
        "{path}: [fit] estimate: {quantity} cannot be determined: {told} of the impacts show the \
         {what} of the force against the displacement, by samples and counts shorter than 0.3 of \
         the contact, and at least 5 are needed; take it out of `estimate`", path = path.display()
    )]
    BenchUntold {
        /// The campaign directory.
        path: PathBuf,
        /// The quantity.
        quantity: &'static str,
        /// What of the force determines it.
        what: &'static str,
        /// Impacts that show it.
        told: usize,
    },
    /// What the instruments do, which the impacts do not determine.
    #[error(
        "{path}: [fit] estimate: {quantity} cannot be determined: what the fits of {fitted} impacts \
         leave does not show it (at least 5 are needed, and a difference of AICc of 10); take it \
         out of `estimate`", path = path.display()
    )]
    ResponseUntold {
        /// The campaign directory.
        path: PathBuf,
        /// The quantity.
        quantity: &'static str,
        /// Impacts that could be fitted.
        fitted: usize,
    },
    /// Impacts that contradict what is given with an uncertainty.
    #[error(
        "{path}: [fit] estimate: campaign.toml says {quantity} = {} ± {} {unit}, and the \
         impacts say {} ± {}: give it the uncertainty that it really has, or leave ± out \
         to take what the impacts say", plain(told[0]), plain(told[1]), plain(found[0]), plain(found[1]), path = path.display()
    )]
    BenchContradicted {
        /// The campaign directory.
        path: PathBuf,
        /// The quantity.
        quantity: &'static str,
        /// Its SI unit.
        unit: &'static str,
        /// Value and standard uncertainty in campaign.toml; SI.
        told: [f64; 2],
        /// Those of the impacts; SI.
        found: [f64; 2],
    },
    /// A recording that may not be read.
    #[error("{place}: the recording \"{file}\" in column \"file\" is not read: {problem}")]
    RecordingRefused {
        /// The row that names it.
        place: Place,
        /// Its name.
        file: String,
        /// Why.
        problem: String,
    },
    /// A sample without its time.
    #[error(
        "{place}: sample {sample} of column \"{column}\" has no time, the cell in column \"{time}\" \
         is blank; fill in the time or leave the sample blank too"
    )]
    SampleWithoutTime {
        /// Where.
        place: Place,
        /// Row below the header, from 0.
        sample: usize,
        /// The column with the sample.
        column: String,
        /// The column of times.
        time: String,
    },
    /// A column without a single sample.
    #[error(
        "{path}: the column \"{column}\" holds no sample, every cell is blank; \
         map the channel to another column", path = path.display()
    )]
    ColumnBlank {
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
    },
    /// A campaign file of a version that this windfall does not read.
    #[error(
        "{place}: format = {found}, but this windfall reads format = {expected}; \
         install a newer windfall, or make a fresh template with `windfall new`"
    )]
    CampaignFormat {
        /// Where.
        place: Place,
        /// Version found.
        found: i64,
        /// Version expected.
        expected: i64,
    },
    /// An environment variable used in a path is not set.
    #[error(
        "{place}: {key} uses the environment variable {variable}, which is not set; \
         set it, for example: export {variable}=/path/to/recordings"
    )]
    VariableUnset {
        /// Where.
        place: Place,
        /// Table and key.
        key: String,
        /// The variable.
        variable: String,
    },
    /// A column placeholder that no column of impacts.csv fills.
    #[error(
        "{place}: column = \"{text}\" uses {{{name}}}, but impacts.csv has no column \"{name}\"; \
         add it, or write the column's name in full"
    )]
    PlaceholderUnknown {
        /// Where.
        place: Place,
        /// The column's name with its placeholders.
        text: String,
        /// The placeholder.
        name: String,
    },
    /// An id given to two rows.
    #[error(
        "{place}: the {what} \"{id}\" is named twice (first in line {first}); ids must be unique"
    )]
    IdRepeated {
        /// The second place.
        place: Place,
        /// "specimen" or "impact".
        what: &'static str,
        /// The id.
        id: String,
        /// Line of the first.
        first: usize,
    },
    /// An impact on a specimen that specimens.csv does not list.
    #[error(
        "{place}: the specimen \"{specimen}\" is not in specimens.csv; add it there or correct the id{nearest}"
    )]
    SpecimenUnknown {
        /// Where.
        place: Place,
        /// The specimen.
        specimen: String,
        /// Suggestion for the message, or "".
        nearest: String,
    },
    /// No impact shows the mass of the carriage.
    #[error(
        "{path}: the mass cannot be found from any of the {impacts} impacts; give it in \
         campaign.toml: mass = \"0.5 kg\". The first impact says: {first}", path = path.display()
    )]
    MassUnknown {
        /// The campaign directory.
        path: PathBuf,
        /// How many impacts there are.
        impacts: usize,
        /// Why the first one does not show it.
        first: String,
    },
    /// A rig that is still the example of a template.
    #[error("{place}: [rig]: {problem}")]
    RigNotGiven {
        /// Where.
        place: Place,
        /// What is missing, and how it is said.
        problem: String,
    },
    /// An impact whose energy nothing says.
    #[error(
        "{place}: the impact energy is not known; give a column energy_J, or drop_height_m \
         together with mass_kg or with `mass` in [rig]"
    )]
    EnergyUnknown {
        /// Where.
        place: Place,
    },
    /// A campaign without a channel that its kind needs.
    #[error(
        "{item}: no channel holds {quantity}; map a column to it under [channels] in campaign.toml"
    )]
    ChannelNotMapped {
        /// Id in impacts.csv.
        item: String,
        /// The quantity.
        quantity: String,
    },
    /// No samples between from_s and to_s.
    #[error(
        "{item}: channel '{channel}' has no samples between {from} s and {to} s; correct from_s \
         and to_s in impacts.csv (`windfall inspect` shows the times of a recording)"
    )]
    RangeEmpty {
        /// Id in impacts.csv.
        item: String,
        /// The channel.
        channel: String,
        /// Begin of the range; s.
        from: f64,
        /// Its end; s.
        to: f64,
    },
}

impl Fault for CampaignError {
    fn is_request(&self) -> bool {
        !matches!(self, Self::MassUnknown { .. })
    }
}
