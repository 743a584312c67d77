//! Measured samples as the residual pass reads them.

/// Samples evaluated side by side.
pub(crate) const PACK: usize = 4;
/// Quantities a sample may have, in the order of [`Quantity`].
pub const QUANTITIES: usize = 4;

/// Measured quantities that a fit can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Displacement; m.
    Displacement,
    /// Displacement rate; m/s.
    Rate,
    /// Contact force; N.
    Force,
    /// Acceleration; m/s².
    Acceleration,
}

impl Quantity {
    /// All, in the order of the arrays indexed by quantity.
    pub const ALL: [Self; QUANTITIES] = [
        Self::Displacement,
        Self::Rate,
        Self::Force,
        Self::Acceleration,
    ];

    /// Name in campaign files and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Rate => "rate",
            Self::Force => "force",
            Self::Acceleration => "acceleration",
        }
    }
}

/// Samples of one or more quantities taken at the same times.
#[derive(Clone, Debug)]
pub struct SampleGroup {
    /// Number of samples.
    pub(crate) len: usize,
    /// Times, followed by padding for the last pack; s.
    pub(crate) times: Vec<f64>,
    /// Samples of each quantity, padded; empty when there are none.
    pub(crate) values: [Vec<f64>; QUANTITIES],
    /// Weight of each quantity in the cost; zero when there are none.
    pub(crate) weights: [f64; QUANTITIES],
}

impl SampleGroup {
    /// Samples at `times`, with a weight per quantity. All slices are as long
    /// as `times`; a quantity that was not measured is `None`.
    #[must_use]
    pub fn new(times: &[f64], values: [Option<(&[f64], f64)>; QUANTITIES]) -> Self {
        let padded = |slice: &[f64]| {
            let mut out = Vec::with_capacity(slice.len() + PACK);
            out.extend_from_slice(slice);
            out.resize(slice.len() + PACK, 0.0);
            out
        };
        Self {
            len: times.len(),
            times: padded(times),
            values: values.map(|v| v.map_or_else(Vec::new, |(samples, _)| padded(samples))),
            weights: values.map(|v| v.map_or(0.0, |(_, weight)| weight)),
        }
    }

    /// Sampling times; s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times[..self.len]
    }

    /// Mean time between samples; s. Zero for a single sample.
    #[must_use]
    pub fn interval(&self) -> f64 {
        match self.times() {
            [first, .., last] => (last - first) / (self.len - 1) as f64,
            _ => 0.0,
        }
    }

    /// Whether it holds samples of `quantity`.
    #[must_use]
    pub fn holds(&self, quantity: Quantity) -> bool {
        !self.values[quantity as usize].is_empty()
    }

    /// Weight of a quantity in the cost.
    #[must_use]
    pub fn weight(&self, quantity: Quantity) -> f64 {
        self.weights[quantity as usize]
    }

    /// Indices of the samples with `from ≤ time − onset < to`; the last ones
    /// included when `to` is the end of the motion.
    pub(crate) fn range(
        &self,
        onset: f64,
        segment_from: f64,
        segment_to: f64,
        end: f64,
    ) -> (usize, usize) {
        let first = self.first_from(onset, segment_from);
        let last = if segment_to >= end {
            self.len
        } else {
            self.first_from(onset, segment_to)
        };
        (first, last)
    }

    /// Index of the first sample with `time − onset ≥ from`: guessed from an even
    /// spacing, and searched for where that is wrong.
    fn first_from(&self, onset: f64, from: f64) -> usize {
        let times = self.times();
        let before = |i: usize| times[i] - onset < from;
        let [start, ..] = times else { return 0 };
        let guess = ((from + onset - start) / self.interval()).ceil();
        // A guess that is no number becomes 0.
        let guess = (guess.max(0.0) as usize).min(times.len());
        for at in [guess, guess.saturating_sub(1), guess + 1] {
            let above = at == 0 || (at <= times.len() && before(at - 1));
            let below = at >= times.len() || !before(at);
            if above && below && at <= times.len() {
                return at;
            }
        }
        times.partition_point(|t| t - onset < from)
    }
}
