//! `windfall summary` and `windfall compare`

use crate::args::compare::{CompareArguments, SummaryArguments};
use crate::show::show;
use windfall_files::error::Error;
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
    let work = || summarize_table(&arguments.request);
    show(&arguments.shown, work, text_of_summary, csv_of_summary)?;
    Ok(())
}

/// Compares groups, or predictions with what was measured.
pub fn run_compare(arguments: &CompareArguments) -> anyhow::Result<()> {
    let (shown, request) = (&arguments.shown, &arguments.request);
    let Some(asked) = &arguments.agreement else {
        let work = || compare_groups(request);
        show(shown, work, text_of_compare, csv_of_compare)?;
        return Ok(());
    };
    let work = || {
        let data = request.reading.read(&request.table)?;
        let outcome = agreement(&data, asked)?;
        if let Some(folder) = &request.figures {
            draw_agreement(folder, &data, asked)?;
        }
        Ok::<_, Error>(outcome)
    };
    show(shown, work, text_of_agreement, csv_of_agreement)?;
    Ok(())
}
