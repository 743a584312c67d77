//! What `fit` gives, whatever the campaign measures.

use crate::outcome::{CampaignOutcome, FailureOutcome, StatusOutcome};
use serde::Serialize;

/// What `fit` gives, whatever the campaign measures.
///
/// In JSON every kind has `windfall`, `campaign`, `simulated`, `status`,
/// `impacts` (one entry per result), `failed`, `summary` and `findings`.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum AnyOutcome {
    /// Laws fitted to single impacts.
    Impacts(Box<CampaignOutcome>),
}

impl AnyOutcome {
    /// How the results came about.
    #[must_use]
    pub fn status(&self) -> &StatusOutcome {
        match self {
            Self::Impacts(outcome) => &outcome.status,
        }
    }

    /// What could not be evaluated.
    #[must_use]
    pub fn failed(&self) -> &[FailureOutcome] {
        match self {
            Self::Impacts(outcome) => &outcome.failed,
        }
    }

    /// Number of results.
    #[must_use]
    pub fn results(&self) -> usize {
        match self {
            Self::Impacts(outcome) => outcome.impacts.len(),
        }
    }
}
