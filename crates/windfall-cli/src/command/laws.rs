//! `windfall laws`

use crate::args::format::Format;
use crate::args::laws::LawsArguments;
use crate::command::fit::{moving, progress_bar};
use crate::show::{message, write_json, write_result};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_population::ranking::run::rank_campaign;
use windfall_population::ranking::text::{csv_of_laws, text_of_laws};

/// Ranks laws over a campaign and shows the table.
pub fn run(arguments: &LawsArguments) -> anyhow::Result<()> {
    let bar = progress_bar();
    let progress = moving(&bar);
    let request = FitRequest {
        laws: arguments.laws.clone(),
        free: arguments.free.clone(),
        quantities: arguments.quantities.clone(),
        figures: arguments.drawn.folder(),
        threads: arguments.threads,
        ..FitRequest::default()
    };
    let outcome = rank_campaign(&arguments.directory, &request, &progress)?;
    bar.finish_and_clear();
    match arguments.format {
        Format::Json => write_json(&outcome)?,
        Format::Csv => write_result(&csv_of_laws(&outcome)?)?,
        Format::Text => write_result(&text_of_laws(&outcome))?,
    }
    // The text shows them itself.
    if arguments.format != Format::Text {
        for failure in &outcome.failed {
            message(&format!("not used: {}: {}", failure.id, failure.message));
        }
    }
    Ok(())
}
