//! Group summaries and comparisons as text and CSV.

use crate::compare::agreement::AgreementOutcome;
use crate::compare::outcome::{CompareOutcome, PairOutcome, StatisticTest};
use crate::compare::summary::SummaryOutcome;
use crate::rows::{RowCount, rows_text};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::columns::{Column, csv_of_rows, given, strings, text_of_rows};
use windfall_files::text::number::{beside_sd, plain};
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::{findings_list, page_tables};
use windfall_statistics::compare::group_summary::GroupSummary;
use windfall_statistics::compare::one_way_anova::FTest;

/// "95 %".
fn percent(part: f64) -> String {
    match part.is_finite() {
        // 0.29 × 100 is 28.999999999999996
        true => format!("{} %", (1e6 * part).round() / 1e4),
        false => "-".to_owned(),
    }
}

/// Mean and spread of a group.
fn group_cells(group: &GroupSummary) -> Vec<String> {
    let cv = match group.cv.is_finite() {
        true => format!("{:.1} %", 100.0 * group.cv),
        false => "-".to_owned(),
    };
    let mut cells = vec![
        group.group.clone(),
        group.n.to_string(),
        beside_sd(group.mean, group.se),
    ];
    cells.extend([number(group.sd), cv, number(group.se)]);
    cells.extend([group.low, group.high].map(|end| beside_sd(end, group.se)));
    cells
}

/// Order statistics of a group.
fn order_cells(group: &GroupSummary) -> Vec<String> {
    let mut cells = vec![group.group.clone(), group.missing.to_string()];
    let ordered = [group.min, group.q1, group.median, group.q3, group.max];
    cells.extend(ordered.map(number));
    cells
}

/// A column of values, with the rows that were left out.
fn heading(value: &str, count: &RowCount) -> String {
    match count.left_out {
        0 => value.to_owned(),
        _ => format!("{value}: {}", rows_text(count)),
    }
}

/// Group summaries as text.
pub fn text_of_summary(outcome: &SummaryOutcome) -> String {
    let by = match outcome.by.is_empty() {
        true => "group".to_owned(),
        false => outcome.by.join(", "),
    };
    let spread = strings(&[&by, "n", "mean", "SD", "CV", "SE", "from", "to"]);
    let order = strings(&[&by, "missing", "min", "Q1", "median", "Q3", "max"]);
    let mut text = String::new();
    for value in &outcome.values {
        let groups = || value.groups.iter();
        let rows: Vec<Vec<String>> = groups().map(group_cells).collect();
        let spread = page_tables(&spread, &rows, &[0]);
        let rows: Vec<Vec<String>> = groups().map(order_cells).collect();
        let order = page_tables(&order, &rows, &[0]);
        let heading = heading(&value.value, &value.count);
        text += &format!("{heading}\n\n{spread}\n\n{order}\n\n");
    }
    text += &format!(
        "from, to: {} interval of the mean; CV: SD over mean\n",
        percent(outcome.confidence)
    );
    text + &findings_list(&outcome.findings)
}

/// Group summaries as CSV: one row per value and group.
pub fn csv_of_summary(outcome: &SummaryOutcome) -> Result<String, Error> {
    let mut header = strings(&["value"]);
    header.extend(outcome.by.clone());
    header.extend(strings(&[
        "n", "missing", "mean", "sd", "cv", "se", "low", "high", "min", "q1", "median", "q3", "max",
    ]));
    let rows = outcome.values.iter().flat_map(|value| {
        value.groups.iter().map(|group| {
            let mut row = vec![value.value.clone()];
            row.extend(group.levels.clone());
            row.extend([group.n, group.missing].map(|count| count.to_string()));
            let numbers = [
                group.mean,
                group.sd,
                group.cv,
                group.se,
                group.low,
                group.high,
                group.min,
                group.q1,
                group.median,
                group.q3,
                group.max,
            ];
            row.extend(numbers.map(cell));
            row
        })
    });
    csv_text(&header, rows)
}

/// A number of a CSV cell; blank where there is none.
fn cell(value: f64) -> String {
    match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    }
}

/// A comparison as text.
pub fn text_of_compare(outcome: &CompareOutcome) -> String {
    let mut header = strings(&["n", "mean", "SD", "CV", "SE", "from", "to", "letters"]);
    header.insert(0, outcome.by.join(", "));
    let rows = outcome.groups.iter().map(|group| {
        let mut cells = group_cells(&group.group);
        cells.push(group.letters.clone());
        cells
    });
    let left = [0, header.len() - 1];
    let mut text = heading(&outcome.value, &outcome.count) + "\n\n";
    text += &page_tables(&header, &rows.collect::<Vec<_>>(), &left);
    text += &format!(
        "\n\nfrom, to: {} interval of the mean; groups that share a letter were not found to differ\n",
        percent(outcome.confidence)
    );
    text += &tests_text(outcome);
    text += &format!("\nPairs: {}\n\n{}\n", outcome.method, pairs_text(outcome));
    text + &findings_list(&outcome.findings)
}

