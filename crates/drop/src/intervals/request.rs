//! What `windfall bounces` is asked.

use crate::intervals::estimate::Timing;
use std::path::PathBuf;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive};

/// What `windfall bounces` is asked; texts with units.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct BouncesRequest {
    /// Tables of intervals (CSV): a drop in each row, its intervals in columns whose names say
    /// a unit of time, such as t1_ms and t2_ms
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath, required_unless_present = "intervals"))]
    pub tables: Vec<PathBuf>,
    /// Intervals between the impacts of one drop, such as '547, 412, 314 ms'; may be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIMES"))]
    pub intervals: Vec<String>,
    /// The tables have a drop in each column, its intervals below each other
    #[cfg_attr(feature = "clap", arg(long, requires = "tables"))]
    pub each_column: bool,
    /// Height of all drops, for the restitution of the first impact; a column such as
    /// drop_height_cm gives each its own
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH"))]
    pub height: Option<String>,
    /// Standard uncertainty of the drop heights; none if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH"))]
    pub height_sd: Option<String>,
    /// Step of the stopwatch; if left out, one unit of the last digit that is written anywhere
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub resolution: Option<String>,
    /// Standard uncertainty of the instant at which an impact is noticed, besides the step;
    /// none if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub trigger_sd: Option<String>,
    /// How long a contact lasts: it is taken off every interval; nothing if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIME"))]
    pub contact: Option<String>,
    /// Acceleration of gravity, or along a track; 9.80665 m/s^2 if left out
    #[cfg_attr(feature = "clap", arg(long, value_name = "ACCELERATION"))]
    pub gravity: Option<String>,
    /// Level of the intervals of means
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.95, value_name = "LEVEL")
    )]
    pub confidence: f64,
}

impl BouncesRequest {
    /// What is known of the stopwatch and of the drops.
    ///
    /// * `written`: smallest step in which intervals are written; s
    ///
    /// # Errors
    /// An option is no quantity of its kind.
    pub fn timing(&self, written: f64) -> Result<Timing, Error> {
        let or = |text: &Option<String>, option: &str, unit: &str| match text {
            Some(text) => at_least_zero(option, text, unit),
            None => Ok(0.0),
        };
        let known = positive_option("--resolution", self.resolution.as_deref(), "s")?;
        let gravity = positive_option("--gravity", self.gravity.as_deref(), "m/s^2")?;
        Ok(Timing {
            resolution: known.unwrap_or(written),
            trigger_sd: or(&self.trigger_sd, "--trigger-sd", "s")?,
            contact: or(&self.contact, "--contact", "s")?,
            gravity: gravity.unwrap_or(STANDARD_GRAVITY),
            height_sd: or(&self.height_sd, "--height-sd", "m")?,
        })
    }
}

/// An option above zero, in SI, where it is given.
pub(crate) fn positive_option(
    option: &str,
    text: Option<&str>,
    unit: &str,
) -> Result<Option<f64>, Error> {
    text.map(|text| positive(option, text, unit)).transpose()
}
