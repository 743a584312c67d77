//! The outline of a channel over time, as plots take it.

/// Where a stretch of a channel lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Time of its first sample, s; its number where times are not known.
    pub x: f64,
    /// First sample.
    pub first: f64,
    /// Last sample.
    pub last: f64,
    /// Smallest sample.
    pub smallest: f64,
    /// Largest sample.
    pub largest: f64,
}

/// The outline of a channel over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the channel.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Whether `x` is a time.
    pub timed: bool,
    /// The stretches in order; a stretch of one sample has four equal values.
    pub points: Vec<CurvePoint>,
}
