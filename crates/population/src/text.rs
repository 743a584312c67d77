//! A population as text and CSV.

use crate::outcome::{
    PopulationEffect, PopulationOutcome, PopulationParameter, PopulationPosteriorOutcome,
    RangeOutcome,
};
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::number::{beside_sd, plain, unit_text};
use windfall_files::text::statistic::{number, probability};
use windfall_files::text::table::{failures_list, findings_list, page_tables, paragraph};

/// The columns of a table, separated by commas.
fn columns(names: &str) -> Vec<String> {
    names.split(',').map(str::to_owned).collect()
}

fn cells(range: &RangeOutcome, factor: f64) -> [String; 3] {
    let [value, low, high] =
        [Some(range.value), range.low, range.high].map(|v| v.map(|v| v * factor));
    let width = high
        .zip(low)
        .map_or(f64::INFINITY, |(high, low)| high - low);
    // A quarter of a 95 % interval is about a standard deviation.
    [value, low, high].map(|own| own.map_or_else(|| "-".to_owned(), |v| beside_sd(v, 0.25 * width)))
}

/// A population as text, with the two-stage estimate next to each number.
pub fn text_of_population(outcome: &PopulationOutcome) -> String {
    let mut text = format!("{}\n", outcome.campaign);
    if let Some(label) = &outcome.simulated {
        text += &format!("{label}\n");
    }
    text += &format!(
        "{}: {} fruit, {} impacts ({})\n\n",
        outcome.law, outcome.fruits, outcome.impacts, outcome.method
    );
    text += "Median fruit, and how fruit and the impacts of one fruit differ:\n";
    text += &spread_table(outcome);
    if !outcome.correlations.is_empty() {
        text += "\n\nCorrelations:\n";
        text += &correlation_table(outcome);
    }
    if !outcome.effects.is_empty() {
        text += "\n\nEffects of covariates, per unit (on ln of the parameter; exponents as they are):\n";
        text += &effect_table(&outcome.effects, &outcome.two_stage.effects);
    }
    if let Some(posterior) = &outcome.posterior {
        text += &format!(
            "\n\nPosterior, {} chains of {} draws (largest R-hat {:.3}, fewest independent draws {:.0}, {} divergences):\n",
            posterior.chains,
            posterior.draws,
            posterior.largest_r_hat,
            posterior.fewest_draws,
            posterior.divergences
        );
        text += &posterior_table(outcome, posterior);
    }
    text += "\n\n";
    let note = "Intervals: t of effects and medians (Satterthwaite), profile likelihood of standard \
                deviations and correlations. Two-stage: each impact fitted, averaged per fruit; \
                effects by least squares over all impacts as if they were independent.";
    text += &(paragraph(note, 0) + "\n");
    text += &findings_list(&outcome.findings);
    text + &failures_list("left out", &outcome.failed, 4)
}

/// Factor and unit that deviations of a parameter are shown with.
fn deviations_shown(parameter: &PopulationParameter) -> (f64, &'static str) {
    match parameter.scale.as_str() {
        "logarithm" => (100.0, " (%)"),
        _ => (1.0, ""),
    }
}

fn spread_table(outcome: &PopulationOutcome) -> String {
    let header = columns(",estimate,from,to,two-stage,from,to");
    let mut rows = Vec::new();
    for (i, parameter) in outcome.parameters.iter().enumerate() {
        let (factor, unit) = deviations_shown(parameter);
        let median = match parameter.unit.as_str() {
            "1" => format!("median {}", parameter.name),
            unit => format!("median {} ({})", parameter.name, unit_text(unit)),
        };
        let mut row = |name: String, own: &RangeOutcome, other: Option<&RangeOutcome>, f: f64| {
            let mut line = vec![name];
            line.extend(cells(own, f));
            match other {
                Some(other) => line.extend(cells(other, f)),
                None => line.extend(columns(",,")),
            }
            rows.push(line);
        };
        let stages = &outcome.two_stage;
        row(median, &parameter.median, stages.medians.get(i), 1.0);
        let name = format!("SD of {} between fruit{unit}", parameter.name);
        row(name, &parameter.between, stages.between.get(i), factor);
        let name = format!("SD of {} within fruit{unit}", parameter.name);
        row(name, &parameter.within, None, factor);
    }
    page_tables(&header, &rows, &[0])
}

