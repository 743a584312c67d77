//! `windfall summary` and `windfall compare`

use crate::args::compare::{CompareArguments, Pairs, SummaryArguments};
use crate::show::show;
use windfall_tables::compare::agreement::{AgreementRequest, agreement};
use windfall_tables::compare::pairs::PairMethod;
use windfall_tables::compare::run::{CompareRequest, compare_groups};
use windfall_tables::compare::summary::{SummaryRequest, summarize_table};
use windfall_tables::compare::text::{
    csv_of_agreement, csv_of_compare, csv_of_summary, text_of_agreement, text_of_compare,
    text_of_summary,
};

/// Describes groups.
pub fn run_summary(arguments: &SummaryArguments) -> anyhow::Result<()> {
    let outcome = summarize_table(&SummaryRequest {
        table: arguments.table.clone(),
        by: names(&arguments.by),
        values: arguments.values.clone(),
        confidence: arguments.confidence,
    })?;
    show(arguments.format, &outcome, text_of_summary, csv_of_summary)
}

/// Compares groups, or predictions with what was measured.
pub fn run_compare(arguments: &CompareArguments) -> anyhow::Result<()> {
    if let (Some(measured), Some(predicted)) = (&arguments.measured, &arguments.predicted) {
        let outcome = agreement(&AgreementRequest {
            table: arguments.table.clone(),
            measured: measured.clone(),
            predicted: predicted.clone(),
            parameters: arguments.parameters,
        })?;
        return show(
            arguments.format,
            &outcome,
            text_of_agreement,
            csv_of_agreement,
        );
    }
    let outcome = compare_groups(&CompareRequest {
        table: arguments.table.clone(),
        value: arguments.value.clone().unwrap_or_default(),
        by: names(&arguments.by),
        paired: arguments.paired.clone(),
        specimen: arguments.specimen.clone(),
        method: match arguments.pairs {
            Pairs::Tukey => PairMethod::Tukey,
            Pairs::GamesHowell => PairMethod::GamesHowell,
            Pairs::Holm => PairMethod::Holm,
        },
        confidence: arguments.confidence,
    })?;
    show(arguments.format, &outcome, text_of_compare, csv_of_compare)
}

fn names(by: &[String]) -> Vec<String> {
    by.iter().map(|name| name.trim().to_owned()).collect()
}
