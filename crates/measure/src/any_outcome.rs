//! What `fit` gives, whatever the campaign measures.

use crate::measured::MeasuredOutcome;
use crate::text::finding_kinds_of_measured;
use serde::Serialize;
use windfall_campaign::impacts::findings::finding_kinds_of;
use windfall_campaign::result::outcome::{CampaignOutcome, StatusOutcome};
use windfall_files::finding_kind::FindingKind;
use windfall_files::found::FailureOutcome;

/// What `fit` gives, whatever the campaign measures.
///
/// In JSON every kind has `windfall`, `campaign`, `simulated`, `status`,
/// `impacts` (one entry per result), `failed`, `summary` and `findings`.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
#[serde(untagged)]
pub enum AnyOutcome {
    /// Laws fitted to single impacts.
    Impacts(Box<CampaignOutcome>),
    /// Values of recordings of another kind.
    Measured(Box<MeasuredOutcome>),
}

impl AnyOutcome {
    /// The outcome as indented JSON.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn json(&self) -> serde_json::Result<String> {
        match self {
            // Compiled where all of its parts are.
            Self::Impacts(own) => own.json(),
            Self::Measured(own) => serde_json::to_string_pretty(own),
        }
    }

    /// Its findings, each kind once with the impacts that have it: what `fit` prints.
    pub fn finding_kinds(&self) -> Vec<FindingKind> {
        match self {
            Self::Impacts(outcome) => finding_kinds_of(outcome),
            Self::Measured(outcome) => finding_kinds_of_measured(outcome),
        }
    }

    /// How the results came about.
    pub fn status(&self) -> &StatusOutcome {
        match self {
            Self::Impacts(outcome) => &outcome.status,
            Self::Measured(outcome) => &outcome.status,
        }
    }

    /// What could not be evaluated.
    pub fn failed(&self) -> &[FailureOutcome] {
        match self {
            Self::Impacts(outcome) => &outcome.failed,
            Self::Measured(outcome) => &outcome.failed,
        }
    }

    /// Number of results.
    pub fn results(&self) -> usize {
        match self {
            Self::Impacts(outcome) => outcome.impacts.len(),
            Self::Measured(outcome) => outcome.impacts.len(),
        }
    }
}
