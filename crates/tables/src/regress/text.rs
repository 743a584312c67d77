//! A linear model as text and CSV.

use crate::regress::outcome::{AnovaOutcome, TermOutcome};
use crate::regress::residuals::residuals_text;
use crate::regress::run::RegressOutcome;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::findings_list;
use windfall_files::text::table::{page_tables, paragraph};

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Estimates as a table.
#[must_use]
pub fn terms_text(terms: &[TermOutcome]) -> String {
    let header = strings(&["term", "estimate", "se", "t", "p", "from", "to"]);
    let rows = terms.iter().map(|term| {
        vec![
            term.term.clone(),
            number(term.estimate),
            number(term.se),
            number(term.t),
            probability(term.p),
            number(term.low),
            number(term.high),
        ]
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[0])
}

/// An analysis of variance as a table.
#[must_use]
pub fn anova_text(rows: &[AnovaOutcome], rest: &[(&str, f64, f64)]) -> String {
    let header = strings(&["source", "SS", "df", "mean square", "F", "p"]);
    let own = rows.iter().map(|row| {
        vec![
            row.term.clone(),
            number(row.ss),
            freedom(row.df),
            number(row.ss / row.df),
            number(row.f),
            probability(row.p),
        ]
    });
    let rest = rest.iter().map(|(name, ss, df)| {
        vec![
            (*name).to_owned(),
            number(*ss),
            freedom(*df),
            number(ss / df),
            String::new(),
            String::new(),
        ]
    });
    page_tables(&header, &own.chain(rest).collect::<Vec<_>>(), &[0])
}

/// A model as text.
#[must_use]
pub fn text_of_regress(outcome: &RegressOutcome) -> String {
    let quality = &outcome.quality;
    let mut text = format!("{}\n{} rows", outcome.formula, outcome.rows);
    if outcome.left_out > 0 {
        text += &format!(", {} left out", outcome.left_out);
    }
    text += "\n\n";
    if !outcome.steps.is_empty() {
        text += &steps_text(outcome);
        text += "\n";
    }
    text += &terms_text(&outcome.terms);
    if outcome.robust {
        text += "\nStandard errors that hold for unequal variances (HC3).\n";
    }
    text += &format!(
        "\n\nR² {}, adjusted {}, predicted {} (PRESS {})\nresidual standard deviation {} on {} degrees of freedom\n\
         model F {} on {} and {}, p {}\nAICc {}, BIC {}, adequate precision {}\n",
        number(quality.r2),
        number(quality.r2_adjusted),
        number(quality.r2_predicted),
        number(quality.press),
        number(quality.sigma),
        outcome.residual.df,
        number(outcome.model.f),
        outcome.model.df,
        outcome.residual.df,
        probability(outcome.model.p),
        number(quality.aicc),
        number(quality.bic),
        number(quality.adequate_precision),
    );
    if let Some(validation) = &outcome.cross_validation {
        text += &format!(
            "cross-validation in {} parts: R² {}, error of prediction {}\n",
            validation.folds,
            number(validation.r2),
            number(validation.rms)
        );
    }
    text += &format!("\nAnalysis of variance, type {}:\n", outcome.anova_type);
    let mut rest = vec![("residual", outcome.residual.ss, outcome.residual.df)];
    if let Some(lack) = &outcome.lack_of_fit {
        rest.push(("  lack of fit", lack.lack.ss, lack.lack.df));
        rest.push(("  pure error", lack.pure_error.ss, lack.pure_error.df));
    }
    rest.push(("total", outcome.total.ss, outcome.total.df));
    text += &anova_text(&outcome.anova, &rest);
    text += "\n";
    match &outcome.lack_of_fit {
        Some(lack) => {
            text += &format!(
                "lack of fit: F {} on {} and {}, p {}\n",
                number(lack.lack.f),
                lack.lack.df,
                lack.pure_error.df,
                probability(lack.lack.p)
            );
        }
        None => {
            text += "lack of fit: no rows are repeated, so there is no pure error to test against\n"
        }
    }
    if !outcome.vif.is_empty() {
        let factors = outcome
            .vif
            .iter()
            .map(|v| format!("{} {}", v.term, number(v.factor)));
        let line = format!(
            "variance inflation: {}",
            factors.collect::<Vec<_>>().join(", ")
        );
        text += &(paragraph(&line, 2) + "\n");
    }
    text += &residuals_text(&outcome.residuals);
    if !outcome.predictions.is_empty() {
        text += &format!("\n{}\n", predictions_text(outcome));
    }
    text + &findings_list(&outcome.findings)
}

fn steps_text(outcome: &RegressOutcome) -> String {
    let header = strings(&["step", "", "term", "F", "p", "criterion", "R² then"]);
    let rows = outcome.steps.iter().enumerate().map(|(place, step)| {
        vec![
            (place + 1).to_string(),
            step.action.to_owned(),
            step.term.clone(),
            number(step.f),
            probability(step.p),
            step.criterion.map_or_else(|| "-".to_owned(), number),
            number(step.r2),
        ]
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[1, 2]) + "\n"
}

fn predictions_text(outcome: &RegressOutcome) -> String {
    let header = strings(&[
        "line",
        "predicted",
        "se",
        "mean from",
        "to",
        "observation from",
        "to ",
    ]);
    page_tables(&header, &prediction_rows(outcome, &number), &[])
}

fn prediction_rows(outcome: &RegressOutcome, write: &dyn Fn(f64) -> String) -> Vec<Vec<String>> {
    let rows = outcome.predictions.iter().map(|row| {
        let numbers = [
            row.predicted,
            row.se,
            row.mean_low,
            row.mean_high,
            row.low,
            row.high,
        ];
        let cells = numbers.into_iter().map(write);
        std::iter::once(row.line.to_string()).chain(cells).collect()
    });
    rows.collect()
}

/// A model as CSV: estimates, or predictions where they were asked for.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_regress(outcome: &RegressOutcome) -> Result<String, Error> {
    if !outcome.predictions.is_empty() {
        let header = strings(&[
            "line",
            "predicted",
            "se",
            "mean_low",
            "mean_high",
            "low",
            "high",
        ]);
        let rows = prediction_rows(outcome, &|value| value.to_string());
        return csv_text(&header, rows);
    }
    csv_of_terms(&outcome.terms)
}

/// Estimates as CSV.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_terms(terms: &[TermOutcome]) -> Result<String, Error> {
    let header = strings(&["term", "estimate", "se", "t", "df", "p", "low", "high"]);
    let rows = terms.iter().map(|term| {
        let numbers = [
            term.estimate,
            term.se,
            term.t,
            term.df,
            term.p,
            term.low,
            term.high,
        ];
        let cells = numbers.iter().map(f64::to_string);
        std::iter::once(term.term.clone()).chain(cells).collect()
    });
    csv_text(&header, rows)
}
