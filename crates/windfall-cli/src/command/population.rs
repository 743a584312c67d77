//! `windfall population`

use crate::args::format::Format;
use crate::args::population::PopulationArguments;
use crate::progress::with_bar;
use crate::show::{message, tell_failures, write_json, write_result};
use windfall_campaign::pipeline::request::{FitRequest, Reuse};
use windfall_cards::read_card::write_card;
use windfall_population::card::card_of_population;
use windfall_population::run::{PopulationRequest, population};
use windfall_population::text::{csv_of_population, text_of_population};

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
    let outcome = with_bar(|progress| population(&request, progress)).map_err(tell_failures)?;
    if let Some(path) = &request.card {
        write_card(
            path,
            &card_of_population(&request, &outcome, &windfall_files::progress::quiet)?,
        )?;
    }
    match arguments.format {
        Format::Json => write_json(&outcome)?,
        Format::Csv => write_result(&csv_of_population(&outcome)?)?,
        Format::Text => return write_result(&text_of_population(&outcome)),
    }
    for failure in &outcome.failed {
        message(&format!("left out: {}: {}", failure.id, failure.message));
    }
    Ok(())
}
