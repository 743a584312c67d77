//! Residual variances by level as text.

use crate::regress::run::RegressOutcome;
use crate::regress::variances::outcome::{LevelVarianceOutcome, VariancesOutcome};
use windfall_files::text::columns::{Column, text_of_rows};
use windfall_files::text::statistic::{chi_square, freedom, number, probability};
use windfall_statistics::model::anova::AnovaRow;

const LEVELS: [Column<LevelVarianceOutcome>; 6] = [
    ("level", |own| own.level.clone()),
    ("rows", |own| own.rows.to_string()),
    ("sd", |own| number(own.sd)),
    ("from", |own| number(own.low)),
    ("to", |own| number(own.high)),
    ("df", |own| number(own.df)),
];

const TESTS: [Column<(AnovaRow, f64)>; 5] = [
    ("term", |own| own.0.term.clone()),
    ("F", |own| number(own.0.f)),
    ("df", |own| freedom(own.0.df)),
    ("residual df", |own| number(own.1)),
    ("p", |own| probability(own.0.p)),
];

/// Standard deviations of levels, quality and tests of a model with them.
pub(crate) fn variances_text(outcome: &RegressOutcome, variances: &VariancesOutcome) -> String {
    let (test, quality) = (variances.test, &outcome.quality);
    let tests: Vec<(AnovaRow, f64)> = outcome
        .anova
        .iter()
        .cloned()
        .zip(variances.anova_df.iter().copied())
        .collect();
    format!(
        "\n\nResidual standard deviation by {} ({}):\n{}\n\
         against one for all: {}\n\
         log-likelihood {}, AIC {}, AICc {}, BIC {}\n\n\
         Tests of the terms, type {}, with Satterthwaite's degrees of freedom:\n{}\n",
        variances.by,
        variances.method,
        text_of_rows(&variances.levels, &LEVELS, &[0]),
        chi_square(test.statistic, test.df as f64, Some(test.p)),
        number(quality.log_likelihood),
        number(quality.aic),
        number(quality.aicc),
        number(quality.bic),
        outcome.anova_type,
        text_of_rows(&tests, &TESTS, &[0]),
    )
}
