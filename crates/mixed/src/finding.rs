//! What a reader of a mixed model should know besides its numbers.

/// A remark on one mixed model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum MixedFinding {
    #[error(
        "singular fit: ({term}) {what}; the data show no more of this kind of variation \
         than chance makes, and a simpler random part fits as well"
    )]
    Singular { term: String, what: String },
    #[error(
        "the search stopped after {evaluations} evaluations before the criterion was \
         level; its values are not estimates"
    )]
    NoConvergence { evaluations: usize },
    #[error(
        "the likelihood does not depend on {directions} direction(s) of the variance \
         parameters, and the variances along them are arbitrary; the fixed effects may \
         take up all differences between groups, or nothing is left for the residual"
    )]
    FlatCriterion { directions: usize },
    #[error(
        "the {side} end of the profile interval of {parameter} was not reached; the \
         likelihood stays too high"
    )]
    ProfileOpen {
        parameter: String,
        side: &'static str,
    },
    #[error(
        "the likelihood is higher by {rise:.3} where the level {level} does not scatter about the \
         model at all; shown is the highest maximum at which every level does: the rows say \
         little about the variance of that level"
    )]
    HigherWithoutScatter { level: String, rise: f64 },
    #[error(
        "the log-likelihood has a second maximum, lower by {below:.3}: there are few rows for so \
         many variances, and standard errors and intervals understate the uncertainty"
    )]
    SeveralMaxima { below: f64 },
    #[error(
        "the likelihood is higher by {rise:.3} at another value of {parameter}: what is shown is \
         not its highest maximum; try a simpler random part or fewer levels"
    )]
    HigherElsewhere { parameter: String, rise: f64 },
}

impl MixedFinding {
    /// A name for programs, which stays.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Singular { .. } => "singular",
            Self::NoConvergence { .. } => "no_convergence",
            Self::FlatCriterion { .. } => "flat_criterion",
            Self::ProfileOpen { .. } => "profile_open",
            Self::HigherWithoutScatter { .. } => "higher_without_scatter",
            Self::SeveralMaxima { .. } => "several_maxima",
            Self::HigherElsewhere { .. } => "higher_elsewhere",
        }
    }
}
