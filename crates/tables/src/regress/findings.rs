//! What a reader of a linear model must know.

use crate::regress::outcome::{RangeOutcome, StepOutcome};
use crate::rows::{GroupLoss, RowCount, lines_text};
use std::collections::BTreeMap;
use windfall_files::found::FindingOutcome;
use windfall_files::table::data::Data;
use windfall_files::text::number::{p_value, plain};
use windfall_statistics::model::anova::LackOfFit;
use windfall_statistics::model::encoding::Encoding;
use windfall_statistics::model::formula_syntax::Kind;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::model_frame::ModelFrame;
use windfall_statistics::model::reduced::Aliased;
use windfall_statistics::numbers::Numbers;
use windfall_statistics::residuals::diagnostics::{Inflation, Influence, RowInfluence};
use windfall_statistics::runs::Runs;
use windfall_statistics::table::Table;

/// Variance inflation that is reported (Montgomery, Peck & Vining, Linear Regression, §9.4.2).
const INFLATED: f64 = 10.0;

/// Residuals below this share of the response's sum of squares are rounding.
const EXACT: f64 = 1e-24;

/// Condition beyond which digits are lost.
const ILL_CONDITIONED: f64 = 1e7;

/// Levels of a column that numbers may name.
const FEWEST_CODES: usize = 3;
const MOST_CODES: usize = 50;

/// Probability below which a lack of fit is told.
const LACKING: f64 = 0.05;

/// A finding.
pub fn finding(code: &str, message: String) -> FindingOutcome {
    FindingOutcome::new(code, message)
}

/// Columns that nearly depend on each other.
pub(crate) fn condition_finding(condition: f64) -> Option<FindingOutcome> {
    (condition > ILL_CONDITIONED).then(|| {
        finding(
            "ill-conditioned",
            format!(
                "columns are dependent but for 1 part in {}: centre the columns, or use poly( )",
                plain(condition)
            ),
        )
    })
}

/// Means and predictions outside of the rows that the model was fitted to.
///
/// * `held`: columns with the value at which means are taken
/// * `asked`: the table that is predicted
pub(crate) fn extrapolated(
    ranges: &[RangeOutcome],
    held: &[(String, f64)],
    asked: Option<&Data>,
) -> Option<FindingOutcome> {
    let outside = |range: &RangeOutcome| {
        let beyond = |value: &f64| *value < range.low || *value > range.high;
        let column = asked.and_then(|own| own.table.numbers(&range.column).ok());
        let predicted = column.is_some_and(|own| own.iter().any(|value| beyond(&value)));
        let at = held.iter().filter(|own| own.0 == range.column);
        predicted || at.map(|own| &own.1).any(beyond)
    };
    let told = ranges.iter().filter(|own| outside(own)).map(|own| {
        format!(
            "{} (rows have {} to {})",
            own.column,
            plain(own.low),
            plain(own.high)
        )
    });
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| {
        finding(
            "extrapolated",
            format!(
                "means or predictions lie outside of the rows in {}: the model says nothing of \
                 how the response goes on there",
                told.join(", ")
            ),
        )
    })
}

