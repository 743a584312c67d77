//! What `fit` gives: saved in the store, shown as text, JSON or CSV.
//!
//! The names of the fields are the keys of the JSON that scripts rely on.
//! All numbers are SI.

use crate::result::interval_outcome::IntervalOutcome;
use serde::{Deserialize, Serialize};
use windfall_files::found::{EstimateOutcome, FailureOutcome, FindingOutcome, SpreadOutcome};
use windfall_files::name::Name;
use windfall_files::named::Named;
use windfall_identify::fit::result::PHASES;

/// How one quantity of the cost function fits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct ResidualOutcome {
    /// Samples.
    pub samples: usize,
    /// Weight of a square in the cost.
    pub weight: f64,
    /// Noise of a sample, from the recording itself.
    pub noise: f64,
    /// Correlation of the noise of successive samples that the fit reckoned
    /// with; 1.
    #[serde(default)]
    #[schema(required)]
    pub persistence: f64,
    /// Root mean square residual.
    pub rms: f64,
    /// Runs test: standardised number of runs; far below 0 when the residuals
    /// are not random.
    pub runs_z: Option<f64>,
    /// Mean residual over `rms` in each of eight equal parts of the contact; 1.
    #[serde(default)]
    #[schema(value_type = Vec<f64>)]
    #[schema(required)]
    pub by_phase: [f64; PHASES],
}

/// One law fitted to one impact.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct ImpactOutcome {
    /// Id of the impact.
    pub id: String,
    /// Id of the specimen.
    pub specimen: String,
    /// Group of the specimen or impact, where the campaign has groups.
    pub group: Option<String>,
    /// The recording, as impacts.csv names it.
    pub file: String,
    /// Name of the law.
    #[schema(value_type = String)]
    pub law: Name,
    /// Quantities in the cost function.
    #[schema(value_type = Vec<String>)]
    pub quantities: Vec<Name>,
    /// Parameters of the law, in its order.
    pub parameters: Named<EstimateOutcome>,
    /// Initial velocity, onset and offset, as far as they were estimated.
    pub nuisances: Named<EstimateOutcome>,
    /// Correlations of the estimates: "k, c".
    pub correlations: Named<f64>,
    /// Value of the cost function.
    pub cost: f64,
    /// Samples in it.
    pub samples: usize,
    /// Evaluations of the model.
    pub evaluations: usize,
    /// Whether a minimum was reached.
    pub converged: bool,
    /// Root of the cost.
    pub residual_norm: f64,
    /// How each quantity fits.
    pub residuals: Named<ResidualOutcome>,
    /// Parameters by the linear regression of the force, for comparison.
    pub regression: Named<EstimateOutcome>,
    /// Velocities, energies, peaks.
    pub derived: Named<Option<f64>>,
    /// Standard uncertainties of those read off the signals, where known.
    pub derived_sd: Named<f64>,
    /// "signal" or "fit" for each entry of `derived`.
    #[schema(value_type = Named<String>)]
    pub derived_from: Named<Name>,
    /// The same quantities in the motion under the fitted law; `restitution` is
    /// what the law delivers. A law that takes a restitution as a parameter has
    /// it here too, as `nominal_restitution`.
    pub fitted: Named<Option<f64>>,
    /// Combinations of parameters, from what the data tell least to what they tell
    /// best: the change of each that changes −2 ln of the likelihood by 1.
    #[serde(default)]
    #[schema(required)]
    pub directions: Vec<Named<f64>>,
    /// What one standard uncertainty of each quantity of the bench adds to each estimate. It is
    /// part of their deviations, and the same error in all impacts.
    #[serde(default)]
    #[schema(required)]
    pub common: Named<Named<f64>>,
    /// How the intervals came about.
    #[serde(default)]
    #[schema(required)]
    pub intervals: IntervalOutcome,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
    /// Why the impact does not count in means, cards and figures; nothing if it does.
    #[serde(default)]
    #[schema(required)]
    pub left_out: Vec<FindingOutcome>,
}

impl ImpactOutcome {
    /// Drops what only the impact's own view shows, so that many impacts are sent fast:
    /// nuisances except the onset, correlations, residuals, regression, directions, common
    /// errors, the fitted motion, where derived quantities come from and how sure they are,
    /// draws and profiles.
    pub fn abridge(&mut self) {
        self.nuisances
            .0
            .retain(|(name, _)| name.as_str() == "onset");
        self.correlations = Named::default();
        self.residuals = Named::default();
        self.regression = Named::default();
        self.derived_sd = Named::default();
        self.derived_from = Named::default();
        self.fitted = Named::default();
        self.directions = Vec::new();
        self.common = Named::default();
        self.intervals.drawn = Named::default();
        self.intervals.profiles = Named::default();
    }

    /// A derived quantity, where it is known.
    pub fn derived(&self, name: &str) -> Option<f64> {
        self.derived.get(name).copied().flatten()
    }

    /// A quantity in the motion under the fitted law, where it is known.
    pub fn fitted(&self, name: &str) -> Option<f64> {
        self.fitted.get(name).copied().flatten()
    }
}

