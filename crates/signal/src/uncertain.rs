//! Values with their standard uncertainty.

/// A value with its standard uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertain {
    /// Value.
    pub value: f64,
    /// Standard uncertainty.
    pub sd: f64,
}
