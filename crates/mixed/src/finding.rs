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
}

impl MixedFinding {
    /// A name for programs, which stays.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Singular { .. } => "singular",
            Self::NoConvergence { .. } => "no_convergence",
            Self::FlatCriterion { .. } => "flat_criterion",
            Self::ProfileOpen { .. } => "profile_open",
        }
    }
}
