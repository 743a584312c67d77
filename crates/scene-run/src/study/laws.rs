//! Laws of a scene, resampled from the uncertainty that their cards state.

use crate::file::card::lower_factor;
use crate::file::read::ScenePlan;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_scene::draws::normals;

/// Streams of the seed for laws.
const STREAM: u64 = 1 << 34;

/// Draws the median law of each card from its covariance. Cards of one campaign are drawn
/// together: what was transferred from one law errs with it.
///
/// # Errors
/// A card's covariance is none, or gives parameters that its law cannot have.
pub fn draw_laws(plan: &mut ScenePlan, seed: u64) -> Result<(), Error> {
    let mut campaigns: Vec<&str> = plan
        .cards
        .values()
        .map(|own| &*own.origin.campaign)
        .collect();
    campaigns.sort_unstable();
    campaigns.dedup();
    for (pair, card) in &plan.cards {
        let (Some(covariance), Some(interaction)) =
            (&card.covariance, plan.scene.interactions.get_mut(pair))
        else {
            continue;
        };
        let wrong = |problem: String| unusable(format!("law card \"{}\"", card.title), problem);
        let factor = lower_factor(&covariance.matrix)
            .filter(|rows| rows.len() == covariance.of.len())
            .ok_or_else(|| wrong("[covariance] matrix is no covariance".to_owned()))?;
        let campaign = campaigns
            .iter()
            .position(|own| *own == card.origin.campaign);
        let stream = STREAM + campaign.unwrap_or(0) as u64;
        let draws = normals(seed, stream, factor.len());
        let kind = interaction.law.kind();
        let description = kind.describe();
        let names = &description.parameters;
        let mut values = interaction.law.parameters();
        for (of, row) in covariance.of.iter().zip(&factor) {
            let shift: f64 = row.iter().zip(&draws).map(|(l, z)| l * z).sum();
            let (name, logarithm) = match of.strip_prefix("ln ") {
                Some(name) => (name, true),
                None => (of.as_str(), false),
            };
            // What belongs to the fit alone, such as a mass factor, is no parameter.
            let Some(place) = names.iter().position(|own| own.name == name) else {
                continue;
            };
            values[place] = match logarithm {
                true => values[place] * shift.exp(),
                false => values[place] + shift,
            };
        }
        interaction.law = kind
            .with_parameters(&values)
            .map_err(|error| wrong(format!("drawn from its covariance: {error}")))?;
    }
    Ok(())
}

/// Pairs of materials whose law is taken as certain: no card, or one without covariance.
pub fn certain_laws(plan: &ScenePlan) -> Vec<String> {
    let certain = plan.scene.interactions.keys().filter(|pair| {
        let card = plan.cards.get(pair);
        card.is_none_or(|card| card.covariance.is_none())
    });
    let name = |material: usize| plan.scene.materials[material].as_str();
    certain
        .map(|pair| format!("{} and {}", name(pair.0), name(pair.1)))
        .collect()
}
