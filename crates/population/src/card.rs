//! The law card of a population: median fruit, how fruit differ, what covariates
//! change.

use crate::outcome::{Population, PopulationOutcome, PopulationParameter};
use crate::run::PopulationRequest;
use windfall_campaign::impacts::card::{card_of_fit, law_of_medians};
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::apply_request;
use windfall_campaign::settings::read::read_campaign;
use windfall_cards::law_card::{
    CardCovariance, CardCovariate, CardParameter, CardPopulation, LawCard, labels_of,
};
use windfall_contact::expression::LawExpression;
use windfall_files::error::Error;
use windfall_files::progress::Progress;

/// The card of a population: the range in which the law was seen is that of the
/// fits of its impacts, which are taken from the store or made.
///
/// # Errors
/// As [`fit_campaign`] and [`card_of_fit`].
pub fn card_of_population(
    request: &PopulationRequest,
    outcome: &PopulationOutcome,
    progress: Progress,
) -> Result<LawCard, Error> {
    let mut campaign = read_campaign(&request.directory)?;
    apply_request(&mut campaign, &request.fit)?;
    campaign.fit.laws.truncate(1);
    let law = campaign.fit.laws[0].to_string();
    let mut fit = request.fit.clone();
    fit.laws = vec![law];
    let fitted = fit_campaign(&request.directory, &fit, progress)?;
    let mut card = card_of_fit(&campaign, &fitted)?;
    let kind = campaign.fit.laws[0].kind;
    let mut values: Vec<f64> = kind
        .describe()
        .parameters
        .iter()
        .map(|p| card.parameters.get(p.name).map_or(f64::NAN, |c| c.value))
        .collect();
    for (place, described) in kind.describe().parameters.iter().enumerate() {
        let estimated = outcome.parameters.iter().find(|p| p.name == described.name);
        if let Some(parameter) = estimated {
            values[place] = parameter.median.value;
            card.parameters
                .insert(described.name.to_owned(), card_parameter(parameter));
        }
    }
    let law = law_of_medians(&campaign, kind, &values)?;
    card.expression = LawExpression::from(law).to_string();
    card.covariance = Some(median_covariance(&outcome.population));
    card.cautions = outcome.findings.iter().map(|f| f.message.clone()).collect();
    card.bodies.specimens = outcome.fruits;
    card.bodies.recordings = outcome.impacts;
    card.origin.method = outcome.method.clone();
    card.population = Some(card_population(&outcome.population));
    Ok(card)
}

fn card_parameter(parameter: &PopulationParameter) -> CardParameter {
    let interval = parameter.median.low.zip(parameter.median.high);
    CardParameter {
        value: parameter.median.value,
        unit: parameter.unit.clone(),
        // Half the interval over the normal quantile: the standard uncertainty.
        sd: interval.map(|(low, high)| (high - low) / (2.0 * 1.96)),
        interval: interval.map(|(low, high)| [low, high]),
    }
}

/// Covariance of the medians on the scale of the deviations.
fn median_covariance(population: &Population) -> CardCovariance {
    CardCovariance {
        of: labels_of(&population.parameters, &population.logarithmic),
        matrix: population.median_covariance.clone(),
        of_what: "the median fruit".to_owned(),
    }
}

fn card_population(population: &Population) -> CardPopulation {
    let labels = labels_of(&population.parameters, &population.logarithmic);
    let covariates = population.covariates.iter().flat_map(|covariate| {
        let effects = covariate.effects.iter().zip(&covariate.sds);
        effects
            .zip(&labels)
            .map(|((effect, sd), on)| CardCovariate {
                name: covariate.name.clone(),
                unit: "as in the campaign".to_owned(),
                on: on.clone(),
                centre: covariate.centre,
                effect: *effect,
                sd: Some(*sd),
            })
    });
    CardPopulation {
        covariates: covariates.collect(),
        of: labels.clone(),
        median: population.median.clone(),
        between_fruit: population.between.clone(),
        within_fruit: Some(population.within.clone()),
        fruit: population.fruits,
        impacts: population.impacts,
        method: population.method.clone(),
    }
}
