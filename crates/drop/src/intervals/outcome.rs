//! What `windfall bounces` says. The names of the fields are the keys of its JSON; all numbers
//! are SI.

use crate::intervals::speed::SpeedOutcome;
use serde::Serialize;
use windfall_files::found::FindingOutcome;
use windfall_files::name::Name;

/// Drops, and what they say together.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct BouncesOutcome {
    /// Acceleration of gravity; m/s².
    pub gravity: f64,
    /// Step of the stopwatch; s.
    pub resolution: f64,
    /// Whether the step was taken from the digits that are written.
    pub resolution_from_digits: bool,
    /// Standard uncertainty of an instant, besides the step; s.
    pub trigger_sd: f64,
    /// Duration of a contact, taken off every interval; s.
    pub contact: f64,
    /// The drops, in the order of the tables.
    pub drops: Vec<TimedDropOutcome>,
    /// Mean of the drops that count; `None` where none does.
    pub mean: Option<MeanOutcome>,
    /// How restitution depends on speed, where that can be told.
    pub by_speed: Option<SpeedOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// One drop.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TimedDropOutcome {
    /// What it is called.
    pub drop: String,
    /// Times from impact to impact, `None` where one was not noticed; s.
    pub intervals: Vec<Option<f64>>,
    /// Height from which it fell, as given; m.
    pub height: Option<f64>,
    /// Geometric mean of the restitutions of its impacts; 1.
    pub restitution: f64,
    /// Its standard uncertainty from timing and height; 1.
    pub restitution_sd: f64,
    /// Height of a drop whose first impact had this restitution; m.
    pub height_estimate: Option<f64>,
    /// Its standard uncertainty from timing; m.
    pub height_estimate_sd: Option<f64>,
    /// Its impacts.
    pub impacts: Vec<TimedImpactOutcome>,
    /// First impact that is not used, as an interval after it is longer than the one before.
    pub unused_from: Option<usize>,
    /// Why the drop does not count; `None` for one that does.
    pub left_out: Option<String>,
    /// Other columns of its row in the table, with their cells.
    #[serde(skip)]
    pub labels: Vec<(Name, String)>,
}

/// One impact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TimedImpactOutcome {
    /// Its number; the drop ends in impact 1.
    pub impact: usize,
    /// Speed at which it is struck; m/s.
    pub speed: f64,
    /// Speed after it over speed before it; 1.
    pub restitution: f64,
    /// Its standard uncertainty from timing and height; 1.
    pub restitution_sd: f64,
    /// Height of the flight that follows; m.
    pub rebound_height: f64,
}

/// Restitution over drops, or over the impacts of a single one.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeanOutcome {
    /// "drops" or "impacts": what the spread is between.
    pub over: &'static str,
    /// How many of them.
    pub n: usize,
    /// Mean; 1.
    pub restitution: f64,
    /// Standard deviation; `None` for a single one. 1.
    pub sd: Option<f64>,
    /// Lower end of the mean's interval by Student's t; `None` for a single one. 1.
    pub low: Option<f64>,
    /// Upper end; 1.
    pub high: Option<f64>,
    /// Level of the interval.
    pub confidence: f64,
    /// Median; 1.
    pub median: f64,
    /// Median absolute deviation, scaled to the standard deviation of a normal distribution; 1.
    pub robust_sd: Option<f64>,
    /// Root mean square of the standard uncertainties from timing and height; 1.
    pub timing_sd: f64,
}
