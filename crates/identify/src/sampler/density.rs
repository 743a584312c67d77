//! Densities that can be drawn from, and how much of them is drawn.

/// How much of a posterior is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drawing {
    /// Chains.
    pub chains: usize,
    /// Kept draws of each.
    pub draws: usize,
    /// Seed of all of them.
    pub seed: u64,
}

/// A density in coordinates in which it is near a standard normal one.
#[cfg_attr(not(feature = "sampler"), allow(dead_code))]
pub(crate) trait LogDensity {
    /// Number of coordinates.
    fn size(&self) -> usize;

    /// Log-density at `z`, up to a constant, and its gradient; `None` where there
    /// is none.
    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64>;

    /// Told after each of `all` draws, those for tuning among them.
    fn drawn(&self, _done: usize, _all: usize) {}
}
