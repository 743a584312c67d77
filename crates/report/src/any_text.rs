//! What `fit` shows, whatever the campaign measures.

use std::path::Path;
use windfall_campaign::impacts::table::{ImpactTable, csv_of_campaign};
use windfall_campaign::impacts::text::text_of_campaign;
use windfall_campaign::settings::kind::CampaignKind;
use windfall_files::error::Error;
use windfall_files::sheet::form::Form;
use windfall_files::sheet::found::FoundTable;
use windfall_files::sheet::write::write_rows;
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

/// Writes the table of [`csv_of_any`] into a file; for programs that read columns with those that
/// are blank, so that all campaigns of a kind with the same laws have the same.
///
/// # Errors
/// The file may not be replaced, or cannot be written.
pub fn write_any(path: &Path, form: Form, outcome: &AnyOutcome) -> Result<(), Error> {
    match outcome {
        AnyOutcome::Impacts(own) => {
            let table = ImpactTable::of(own);
            let rows = own.impacts.iter().map(|impact| table.row(impact));
            write_rows(path, form, &table.schema, rows)
        }
        AnyOutcome::Measured(_) => {
            let table = FoundTable::read("fit", &csv_of_any(outcome)?)?;
            write_rows(path, form, &table.schema, table.rows())
        }
    }
}
