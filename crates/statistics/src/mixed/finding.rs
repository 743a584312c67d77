//! What a reader of a mixed model should know besides its numbers.

use std::fmt;

/// A remark on one mixed model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MixedFinding {
    /// The estimate lies on the edge of what covariances can be.
    Singular {
        /// The random term.
        term: String,
        /// What is there, in words.
        what: String,
    },
    /// The search stopped before the gradient vanished.
    NoConvergence {
        /// Evaluations of the criterion.
        evaluations: usize,
    },
    /// The criterion does not change in some direction of the variances.
    FlatCriterion {
        /// Number of such directions.
        directions: usize,
    },
    /// A likelihood ratio test of a variance against zero.
    VarianceOnEdge,
    /// A limit of a profile interval was not reached.
    ProfileOpen {
        /// The parameter.
        parameter: String,
        /// Which side.
        side: &'static str,
    },
}

impl MixedFinding {
    /// A name for programs, which stays.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Singular { .. } => "singular",
            Self::NoConvergence { .. } => "no_convergence",
            Self::FlatCriterion { .. } => "flat_criterion",
            Self::VarianceOnEdge => "variance_on_edge",
            Self::ProfileOpen { .. } => "profile_open",
        }
    }
}

impl fmt::Display for MixedFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { term, what } => write!(
                f,
                "singular fit: ({term}) {what}; the data show no more of this kind of variation \
                 than chance makes, and a simpler random part fits as well"
            ),
            Self::NoConvergence { evaluations } => write!(
                f,
                "the search stopped after {evaluations} evaluations before the criterion was \
                 level; its values are not estimates"
            ),
            Self::FlatCriterion { directions } => write!(
                f,
                "the likelihood does not depend on {directions} direction(s) of the variance \
                 parameters, and the variances along them are arbitrary; the fixed effects may \
                 take up all differences between groups, or nothing is left for the residual"
            ),
            Self::VarianceOnEdge => write!(
                f,
                "the models differ in random terms: a variance of zero lies on the edge of what \
                 it can be, and the p-value of chi-square is too large (about twice for one variance)"
            ),
            Self::ProfileOpen { parameter, side } => write!(
                f,
                "the {side} end of the profile interval of {parameter} was not reached; the \
                 likelihood stays too high"
            ),
        }
    }
}
