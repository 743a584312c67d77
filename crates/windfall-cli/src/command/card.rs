//! `windfall card`

use crate::args::common::{CardAction, CardArguments};
use crate::command::geometry::run_transfer;
use crate::outcome::Laws;
use crate::show::show;
use windfall_cards::card_text::{csv_of_card, text_of_card};
use windfall_cards::library::laws::{csv_of_laws, law_cards, text_of_laws};
use windfall_cards::library::show::{LibraryRequest, show_library};
use windfall_cards::library::text::{csv_of_library, text_of_library};
use windfall_cards::read_card::read_card;

/// Shows force laws or published values, or transfers a law.
pub fn run(arguments: &CardArguments) -> anyhow::Result<()> {
    match &arguments.action {
        CardAction::Transfer(arguments) => run_transfer(arguments)?,
        CardAction::Show {
            library: Some(name),
            fruit,
            at,
            shown,
            ..
        } => {
            let request = LibraryRequest {
                name: name.clone(),
                fruit: fruit.clone(),
                at: at.clone(),
            };
            let work = || show_library(&request);
            show(shown, work, text_of_library, csv_of_library)?;
        }
        CardAction::Show {
            file: Some(file),
            shown,
            ..
        } => {
            show(shown, || read_card(file), text_of_card, csv_of_card)?;
        }
        CardAction::Show {
            laws, law, shown, ..
        } => {
            let file = laws.as_ref().and_then(Option::as_deref);
            let work = || law_cards(law.as_deref(), file).map(|laws| Laws { laws });
            let text = |own: &Laws| text_of_laws(&own.laws);
            show(shown, work, text, |own| csv_of_laws(&own.laws))?;
        }
    }
    Ok(())
}
