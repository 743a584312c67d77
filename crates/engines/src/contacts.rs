//! The contacts of a scene in the terms of engines that windfall does not run.

use crate::delivered::text_of_delivered;
use crate::parameters::{ContactTerms, Other, contact_terms, text_of_terms};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::write_file::write_whole;
use windfall_scene_run::file::read::{ScenePlan, read_scene};
use windfall_scene_run::file_error::make_directory;

/// Contacts that were written.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct ContactsOutcome {
    /// The engine.
    pub engine: String,
    /// The file.
    #[schema(value_type = String)]
    pub file: PathBuf,
    /// Each pair of materials.
    pub contacts: Vec<ContactTerms>,
}

/// How far the delivered restitution may be off the law's in the range of its card; 1.
pub const MOST: f64 = 0.01;

/// Whether every law with a card is delivered in the range of it.
fn check(
    other: Other,
    contacts: &[ContactTerms],
    ranges: &BTreeMap<(usize, usize), [f64; 2]>,
    plan: &ScenePlan,
) -> Result<(), Error> {
    let has_range = |own: &&ContactTerms| {
        let mut pairs = ranges.keys();
        pairs.any(|(a, b)| [*a, *b].map(|at| &plan.scene.materials[at]) == own.between.each_ref())
    };
    let off = |own: &&ContactTerms| own.delivered.iter().any(|own| own.error() > MOST);
    let off: Vec<String> = contacts
        .iter()
        .filter(|own| has_range(own) && off(own))
        .map(|own| {
            let [a, b] = &own.between;
            format!("\n  - {a} and {b}: {}", text_of_delivered(&own.delivered))
        })
        .collect();
    match off.is_empty() {
        true => Ok(()),
        false => Err(unusable(
            format!("--engine {}", other.title().to_lowercase()),
            format!(
                "{} has no damping of this law's kind, and the restitution that it would deliver \
                 is not within 1 % of the law's in the range of its card: give --speed V for a \
                 contact that is right at V m/s alone, or take an engine that has the law \
                 (lammps, liggghts, chrono){}",
                other.title(),
                off.concat()
            ),
        )),
    }
}

/// Writes the contacts of a scene in the terms of another engine.
///
/// * `out`: directory to write into; that of the file where it is left out
/// * `speed`: impact speed at which damping that is not the law's takes the same energy, m/s;
///   where it is left out, the middle of the range of the law's card
///
/// # Errors
/// The scene cannot be used; the file cannot be written; without a speed, what the engine
/// delivers is off by more than [`MOST`] somewhere in the range of the law's card.
pub fn export_contacts(
    path: &Path,
    other: Other,
    out: Option<&Path>,
    speed: Option<f64>,
) -> Result<ContactsOutcome, Error> {
    let plan = read_scene(path)?;
    let cards = plan.cards.iter();
    let ranges: BTreeMap<_, _> = cards
        .map(|(pair, card)| (*pair, card.range.impact_velocity))
        .collect();
    let contacts = contact_terms(other, &plan.scene, speed, &ranges);
    if speed.is_none() && !ranges.is_empty() {
        check(other, &contacts, &ranges, &plan)?;
    }
    let (name, _) = other.file();
    let file = match out {
        Some(out) => {
            make_directory(out)?;
            out.join(name)
        }
        None => path.with_file_name(name),
    };
    let text = text_of_terms(other, &plan.title, &contacts);
    write_whole(&file, text.as_bytes())?;
    Ok(ContactsOutcome {
        engine: other.title().to_owned(),
        file,
        contacts,
    })
}
