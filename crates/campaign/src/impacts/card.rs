//! The law card of a campaign of fitted impacts: the median fruit, how fruit
//! differ, and in what the law was seen.

use crate::impacts::two_stage::{Estimates, Population, two_stage};
use crate::result::counted::reasons_counted;
use crate::result::given::held_together;
use crate::result::outcome::{CampaignOutcome, ImpactOutcome};
use crate::result::summary::common_moves;
use crate::settings::model::{Campaign, ImpactCampaign, RigPlan};
use std::collections::BTreeMap;
use windfall_cards::law_card::{
    CARD_FORMAT, CardBodies, CardCovariance, CardOrigin, CardParameter, CardPopulation, CardRange,
    LawCard, labels_of, range_of_values,
};
use windfall_cards::law_use::end_name;
use windfall_cards::read_card::card_definition;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_files::error::Error;
use windfall_files::named::grouped;
use windfall_files::provenance::{VERSION, digest_file, time_now};

/// Files whose digests a card carries.
const FILES: [&str; 3] = ["campaign.toml", "impacts.csv", "specimens.csv"];
/// Normal quantile of 95 %; 1.
const QUANTILE: f64 = 1.96;

/// The law of a campaign as a card: the median over its fruit.
///
/// # Errors
/// More than one law was fitted, or no impact counts.
pub fn card_of_fit(campaign: &ImpactCampaign, outcome: &CampaignOutcome) -> Result<LawCard, Error> {
    let unknown = |missing: &str, advice| Error::not_known(&campaign.shared.title, missing, advice);
    let [asked] = &campaign.fit.laws[..] else {
        let advice = "name one, as in `windfall fit DIR --law kuwabara-kono --card FILE`";
        return Err(unknown(
            "a card is of one law, and several were fitted",
            advice,
        ));
    };
    let kind = asked.kind;
    let mut impacts: Vec<&ImpactOutcome> = outcome.impacts.iter().collect();
    let all = impacts.len();
    if all == 0 {
        return Err(Error::NothingFitted {
            path: campaign.shared.directory.clone(),
            failures: outcome.failed.clone(),
        });
    }
    impacts.retain(|impact| impact.counts());
    if impacts.is_empty() {
        let advice = "`windfall fit DIR` says why each is left out";
        return Err(unknown("no impact counts, so there is no law", advice));
    }
    let estimates = estimates_of(&impacts);
    let mut population = two_stage(&estimates);
    let held = held_together(&campaign.fit, kind, &impacts);
    if !held.is_empty() {
        population.between = None;
        population.method = format!(
            "nothing is said of how fruit differ, since a prior holds their estimates of {} \
             together",
            held.join(" and ")
        );
    }
    let common = add_common(&mut population.of_mean, &estimates, &impacts);
    let law = law_of(campaign, kind, &impacts, &estimates, &population)?;
    let mut cautions: Vec<String> = outcome.findings.iter().map(|f| f.message.clone()).collect();
    if impacts.len() < all {
        cautions.push(format!(
            "{} of {all} impacts do not count and are left out: {}",
            all - impacts.len(),
            reasons_counted(&outcome.impacts)
        ));
    }
    // What the method leaves out, where it leaves something out.
    if population.between.is_none() || population.method.contains(';') {
        cautions.push(population.method.clone());
    }
    Ok(LawCard {
        format: CARD_FORMAT,
        title: campaign.shared.title.clone(),
        law: kind.name().to_owned(),
        expression: LawExpression::from(law).to_string(),
        end: end_name(campaign.fit.options.end).to_owned(),
        cautions,
        parameters: parameters_of(&law, &estimates, &population),
        covariance: Some(CardCovariance {
            of: labels_of(&estimates.names, &estimates.logarithmic),
            matrix: population.of_mean.clone(),
            of_what: match common {
                true => {
                    "the median fruit, by the scatter between fruit and the uncertainty of \
                         the bench and of priors"
                }
                false => "the median fruit, by the scatter between fruit",
            }
            .to_owned(),
        })
        .filter(|covariance| covariance.matrix.iter().flatten().all(|v| v.is_finite())),
        range: range_of(outcome, &impacts),
        bodies: CardBodies {
            impactor: impactor(campaign).to_owned(),
            target: "fruit".to_owned(),
            effective_mass_factor: 1.0,
            specimens: population.fruit,
            recordings: impacts.len(),
            radius: None,
        },
        origin: card_origin(
            &campaign.shared,
            "each impact fitted, then the median over fruit",
        )?,
        contact: None,
        population: card_population(&estimates, &population, impacts.len()),
        definition: card_definition(kind),
    })
}

fn impactor(campaign: &ImpactCampaign) -> &'static str {
    match campaign.rig {
        RigPlan::Pendulum(_) => "impactor of a pendulum",
        RigPlan::Carriage { .. } => "impactor on a line",
    }
}

/// Adds to a covariance what the uncertainties of the bench do to all fruit alike, which no
/// number of them makes smaller; whether there was any.
fn add_common(
    covariance: &mut [Vec<f64>],
    estimates: &Estimates,
    impacts: &[&ImpactOutcome],
) -> bool {
    let names = estimates.names.iter().map(String::as_str);
    let parameters: Vec<(&str, bool)> = names.zip(estimates.logarithmic.iter().copied()).collect();
    let moves = common_moves(impacts, &parameters);
    for moved in &moves {
        add_outer(covariance, moved);
    }
    !moves.is_empty()
}

/// Adds v vᵀ to a matrix.
pub fn add_outer(matrix: &mut [Vec<f64>], v: &[f64]) {
    for (row, by_row) in matrix.iter_mut().zip(v) {
        for (cell, by_column) in row.iter_mut().zip(v) {
            *cell += by_row * by_column;
        }
    }
}