/// Analysis of variance and tests of what it assumes.
fn tests_text(outcome: &CompareOutcome) -> String {
    let ratio = |name: &str, what: &str, test: &FTest| {
        let df = format!("{} and {}", freedom(test.df1), freedom(test.df2));
        vec![
            name.to_owned(),
            what.to_owned(),
            format!("F {}", number(test.f)),
            df,
            probability(test.p),
        ]
    };
    let statistic = |name: &str, what: &str, symbol: &str, test: &StatisticTest| {
        vec![
            name.to_owned(),
            what.to_owned(),
            format!("{symbol} {}", number(test.statistic)),
            test.df.map_or_else(String::new, freedom),
            probability(test.p),
        ]
    };
    let mut rows = Vec::new();
    let mut share = String::new();
    if let Some(anova) = &outcome.anova {
        let test = FTest {
            f: anova.f,
            df1: anova.between_df,
            df2: anova.within_df,
            p: anova.p,
        };
        rows.push(ratio("analysis of variance", "equal means", &test));
        share = format!(
            "\nSS between {}, within {}; SD within {}; η² {:.3}, ω² {:.3}\n",
            plain(anova.between_ss),
            plain(anova.within_ss),
            plain(anova.residual_sd),
            anova.eta_squared,
            anova.omega_squared
        );
    }
    let ratios = [
        ("Welch", "equal means", &outcome.welch),
        ("Levene", "equal variances", &outcome.levene),
        ("Brown-Forsythe", "equal variances", &outcome.brown_forsythe),
    ];
    for (name, what, test) in ratios {
        rows.extend(test.as_ref().map(|test| ratio(name, what, test)));
    }
    let bartlett = outcome.bartlett.as_ref();
    rows.extend(bartlett.map(|test| statistic("Bartlett", "equal variances", "χ²", test)));
    let normal = match outcome.paired {
        Some(_) => "normal differences",
        None => "normal residuals",
    };
    let shapiro = outcome.shapiro_wilk.as_ref();
    rows.extend(shapiro.map(|test| statistic("Shapiro-Wilk", normal, "W", test)));
    if rows.is_empty() {
        return String::new();
    }
    let header = strings(&["test", "of", "statistic", "df", "p"]);
    let table = page_tables(&header, &rows, &[0, 1, 2]);
    format!("\n{table}\n{share}")
}

fn pairs_text(outcome: &CompareOutcome) -> String {
    let symbol = match outcome.method.contains("t test") {
        true => "t",
        false => "q",
    };
    let columns: [Column<PairOutcome>; 9] = [
        ("pair", |pair| format!("{} - {}", pair.second, pair.first)),
        ("difference", |pair| number(pair.difference)),
        ("SE", |pair| number(pair.se)),
        (symbol, |pair| number(pair.statistic)),
        ("df", |pair| freedom(pair.df)),
        ("p", |pair| probability(pair.p)),
        ("from", |pair| number(pair.low)),
        ("to", |pair| number(pair.high)),
        ("g", |pair| number(pair.hedges_g)),
    ];
    text_of_rows(&outcome.pairs, &columns, &[0])
}

/// A comparison as CSV: one row per pair of groups.
pub fn csv_of_compare(outcome: &CompareOutcome) -> Result<String, Error> {
    let pairs: Vec<_> = outcome.pairs.iter().map(|pair| (outcome, pair)).collect();
    let columns: [Column<(&CompareOutcome, &PairOutcome)>; 13] = [
        ("value", |row| row.0.value.clone()),
        ("first", |row| row.1.first.clone()),
        ("second", |row| row.1.second.clone()),
        ("difference", |row| cell(row.1.difference)),
        ("se", |row| cell(row.1.se)),
        ("statistic", |row| cell(row.1.statistic)),
        ("df", |row| cell(row.1.df)),
        ("p", |row| cell(row.1.p)),
        ("low", |row| cell(row.1.low)),
        ("high", |row| cell(row.1.high)),
        ("hedges_g", |row| cell(row.1.hedges_g)),
        ("pairs", |row| {
            row.1.n_pairs.map_or_else(String::new, |n| n.to_string())
        }),
        ("method", |row| row.0.method.to_owned()),
    ];
    csv_of_rows(&pairs, &columns)
}

/// Rows of an agreement: name, number, meaning.
fn agreement_rows(found: &AgreementOutcome) -> [(&'static str, Option<f64>, &'static str); 8] {
    let mean_relative = "mean absolute relative difference, a fraction";
    let r2 = "1 - Σ(O-P)²/Σ(O-Ō)²; below 0: worse than the mean";
    let correlation = "squared correlation, blind to bias and scale";
    let chi_squared = "Σ(O-P)²/P: an index, not a test";
    let reduced = "Σ(O-P)²/(N-p): an index, not a test";
    [
        ("bias", Some(found.bias), "mean of predicted less measured"),
        ("RMSE", Some(found.rmse), "root mean square difference"),
        ("MAE", Some(found.mae), "mean absolute difference"),
        ("MAPE", found.mape, mean_relative),
        ("R2", found.r2, r2),
        ("r2", found.correlation_squared, correlation),
        ("chi_squared", found.chi_squared, chi_squared),
        ("reduced_chi_squared", found.reduced_chi_squared, reduced),
    ]
}

/// An agreement as text.
pub fn text_of_agreement(outcome: &AgreementOutcome) -> String {
    let columns: [Column<(&str, Option<f64>, &str)>; 3] = [
        ("index", |row| row.0.to_owned()),
        ("value", |row| given(row.1, number)),
        ("meaning", |row| row.2.to_owned()),
    ];
    let table = text_of_rows(&agreement_rows(outcome), &columns, &[0, 2]);
    format!(
        "{} (predicted) against {} (measured), {} rows\n\n{table}\n{}",
        outcome.predicted,
        outcome.measured,
        outcome.n,
        findings_list(&outcome.findings)
    )
}

/// An agreement as CSV.
pub fn csv_of_agreement(outcome: &AgreementOutcome) -> Result<String, Error> {
    let rows = agreement_rows(outcome);
    let header: Vec<String> = ["measured", "predicted", "n"]
        .into_iter()
        .chain(rows.iter().map(|row| row.0))
        .map(str::to_owned)
        .collect();
    let mut row = vec![
        outcome.measured.clone(),
        outcome.predicted.clone(),
        outcome.n.to_string(),
    ];
    row.extend(rows.iter().map(|row| row.1.map_or_else(String::new, cell)));
    csv_text(&header, [row])
}
