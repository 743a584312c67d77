//! `windfall card`

use crate::args::common::{CardAction, CardArguments};
use crate::args::format::Format;
use crate::command::geometry::run_transfer;
use crate::show::{show, write_json, write_result};
use windfall_cards::card_text::{csv_of_card, text_of_card};
use windfall_cards::library::laws::{csv_of_laws, law_cards, text_of_laws};
use windfall_cards::library::show::{LibraryRequest, show_library};
use windfall_cards::library::text::{csv_of_library, text_of_library};
use windfall_cards::read_card::read_card;

/// Shows force laws or published values, or transfers a law.
pub fn run(arguments: &CardArguments) -> anyhow::Result<()> {
    let (laws, law, format) = match &arguments.action {
        CardAction::Transfer(arguments) => return run_transfer(arguments),
        CardAction::Show {
            library: Some(name),
            fruit,
            at,
            format,
            ..
        } => {
            let request = LibraryRequest {
                name: name.clone(),
                fruit: fruit.clone(),
                at: at.clone(),
            };
            return run_library(&request, *format);
        }
        CardAction::Show {
            file: Some(file),
            format,
            ..
        } => {
            let card = read_card(file)?;
            return show(*format, &card, text_of_card, csv_of_card);
        }
        CardAction::Show {
            laws, law, format, ..
        } => (laws, law, format),
    };
    let laws = law_cards(law.as_deref(), laws.as_ref().and_then(Option::as_deref))?;
    match format {
        Format::Json => write_json(&serde_json::json!({ "laws": laws })),
        Format::Csv => write_result(&csv_of_laws(&laws)?),
        Format::Text => write_result(&text_of_laws(&laws)),
    }
}

/// Shows published values and models.
fn run_library(request: &LibraryRequest, format: Format) -> anyhow::Result<()> {
    let outcome = show_library(request)?;
    show(format, &outcome, text_of_library, csv_of_library)
}
