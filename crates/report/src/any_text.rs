//! What `fit` shows, whatever the campaign measures.

use windfall_campaign::impacts::csv::csv_of_campaign;
use windfall_campaign::impacts::text::text_of_campaign;
use windfall_campaign::settings::kind::CampaignKind;
use windfall_files::error::Error;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::taps::text::csv_of_acoustic;
use windfall_measure::text::{csv_of_measured, text_of_measured};

/// Tables for people.
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