/// The posterior beside the estimate.
fn posterior_table(outcome: &PopulationOutcome, posterior: &PopulationPosteriorOutcome) -> String {
    let header = columns(",estimate,from,to,posterior,from,to");
    let rows = posterior_rows(outcome, posterior).into_iter();
    let rows = rows.map(|row| {
        let mut line = vec![row.label];
        line.extend(cells(&row.estimate, row.factor));
        line.extend(cells(&row.posterior, row.factor));
        line
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[0])
}

struct PosteriorRow {
    label: String,
    quantity: &'static str,
    of: String,
    covariate: String,
    factor: f64,
    estimate: RangeOutcome,
    posterior: RangeOutcome,
}

fn posterior_rows(
    outcome: &PopulationOutcome,
    posterior: &PopulationPosteriorOutcome,
) -> Vec<PosteriorRow> {
    let mut rows = Vec::new();
    for (i, parameter) in outcome.parameters.iter().enumerate() {
        let (factor, unit) = deviations_shown(parameter);
        let name = &parameter.name;
        let mut row = |label, quantity, factor, estimate: &RangeOutcome, drawn: &[RangeOutcome]| {
            if let Some(posterior) = drawn.get(i) {
                rows.push(PosteriorRow {
                    label,
                    quantity,
                    of: name.clone(),
                    covariate: String::new(),
                    factor,
                    estimate: *estimate,
                    posterior: *posterior,
                });
            }
        };
        let label = format!("median {name}");
        row(label, "median", 1.0, &parameter.median, &posterior.medians);
        let label = format!("SD of {name} between fruit{unit}");
        let own = &posterior.between;
        row(label, "sd_between", factor, &parameter.between, own);
        let label = format!("SD of {name} within fruit{unit}");
        let own = &posterior.within;
        row(label, "sd_within", factor, &parameter.within, own);
    }
    for (i, pair) in outcome.correlations.iter().enumerate() {
        let levels = [
            (
                "between",
                "correlation_between",
                &pair.between,
                &posterior.between_correlations,
            ),
            (
                "within",
                "correlation_within",
                &pair.within,
                &posterior.within_correlations,
            ),
        ];
        for (level, quantity, estimate, drawn) in levels {
            if let Some(posterior) = drawn.get(i) {
                rows.push(PosteriorRow {
                    label: format!("{}, {} {level} fruit", pair.first, pair.second),
                    quantity,
                    of: format!("{} {}", pair.first, pair.second),
                    covariate: String::new(),
                    factor: 1.0,
                    estimate: *estimate,
                    posterior: *posterior,
                });
            }
        }
    }
    for (effect, posterior) in outcome.effects.iter().zip(&posterior.effects) {
        rows.push(PosteriorRow {
            label: format!("effect of {} on {}", effect.covariate, effect.parameter),
            quantity: "effect",
            of: effect.parameter.clone(),
            covariate: effect.covariate.clone(),
            factor: 1.0,
            estimate: RangeOutcome {
                value: effect.effect,
                low: Some(effect.low),
                high: Some(effect.high),
            },
            posterior: *posterior,
        });
    }
    rows
}

fn correlation_table(outcome: &PopulationOutcome) -> String {
    let header = columns(",estimate,from,to,two-stage");
    let mut rows = Vec::new();
    for (i, pair) in outcome.correlations.iter().enumerate() {
        let mut row = vec![format!("{}, {} between fruit", pair.first, pair.second)];
        row.extend(cells(&pair.between, 1.0));
        let stages = outcome.two_stage.correlations.get(i);
        row.push(stages.map_or_else(String::new, |c| plain(*c)));
        rows.push(row);
        let mut row = vec![format!("{}, {} within fruit", pair.first, pair.second)];
        row.extend(cells(&pair.within, 1.0));
        row.push(String::new());
        rows.push(row);
    }
    page_tables(&header, &rows, &[0])
}

fn effect_table(effects: &[PopulationEffect], stages: &[PopulationEffect]) -> String {
    let header = columns("covariate,centre,on,effect,from,to,df,p,two-stage,from,to");
    let rows = effects.iter().map(|effect| {
        let mut row = vec![
            effect.covariate.clone(),
            number(effect.centre),
            effect.parameter.clone(),
            number(effect.effect),
            number(effect.low),
            number(effect.high),
            number(effect.df),
            probability(effect.p),
        ];
        let same = |other: &&PopulationEffect| {
            other.covariate == effect.covariate && other.parameter == effect.parameter
        };
        match stages.iter().find(same) {
            Some(other) => row.extend([other.effect, other.low, other.high].map(number)),
            None => row.extend(columns(",,")),
        }
        row
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 2])
}

/// A population as CSV: one number with its interval per row.
///
/// # Errors
/// The rows cannot be written.
pub fn csv_of_population(outcome: &PopulationOutcome) -> Result<String, Error> {
    let header = columns("method,quantity,parameter,covariate,value,low,high");
    let row = |method: &str, quantity: &str, parameter: &str, range: &RangeOutcome| {
        vec![
            method.to_owned(),
            quantity.to_owned(),
            parameter.to_owned(),
            String::new(),
            range.value.to_string(),
            number_cell(range.low),
            number_cell(range.high),
        ]
    };
    let mut rows = Vec::new();
    for (i, parameter) in outcome.parameters.iter().enumerate() {
        let name = &parameter.name;
        rows.push(row("mixed", "median", name, &parameter.median));
        rows.push(row("mixed", "sd_between", name, &parameter.between));
        rows.push(row("mixed", "sd_within", name, &parameter.within));
        let stages = &outcome.two_stage;
        rows.push(row("two-stage", "median", name, &stages.medians[i]));
        rows.push(row("two-stage", "sd_between", name, &stages.between[i]));
    }
    for pair in &outcome.correlations {
        let name = format!("{} {}", pair.first, pair.second);
        rows.push(row("mixed", "correlation_between", &name, &pair.between));
        rows.push(row("mixed", "correlation_within", &name, &pair.within));
    }
    for (method, effects) in [
        ("mixed", &outcome.effects),
        ("two-stage", &outcome.two_stage.effects),
    ] {
        for effect in effects {
            rows.push(vec![
                method.to_owned(),
                "effect".to_owned(),
                effect.parameter.clone(),
                effect.covariate.clone(),
                effect.effect.to_string(),
                effect.low.to_string(),
                effect.high.to_string(),
            ]);
        }
    }
    if let Some(posterior) = &outcome.posterior {
        for found in posterior_rows(outcome, posterior) {
            let mut line = row("posterior", found.quantity, &found.of, &found.posterior);
            line[3] = found.covariate;
            rows.push(line);
        }
    }
    csv_text(&header, rows)
}
