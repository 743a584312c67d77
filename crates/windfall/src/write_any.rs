//! What `fit` shows, whatever the campaign measures.

use crate::any_outcome::AnyOutcome;
use crate::campaign_kind::CampaignKind;
use crate::error::Error;
use crate::write_acoustic::csv_of_acoustic;
use crate::write_csv::csv_of_campaign;
use crate::write_measured::{csv_of_measured, text_of_measured};
use crate::write_text::text_of_campaign;

/// Tables for people.
#[must_use]
pub fn text_of_any(outcome: &AnyOutcome) -> String {
    match outcome {
        AnyOutcome::Impacts(outcome) => text_of_campaign(outcome),
        AnyOutcome::Measured(outcome) => text_of_measured(outcome),
    }
}

/// One line per result, for other programs.
///
/// # Errors
/// The table cannot be written.
pub fn csv_of_any(outcome: &AnyOutcome) -> Result<String, Error> {
    match outcome {
        AnyOutcome::Impacts(outcome) => csv_of_campaign(outcome),
        AnyOutcome::Measured(outcome) if outcome.kind == CampaignKind::Acoustic.name() => {
            csv_of_acoustic(outcome)
        }
        AnyOutcome::Measured(outcome) => csv_of_measured(outcome),
    }
}
