//! Densities that can be drawn from, and their points.

/// A density in coordinates in which it is near a standard normal one.
pub(crate) trait LogDensity {
    /// Number of coordinates.
    fn size(&self) -> usize;

    /// Log-density at `z`, up to a constant, and its gradient; `None` where there
    /// is none.
    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64>;

    /// Told after each of `all` draws, those for tuning among them.
    fn drawn(&self, _done: usize, _all: usize) {}
}

/// A point with the density there.
#[derive(Clone)]
pub(crate) struct Point {
    pub at: Vec<f64>,
    pub gradient: Vec<f64>,
    pub log_density: f64,
}

impl Point {
    /// The point at `at`; `None` where there is no density.
    pub(crate) fn new(density: &dyn LogDensity, at: Vec<f64>) -> Option<Self> {
        let mut gradient = vec![0.0; at.len()];
        let log_density = density.evaluate(&at, &mut gradient)?;
        let finite = log_density.is_finite() && gradient.iter().all(|g| g.is_finite());
        finite.then_some(Self {
            at,
            gradient,
            log_density,
        })
    }
}
