//! `windfall card`

use crate::args::{CardAction, CardArguments};
use crate::args_format::Format;
use crate::show::{write_json, write_result};
use windfall::workflow_card::{csv_of_laws, law_cards, text_of_laws};

/// Shows force laws.
pub fn run(arguments: &CardArguments) -> anyhow::Result<()> {
    let CardAction::Show { law, format, .. } = &arguments.action;
    let laws = law_cards(law.as_deref())?;
    match format {
        Format::Json => write_json(&serde_json::json!({ "laws": laws })),
        Format::Csv => write_result(&csv_of_laws(&laws)?),
        Format::Text => write_result(&text_of_laws(&laws)),
    }
}
