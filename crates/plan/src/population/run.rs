//! A law card → a plan for one of its parameters.

use crate::outcome::PlanOutcome;
use crate::parse::positive;
use crate::population::question::PopulationQuestion;
use crate::population::request::PopulationPlanRequest;
use crate::run::plan;
use windfall_cards::law_card::CardPopulation;
use windfall_cards::read_card::read_card;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::known_names::known_names;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::number;

/// Plans how well a population's median and spread are known.
///
/// # Errors
/// The card has no population or no such parameter; no study tells what is wanted.
pub fn plan_population(request: &PopulationPlanRequest) -> Result<PlanOutcome, Error> {
    if request.plan.power.is_some() || request.plan.one_sided {
        let problem = "a median and a spread have intervals and no test: give --half-width, or \
                       --fruit";
        return Err(unusable("--power", problem));
    }
    let card = read_card(&request.card)?;
    let shown = request.card.display();
    let population = card.population.as_ref().ok_or_else(|| {
        let problem = format!(
            "{shown} holds no population: write one with `windfall population DIR --card FILE`"
        );
        unusable("CARD", problem)
    })?;
    let (place, of) = parameter(population, &request.parameter)?;
    let between = sd(&population.between_fruit, place);
    let known = variance(&population.between_fruit, place);
    if let Some(negative) = known.filter(|variance| *variance < 0.0) {
        let problem = format!(
            "{shown} states a negative variance of {of} between fruit, {}: correct the card",
            plain(negative)
        );
        return Err(unusable("--parameter", problem));
    }
    if between.is_nan() || between <= 0.0 {
        let problem = format!(
            "by {shown} fruit do not differ in {of}: there is no spread to plan for; the campaign \
             behind it was too small to see one"
        );
        return Err(unusable("--parameter", problem));
    }
    let within = match (request.within, &population.within_fruit) {
        (Some(within), _) => positive("--within", within)?,
        (None, Some(covariance)) => {
            let within = sd(covariance, place);
            if within.is_nan() {
                let problem = format!(
                    "{shown} states a negative variance of {of} between the impacts of a fruit: \
                     correct the card, or state --within"
                );
                return Err(unusable("--parameter", problem));
            }
            within
        }
        (None, None) => {
            let problem =
                format!("{shown} does not tell how the impacts of a fruit scatter: say it");
            return Err(unusable("--within", problem));
        }
    };
    let question = PopulationQuestion {
        between,
        within,
        about: about(request, population, of, (between, within)),
        findings: findings(population, of),
    };
    plan(&question, &request.plan)
}

fn about(
    request: &PopulationPlanRequest,
    population: &CardPopulation,
    of: &str,
    (between, within): (f64, f64),
) -> Vec<String> {
    let scale = match of.starts_with("ln ") {
        true => "; of logarithms, so that 0.05 is about 5 %",
        false => "",
    };
    vec![
        format!("median of {of} over fruit, and its SD between fruit"),
        format!(
            "SD between fruit {}, between the impacts of a fruit {}{scale} ({}: {} impacts on {} \
             fruit)",
            number(between),
            number(within),
            request.card.display(),
            population.impacts,
            population.fruit
        ),
        "SD's error: standard error of the SD between fruit, in parts of it; SD of zero: \
         probability that it is estimated as zero; neither can be told of one impact on each fruit"
            .to_owned(),
    ]
}

/// The place of a parameter, and how the card calls it.
fn parameter<'a>(population: &'a CardPopulation, name: &str) -> Result<(usize, &'a str), Error> {
    let own = |of: &String| of == name || of.strip_prefix("ln ") == Some(name);
    match population.of.iter().position(own) {
        Some(place) => Ok((place, &population.of[place])),
        None => {
            let known = known_names(name, population.of.iter().map(String::as_str));
            Err(unusable(
                "--parameter",
                format!("no \"{name}\" in the population{known}"),
            ))
        }
    }
}

fn sd(covariance: &[Vec<f64>], place: usize) -> f64 {
    variance(covariance, place).map_or(f64::NAN, f64::sqrt)
}

fn variance(covariance: &[Vec<f64>], place: usize) -> Option<f64> {
    covariance.get(place)?.get(place).copied()
}

/// Fruit below which an estimated spread is a poor base of a plan.
const FEW_FRUIT: usize = 20;

fn findings(population: &CardPopulation, of: &str) -> Vec<FindingOutcome> {
    let few = population.fruit < FEW_FRUIT;
    let n = population.fruit.max(2) as f64;
    let message = format!(
        "the spread of {of} is that of {} fruit, and itself known to about ± {} %: plan some more",
        population.fruit,
        plain(196.0 / (2.0 * (n - 1.0)).sqrt())
    );
    few.then(|| FindingOutcome::new("few-fruit-behind-plan", message))
        .into_iter()
        .collect()
}
