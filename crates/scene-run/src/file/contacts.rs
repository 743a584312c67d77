//! `[[contacts]]` of scene.toml.

use crate::file::card::spread_of_card;
use crate::file::key::Section;
use crate::file::scene::ContactFile;
use std::collections::BTreeMap;
use windfall_cards::law_card::LawCard;
use windfall_cards::law_use::complete_law_among;
use windfall_cards::read_card::{law_of_card, read_card};
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::TomlSource;
use windfall_scene::annuli::MOST_ANNULI;
use windfall_scene::interaction::{Interaction, mindlin_ratio};

/// What `[[contacts]]` say, by the pair of materials.
#[derive(Default)]
pub(crate) struct Contacts {
    /// How they interact.
    pub interactions: BTreeMap<(usize, usize), Interaction>,
    /// Law cards, where laws come from cards.
    pub cards: BTreeMap<(usize, usize), LawCard>,
    /// Part of the absorbed energy that a fruit takes, where the file says so; 1.
    pub fruit_shares: BTreeMap<(usize, usize), f64>,
}

/// Reads all contacts.
///
/// # Errors
/// Something is missing or invalid, or a pair is there twice.
pub(crate) fn contacts_of(
    source: &TomlSource,
    contacts: &[Spanned<ContactFile>],
    materials: &[String],
) -> Result<Contacts, Error> {
    let mut all = Contacts::default();
    for contact in contacts {
        let table = Section {
            source,
            name: "[[contacts]]",
            at: contact.span(),
        };
        let (pair, interaction, card) = contact_of(&table, contact.get_ref(), materials)?;
        if all.interactions.insert(pair, interaction).is_some() {
            let problem = "these two materials stand in more than one [[contacts]]";
            let names = format!("{}, {}", materials[pair.0], materials[pair.1]);
            return Err(table.refused(&table.at, "between", names, problem));
        }
        all.cards.extend(card.map(|card| (pair, card)));
        if let Some(share) = &contact.get_ref().fruit_share {
            let value = *share.get_ref();
            if !(0.0..=1.0).contains(&value) {
                let problem = "a share lies between 0 and 1";
                return Err(table.refused(&share.span(), "fruit_share", value, problem));
            }
            all.fruit_shares.insert(pair, value);
        }
    }
    Ok(all)
}

type Found = ((usize, usize), Interaction, Option<LawCard>);

fn contact_of(table: &Section, file: &ContactFile, materials: &[String]) -> Result<Found, Error> {
    let Some(between) = &file.between else {
        let example = "between = [\"apple\", \"steel\"]";
        return Err(table.lacks("between", "the two materials", example));
    };
    let [a, b] = between.get_ref();
    let own = |name| table.material(&between.span(), "between", name, materials);
    let (a, b) = (own(a)?, own(b)?);
    let mut seen = table.above_zero(&file.effective_radius, "effective_radius", "m")?;
    let mut card = None;
    let mut spread = None;
    let law = match (&file.card, &file.law) {
        (Some(name), None) => {
            let path = table.named_file("card", name)?;
            let own = read_card(&path)?;
            let law = law_of_card(&own, &path)?;
            seen = seen.or(own.contact.as_ref().map(|contact| contact.effective_radius));
            spread = spread_of_card(&own, &law, &path)?;
            card = Some(own);
            law
        }
        (None, Some(law)) => {
            let text = law.get_ref();
            complete_law_among(text, &[])
                .map_err(|error| table.refused(&law.span(), "law", text, error.to_string()))?
        }
        _ => {
            let example = "card = \"apple.toml\"   or   law = \"kuwabara-kono(k=753599, c=1524)\"";
            return Err(table.lacks("card", "a law card, or a law", example));
        }
    };
    let or = |value, key, usual: f64| {
        Ok::<f64, Error>(table.number_from_zero(value, key)?.unwrap_or(usual))
    };
    let interaction = Interaction {
        law,
        effective_radius: seen,
        spread,
        friction: or(&file.friction, "friction", 0.0)?,
        tangential_ratio: tangential_ratio(table, file)?,
        tangential_damping: or(&file.tangential_damping, "tangential_damping", 1.0)?,
        annuli: annuli(table, file)?,
        rolling: or(&file.rolling, "rolling", 0.0)?,
    };
    Ok(((a.min(b), a.max(b)), interaction, card))
}

/// Tangential over normal stiffness, or what Poisson's ratio makes of it.
fn tangential_ratio(table: &Section, file: &ContactFile) -> Result<f64, Error> {
    let ratio = table.number_from_zero(&file.tangential_ratio, "tangential_ratio")?;
    let Some(poisson) = &file.poisson else {
        return Ok(ratio.unwrap_or_else(|| mindlin_ratio(DEFAULT_POISSON)));
    };
    let value = *poisson.get_ref();
    let problem = match ratio {
        Some(_) => "poisson and tangential_ratio say the same: leave one out",
        None if (-1.0..=0.5).contains(&value) => return Ok(mindlin_ratio(value)),
        None => "Poisson's ratio lies between -1 and 0.5",
    };
    Err(table.refused(&poisson.span(), "poisson", value, problem))
}

fn annuli(table: &Section, file: &ContactFile) -> Result<usize, Error> {
    let Some(annuli) = &file.annuli else {
        return Ok(DEFAULT_ANNULI);
    };
    match *annuli.get_ref() {
        own @ 1..=MOST_ANNULI => Ok(own),
        own => {
            let problem = format!("annuli of a contact area are 1 to {MOST_ANNULI}");
            Err(table.refused(&annuli.span(), "annuli", own, problem))
        }
    }
}

/// Annuli of a contact area where their number is not given.
const DEFAULT_ANNULI: usize = 4;
/// Poisson's ratio where none is given; 1.
const DEFAULT_POISSON: f64 = 0.3;
