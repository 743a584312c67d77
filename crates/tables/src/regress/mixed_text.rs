//! A mixed model as text and CSV.

use crate::regress::mixed::MixedOutcome;
use crate::regress::text::csv_of_terms;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::findings_list;
use windfall_files::text::table::page_tables;

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// A mixed model as text.
#[must_use]
pub fn text_of_mixed(outcome: &MixedOutcome) -> String {
    let groups = outcome.groups.iter();
    let groups: Vec<String> = groups
        .map(|(name, count)| format!("{count} of {name}"))
        .collect();
    let mut text = format!(
        "{}\n{} rows{}; groups: {}; {}\n\n",
        outcome.formula,
        outcome.rows,
        match outcome.left_out {
            0 => String::new(),
            n => format!(", {n} left out"),
        },
        groups.join(", "),
        outcome.method
    );
    let header = strings(&["term", "estimate", "se", "df", "t", "p", "from", "to"]);
    let rows = outcome.terms.iter().map(|term| {
        vec![
            term.term.clone(),
            number(term.estimate),
            number(term.se),
            number(term.df),
            number(term.t),
            probability(term.p),
            number(term.low),
            number(term.high),
        ]
    });
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &[0]);
    text += &format!(
        "\n\nTests of the terms, each after all others ({}):\n",
        outcome.df_method
    );
    let header = strings(&["term", "F", "df", "residual df", "p"]);
    let rows = outcome.anova.iter().map(|row| {
        vec![
            row.test.term.clone(),
            number(row.test.f),
            freedom(row.test.df),
            number(row.df_denominator),
            probability(row.test.p),
        ]
    });
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &[0]);
    text += "\n\nStandard deviations and correlations, with profile intervals of the same likelihood:\n";
    let header = strings(&["between", "", "of", "value", "from", "to"]);
    let rows = outcome.variances.iter().map(|row| {
        vec![
            row.group.clone(),
            row.kind.to_owned(),
            row.of.clone(),
            number(row.value),
            number(row.low),
            number(row.high),
        ]
    });
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 1, 2]);
    text += &format!(
        "\n\nR² of the fixed effects {}, with the random effects {}\nAIC {}, AICc {}, BIC {}, log-likelihood {}\n",
        plain(outcome.r2),
        plain(outcome.r2_conditional),
        number(outcome.aic),
        number(outcome.aicc),
        number(outcome.bic),
        number(outcome.log_likelihood),
    );
    if !outcome.predictions.is_empty() {
        let header = strings(&[
            "line",
            "mean over groups",
            "predicted",
            "se",
            "mean from",
            "to",
            "observation from",
            "to ",
        ]);
        let rows = prediction_rows(outcome, &number);
        text += &format!("\n{}\n", page_tables(&header, &rows, &[]));
    }
    text + &findings_list(&outcome.findings)
}

fn prediction_rows(outcome: &MixedOutcome, write: &dyn Fn(f64) -> String) -> Vec<Vec<String>> {
    let rows = outcome.predictions.iter().map(|row| {
        let numbers = [
            row.population,
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

/// A mixed model as CSV: fixed effects, or predictions where they were asked for.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_mixed(outcome: &MixedOutcome) -> Result<String, Error> {
    if outcome.predictions.is_empty() {
        return csv_of_terms(&outcome.terms);
    }
    let header = strings(&[
        "line",
        "population",
        "predicted",
        "se",
        "mean_low",
        "mean_high",
        "low",
        "high",
    ]);
    csv_text(
        &header,
        prediction_rows(outcome, &|value| value.to_string()),
    )
}
