//! Force against displacement as a table: a monotone piecewise cubic.

use crate::formula::error::FormulaError;

/// Names of the columns of a table: displacement, force, damping.
pub const COLUMNS: [&str; 3] = ["displacement_m", "force_N", "damping_N_s_m"];

/// Rows of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    /// Displacements, rising from 0; m.
    pub displacement: Vec<f64>,
    /// Forces at rest, from 0 and never falling; N.
    pub force: Vec<f64>,
    /// Damping, at or above 0, where there is any; N s/m.
    pub damping: Option<Vec<f64>>,
}

/// A monotone piecewise cubic with a continuous slope, linear beyond its end.
///
/// # Source
/// Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17:238; slopes inside by
/// the harmonic mean of Fritsch and Butland (1984), at the ends by the parabola
/// through three points, held monotone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MonotoneCubic {
    at: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl MonotoneCubic {
    /// Through the points; at least two, with `at` rising.
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
    pub(crate) fn evaluate(&self, at: f64) -> (f64, f64) {
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

    /// The last place.
    pub(crate) fn end(&self) -> f64 {
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

const BEGINS: &str = "a table begins with displacement 0 and force 0: add that row";

/// Whether a table can be a law.
pub(crate) fn check_table(table: &ForceTable) -> Result<(), FormulaError> {
    let [x_name, force_name, damping_name] = COLUMNS;
    let wrong = |row, column, reason| {
        Err(FormulaError::Table {
            row,
            column,
            reason,
        })
    };
    let rows = table.displacement.len();
    let columns = [
        (Some(&table.force), force_name),
        (table.damping.as_ref(), damping_name),
    ];
    let other = |(own, _): &(Option<&Vec<f64>>, _)| own.is_some_and(|own| own.len() != rows);
    if let Some((_, column)) = columns.into_iter().find(other) {
        let reason = "its columns have different lengths: every row needs every column";
        return wrong(0, column, reason);
    }
    if rows < 3 {
        let reason = "it has fewer than three rows: give at least three";
        return wrong(0, x_name, reason);
    }
    for row in 0..rows {
        let (x, force) = (table.displacement[row], table.force[row]);
        let damping = table.damping.as_ref().map_or(0.0, |c| c[row]);
        let numbers = [(x, x_name), (force, force_name), (damping, damping_name)];
        if let Some((_, column)) = numbers.into_iter().find(|(own, _)| !own.is_finite()) {
            return wrong(row + 1, column, "a value is not a finite number");
        }
        let (column, reason) = match () {
            () if damping < 0.0 => {
                let reason = "the damping is negative: it must be at or above 0 N s/m";
                (damping_name, reason)
            }
            () if row == 0 && x != 0.0 => (x_name, BEGINS),
            () if row == 0 && force != 0.0 => (force_name, BEGINS),
            () if row > 0 && x <= table.displacement[row - 1] => {
                let reason = "the displacement does not rise: sort the rows by displacement and \
                              merge equal ones";
                (x_name, reason)
            }
            () if row > 0 && force < table.force[row - 1] => {
                let reason = "the force falls: a table holds the force while loading, which rises \
                              with the displacement";
                (force_name, reason)
            }
            () => continue,
        };
        return wrong(row + 1, column, reason);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