/// What was estimated on each impact, by fruit; positive scales as logarithms.
fn estimates_of(impacts: &[&ImpactOutcome]) -> Estimates {
    let estimated = impacts[0].parameters.0.iter();
    let estimated: Vec<_> = estimated.filter(|(_, estimate)| !estimate.held).collect();
    let value = |impact: &ImpactOutcome, name: &str| {
        impact.parameters.get(name).map_or(f64::NAN, |e| e.value)
    };
    let positive = |name: &str| impacts.iter().all(|impact| value(impact, name) > 0.0);
    let logarithmic = estimated
        .iter()
        .map(|(name, e)| e.unit != "1" && positive(name));
    let logarithmic: Vec<bool> = logarithmic.collect();
    let row = |impact: &ImpactOutcome| -> Vec<f64> {
        let values = estimated.iter().map(|(name, _)| value(impact, name));
        let pairs = values.zip(&logarithmic);
        pairs
            .map(|(value, logarithmic)| if *logarithmic { value.ln() } else { value })
            .collect()
    };
    let rows = impacts.iter().map(|impact| (&impact.specimen, row(impact)));
    let fruit = grouped(rows).into_iter().map(|(_, rows)| rows);
    Estimates {
        fruit: fruit.collect(),
        logarithmic,
        names: estimated.iter().map(|(name, _)| name.to_string()).collect(),
    }
}

/// The law at the median of what was estimated; what was held as it was.
fn law_of(
    campaign: &ImpactCampaign,
    kind: LawKind,
    impacts: &[&ImpactOutcome],
    estimates: &Estimates,
    population: &Population,
) -> Result<Law, Error> {
    let medians = estimates.values(&population.mean);
    let values: Vec<f64> = kind
        .describe()
        .parameters
        .iter()
        .map(|parameter| {
            let place = estimates.names.iter().position(|n| n == parameter.name);
            match place {
                Some(place) => medians[place],
                // Held, or following each impact: the mean.
                None => {
                    let found = impacts
                        .iter()
                        .filter_map(|i| i.parameters.get(parameter.name));
                    found.map(|e| e.value).sum::<f64>() / impacts.len() as f64
                }
            }
        })
        .collect();
    law_of_medians(campaign, kind, &values)
}

/// The law with the medians of its parameters.
///
/// # Errors
/// They make no law.
pub fn law_of_medians(
    campaign: &ImpactCampaign,
    kind: LawKind,
    values: &[f64],
) -> Result<Law, Error> {
    kind.with_parameters(values).map_err(|error| {
        let missing = format!("the median of its parameters is no law ({error})");
        let advice = "look at the impacts one by one: `windfall fit DIR`";
        Error::not_known(&campaign.shared.title, missing, advice)
    })
}

fn parameters_of(
    law: &Law,
    estimates: &Estimates,
    population: &Population,
) -> BTreeMap<String, CardParameter> {
    let named = law
        .kind()
        .describe()
        .parameters
        .iter()
        .zip(law.parameters());
    named
        .enumerate()
        .map(|(index, (parameter, value))| {
            let place = estimates.names.iter().position(|n| n == parameter.name);
            let sd = place.map(|p| population.of_mean[p][p].sqrt());
            let sd = sd.filter(|sd| sd.is_finite());
            let logarithmic = place.is_some_and(|p| estimates.logarithmic[p]);
            let card = CardParameter {
                value,
                unit: law.unit_of(index),
                sd: sd.map(|sd| if logarithmic { value * sd } else { sd }),
                interval: sd.map(|sd| match logarithmic {
                    true => [
                        value * (-QUANTILE * sd).exp(),
                        value * (QUANTILE * sd).exp(),
                    ],
                    false => [value - QUANTILE * sd, value + QUANTILE * sd],
                }),
            };
            (parameter.name.to_owned(), card)
        })
        .collect()
}

fn card_population(
    estimates: &Estimates,
    population: &Population,
    impacts: usize,
) -> Option<CardPopulation> {
    Some(CardPopulation {
        of: labels_of(&estimates.names, &estimates.logarithmic),
        median: estimates.values(&population.mean),
        between_fruit: population.between.clone()?,
        within_fruit: population.within.clone(),
        fruit: population.fruit,
        impacts,
        method: population.method.clone(),
        covariates: Vec::new(),
    })
}

/// In what the law was seen: the motions under the fitted laws.
fn range_of(outcome: &CampaignOutcome, impacts: &[&ImpactOutcome]) -> CardRange {
    let of = |name: &str| {
        let values = impacts.iter();
        range_of_values(values.filter_map(|i| i.fitted(name).or_else(|| i.derived(name))))
    };
    CardRange {
        impact_velocity: of("impact_velocity"),
        peak_force: of("peak_force"),
        displacement: of("max_displacement"),
        mass: [outcome.effective_mass.value; 2],
    }
}

/// Where a card comes from, with the digests of the tables of its campaign.
///
/// # Errors
/// A table can no longer be read.
pub fn card_origin(campaign: &Campaign, method: &str) -> Result<CardOrigin, Error> {
    let mut digests = BTreeMap::new();
    for file in FILES {
        let path = campaign.directory.join(file);
        if path.is_file() {
            digests.insert(file.to_owned(), digest_file(&path)?);
        }
    }
    Ok(CardOrigin {
        campaign: campaign.title.clone(),
        method: method.to_owned(),
        simulated: campaign.simulated.clone(),
        digests,
        windfall: VERSION.to_owned(),
        date: time_now(),
    })
}
