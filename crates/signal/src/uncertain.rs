//! Values with their standard uncertainty.

/// A value with its standard uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertain {
    /// Value.
    pub value: f64,
    /// Standard uncertainty.
    pub sd: f64,
}

impl Uncertain {
    /// A value with its standard uncertainty.
    pub const fn new(value: f64, sd: f64) -> Self {
        Self { value, sd }
    }

    /// A value without uncertainty.
    pub const fn exact(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}
