//! `windfall regress`

use crate::args::format::Format;
use crate::args::regress::RegressArguments;
use crate::show::{write_json, write_result};
use windfall_tables::regress::mixed_text::{csv_of_mixed, text_of_mixed};
use windfall_tables::regress::run::{AnyRegressOutcome, regress};
use windfall_tables::regress::text::{csv_of_regress, text_of_regress};

/// A linear model of a table.
pub fn run(arguments: &RegressArguments) -> anyhow::Result<()> {
    let outcome = regress(&arguments.request)?;
    match (arguments.format, &outcome) {
        (Format::Json, _) => write_json(&outcome),
        (Format::Csv, AnyRegressOutcome::Linear(own)) => write_result(&csv_of_regress(own)?),
        (Format::Csv, AnyRegressOutcome::Mixed(own)) => write_result(&csv_of_mixed(own)?),
        (Format::Text, AnyRegressOutcome::Linear(own)) => write_result(&text_of_regress(own)),
        (Format::Text, AnyRegressOutcome::Mixed(own)) => write_result(&text_of_mixed(own)),
    }
}
