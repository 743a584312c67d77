//! A curve through points that rises only where they rise.

/// A monotone piecewise cubic with a continuous slope, linear beyond its end.
///
/// # Source
/// Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17:238; slopes inside by
/// the harmonic mean of Fritsch and Butland (1984), at the ends by the parabola
/// through three points, held monotone.
#[derive(Clone, Debug, PartialEq)]
pub struct MonotoneCubic {
    at: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl MonotoneCubic {
    /// Through the points.
    ///
    /// * `at`: rising, at least two; `value`: as many
    pub fn new(at: &[f64], value: &[f64]) -> Self {
        let last = at.len() - 1;
        let width: Vec<f64> = at.windows(2).map(|w| w[1] - w[0]).collect();
        let secant: Vec<f64> = (0..last)
            .map(|i| (value[i + 1] - value[i]) / width[i])
            .collect();
        let mut slope = vec![0.0; at.len()];
        for i in 1..last {
            let (left, right) = (secant[i - 1], secant[i]);
            if left * right > 0.0 {
                let (a, b) = (2.0 * width[i] + width[i - 1], width[i] + 2.0 * width[i - 1]);
                slope[i] = (a + b) / (a / left + b / right);
            }
        }
        if last == 1 {
            slope = vec![secant[0]; 2];
        } else {
            slope[0] = end_slope(width[0], width[1], secant[0], secant[1]);
            let (one, two) = (last - 1, last - 2);
            slope[last] = end_slope(width[one], width[two], secant[one], secant[two]);
        }
        Self {
            at: at.to_vec(),
            value: value.to_vec(),
            slope,
        }
    }

    /// Value and slope at a place.
    pub fn evaluate(&self, at: f64) -> (f64, f64) {
        let last = self.at.len() - 1;
        if at.is_nan() {
            return (f64::NAN, f64::NAN);
        }
        if at <= self.at[0] || at >= self.at[last] {
            let end = if at <= self.at[0] { 0 } else { last };
            let beyond = at - self.at[end];
            return (self.value[end] + self.slope[end] * beyond, self.slope[end]);
        }
        let i = self.at.partition_point(|known| *known <= at) - 1;
        let width = self.at[i + 1] - self.at[i];
        let secant = (self.value[i + 1] - self.value[i]) / width;
        let (first, second) = (self.slope[i], self.slope[i + 1]);
        let quadratic = (3.0 * secant - 2.0 * first - second) / width;
        let cubic = (first + second - 2.0 * secant) / (width * width);
        let h = at - self.at[i];
        let value = self.value[i] + h * (first + h * (quadratic + h * cubic));
        (value, first + h * (2.0 * quadratic + 3.0 * h * cubic))
    }

    /// The steepest slope between the first place and the last, without its sign.
    pub fn largest_slope(&self) -> f64 {
        let ends = self.slope.iter().map(|own| own.abs());
        // Between two points the slope is a parabola.
        let inside = (1..self.at.len()).map(|i| {
            let width = self.at[i] - self.at[i - 1];
            let secant = (self.value[i] - self.value[i - 1]) / width;
            let (first, second) = (self.slope[i - 1], self.slope[i]);
            let quadratic = 3.0 * secant - 2.0 * first - second;
            let cubic = first + second - 2.0 * secant;
            let peak = (-quadratic / (3.0 * cubic)).clamp(0.0, 1.0);
            match cubic == 0.0 {
                true => 0.0,
                false => (first + peak * (2.0 * quadratic + 3.0 * peak * cubic)).abs(),
            }
        });
        ends.chain(inside).fold(0.0, f64::max)
    }

    /// The smallest and the largest value between the first place and the last.
    pub fn range(&self) -> [f64; 2] {
        // Between two points it goes nowhere but from one to the other.
        let values = self.value.iter();
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], own| {
            [own.min(low), own.max(high)]
        })
    }

    /// The last place.
    pub fn end(&self) -> f64 {
        self.at.last().copied().unwrap_or_default()
    }
}

/// Slope at an end by three points, held monotone.
fn end_slope(width: f64, next: f64, secant: f64, following: f64) -> f64 {
    let slope = ((2.0 * width + next) * secant - width * following) / (width + next);
    match () {
        () if slope * secant <= 0.0 => 0.0,
        () if secant * following <= 0.0 && slope.abs() > 3.0 * secant.abs() => 3.0 * secant,
        () => slope,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_smallest_and_largest_values() {
        let own = MonotoneCubic::new(&[0.0, 1.0, 1.5, 4.0], &[0.2, -0.3, 0.9, 0.1]);
        assert_eq!(own.range(), [-0.3, 0.9]);
        let inside = |n: usize| own.evaluate(n as f64 * 0.01).0;
        assert!((0..=400).map(inside).all(|own| (-0.3..=0.9).contains(&own)));
    }

    #[test]
    fn closed_form_a_parabola_and_a_line() {
        // Through three points of a rising parabola the end slopes are exact.
        let at = [0.0, 1.0, 3.0];
        let cubic = MonotoneCubic::new(&at, &[0.0, 3.0, 15.0]);
        assert_eq!(cubic.slope[0], 2.0);
        assert_eq!(cubic.slope[2], 8.0);
        let line = MonotoneCubic::new(&at, &[0.0, 2.0, 6.0]);
        for x in [0.1, 0.9, 1.0, 2.5, 3.0, 7.0] {
            let (value, slope) = line.evaluate(x);
            assert!((value - 2.0 * x).abs() < 1e-14 && (slope - 2.0).abs() < 1e-14);
        }
    }

    #[test]
    fn matches_scipy_where_it_is_steepest() {
        // The largest |slope| of scipy.interpolate.PchipInterpolator of SciPy 1.17.1 on 10⁶ places.
        let cases: [(&[f64], &[f64], f64); 3] = [
            (&[0.0, 1.0, 2.0, 4.0], &[0.0, 5.0, 14.0, 50.0], 24.0),
            (
                &[0.0, 0.5, 2.0, 2.2],
                &[0.0, 0.4, -0.3, -0.3],
                1.135_823_754_788_171,
            ),
            (&[1.0, 2.0, 3.0], &[0.0, 0.0, 1.0], 1.5),
        ];
        for (at, value, wanted) in cases {
            let found = MonotoneCubic::new(at, value).largest_slope();
            assert!((found - wanted).abs() < 1e-9 * wanted, "{found} {wanted}");
        }
    }
}
