//! `windfall regress`

use crate::args::regress::RegressArguments;
use crate::show::show;
use windfall_tables::regress::mixed_text::{csv_of_mixed, text_of_mixed};
use windfall_tables::regress::run::{AnyRegressOutcome, regress};
use windfall_tables::regress::text::{csv_of_regress, text_of_regress};

/// A linear model of a table.
pub fn run(arguments: &RegressArguments) -> anyhow::Result<()> {
    let text = |outcome: &AnyRegressOutcome| match outcome {
        AnyRegressOutcome::Linear(own) => text_of_regress(own),
        AnyRegressOutcome::Mixed(own) => text_of_mixed(own),
    };
    let csv = |outcome: &AnyRegressOutcome| match outcome {
        AnyRegressOutcome::Linear(own) => csv_of_regress(own),
        AnyRegressOutcome::Mixed(own) => csv_of_mixed(own),
    };
    show(&arguments.shown, || regress(&arguments.request), text, csv)?;
    Ok(())
}
