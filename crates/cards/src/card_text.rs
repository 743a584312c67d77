//! A law card as text for people.

use crate::law_card::{CardCovariate, CardPopulation, LawCard};
use std::fmt::Write;
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::number::{beside_sd, interval, unit_text};
use windfall_files::text::statistic::number;
use windfall_files::text::table::table_text;

/// A card as a table with what must be known beside it.
pub fn text_of_card(card: &LawCard) -> String {
    let mut text = format!(
        "{}\n\n{}\ncontact ends at {}\n\n",
        card.title, card.expression, card.end
    );
    let header = [
        "parameter",
        "value",
        "standard uncertainty",
        "95 % interval",
        "unit",
    ];
    let rows = card.parameters.iter().map(|(name, parameter)| {
        vec![
            name.clone(),
            match parameter.sd {
                Some(sd) => beside_sd(parameter.value, sd),
                None => number(parameter.value),
            },
            parameter.sd.map_or_else(|| "held".to_owned(), number),
            parameter
                .interval
                .map_or_else(String::new, |[low, high]| interval(low, high)),
            unit_text(&parameter.unit),
        ]
    });
    text.push_str(&table_text(&header.map(str::to_owned), rows, &[0, 4]));
    text.push_str("\n\n");
    let range = &card.range;
    let between = |[low, high]: [f64; 2]| format!("{} to {}", number(low), number(high));
    let mut line = |name: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name}: {value}");
    };
    line(
        "seen at impact velocities of",
        between(range.impact_velocity) + " m/s",
    );
    line("peak contact forces", between(range.peak_force) + " N");
    line("displacements", between(range.displacement) + " m");
    line("masses", between(range.mass) + " kg");
    let bodies = &card.bodies;
    line(
        "bodies",
        format!(
            "{} against {}, effective mass factor {}, {} fruit, {} recordings",
            bodies.impactor,
            bodies.target,
            bodies.effective_mass_factor,
            bodies.specimens,
            bodies.recordings
        ),
    );
    if let Some(covariance) = &card.covariance {
        line("uncertainty is that of", covariance.of_what.clone());
    }
    if let Some(contact) = &card.contact {
        let (radius, modulus) = (
            number(contact.effective_radius),
            number(contact.effective_modulus),
        );
        line(
            "contact",
            format!("{}: R* = {radius} m, E* = {modulus} Pa", contact.bodies),
        );
    }
    if let Some(population) = &card.population {
        line("between fruit", between_text(population));
        line("estimated by", population.method.clone());
        for effect in &population.covariates {
            line("effect", effect_text(effect));
        }
    }
    if let Some(formula) = card.definition.as_ref().and_then(|d| d.force.as_ref()) {
        line("formula", formula.trim().to_owned());
    }
    let origin = &card.origin;
    let made = format!(
        "{}, {}, windfall {}, {}",
        origin.campaign, origin.method, origin.windfall, origin.date
    );
    line("origin", made);
    if let Some(label) = &origin.simulated {
        line("simulated", label.clone());
    }
    for caution in &card.cautions {
        line("caution", caution.clone());
    }
    text
}

/// "sd of ln k 0.18, of ln c 0.24 over 40 fruit and 240 impacts; correlation of
/// ln k and ln c 0.31".
fn between_text(population: &CardPopulation) -> String {
    let matrix = &population.between_fruit;
    let sd = |i: usize| matrix[i][i].max(0.0).sqrt();
    let places = 0..population.of.len().min(matrix.len());
    let sds: Vec<String> = places
        .clone()
        .map(|i| format!("of {} {}", population.of[i], number(sd(i))))
        .collect();
    let mut text = format!(
        "sd {} over {} fruit and {} impacts",
        sds.join(", "),
        population.fruit,
        population.impacts
    );
    for i in places {
        for j in 0..i {
            let correlation = matrix[i][j] / (sd(i) * sd(j));
            if !correlation.is_finite() {
                continue;
            }
            text += &format!(
                "; correlation of {} and {} {correlation:.2}",
                population.of[j], population.of[i]
            );
        }
    }
    text
}

/// "ln k rises by 0.4 ± 0.1 per m/s of impact_velocity, from 0.35 m/s".
fn effect_text(effect: &CardCovariate) -> String {
    let sd = effect
        .sd
        .map_or_else(String::new, |sd| format!(" ± {}", number(sd)));
    format!(
        "{} changes by {}{sd} per {} of {}; the median is at {} {}",
        effect.on,
        number(effect.effect),
        effect.unit,
        effect.name,
        number(effect.centre),
        effect.unit
    )
}

/// The parameters of a card as CSV.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_card(card: &LawCard) -> Result<String, Error> {
    let header = ["parameter", "value", "sd", "low", "high", "unit"];
    let rows = card.parameters.iter().map(|(name, parameter)| {
        vec![
            name.clone(),
            parameter.value.to_string(),
            number_cell(parameter.sd),
            number_cell(parameter.interval.map(|[low, _]| low)),
            number_cell(parameter.interval.map(|[_, high]| high)),
            unit_text(&parameter.unit),
        ]
    });
    csv_text(&header.map(str::to_owned), rows)
}