/// Rows with missing cells.
pub(crate) fn left_out_finding(left_out: &[(usize, String)], lines: &Runs) -> Vec<FindingOutcome> {
    let mut columns: Vec<&str> = Vec::new();
    for (_, column) in left_out {
        if !columns.contains(&column.as_str()) {
            columns.push(column);
        }
    }
    let message = |column: &&str| {
        let own = left_out.iter().filter(|(_, name)| name == column);
        let own: Vec<usize> = own.filter_map(|(row, _)| lines.get(*row)).collect();
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

/// Rows of a table by the levels of a model's first category.
pub(crate) fn row_count(
    frame: &ModelFrame,
    table: &Table,
    left_out: &[(usize, String)],
) -> RowCount {
    RowCount {
        rows: table.rows() - left_out.len(),
        left_out: left_out.len(),
        left_out_by: losses(frame, table, left_out),
    }
}

fn losses(frame: &ModelFrame, table: &Table, left_out: &[(usize, String)]) -> Vec<GroupLoss> {
    let category = frame.atoms.iter().find_map(|atom| match atom {
        Encoding::Category { column, .. } => table.column(column).ok(),
        _ => None,
    });
    let Some(categories) = category.map(|own| own.cells.categories()) else {
        return Vec::new();
    };
    let name = |code: Option<usize>| code.map_or("", |code| &categories.levels[code]);
    let mut lost: BTreeMap<Option<usize>, usize> = BTreeMap::new();
    for (row, _) in left_out {
        *lost.entry(categories.codes[*row]).or_default() += 1;
    }
    let rows = |code| categories.codes.iter().filter(|own| **own == code).count();
    let loss = |(code, left_out): (Option<usize>, usize)| GroupLoss {
        group: name(code).to_owned(),
        left_out,
        rows: rows(code),
    };
    lost.into_iter().map(loss).collect()
}

/// Columns of numbers that look like names of levels: 1, 2, 3 … with several rows each.
pub(crate) fn code_findings(frame: &ModelFrame, table: &Table) -> Vec<FindingOutcome> {
    let numbers = frame.atoms.iter().filter_map(|atom| match atom {
        Encoding::Numbers { name, node } => match &node.kind {
            Kind::Name(column) => Some((name, table.numbers(column).ok()?)),
            _ => None,
        },
        _ => None,
    });
    let found = numbers.filter_map(|(name, values)| {
        let count = codes(values)?;
        Some(finding(
            "codes",
            format!(
                "{name} holds the whole numbers 1 to {count}, and is taken as a number with one \
                 slope; if they name levels (blocks, days, lots), write C({name})"
            ),
        ))
    });
    found.collect()
}

/// Largest of the numbers 1, 2, 3 … n, where values are nothing else, and several rows each.
fn codes(values: &Numbers) -> Option<usize> {
    let mut known = [false; MOST_CODES];
    let mut rows = 0;
    for value in values.iter().filter(|own| !own.is_nan()) {
        let code = value as usize;
        if code as f64 != value || code == 0 {
            return None;
        }
        *known.get_mut(code - 1)? = true;
        rows += 1;
    }
    let count = known.iter().filter(|own| **own).count();
    let in_turn = known[..count].iter().all(|own| *own);
    (in_turn && count >= FEWEST_CODES && rows >= 2 * count).then_some(count)
}

/// A lack of fit that chance does not explain.
pub(crate) fn lack_finding(lack_of_fit: Option<&LackOfFit>) -> Option<FindingOutcome> {
    let lack = &lack_of_fit?.lack;
    (lack.p < LACKING).then(|| {
        finding(
            "lack-of-fit",
            format!(
                "the model misses rows by more than repeated rows scatter ({}): a term may be \
                 missing, or repeats were made in the same batch or on the same day and differ \
                 less than other rows do",
                p_value(lack.p)
            ),
        )
    })
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
    influence: &Influence,
    vif: &[Inflation],
    lines: &Runs,
    steps: &[StepOutcome],
) -> Vec<FindingOutcome> {
    let mut found = Vec::new();
    if fit.residual_df == 0 {
        found.push(finding(
            "saturated",
            "there are as many coefficients as rows: nothing is left to tell their errors".into(),
        ));
    }
    if fit.residual_df > 0 && fit.residual_ss <= EXACT * fit.total_ss {
        found.push(finding(
            "exact-fit",
            "the model describes the response but for rounding: its standard errors, tests and \
             probabilities say nothing"
                .to_owned(),
        ));
    }
    found.extend(condition_finding(fit.condition));
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
    let at = |chosen: fn(&RowInfluence) -> bool| -> Vec<usize> {
        let rows = influence.places(chosen).into_iter();
        rows.filter_map(|row| lines.get(row)).collect()
    };
    let alone = at(|row| row.leverage > 1.0 - 1e-9);
    if !alone.is_empty() && fit.residual_df > 0 {
        found.push(finding(
            "decides-alone",
            format!(
                "{} {} a coefficient alone: PRESS and predicted R² do not exist",
                lines_text(&alone),
                if alone.len() == 1 {
                    "decides"
                } else {
                    "each decide"
                }
            ),
        ));
    }
    let influential = at(|row| row.cook > 1.0 && row.leverage <= 1.0 - 1e-9);
    if !influential.is_empty() {
        found.push(finding(
            "influential",
            format!("Cook's distance above 1 in {}", lines_text(&influential)),
        ));
    }
    let far = at(|row| row.studentised.abs() > 4.0);
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
