//! What a planned study can tell: power of tests and width of intervals, in closed form.

pub mod drawn_slope;
pub mod half_width;
pub mod t_test;
pub mod welch;

use windfall_distribution::tail::t_upper_quantile;

/// A test at a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// Probability of rejecting where there is no effect, between 0 and 1.
    pub alpha: f64,
    /// Which effects count.
    pub sides: Sides,
}

/// Which effects a test looks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// Those in the direction that was expected.
    One,
    /// Those in both directions; a rejection on the wrong side counts too (`strict = TRUE` in
    /// R's `power.t.test`).
    #[default]
    Two,
}

impl Test {
    /// Probability in one tail beyond the critical value; NaN unless 0 < α < 1.
    pub fn tail(self) -> f64 {
        let alpha = probability(self.alpha);
        match self.sides {
            Sides::One => alpha,
            Sides::Two => 0.5 * alpha,
        }
    }
}

/// The value where it lies between 0 and 1, else NaN.
fn probability(value: f64) -> f64 {
    match value > 0.0 && value < 1.0 {
        true => value,
        false => f64::NAN,
    }
}

/// Quantile of t of an interval of this confidence; NaN unless 0 < confidence < 1.
pub(crate) fn interval_quantile(confidence: f64, df: f64) -> f64 {
    t_upper_quantile(0.5 * (1.0 - probability(confidence)), df)
}
