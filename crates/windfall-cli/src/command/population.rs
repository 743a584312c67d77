//! `windfall population`

use crate::args::format::Format;
use crate::args::population::PopulationArguments;
use crate::caller::told;
use crate::progress::with_bar;
use crate::show::{message, show, tell_failures};
use windfall_campaign::pipeline::request::{FitRequest, Reuse};
use windfall_cards::read_card::write_card;
use windfall_files::error::Error;
use windfall_files::progress::quiet;
use windfall_population::card::card_of_population;
use windfall_population::run::{PopulationRequest, population};
use windfall_population::text::{csv_of_population, text_of_population};
use windfall_workspace::kept_work::kept;

/// Estimates a population and shows it.
pub fn run(arguments: &PopulationArguments) -> anyhow::Result<()> {
    let request = PopulationRequest {
        directory: arguments.directory.clone(),
        fit: FitRequest {
            laws: arguments.law.iter().cloned().collect(),
            free: arguments.free.clone(),
            reuse: if arguments.refit {
                Reuse::Nothing
            } else {
                Reuse::Unchanged
            },
            threads: arguments.threads,
            draws: arguments.draws,
            seed: arguments.seed,
            ..FitRequest::default()
        },
        covariates: arguments.covariates.clone(),
        posterior: arguments.posterior,
        detail: arguments.detail.clone(),
        card: arguments.card.clone(),
    };
    let estimate = || {
        let outcome = with_bar(|progress| population(&request, progress)).map_err(tell_failures)?;
        if let Some(path) = &request.card {
            write_card(path, &card_of_population(&request, &outcome, &quiet)?)?;
        }
        Ok::<_, Error>(outcome)
    };
    let work = || kept(&request.directory, ("population", told()), estimate);
    let outcome = show(
        &arguments.shown,
        work,
        text_of_population,
        csv_of_population,
    )?;
    // The text shows them itself.
    if arguments.shown.format != Format::Text {
        for failure in &outcome.failed {
            message(&format!("left out: {}: {}", failure.id, failure.message));
        }
    }
    Ok(())
}
