//! `windfall fit` as it is asked for, on top of what the campaign says.

use crate::campaign::Campaign;
use crate::error::Error;
use crate::option_value::{chosen, unusable};
use crate::read_fit::{
    ENDS, TREATMENTS, WEIGHTS, hold_velocity, known_velocity, quantities_named, unknown_parameter,
};
use crate::toml_source::suggestion;
use windfall_contact::expression::{LawExpression, parse_law};
use windfall_identify::problem::FitOptions;

/// What `fit` is asked for beyond what the campaign says.
#[derive(Clone, Debug, Default)]
pub struct FitRequest {
    /// Laws in place of those of the campaign; none keeps them.
    pub laws: Vec<String>,
    /// Parameters to estimate although they have a value; none keeps those of
    /// the campaign.
    pub free: Vec<String>,
    /// Quantities in place of those of the campaign; none keeps them.
    pub quantities: Vec<String>,
    /// Weights in place of the campaign's: a word of [`WEIGHTS`].
    pub weights: Option<String>,
    /// Treatment of the velocity at first touch: a word of [`TREATMENTS`], or the
    /// velocity to hold it at.
    pub initial_velocity: Option<String>,
    /// Treatment of the time of first touch.
    pub onset: Option<String>,
    /// Treatment of the zero of the displacement.
    pub displacement_offset: Option<String>,
    /// End of contact in place of the campaign's: a word of [`ENDS`].
    pub end: Option<String>,
    /// Column to group by in place of the campaign's.
    pub group: Option<String>,
    /// What becomes of results in the store.
    pub reuse: Reuse,
    /// Number of threads; all cores when `None`. It never changes a result.
    pub threads: Option<usize>,
}

/// What becomes of results in the store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reuse {
    /// Impacts that have not changed are answered from it.
    #[default]
    Unchanged,
    /// Every impact is fitted again.
    Nothing,
}

/// Puts what is asked for in the place of what the campaign says.
///
/// # Errors
/// An option cannot be used.
pub fn apply_request(campaign: &mut Campaign, request: &FitRequest) -> Result<(), Error> {
    apply_laws(campaign, request)?;
    apply_options(&mut campaign.fit.options, request)?;
    let Some(group) = &request.group else {
        return Ok(());
    };
    let names = group_columns(campaign);
    if !names.contains(&group.as_str()) {
        let problem = format!(
            "neither specimens.csv nor impacts.csv has this column{}; they have: {}",
            suggestion(group, names.iter().copied()),
            names.join(", ")
        );
        return Err(unusable(format!("--group {group}"), problem));
    }
    campaign.group = Some(group.clone());
    Ok(())
}

fn apply_laws(campaign: &mut Campaign, request: &FitRequest) -> Result<(), Error> {
    let plan = &mut campaign.fit;
    if !request.laws.is_empty() {
        plan.laws = laws_named(&request.laws)?;
        // The campaign's list may name parameters of laws that are not fitted now.
        let laws = &plan.laws;
        plan.free
            .retain(|name| unknown_parameter(std::slice::from_ref(name), laws).is_none());
    }
    if !request.free.is_empty() {
        if let Some((index, problem)) = unknown_parameter(&request.free, &plan.laws) {
            return Err(unusable(format!("--free {}", request.free[index]), problem));
        }
        plan.free.clone_from(&request.free);
    }
    Ok(())
}

fn laws_named(texts: &[String]) -> Result<Vec<LawExpression>, Error> {
    let mut laws: Vec<LawExpression> = Vec::new();
    for text in texts {
        let option = || format!("--law {text}");
        let law = parse_law(text).map_err(|error| unusable(option(), error.to_string()))?;
        // Results are told apart by the name of the law.
        if laws.iter().any(|known| known.kind == law.kind) {
            let problem = "this law is named twice; each law can be fitted once";
            return Err(unusable(option(), problem));
        }
        laws.push(law);
    }
    Ok(laws)
}

fn apply_options(options: &mut FitOptions, request: &FitRequest) -> Result<(), Error> {
    if !request.quantities.is_empty() {
        let words = request.quantities.iter().map(String::as_str);
        options.quantities = quantities_named(words)
            .map_err(|(word, problem)| unusable(format!("--quantities {word}"), problem))?;
    }
    if let Some(word) = &request.weights {
        options.weighting = chosen("--weights", word, &WEIGHTS)?;
    }
    if let Some(word) = &request.end {
        options.end = chosen("--end", word, &ENDS)?;
    }
    if let Some(text) = &request.initial_velocity {
        match known_velocity(text) {
            Some(known) => hold_velocity(options, known),
            None => {
                options.known_velocity = None;
                options.initial_velocity = chosen("--initial-velocity", text, &TREATMENTS)?;
            }
        }
    }
    let treatments = [
        ("--onset", &request.onset, &mut options.onset),
        (
            "--displacement-offset",
            &request.displacement_offset,
            &mut options.displacement_offset,
        ),
    ];
    for (option, word, treatment) in treatments {
        if let Some(word) = word {
            *treatment = chosen(option, word, &TREATMENTS)?;
        }
    }
    Ok(())
}

fn group_columns(campaign: &Campaign) -> Vec<&str> {
    let specimen = campaign.specimens.first().map_or(&[][..], |s| &s.cells);
    let impact = campaign.impacts.first().map_or(&[][..], |i| &i.cells);
    let cells = specimen.iter().chain(impact);
    cells.map(|(name, _)| name.as_str()).collect()
}
