//! Why a mixed model cannot be fitted or used.

use thiserror::Error;

/// What is wrong with a mixed model, or with what is asked of it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum MixedError {
    #[error(
        "{what}, row {row}: {value} where a finite number is needed; leave the row out or complete it"
    )]
    NotFinite {
        what: String,
        row: usize,
        value: f64,
    },
    #[error("{what}: {found} entries where {expected} are needed")]
    WrongLength {
        what: String,
        found: usize,
        expected: usize,
    },
    #[error("{name} has no columns; give it at least an intercept")]
    NoColumns { name: String },
    #[error(
        "{rows} rows cannot determine {coefficients} coefficients and a residual variance; measure more or leave terms out"
    )]
    FewRows { rows: usize, coefficients: usize },
    #[error("{model}: column {name} {}; leave one of them out", made_of(on))]
    DependentColumn {
        model: String,
        name: String,
        on: Vec<String>,
    },
    #[error(
        "random term ({term}), row {row}: group {group}, but there are {groups}, counted from 0"
    )]
    UnknownGroup {
        term: String,
        row: usize,
        group: usize,
        groups: usize,
    },
    #[error(
        "random term ({term}): {groups} groups with rows, and at least {needed} are needed to estimate how groups differ; use a fixed effect instead"
    )]
    FewGroups {
        term: String,
        groups: usize,
        needed: usize,
    },
    #[error(
        "random term ({term}): {effects} random effects for {rows} rows; its variance cannot be told from the residual variance without groups of several rows"
    )]
    ManyRandomEffects {
        term: String,
        effects: usize,
        rows: usize,
    },
    #[error(
        "{what} reproduce the response to {residual:.1e} of its spread: there is no residual variance to compare with; check that the response is measured, not computed"
    )]
    NoResidual { what: &'static str, residual: f64 },
    #[error(
        "the criterion of the mixed model is not finite at the start; scale the response and the columns to sizes near 1"
    )]
    NoCriterion,
    #[error(
        "Kenward and Roger's method needs a fit by restricted maximum likelihood; fit with REML"
    )]
    NeedsRestricted,
    #[error(
        "{effects} random effects of several grouping factors are too many for Kenward and Roger's method (at most {most}); use Satterthwaite's, which is near it with so many groups"
    )]
    ManyCrossedEffects { effects: usize, most: usize },
    #[error(
        "the variances of the model cannot be told apart, and Kenward and Roger's method needs the covariance of all; use Satterthwaite's or a simpler random part"
    )]
    SingularInformation,
    #[error("a confidence of {confidence} is none; give a share between 0 and 1, as 0.95")]
    WrongConfidence { confidence: f64 },
    #[error(
        "{column}: the level {level:?} {what}, so its variance cannot be estimated: merge it with \
         another level, leave its rows out, or fit without --variance"
    )]
    LevelVariance {
        column: String,
        level: String,
        what: String,
    },
    #[error("new rows, row {row}: the model has no such level of {column}")]
    UnknownLevel { column: String, row: usize },
    #[error("the contrast is zero: it tests nothing; give at least one weight that differs from 0")]
    EmptyContrast,
}

fn made_of(on: &[String]) -> String {
    match on {
        [] => "is zero".to_owned(),
        [only] => format!("is a multiple of {only}"),
        _ => format!("is a combination of {}", on.join(", ")),
    }
}
