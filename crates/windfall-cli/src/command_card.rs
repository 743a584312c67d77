//! `windfall card`

use crate::args::{CardAction, CardArguments};
use crate::args_format::Format;
use crate::command_geometry::run_transfer;
use crate::show::{write_json, write_result};
use windfall::read_card::read_card;
use windfall::workflow_card::{csv_of_laws, law_cards, text_of_laws};
use windfall::workflow_library::{LibraryRequest, show_library};
use windfall::write_law_card::{csv_of_card, text_of_card};
use windfall::write_library::{csv_of_library, text_of_library};

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
            return match format {
                Format::Json => write_json(&card),
                Format::Csv => write_result(&csv_of_card(&card)?),
                Format::Text => write_result(&text_of_card(&card)),
            };
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
    match format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&csv_of_library(&outcome)?),
        Format::Text => write_result(&text_of_library(&outcome)),
    }
}
