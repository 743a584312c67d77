//! Weights of rows: the variance of a row is σ² over its weight.

use nalgebra::DMatrix;
use std::borrow::Cow;
use windfall_numerics::double_double::DoubleDouble;

/// Weights of the rows of a model, as their roots: with columns and response times these, all
/// rows have one variance (Aitken 1935, Proc. R. Soc. Edinb. 55, 42-48).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// Empty where all rows weigh 1.
    roots: Vec<f64>,
    /// Σ log w
    log_sum: f64,
}

impl Weights {
    /// Of the weights themselves, positive and finite.
    pub fn of(weights: impl Iterator<Item = f64>) -> Self {
        let roots: Vec<f64> = weights.map(f64::sqrt).collect();
        Self {
            log_sum: 2.0 * roots.iter().map(|root| root.ln()).sum::<f64>(),
            roots,
        }
    }

    /// Whether all rows weigh 1.
    pub fn is_empty(&self) -> bool {
        self.roots.is_empty()
    }

    /// How many there are; none where all rows weigh 1.
    pub fn len(&self) -> usize {
        self.roots.len()
    }

    /// Root of the weight of a row.
    pub fn root(&self, row: usize) -> f64 {
        self.roots.get(row).copied().unwrap_or(1.0)
    }

    /// Weight of a row.
    pub fn weight(&self, row: usize) -> f64 {
        self.root(row).powi(2)
    }

    /// Σ log w, by which the log-likelihood is half larger than that of the weighted rows.
    pub fn log_sum(&self) -> f64 {
        self.log_sum
    }

    /// Values of each row times the root of its weight.
    pub fn weigh<'a>(&self, values: &'a [f64]) -> Cow<'a, [f64]> {
        match self.is_empty() {
            true => Cow::Borrowed(values),
            false => {
                let pairs = values.iter().zip(&self.roots);
                Cow::Owned(pairs.map(|(value, root)| value * root).collect())
            }
        }
    }

    /// [`Weights::weigh`] of the columns of a matrix.
    pub fn weigh_columns(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(x.nrows(), x.ncols(), |row, column| {
            x[(row, column)] * self.root(row)
        })
    }

    /// The columns that [`Weights::weigh_columns`] was given.
    pub fn unweigh_columns(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(x.nrows(), x.ncols(), |row, column| {
            x[(row, column)] / self.root(row)
        })
    }

    /// [`Weights::weigh`] of values that begin at a row.
    pub fn weigh_from(&self, first: usize, values: &mut [f64]) {
        for (value, root) in values.iter_mut().zip(self.roots.iter().skip(first)) {
            *value *= root;
        }
    }

    /// [`Weights::weigh`] of columns, with what rounding takes from them.
    ///
    /// * `lost`: what rounding took before
    pub fn weigh_precisely(
        &self,
        x: &DMatrix<f64>,
        lost: &[(usize, Vec<f64>)],
    ) -> (DMatrix<f64>, Vec<(usize, Vec<f64>)>) {
        let rows = x.nrows();
        let mut weighted = x.clone();
        let column = |column: usize| {
            let before = lost.iter().find(|own| own.0 == column);
            let root = |row: usize| DoubleDouble::from(self.weight(row)).sqrt();
            let own = (0..rows).map(|row| {
                let value = DoubleDouble::from(x[(row, column)]);
                let lost = before.map_or(0.0, |own| own.1[row]);
                (value + DoubleDouble::from(lost)) * root(row)
            });
            own.collect::<Vec<DoubleDouble>>()
        };
        let mut taken = Vec::new();
        for place in 0..x.ncols() {
            let precise = column(place);
            for (own, value) in weighted.column_mut(place).iter_mut().zip(&precise) {
                *own = value.value();
            }
            let rest = precise.iter().zip(weighted.column(place));
            let rest = rest.map(|(own, value)| (*own - DoubleDouble::from(*value)).value());
            taken.push((place, rest.collect()));
        }
        (weighted, taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_sums() {
        let weights = Weights::of([4.0, 1.0, 0.25].into_iter());
        assert_eq!(weights.weigh(&[1.0, 2.0, 3.0]).as_ref(), [2.0, 2.0, 1.5]);
        assert_eq!(weights.log_sum(), 0.0);
        assert_eq!(
            (weights.weight(0), Weights::default().weight(7)),
            (4.0, 1.0)
        );
    }

    #[test]
    fn conserves_what_rounding_takes() {
        let x = DMatrix::from_column_slice(2, 1, &[0.1, 7.0]);
        let weights = Weights::of([3.0, 2.0].into_iter());
        let (weighted, lost) = weights.weigh_precisely(&x, &[]);
        for row in 0..2 {
            let precise = DoubleDouble::from(weighted[row]) + DoubleDouble::from(lost[0].1[row]);
            let square = precise * precise / DoubleDouble::from(weights.weight(row));
            let expected = DoubleDouble::from(x[row]) * DoubleDouble::from(x[row]);
            assert!((square - expected).value().abs() < 1e-28, "{row}");
        }
    }
}
