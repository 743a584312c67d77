//! Tests of the residuals of a linear model, and goodness indices.

use crate::regress::findings::finding;
use windfall_files::found::FindingOutcome;
use windfall_files::text::columns::given;
use windfall_files::text::number::{p_value, plain};
use windfall_files::text::statistic::number;

use crate::goodness_index::{CHI_SQUARED_CAVEAT, goodness_index};
use serde::Serialize;
use std::borrow::Cow;
use windfall_statistics::model::linear_model::LinearFit;
use windfall_statistics::model::model_rows::FormulaRows;
use windfall_statistics::residuals::box_cox::{BoxCox, BoxCoxOptions, box_cox_weighted};
use windfall_statistics::residuals::heteroscedasticity::koenker;
use windfall_statistics::residuals::normality::{
    SHAPIRO_WILK_LARGEST, anderson_darling, shapiro_wilk,
};
use windfall_statistics::residuals::order::durbin_watson;

/// Beyond this many rows the tests take long, and find what does not matter.
const MOST_ROWS: usize = 20_000;

/// Probability below which a test is worth a word.
const DOUBTFUL: f64 = 0.01;

/// A test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TestOutcome {
    /// The test.
    pub test: &'static str,
    /// Its statistic.
    pub statistic: f64,
    /// Its probability.
    pub p: f64,
}

/// How far predictions are from what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct GoodnessOutcome {
    /// Σ (O - P)² / P, where predictions are positive.
    pub chi_squared: Option<f64>,
    /// Σ (O - P)² / (N - p).
    pub reduced_chi_squared: Option<f64>,
    /// What has to be said beside these.
    pub caveat: &'static str,
    /// Root mean square difference.
    pub root_mean_square: f64,
    /// Mean of |O - P|.
    pub mean_absolute: f64,
    /// Mean of |O - P| / |O|.
    pub mean_absolute_relative: Option<f64>,
}

/// Tests of residuals, transform of the response, goodness indices.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[schema(as = ModelResiduals)]
pub struct ResidualOutcome {
    /// Normality, equal variance, order.
    pub tests: Vec<TestOutcome>,
    /// Where the response is positive.
    pub box_cox: Option<BoxCox>,
    /// Indices.
    pub goodness: Option<GoodnessOutcome>,
}

/// Tests the residuals of a model.
pub fn residual_tests(rows: &FormulaRows, fit: &LinearFit) -> ResidualOutcome {
    let goodness = goodness_index(&rows.y, &fit.fitted(&rows.y), fit.columns.len()).ok();
    let goodness = goodness.map(|index| GoodnessOutcome {
        chi_squared: index.chi_squared,
        reduced_chi_squared: index.reduced_chi_squared,
        caveat: CHI_SQUARED_CAVEAT,
        root_mean_square: index.root_mean_square,
        mean_absolute: index.mean_absolute,
        mean_absolute_relative: index.mean_absolute_relative,
    });
    let mut outcome = ResidualOutcome {
        tests: Vec::new(),
        box_cox: None,
        goodness,
    };
    if fit.rows > MOST_ROWS || fit.residual_df == 0 {
        return outcome;
    }
    let matrix = rows.x();
    let Ok(x) = matrix.whole() else {
        return outcome;
    };
    let x = x.select_columns(&fit.columns);
    // Of one variance, and the columns with them; what the variance may change along is not.
    let residuals = &*fit.weights.weigh(&fit.residuals);
    let weighted = match fit.weights.is_empty() {
        true => Cow::Borrowed(&x),
        false => Cow::Owned(fit.weights.weigh_columns(&x)),
    };
    let (normality, normal) = match residuals.len() <= SHAPIRO_WILK_LARGEST {
        true => ("normal (Shapiro-Wilk)", shapiro_wilk(residuals)),
        false => ("normal (Anderson-Darling)", anderson_darling(residuals)),
    };
    let variance = "equal variance (Breusch-Pagan, Koenker's form)";
    let order = "independent of the order of rows (Durbin-Watson)";
    // Tests without enough rows or spread are left out.
    let tests = [
        (normality, normal.ok().map(|t| (t.statistic, t.p))),
        (
            variance,
            koenker(residuals, &x).ok().map(|t| (t.statistic, t.p)),
        ),
        (
            order,
            durbin_watson(residuals, &weighted)
                .ok()
                .map(|t| (t.statistic, t.p)),
        ),
    ];
    let done = |(test, found): (&'static str, Option<(f64, f64)>)| {
        let (statistic, p) = found?;
        Some(TestOutcome { test, statistic, p })
    };
    outcome.tests = tests.into_iter().filter_map(done).collect();
    let options = BoxCoxOptions {
        confidence: fit.confidence,
        ..BoxCoxOptions::default()
    };
    outcome.box_cox = box_cox_weighted(&rows.y, &weighted, &fit.weights, &options).ok();
    outcome
}

/// What the tests say that a reader must know.
pub(crate) fn residual_findings(outcome: &ResidualOutcome) -> Vec<FindingOutcome> {
    let doubtful = outcome.tests.iter().filter(|test| test.p < DOUBTFUL);
    let mut found: Vec<FindingOutcome> = doubtful
        .map(|test| {
            let message = format!("the residuals are not {}: {}", test.test, p_value(test.p));
            finding("residuals", message)
        })
        .collect();
    if let Some(transform) = &outcome.box_cox {
        let above = transform.low.is_some_and(|low| low > 1.0);
        let below = transform.high.is_some_and(|high| high < 1.0);
        if above || below {
            found.push(finding(
                "transform",
                format!(
                    "the response suits the model better to the power {} (Box-Cox; 0 is the \
                     logarithm)",
                    plain(transform.lambda)
                ),
            ));
        }
    }
    found
}

/// The tests as text.
pub fn residuals_text(outcome: &ResidualOutcome) -> String {
    let mut text = String::new();
    if !outcome.tests.is_empty() {
        text += "\nResiduals:\n";
    }
    for test in &outcome.tests {
        let (statistic, p) = (number(test.statistic), p_value(test.p));
        text += &format!("  {}: {statistic}, {p}\n", test.test);
    }
    if let Some(found) = &outcome.box_cox {
        let end = |end: Option<f64>| end.map_or_else(|| "beyond ±3".to_owned(), plain);
        text += &format!(
            "  power of the response (Box-Cox): {}, from {} to {}\n",
            plain(found.lambda),
            end(found.low),
            end(found.high)
        );
    }
    if let Some(goodness) = &outcome.goodness {
        text += &format!(
            "  chi-square index {}, per degree of freedom {}: not a test, both depend on the unit\n",
            given(goodness.chi_squared, plain),
            given(goodness.reduced_chi_squared, plain),
        );
    }
    text
}
