//! A linear model as text and CSV.

use crate::regress::means::text::{csv_of_means, means_text};
use crate::regress::outcome::{PredictionOutcome, StepOutcome, original_cell, original_text};
use crate::regress::residuals::residuals_text;
use crate::regress::run::RegressOutcome;
use crate::regress::variances::text::variances_text;
use crate::rows::rows_text;
use crate::term_units::{coefficient_unit, in_unit_of, table_of_terms};
use windfall_files::error::Error;
use windfall_files::text::columns::{Column, csv_of_rows, given, text_of_rows};
use windfall_files::text::number::{beside_sd, p_value};
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::{findings_list, page_tables, paragraph};
use windfall_mixed::coefficient::Coefficient;
use windfall_statistics::model::anova::{AnovaRow, LackOfFit, SumOfSquares};
use windfall_statistics::model::linear_model::Quality;

const TERMS: [Column<Coefficient>; 7] = [
    ("term", |term| term.name.clone()),
    ("estimate", |term| beside_sd(term.estimate, term.se)),
    ("se", |term| number(term.se)),
    ("t", |term| number(term.t)),
    ("p", |term| probability(term.p)),
    ("from", |term| beside_sd(term.low, term.se)),
    ("to", |term| beside_sd(term.high, term.se)),
];

const TERMS_CSV: [Column<Coefficient>; 8] = [
    ("term", |term| term.name.clone()),
    ("estimate", |term| term.estimate.to_string()),
    ("se", |term| term.se.to_string()),
    ("t", |term| term.t.to_string()),
    ("df", |term| term.df.to_string()),
    ("p", |term| term.p.to_string()),
    ("low", |term| term.low.to_string()),
    ("high", |term| term.high.to_string()),
];

const PREDICTIONS: [Column<PredictionOutcome>; 7] = [
    ("line", |row| row.line.to_string()),
    ("predicted", |row| number(row.prediction.mean)),
    ("se", |row| number(row.prediction.se)),
    ("mean from", |row| number(row.prediction.mean_low)),
    ("to", |row| number(row.prediction.mean_high)),
    ("observation from", |row| number(row.prediction.low)),
    ("to ", |row| number(row.prediction.high)),
];

