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

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement => "m",
            Self::Rate => "m/s",
            Self::Force => "N",
            Self::Acceleration => "m/s^2",
        }
    }

    /// Name in campaign files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Rate => "rate",
            Self::Force => "force",
            Self::Acceleration => "acceleration",
        }
    }
}

/// How far a sample of an even spacing may be from its place; intervals.
const EVEN: f64 = 1e-3;

/// Whether times are an interval apart each, but for rounding and jitter that does not
/// matter.
fn evenly_spaced(times: &[f64], interval: f64) -> bool {
    let first = times.first().copied().unwrap_or(0.0);
    let off = |(i, time): (usize, &f64)| (time - (first + i as f64 * interval)).abs();
    let largest = times.iter().enumerate().map(off).fold(0.0, f64::max);
    interval > 0.0 && largest <= EVEN * interval
}

/// What is not known of a displacement at the edge of a count.
#[derive(Clone, Copy, Debug)]
pub struct EdgeError {
    /// How far the displacement moves between the readings around it, signed; m.
    pub(crate) span: f64,
    /// Variance beyond that of a place somewhere in the span; m².
    pub(crate) beyond: f64,
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
    /// Weight of each sample relative to that of its quantity, padded; empty
    /// where all are 1.
    pub(crate) relative: [Vec<f64>; QUANTITIES],
    /// Errors of displacements at the edges of a count; empty where samples are no edges.
    pub(crate) edges: Vec<EdgeError>,
    /// Correlation of the noise of successive samples of each quantity; 1.
    pub(crate) persistence: [f64; QUANTITIES],
    /// Recorded samples that each sample stands for, padded; empty where all are 1.
    pub(crate) shares: Vec<f64>,
    /// Sum of squares of each quantity that no model of these samples changes, without
    /// its weight; SI.
    pub(crate) remainder: [f64; QUANTITIES],
    /// Mean time between recorded samples; s.
    pub(crate) interval: f64,
    /// Whether all are this far apart.
    pub(crate) even: bool,
    /// Standard uncertainty of the zero that all samples of a quantity share; SI.
    pub(crate) zero_sd: [f64; QUANTITIES],
    /// Whether samples are means over the interval between them.
    pub(crate) means: bool,
    /// Whether the user gave the noise of each quantity: residuals do not change it.
    pub(crate) given: [bool; QUANTITIES],
}

impl SampleGroup {
    /// Samples at `times`, with a weight per quantity. All slices are as long
    /// as `times`; a quantity that was not measured is `None`.
    pub fn new(times: &[f64], values: [Option<(&[f64], f64)>; QUANTITIES]) -> Self {
        let padded = |slice: &[f64]| {
            let mut out = Vec::with_capacity(slice.len() + PACK);
            out.extend_from_slice(slice);
            out.resize(slice.len() + PACK, 0.0);
            out
        };
        let interval = match times {
            [first, .., last] => (last - first) / (times.len() - 1) as f64,
            _ => 0.0,
        };
        Self {
            len: times.len(),
            times: padded(times),
            values: values.map(|v| v.map_or_else(Vec::new, |(samples, _)| padded(samples))),
            weights: values.map(|v| v.map_or(0.0, |(_, weight)| weight)),
            relative: Default::default(),
            edges: Vec::new(),
            shares: Vec::new(),
            remainder: [0.0; QUANTITIES],
            interval,
            even: evenly_spaced(times, interval),
            persistence: [0.0; QUANTITIES],
            zero_sd: [0.0; QUANTITIES],
            means: false,
            given: [false; QUANTITIES],
        }
    }

    /// The same samples, those of `quantity` with noise whose variance is
    /// 1/(weight × relative weight), sample by sample.
    #[must_use]
    pub fn with_relative_weights(mut self, quantity: Quantity, weights: &[f64]) -> Self {
        debug_assert_eq!(weights.len(), self.len);
        let mut padded = weights.to_vec();
        padded.resize(self.len + PACK, 0.0);
        self.relative[quantity as usize] = padded;
        self
    }

    /// The same samples, displacements at the edges of a count with these errors.
    #[must_use]
    pub(crate) fn with_edges(mut self, edges: Vec<EdgeError>) -> Self {
        debug_assert_eq!(edges.len(), self.len);
        self.edges = edges;
        self
    }

    /// The same samples, those of `quantity` with noise that is a first-order
    /// autoregression of variance 1/weight and this correlation of successive
    /// samples, −1 < φ < 1.
    #[must_use]
    pub fn with_persistence(mut self, quantity: Quantity, persistence: f64) -> Self {
        self.persistence[quantity as usize] = persistence;
        self
    }

    /// The same samples, those of `quantity` with an unknown zero in common that
    /// is normal with this standard deviation; SI.
    #[must_use]
    pub fn with_zero_sd(mut self, quantity: Quantity, sd: f64) -> Self {
        self.zero_sd[quantity as usize] = sd;
        self
    }

    /// The same samples, those of `quantity` with noise that is known and not estimated.
    #[must_use]
    pub fn with_given_noise(mut self, quantity: Quantity, given: bool) -> Self {
        self.given[quantity as usize] = given;
        self
    }

    /// The same samples, which are means over the interval between them.
    #[must_use]
    pub fn of_means(mut self) -> Self {
        self.means = true;
        self
    }

    /// The same samples without those of `quantity`.
    pub(crate) fn without(mut self, quantity: Quantity) -> Self {
        let q = quantity as usize;
        self.values[q].clear();
        self.weights[q] = 0.0;
        (self.persistence[q], self.zero_sd[q]) = (0.0, 0.0);
        self
    }

    /// Adds to each sample of each quantity what `change` says at its time.
    pub(crate) fn shift(&mut self, change: impl Fn(Quantity, f64) -> f64) {
        for quantity in Quantity::ALL {
            let values = self.values[quantity as usize].iter_mut();
            for (value, time) in values.zip(&self.times[..self.len]) {
                *value += change(quantity, *time);
            }
        }
    }

    /// Weight of sample `index` of a quantity in the cost.
    pub fn weight_of(&self, quantity: Quantity, index: usize) -> f64 {
        let relative = &self.relative[quantity as usize];
        self.weights[quantity as usize] * relative.get(index).copied().unwrap_or(1.0)
    }

    /// Samples of `quantity`; empty where it was not measured.
    pub fn values(&self, quantity: Quantity) -> &[f64] {
        let values = &self.values[quantity as usize];
        &values[..self.len.min(values.len())]
    }

    /// Sampling times; s.
    pub fn times(&self) -> &[f64] {
        &self.times[..self.len]
    }

    /// Mean time between recorded samples; s. Zero for a single sample.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Whether it holds samples of `quantity`.
    pub fn holds(&self, quantity: Quantity) -> bool {
        !self.values[quantity as usize].is_empty()
    }

    /// Whether the noise of quantity `q` is independent from sample to sample.
    pub(crate) fn is_white(&self, q: usize) -> bool {
        self.persistence[q] == 0.0 && self.zero_sd[q] == 0.0
    }

    /// Indices of the samples with `from ≤ time − onset < to`; the last ones
    /// included when `to` is the end of the motion.
    #[inline(always)]
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
    #[inline(always)]
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
