//! `windfall card`

use crate::args::{CardAction, CardArguments};
use crate::args_format::Format;
use crate::command_geometry::run_transfer;
use crate::show::{write_json, write_result};
use windfall::workflow_card::{csv_of_laws, law_cards, text_of_laws};

/// Shows force laws, or transfers one.
pub fn run(arguments: &CardArguments) -> anyhow::Result<()> {
    let (law, format) = match &arguments.action {
        CardAction::Show { law, format, .. } => (law, format),
        CardAction::Transfer(arguments) => return run_transfer(arguments),
    };
    let laws = law_cards(law.as_deref())?;
    match format {
        Format::Json => write_json(&serde_json::json!({ "laws": laws })),
        Format::Csv => write_result(&csv_of_laws(&laws)?),
        Format::Text => write_result(&text_of_laws(&laws)),
    }
}
