//! What a reader of a linear model must know.

use crate::regress::outcome::StepOutcome;
use windfall_files::found::FindingOutcome;
use windfall_files::text::number::plain;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::model_frame::ModelFrame;
use windfall_statistics::model::reduced::Aliased;
use windfall_statistics::residuals::diagnostics::{Inflation, RowInfluence};

/// Variance inflation that is reported (Montgomery, Peck & Vining, Linear Regression, §9.4.2).
const INFLATED: f64 = 10.0;

/// Condition beyond which digits are lost.
const ILL_CONDITIONED: f64 = 1e7;

/// Lines named in a message.
const NAMED: usize = 8;

/// A finding.
pub fn finding(code: &str, message: String) -> FindingOutcome {
    FindingOutcome::new(code, message)
}

/// Lines in words, not too many.
pub(crate) fn lines_text(lines: &[usize]) -> String {
    let named: Vec<String> = lines.iter().take(NAMED).map(usize::to_string).collect();
    let more = match lines.len() > NAMED {
        true => format!(" and {} more", lines.len() - NAMED),
        false => String::new(),
    };
    let word = if lines.len() == 1 { "line" } else { "lines" };
    format!("{word} {}{more}", named.join(", "))
}

/// Rows with missing cells.
pub(crate) fn left_out_finding(
    left_out: &[(usize, String)],
    lines: &[usize],
) -> Vec<FindingOutcome> {
    let mut columns: Vec<&str> = Vec::new();
    for (_, column) in left_out {
        if !columns.contains(&column.as_str()) {
            columns.push(column);
        }
    }
    let message = |column: &&str| {
        let own = left_out.iter().filter(|(_, name)| name == column);
        let own: Vec<usize> = own.map(|(row, _)| lines[*row]).collect();
        let (count, what) = (
            own.len(),
            if own.len() == 1 { "row is" } else { "rows are" },
        );
        finding(
            "missing",
            format!(
                "{column:?} is missing in {}: {count} {what} left out",
                lines_text(&own)
            ),
        )
    };
    columns.iter().map(message).collect()
}

/// Columns that depend on others.
pub(crate) fn aliased_findings(frame: &ModelFrame, aliased: &[Aliased]) -> Vec<FindingOutcome> {
    let found = aliased.iter().map(|aliased| {
        finding(
            "aliased",
            format!(
                "{} has no estimate of its own: {}; take one of them out",
                frame.names[aliased.column],
                dependence(frame, aliased)
            ),
        )
    });
    found.collect()
}

fn dependence(frame: &ModelFrame, aliased: &Aliased) -> String {
    let name = &frame.names[aliased.column];
    match &aliased.combination[..] {
        [] => format!("{name} is zero in all rows"),
        [(0, value)] if frame.intercept => {
            format!(
                "it is {} in all rows, as the intercept is constant",
                plain(*value)
            )
        }
        terms => {
            let terms: Vec<String> = terms
                .iter()
                .map(|(column, factor)| {
                    let name = &frame.names[*column];
                    match (factor - 1.0).abs() < 1e-9 {
                        true => name.clone(),
                        false => format!("{} {name}", plain(*factor)),
                    }
                })
                .collect();
            format!(
                "it is {} in all rows",
                terms.join(" + ").replace("+ -", "- ")
            )
        }
    }
}

/// What is weak about a fit.
pub(crate) fn fit_findings(
    fit: &LinearFit,
    influence: &[RowInfluence],
    vif: &[Inflation],
    lines: &[usize],
    steps: &[StepOutcome],
) -> Vec<FindingOutcome> {
    let mut found = Vec::new();
    if fit.residual_df == 0 {
        found.push(finding(
            "saturated",
            "there are as many coefficients as rows: nothing is left to tell their errors".into(),
        ));
    }
    if fit.condition > ILL_CONDITIONED {
        found.push(finding(
            "ill-conditioned",
            format!(
                "columns are dependent but for 1 part in {}: centre the columns, or use poly( )",
                plain(fit.condition)
            ),
        ));
    }
    let inflated: Vec<String> = vif
        .iter()
        .filter(|v| v.df == 1 && v.factor > INFLATED)
        .map(|v| format!("{} ({})", v.term, plain(v.factor)))
        .collect();
    if !inflated.is_empty() {
        found.push(finding(
            "collinear",
            format!(
                "variance inflation above {INFLATED}: {}; these estimates lean on each other",
                inflated.join(", ")
            ),
        ));
    }
    let at = |chosen: &dyn Fn(&RowInfluence) -> bool| -> Vec<usize> {
        let rows = influence.iter().zip(lines);
        rows.filter(|(row, _)| chosen(row))
            .map(|(_, line)| *line)
            .collect()
    };
    let alone = at(&|row| row.leverage > 1.0 - 1e-9);
    if !alone.is_empty() && fit.residual_df > 0 {
        found.push(finding(
            "decides-alone",
            format!(
                "{} alone decides a coefficient: PRESS and predicted R² do not exist",
                lines_text(&alone)
            ),
        ));
    }
    let influential = at(&|row| row.cook > 1.0 && row.leverage <= 1.0 - 1e-9);
    if !influential.is_empty() {
        found.push(finding(
            "influential",
            format!("Cook's distance above 1 in {}", lines_text(&influential)),
        ));
    }
    let far = at(&|row| row.studentised.abs() > 4.0);
    if !far.is_empty() {
        found.push(finding(
            "outlying",
            format!("studentised residual beyond ±4 in {}", lines_text(&far)),
        ));
    }
    if !steps.is_empty() {
        found.push(finding(
            "selected",
            "terms were chosen on the same rows: the p-values and intervals of what remains are \
             optimistic; cross-validation repeats the choice in every part"
                .into(),
        ));
    }
    found
}
