//! What can go wrong with samples: describing, comparing and testing them.

/// Errors of samples.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SampleError {
    /// Too few values for what was asked.
    #[error("{what}: {found} values, and at least {needed} are needed")]
    TooFewValues {
        /// Which values.
        what: String,
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Nothing to compare a group with.
    #[error("{found} group; a comparison needs at least two")]
    TooFewGroups {
        /// How many there are.
        found: usize,
    },
    /// A value is missing, infinite or not a number.
    #[error("{what}: value {place} is {value}; leave out missing values first")]
    NotFinite {
        /// Which values.
        what: String,
        /// Place, from 1.
        place: usize,
        /// The value.
        value: f64,
    },
    /// A value that is zero or below.
    #[error("{what}: value {place} is {value}, and all have to be above zero")]
    NotPositive {
        /// Which values.
        what: String,
        /// Place, from 1.
        place: usize,
        /// The value.
        value: f64,
    },
    /// Two lists that belong together have different lengths.
    #[error("{what}: {first} values against {second}; each needs its partner")]
    LengthsDiffer {
        /// Which values.
        what: String,
        /// Length of the first.
        first: usize,
        /// Length of the second.
        second: usize,
    },
    /// All values are the same where their spread is needed.
    #[error("{what}: all values are equal, so there is no spread to compare with")]
    NoSpread {
        /// Which values.
        what: String,
    },
    /// A setting outside its range.
    #[error("{quantity} is {value}; {expected} is expected")]
    OutOfRange {
        /// Which setting.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What is legal.
        expected: &'static str,
    },
}
