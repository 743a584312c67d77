//! Straight lines through stretches of a curve.

/// A slope with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// Slope.
    pub value: f64,
    /// Standard error, residuals taken as independent.
    pub sd: f64,
}

/// Sums over a stretch of samples that moves forward.
pub struct Window<'a> {
    x: &'a [f64],
    y: &'a [f64],
    first: usize,
    /// One behind the last sample.
    end: usize,
}

impl<'a> Window<'a> {
    /// No samples yet.
    pub fn new(x: &'a [f64], y: &'a [f64]) -> Self {
        Self {
            x,
            y,
            first: 0,
            end: 0,
        }
    }

    /// Takes in the samples up to `last`, and leaves those behind that are `far`
    /// from it, but keeps `least`.
    pub fn advance(&mut self, last: usize, least: usize, far: impl Fn(usize) -> bool) {
        self.end = last + 1;
        while self.end - self.first > least && far(self.first) {
            self.first += 1;
        }
    }

    /// The sample in the middle.
    pub fn middle(&self) -> usize {
        (self.first + self.end - 1) / 2
    }

    /// What the samples span.
    pub fn length(&self) -> f64 {
        self.x[self.end - 1] - self.x[self.first]
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.end - self.first
    }

    /// Slope of the straight line through the samples; `None` where there are
    /// too few of them or they do not differ.
    pub fn slope(&self) -> Option<Slope> {
        let (x, y) = (&self.x[self.first..self.end], &self.y[self.first..self.end]);
        straight_line(x, y)
    }
}

/// Slope of the straight line through some samples.
pub fn straight_line(x: &[f64], y: &[f64]) -> Option<Slope> {
    let n = x.len() as f64;
    if x.len() < 3 {
        return None;
    }
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        let (x, y) = (x - mean_x, y - mean_y);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    if xx <= 0.0 || !xx.is_finite() {
        return None;
    }
    let value = xy / xx;
    let rest = (yy - value * xy).max(0.0);
    Some(Slope {
        value,
        sd: (rest / (n - 2.0) / xx).sqrt(),
    })
}