const PREDICTIONS_CSV: [Column<PredictionOutcome>; 12] = [
    ("line", |row| row.line.to_string()),
    ("predicted", |row| row.prediction.mean.to_string()),
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

/// An analysis of variance as a table: terms, residual with lack of fit, total.
pub(crate) fn anova_text(
    rows: &[AnovaRow],
    residual: SumOfSquares,
    lack_of_fit: Option<&LackOfFit>,
    total: SumOfSquares,
) -> String {
    let header = ["source", "SS", "df", "mean square", "F", "p"].map(str::to_owned);
    let cells = |name: &str, sum: SumOfSquares, test: [String; 2]| {
        let [f, p] = test;
        let (ss, df) = (number(sum.ss), freedom(sum.df));
        vec![name.to_owned(), ss, df, number(sum.ss / sum.df), f, p]
    };
    let sum = |row: &AnovaRow| SumOfSquares {
        ss: row.ss,
        df: row.df,
    };
    let untested = || [String::new(), String::new()];
    let tested = |row: &AnovaRow| cells(&row.term, sum(row), [number(row.f), probability(row.p)]);
    let mut table: Vec<Vec<String>> = rows.iter().map(tested).collect();
    table.push(cells("residual", residual, untested()));
    if let Some(found) = lack_of_fit {
        if found.lack.df > 0.0 {
            table.push(cells("  lack of fit", sum(&found.lack), untested()));
        }
        table.push(cells("  pure error", found.pure_error, untested()));
    }
    table.push(cells("total", total, untested()));
    page_tables(&header, &table, &[0])
}

/// R² in its three forms, and PRESS.
pub(crate) fn r2_text(quality: &Quality) -> String {
    format!(
        "R² {}, adjusted {}, predicted {} (PRESS {})",
        number(quality.r2),
        number(quality.r2_adjusted),
        number(quality.r2_predicted),
        number(quality.press),
    )
}

pub(crate) fn lack_of_fit_text(lack_of_fit: Option<&LackOfFit>, unrepeated: &str) -> String {
    let Some(LackOfFit { lack, pure_error }) = lack_of_fit else {
        return format!("lack of fit: {unrepeated}, so there is no pure error to test against\n");
    };
    if lack.df == 0.0 {
        return "lack of fit: the model has a coefficient for every setting, so no degrees of \
                freedom are left for it\n"
            .to_owned();
    }
    format!(
        "lack of fit: F({}, {}) = {}, {}\n",
        freedom(lack.df),
        freedom(pure_error.df),
        number(lack.f),
        p_value(lack.p)
    )
}

/// A model as text.
pub fn text_of_regress(outcome: &RegressOutcome) -> String {
    let quality = &outcome.quality;
    let rows = rows_text(&outcome.count);
    let mut text = match outcome.count.left_out {
        0 => format!("{}\n{rows}\n\n", outcome.formula),
        _ => format!("{rows}\n{}\n\n", outcome.formula),
    };
    if !outcome.steps.is_empty() {
        text += &(steps_text(&outcome.steps) + "\n\n");
    }
    let unit = |term: &Coefficient| coefficient_unit(&outcome.response, &term.name);
    text += &table_of_terms(&outcome.terms, &TERMS, ("unit", unit), &[0]);
    if let Some(name) = &outcome.weights {
        text += &format!("\n{}", weights_text(name));
    }
    if outcome.robust {
        text += "\nStandard errors that hold for unequal variances (HC3).";
    }
    if let Some(variances) = &outcome.level_variances {
        text += &variances_text(outcome, variances);
        return text + &rest_text(outcome);
    }
    text += &format!(
        "\n\n{}\nresidual standard deviation {} on {} degrees of freedom\n\
         model F({}, {}) = {}, {}\nAICc {}, BIC {}, adequate precision {}\n",
        r2_text(quality),
        in_unit_of(&outcome.response, number(quality.sigma)),
        outcome.residual.df,
        outcome.model.df,
        outcome.residual.df,
        number(outcome.model.f),
        p_value(outcome.model.p),
        number(quality.aicc),
        number(quality.bic),
        number(quality.adequate_precision),
    );
    if let Some(validation) = &outcome.cross_validation {
        text += &format!(
            "cross-validation in {} parts{}: R² {}, error of prediction {}\n",
            validation.folds,
            match &outcome.fold_by {
                Some(name) => format!(" that keep each {name} together"),
                None => String::new(),
            },
            number(validation.r2),
            number(validation.rms)
        );
    }
    let lack_of_fit = outcome.lack_of_fit.as_ref();
    text += &format!(
        "\nAnalysis of variance, type {}:\n{}\n{}",
        outcome.anova_type,
        anova_text(&outcome.anova, outcome.residual, lack_of_fit, outcome.total),
        lack_of_fit_text(lack_of_fit, "no rows are repeated")
    );
    if !outcome.vif.is_empty() {
        let factors = outcome.vif.iter();
        let factors: Vec<String> = factors
            .map(|v| format!("{} {}", v.term, number(v.factor)))
            .collect();
        let line = format!("variance inflation: {}", factors.join(", "));
        text += &(paragraph(&line, 2) + "\n");
    }
    text + &rest_text(outcome)
}

/// Residuals, means, predictions and findings.
fn rest_text(outcome: &RegressOutcome) -> String {
    let mut text = residuals_text(&outcome.residuals);
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

/// What weights mean.
pub(crate) fn weights_text(name: &str) -> String {
    let told = format!(
        "Rows are weighted by {name}: the variance of a row is the residual variance divided by \
         its weight. Tests of residuals use residuals times the square root of the weight; a \
         further observation has weight 1."
    );
    paragraph(&told, 0)
}

fn steps_text(steps: &[StepOutcome]) -> String {
    let rows: Vec<(usize, &StepOutcome)> = (1..).zip(steps).collect();
    let columns: [Column<(usize, &StepOutcome)>; 7] = [
        ("step", |row| row.0.to_string()),
        ("", |row| row.1.action.to_owned()),
        ("term", |row| row.1.term.clone()),
        ("F", |row| number(row.1.f)),
        ("p", |row| probability(row.1.p)),
        ("criterion", |row| given(row.1.criterion, number)),
        ("R² then", |row| number(row.1.r2)),
    ];
    text_of_rows(&rows, &columns, &[1, 2])
}

/// A model as CSV: estimates, or predictions or means where they were asked for.
pub fn csv_of_regress(outcome: &RegressOutcome) -> Result<String, Error> {
    match (&outcome.predictions[..], &outcome.means[..]) {
        ([], []) => csv_of_terms(&outcome.terms),
        ([], means) => csv_of_means(means),
        (predictions, _) => csv_of_rows(predictions, &PREDICTIONS_CSV),
    }
}

pub(crate) fn csv_of_terms(terms: &[Coefficient]) -> Result<String, Error> {
    csv_of_rows(terms, &TERMS_CSV)
}
