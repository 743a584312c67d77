//! `windfall laws`

use crate::args::laws::LawsArguments;
use crate::caller::told;
use crate::progress::with_bar;
use crate::show::{show, tell_unused};
use windfall_campaign::pipeline::request::{FitRequest, Reuse};
use windfall_population::ranking::run::rank_campaign;
use windfall_population::ranking::text::{csv_of_laws, text_of_laws};
use windfall_workspace::kept_work::kept;

/// Ranks laws over a campaign and shows the table.
pub fn run(arguments: &LawsArguments) -> anyhow::Result<()> {
    let request = FitRequest {
        laws: arguments.laws.clone(),
        free: arguments.free.clone(),
        quantities: arguments.quantities.clone(),
        figures: arguments.figures.clone(),
        reuse: if arguments.refit {
            Reuse::Nothing
        } else {
            Reuse::Unchanged
        },
        threads: arguments.threads,
        ..FitRequest::default()
    };
    let directory = &arguments.directory;
    let rank = || with_bar(|progress| rank_campaign(directory, &request, progress));
    let work = || kept(directory, ("laws", told()), rank);
    let outcome = show(&arguments.shown, work, text_of_laws, csv_of_laws)?;
    tell_unused(arguments.shown.format, &outcome.failed);
    Ok(())
}
