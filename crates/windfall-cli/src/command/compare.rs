//! `windfall summary` and `windfall compare`

use crate::args::compare::{CompareArguments, SummaryArguments};
use crate::show::show;
use windfall_tables::compare::agreement::agreement;
use windfall_tables::compare::agreement_figure::draw_agreement;
use windfall_tables::compare::run::compare_groups;
use windfall_tables::compare::summary::summarize_table;
use windfall_tables::compare::text::{
    csv_of_agreement, csv_of_compare, csv_of_summary, text_of_agreement, text_of_compare,
    text_of_summary,
};

/// Describes groups.
pub fn run_summary(arguments: &SummaryArguments) -> anyhow::Result<()> {
    let outcome = summarize_table(&arguments.request)?;
    show(arguments.format, &outcome, text_of_summary, csv_of_summary)
}

/// Compares groups, or predictions with what was measured.
pub fn run_compare(arguments: &CompareArguments) -> anyhow::Result<()> {
    let (format, request) = (arguments.format, &arguments.request);
    if let Some(asked) = &arguments.agreement {
        let data = request.reading.read(&request.table)?;
        let outcome = agreement(&data, asked)?;
        if let Some(folder) = &request.figures {
            draw_agreement(folder, &data, asked)?;
        }
        return show(format, &outcome, text_of_agreement, csv_of_agreement);
    }
    let outcome = compare_groups(request)?;
    show(format, &outcome, text_of_compare, csv_of_compare)
}
