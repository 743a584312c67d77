//! What can go wrong with samples: describing, comparing and testing them.

/// Errors of samples.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum SampleError {
    #[error("{what}: {found} values, and at least {needed} are needed")]
    TooFewValues {
        what: String,
        found: usize,
        needed: usize,
    },
    #[error("{found} group; a comparison needs at least two")]
    TooFewGroups { found: usize },
    #[error("{what}: value {place} is {value}; leave out missing values first")]
    NotFinite {
        what: String,
        place: usize,
        value: f64,
    },
    #[error("{what}: value {place} is {value}, and all have to be above zero")]
    NotPositive {
        what: String,
        place: usize,
        value: f64,
    },
    #[error("{what}: {first} values against {second}; each needs its partner")]
    LengthsDiffer {
        what: String,
        first: usize,
        second: usize,
    },
    #[error("{0}: all values are equal, so there is no spread to compare with")]
    NoSpread(String),
    #[error("{quantity} is {value}; {expected} is expected")]
    OutOfRange {
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    },
}

impl SampleError {
    pub(crate) fn too_few(what: impl Into<String>, found: usize, needed: usize) -> Self {
        let what = what.into();
        Self::TooFewValues {
            what,
            found,
            needed,
        }
    }

    pub(crate) fn lengths(what: impl Into<String>, first: usize, second: usize) -> Self {
        let what = what.into();
        Self::LengthsDiffer {
            what,
            first,
            second,
        }
    }
}
