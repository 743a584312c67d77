//! Variances of a mixed model with their intervals.

use crate::regress::findings::finding;
use crate::regress::mixed_outcome::{MixedLevelsOutcome, VarianceOutcome};
use crate::regress::variances::run::variances_test;
use windfall_files::found::FindingOutcome;
use windfall_mixed::constraint::VarianceParameter;
use windfall_mixed::fit::MixedFit;
use windfall_mixed::profile::Profiles;

/// Variances with profile intervals.
pub(crate) fn variances(
    fit: &MixedFit,
    profiles: &Profiles,
) -> (Vec<VarianceOutcome>, Vec<FindingOutcome>) {
    let shown = profiles.intervals.iter().map(|interval| {
        let (group, kind, of, value) = match &interval.parameter {
            VarianceParameter::Sd { term, column } => {
                let own = &fit.variances[*term];
                (
                    own.term.clone(),
                    "sd",
                    own.columns[*column].clone(),
                    own.sds[*column],
                )
            }
            VarianceParameter::Correlation { term, columns } => {
                let own = &fit.variances[*term];
                let [first, second] = columns;
                let of = format!("{}, {}", own.columns[*first], own.columns[*second]);
                (
                    own.term.clone(),
                    "correlation",
                    of,
                    own.correlations[(*first, *second)],
                )
            }
            VarianceParameter::ResidualSd { level } => {
                let levels = fit.model.levels().zip(fit.levels.as_ref());
                let (of, sd) = match levels {
                    None => (String::new(), fit.residual_sd),
                    Some((levels, own)) => (levels.names[*level].clone(), own.sds[*level]),
                };
                ("residual".to_owned(), "sd", of, sd)
            }
        };
        VarianceOutcome {
            group,
            kind,
            of,
            value,
            low: interval.low,
            high: interval.high,
        }
    });
    let findings = profiles.findings.iter();
    (
        shown.collect(),
        findings.map(|f| finding(f.code(), f.to_string())).collect(),
    )
}

/// Levels with residual variances of their own, tested against one for all.
pub(crate) fn level_variances(fit: &MixedFit) -> Option<MixedLevelsOutcome> {
    let (levels, own) = (fit.model.levels()?, fit.levels.as_ref()?);
    let names = levels.names.iter().cloned();
    Some(MixedLevelsOutcome {
        by: levels.column.clone(),
        rows: names.zip(own.rows.iter().copied()).collect(),
        test: variances_test(
            fit.log_likelihood - own.equal_log_likelihood,
            own.rows.len(),
        ),
    })
}
