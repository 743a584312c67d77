//! A mixed model as text and CSV.

use crate::regress::means::text::{csv_of_means, means_text};
use crate::regress::mixed::{MixedOutcome, MixedPredictionOutcome, MixedTest, VarianceOutcome};
use crate::regress::outcome::{original_cell, original_text};
use crate::regress::text::{csv_of_terms, weights_text};
use crate::rows::rows_text;
use crate::term_units::{coefficient_unit, table_of_terms};
use windfall_files::error::Error;
use windfall_files::text::columns::{Column, csv_of_rows, text_of_rows};
use windfall_files::text::number::{beside_sd, plain};
use windfall_files::text::statistic::{chi_square, freedom, number, probability};
use windfall_files::text::table::findings_list;
use windfall_mixed::coefficient::Coefficient;

const TERMS: [Column<Coefficient>; 8] = [
    ("term", |term| term.name.clone()),
    ("estimate", |term| beside_sd(term.estimate, term.se)),
    ("se", |term| number(term.se)),
    ("df", |term| number(term.df)),
    ("t", |term| number(term.t)),
    ("p", |term| probability(term.p)),
    ("from", |term| beside_sd(term.low, term.se)),
    ("to", |term| beside_sd(term.high, term.se)),
];

pub(crate) const TESTS: [Column<MixedTest>; 5] = [
    ("term", |row| row.test.term.clone()),
    ("F", |row| number(row.test.f)),
    ("df", |row| freedom(row.test.df)),
    ("residual df", |row| number(row.df_denominator)),
    ("p", |row| probability(row.test.p)),
];

pub(crate) const VARIANCES: [Column<VarianceOutcome>; 6] = [
    ("between", |row| row.group.clone()),
    ("", |row| row.kind.to_owned()),
    ("of", |row| row.of.clone()),
    ("value", |row| number(row.value)),
    ("from", |row| number(row.low)),
    ("to", |row| number(row.high)),
];

const PREDICTIONS: [Column<MixedPredictionOutcome>; 8] = [
    ("line", |row| row.line.to_string()),
    ("mean over groups", |row| number(row.prediction.population)),
    ("predicted", |row| number(row.prediction.predicted)),
    ("se", |row| number(row.prediction.se)),
    ("mean from", |row| number(row.prediction.mean_low)),
    ("to", |row| number(row.prediction.mean_high)),
    ("observation from", |row| number(row.prediction.low)),
    ("to ", |row| number(row.prediction.high)),
];

const PREDICTIONS_CSV: [Column<MixedPredictionOutcome>; 13] = [
    ("line", |row| row.line.to_string()),
    ("population", |row| row.prediction.population.to_string()),
    ("predicted", |row| row.prediction.predicted.to_string()),
    ("se", |row| row.prediction.se.to_string()),
    ("mean_low", |row| row.prediction.mean_low.to_string()),
    ("mean_high", |row| row.prediction.mean_high.to_string()),
    ("low", |row| row.prediction.low.to_string()),
    ("high", |row| row.prediction.high.to_string()),
    ("original", |row| {
        original_cell(row.original.as_ref(), |own| own.predicted)
    }),
    ("original_mean_low", |row| {
        original_cell(row.original.as_ref(), |own| own.mean_low)
    }),
    ("original_mean_high", |row| {
        original_cell(row.original.as_ref(), |own| own.mean_high)
    }),
    ("original_low", |row| {
        original_cell(row.original.as_ref(), |own| own.low)
    }),
    ("original_high", |row| {
        original_cell(row.original.as_ref(), |own| own.high)
    }),
];

/// A mixed model as text.
pub fn text_of_mixed(outcome: &MixedOutcome) -> String {
    let groups = outcome.groups.iter();
    let groups: Vec<String> = groups
        .map(|(name, count)| format!("{count} of {name}"))
        .collect();
    let rows = rows_text(&outcome.count);
    let formula = |here: bool| match here {
        true => outcome.formula.clone() + "\n",
        false => String::new(),
    };
    let whole = outcome.count.left_out == 0;
    let unit = |term: &Coefficient| coefficient_unit(&outcome.response, &term.name);
    let mut text = format!(
        "{}{rows}; groups: {}; {}\n{}\n",
        formula(whole),
        groups.join(", "),
        outcome.method,
        formula(!whole),
    );
    if let Some(name) = &outcome.weights {
        text += &(weights_text(name) + "\n");
    }
    text += &format!(
        "{}\n\nTests of the terms, each after all others ({}):\n{}\n\n\
         Standard deviations and correlations, with profile intervals of the same likelihood:\n{}\n\n",
        table_of_terms(&outcome.terms, &TERMS, ("unit", unit), &[0]),
        outcome.df_method,
        text_of_rows(&outcome.anova, &TESTS, &[0]),
        text_of_rows(&outcome.variances, &VARIANCES, &[0, 1, 2])
    );
    if let Some(own) = &outcome.level_variances {
        text += &format!(
            "against one residual standard deviation for all levels of {}: {}\n",
            own.by,
            chi_square(own.test.statistic, own.test.df as f64, Some(own.test.p)),
        );
    }
    text += &format!(
        "R² of the fixed effects {}, with the random effects {}\nAIC {}, AICc {}, BIC {}, log-likelihood {}\n",
        plain(outcome.r2),
        plain(outcome.r2_conditional),
        number(outcome.aic),
        number(outcome.aicc),
        number(outcome.bic),
        number(outcome.log_likelihood),
    );
    text += &means_text(&outcome.means);
    if !outcome.predictions.is_empty() {
        let table = text_of_rows(&outcome.predictions, &PREDICTIONS, &[]);
        text += &format!("\n{table}\n");
        let original = outcome.predictions.iter();
        let original: Vec<_> = original
            .filter_map(|own| Some((own.line, own.original?)))
            .collect();
        text += &original_text(&original);
    }
    text + &findings_list(&outcome.findings)
}

/// A mixed model as CSV: fixed effects, or predictions or means where they were asked for.
pub fn csv_of_mixed(outcome: &MixedOutcome) -> Result<String, Error> {
    match (&outcome.predictions[..], &outcome.means[..]) {
        ([], []) => csv_of_terms(&outcome.terms),
        ([], means) => csv_of_means(means),
        (predictions, _) => csv_of_rows(predictions, &PREDICTIONS_CSV),
    }
}