/// Spread of parameters and derived quantities over the impacts of a group.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct GroupOutcome {
    /// Name of the group; `None` for all impacts together.
    pub group: Option<String>,
    /// Name of the law.
    pub law: String,
    /// Impacts that count.
    pub impacts: usize,
    /// Impacts that were fitted and do not count.
    #[serde(default)]
    #[schema(required)]
    pub left_out: usize,
    /// Specimens among them.
    pub specimens: usize,
    /// Parameters that were estimated.
    pub parameters: Named<SpreadOutcome>,
    /// Velocities, energies, peaks.
    pub derived: Named<SpreadOutcome>,
}

/// Parameters that all impacts on one specimen share.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct JointOutcome {
    /// Id of the specimen.
    pub specimen: String,
    /// Name of the law.
    pub law: String,
    /// Ids of the impacts.
    pub impacts: Vec<String>,
    /// Parameters that were estimated, in the order of the law.
    pub parameters: Named<EstimateOutcome>,
    /// Correlations of the estimates without what is common to all impacts: "k, c".
    pub correlations: Named<f64>,
    /// What one standard uncertainty of each quantity of the bench and each prior adds to each
    /// estimate; part of their deviations.
    pub common: Named<Named<f64>>,
    /// Sum of the squares of the impacts' departures from them, in their deviations; 1.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// Probability of as much by chance.
    pub p: f64,
    /// Factor on the deviations, where impacts differ by more than chance; 1.
    pub scale: f64,
}

/// How the results came about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct StatusOutcome {
    /// Fits done in this run.
    pub fitted: usize,
    /// Fits answered from the store.
    pub stored: usize,
    /// Impacts, or laws on an impact, that failed.
    pub failed: usize,
    /// Whether nothing had to be fitted.
    pub up_to_date: bool,
}

/// A value of the rig that was found from the recordings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct MassOutcome {
    /// Mass; kg.
    pub value: f64,
    /// Its standard uncertainty; kg.
    pub sd: f64,
    /// Impacts that it was found from; 0 for a mass that was weighed.
    pub impacts: usize,
}

/// A quantity of the bench, from all impacts together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct PooledOutcome {
    /// Weighted mean; SI.
    pub value: f64,
    /// Its standard uncertainty; SI.
    pub sd: f64,
    /// Impacts that it comes from.
    pub impacts: usize,
    /// Sum of the squares of their departures from the mean, in their deviations; 1.
    pub chi_square: f64,
}

/// A quantity of the bench that was estimated over all impacts.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct BenchOutcome {
    /// Value; SI.
    pub value: f64,
    /// Its standard uncertainty; SI.
    pub sd: f64,
    /// SI unit.
    pub unit: String,
    /// What campaign.toml says, where it says something; SI.
    pub told: Option<f64>,
    /// Impacts that it comes from.
    pub impacts: usize,
}

/// How a quantity that should be constant goes over a campaign.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct TrendOutcome {
    /// Name of the law.
    pub law: String,
    /// Parameter of the law, "restitution" or "force_gain".
    pub quantity: String,
    /// What it may depend on: "impact_velocity", "order" or "time_of_day".
    pub over: String,
    /// Change of the logarithm of the quantity: with ln of the velocity, from the first to the
    /// last row of impacts.csv, or per hour.
    pub slope: f64,
    /// Its standard uncertainty.
    pub sd: f64,
    /// Range of what it may depend on: of ln v, of the part of the campaign, or in hours.
    pub range: f64,
    /// Probability of as much by chance, times the number of slopes that were looked at.
    pub p: f64,
    /// Impacts.
    pub impacts: usize,
    /// Specimens.
    pub specimens: usize,
    /// Whether only differences between impacts on one specimen count.
    pub within_specimens: bool,
    /// Correlation of the order of impacts with what the quantity is shown over; 1 for order.
    pub order_correlation: f64,
}

/// Everything that `fit` gives for a campaign.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct CampaignOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Remark on the campaign.
    #[serde(default)]
    pub note: Option<String>,
    /// Effective mass at the contact.
    pub effective_mass: MassOutcome,
    /// Gain and delay of the force over all impacts, by Newton's law: "force_gain",
    /// "force_delay".
    #[serde(default)]
    #[schema(required)]
    pub bench: Named<PooledOutcome>,
    /// Quantities of the bench that were estimated over all impacts: "inertia".
    #[serde(default)]
    #[schema(required)]
    pub estimated: Named<BenchOutcome>,
    /// Slopes of parameters over velocity, and of parameters, restitution and the gain of the
    /// force over order and time of day.
    #[serde(default)]
    #[schema(required)]
    pub trends: Vec<TrendOutcome>,
    /// How the results came about.
    pub status: StatusOutcome,
    /// One entry per impact and law.
    pub impacts: Vec<ImpactOutcome>,
    /// What could not be fitted.
    pub failed: Vec<FailureOutcome>,
    /// Spread over all impacts, of the first law.
    pub summary: Named<SpreadOutcome>,
    /// Spread per group and law.
    pub groups: Vec<GroupOutcome>,
    /// One law for all impacts on a specimen, where that was asked for.
    #[serde(default)]
    #[schema(required)]
    pub joint: Vec<JointOutcome>,
    /// What a reader of the whole must know.
    pub findings: Vec<FindingOutcome>,
}

impl CampaignOutcome {
    /// The outcome as indented JSON.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(self)
    }
}
