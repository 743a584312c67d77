//! The result of `windfall laws`, as JSON shows it.

use serde::{Deserialize, Serialize};
use windfall_files::found::{FailureOutcome, FindingOutcome};

/// The result of `windfall laws`.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct LawsOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Impacts on which all laws are compared.
    pub impacts: usize,
    /// Velocity levels among them.
    pub levels: usize,
    /// One word: "sure", "undecided" or "divided".
    pub verdict: String,
    /// What the verdict means, in a sentence.
    pub meaning: String,
    /// Laws, the best first.
    pub laws: Vec<LawEvidenceOutcome>,
    /// How many specimens each law is first for, in the order of `laws`.
    pub specimens_first: Vec<usize>,
    /// Recordings that took no part.
    pub failed: Vec<FailureOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// Evidence of one impact for one law.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct ImpactEvidenceOutcome {
    /// The impact.
    pub id: String,
    /// AICc relative to the law that is best on this impact.
    pub aicc: f64,
}

/// Evidence for one law.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct LawEvidenceOutcome {
    /// The law.
    pub law: String,
    /// Impacts that it could not be fitted to.
    pub failed: usize,
    /// Free parameters of an impact.
    pub parameters_per_impact: f64,
    /// −2 ln likelihood relative to the best law.
    pub cost: f64,
    /// AICc relative to the best law.
    pub aicc: f64,
    /// Lower end of its 95 % interval over impacts like these, taken as independent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub aicc_low: Option<f64>,
    /// Its upper end.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub aicc_high: Option<f64>,
    /// AICc on each impact, relative to the best law there.
    pub impacts: Vec<ImpactEvidenceOutcome>,
    /// BIC relative to the best law.
    pub bic: f64,
    /// Share of resampled campaigns in which it is first.
    pub first_share: f64,
    /// Prediction error at held-out velocities, over the peak.
    pub prediction: Option<f64>,
    /// Its standard error.
    pub prediction_sd: Option<f64>,
    /// Largest residual over noise of a channel, mean over impacts.
    pub residual_ratio: f64,
    /// Runs-test score of the worst channel, mean over impacts.
    pub runs_z: f64,
}
