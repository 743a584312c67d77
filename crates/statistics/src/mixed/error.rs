//! Why a mixed model cannot be fitted or used.

use thiserror::Error;

/// What is wrong with a mixed model, or with what is asked of it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MixedError {
    /// A number that is none.
    #[error(
        "{what}, row {row}: {value} where a finite number is needed; leave the row out or complete it"
    )]
    NotFinite {
        /// Column or response.
        what: String,
        /// Row, from 1.
        row: usize,
        /// What stands there.
        value: f64,
    },
    /// Two lists that belong together differ in length.
    #[error("{what}: {found} entries where {expected} are needed")]
    WrongLength {
        /// Which list.
        what: String,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
    /// A model or term without columns.
    #[error("{name} has no columns; give it at least an intercept")]
    NoColumns {
        /// The model or term.
        name: String,
    },
    /// No more rows than coefficients.
    #[error(
        "{rows} rows cannot determine {coefficients} coefficients and a residual variance; measure more or leave terms out"
    )]
    FewRows {
        /// Rows.
        rows: usize,
        /// Fixed coefficients.
        coefficients: usize,
    },
    /// A column that follows from the others.
    #[error("{model}: column {name} {}; leave one of them out", made_of(on))]
    DependentColumn {
        /// The fixed effects, or the random term.
        model: String,
        /// The column.
        name: String,
        /// The columns it is a combination of; none when it is zero.
        on: Vec<String>,
    },
    /// A group number without a group.
    #[error(
        "random term ({term}), row {row}: group {group}, but there are {groups}, counted from 0"
    )]
    UnknownGroup {
        /// The random term.
        term: String,
        /// Row, from 1.
        row: usize,
        /// Its group.
        group: usize,
        /// How many there are.
        groups: usize,
    },
    /// Too few groups for a variance.
    #[error(
        "random term ({term}): {groups} groups with rows, and at least {needed} are needed to estimate how groups differ; use a fixed effect instead"
    )]
    FewGroups {
        /// The random term.
        term: String,
        /// Groups that have rows.
        groups: usize,
        /// Groups needed.
        needed: usize,
    },
    /// As many random effects as rows.
    #[error(
        "random term ({term}): {effects} random effects for {rows} rows; its variance cannot be told from the residual variance without groups of several rows"
    )]
    ManyRandomEffects {
        /// The random term.
        term: String,
        /// Its groups times its columns.
        effects: usize,
        /// Rows.
        rows: usize,
    },
    /// Nothing is left to be residual.
    #[error(
        "{what} reproduce the response to {residual:.1e} of its spread: there is no residual variance to compare with; check that the response is measured, not computed"
    )]
    NoResidual {
        /// Which effects do.
        what: &'static str,
        /// Length of the residual by that of the response, or of what fixed effects leave.
        residual: f64,
    },
    /// A model whose criterion is not finite where it starts.
    #[error(
        "the criterion of the mixed model is not finite at the start; scale the response and the columns to sizes near 1"
    )]
    NoCriterion,
    /// Kenward and Roger's method with plain maximum likelihood.
    #[error(
        "Kenward and Roger's method needs a fit by restricted maximum likelihood; fit with REML"
    )]
    NeedsRestricted,
    /// Too many random effects for dense matrices.
    #[error(
        "{effects} random effects of several grouping factors are too many for Kenward and Roger's method (at most {most}); use Satterthwaite's, which is near it with so many groups"
    )]
    ManyCrossedEffects {
        /// Random effects.
        effects: usize,
        /// How many are handled.
        most: usize,
    },
    /// Variances that the data cannot tell apart.
    #[error(
        "the variances of the model cannot be told apart, and Kenward and Roger's method needs the covariance of all; use Satterthwaite's or a simpler random part"
    )]
    SingularInformation,
    /// Two models that no likelihood ratio compares.
    #[error("the two models cannot be compared by likelihood ratio: {reason}")]
    NotComparable {
        /// Why.
        reason: &'static str,
    },
    /// A confidence outside of (0, 1).
    #[error("a confidence of {confidence} is none; give a share between 0 and 1, as 0.95")]
    WrongConfidence {
        /// What was asked for.
        confidence: f64,
    },
    /// A test of nothing.
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
