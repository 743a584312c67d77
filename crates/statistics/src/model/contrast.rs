//! Coding of categories as columns of numbers.

use nalgebra::DMatrix;

/// How the levels of a category become columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contrast {
    /// Each level against the first.
    #[default]
    Treatment,
    /// Each level but the last against the mean of all.
    Sum,
    /// Each level against the mean of those before it.
    Helmert,
    /// Orthogonal polynomials over equally spaced levels.
    Polynomial,
    /// A column for each level.
    Full,
}

/// Columns of a contrast with their names.
#[derive(Clone, Debug, PartialEq)]
pub struct ContrastMatrix {
    /// One row for each level.
    pub matrix: DMatrix<f64>,
    /// What stands in brackets behind the name of the factor.
    pub names: Vec<String>,
}

impl Contrast {
    /// Every contrast with its name.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("treatment", Self::Treatment),
        ("sum", Self::Sum),
        ("helmert", Self::Helmert),
        ("poly", Self::Polynomial),
        ("full", Self::Full),
    ];

    /// Its matrix; `reference` is the level that treatment contrasts compare with.
    pub fn matrix(self, levels: &[String], reference: usize) -> ContrastMatrix {
        let count = levels.len();
        let others: Vec<usize> = (0..count).filter(|level| *level != reference).collect();
        let named = |chosen: &[usize]| chosen.iter().map(|l| levels[*l].clone()).collect();
        let all: Vec<usize> = (0..count).collect();
        let columns = count.saturating_sub(1);
        match self {
            Self::Full => ContrastMatrix {
                matrix: DMatrix::identity(count, count),
                names: named(&all),
            },
            Self::Treatment => ContrastMatrix {
                matrix: DMatrix::from_fn(count, columns, |row, column| {
                    f64::from(u8::from(row == others[column]))
                }),
                names: named(&others),
            },
            Self::Sum => ContrastMatrix {
                matrix: DMatrix::from_fn(count, columns, |row, column| {
                    if row + 1 == count {
                        -1.0
                    } else {
                        f64::from(u8::from(row == column))
                    }
                }),
                names: named(&all[..columns]),
            },
            Self::Helmert => ContrastMatrix {
                matrix: DMatrix::from_fn(count, columns, |row, column| {
                    match row.cmp(&(column + 1)) {
                        std::cmp::Ordering::Less => -1.0,
                        std::cmp::Ordering::Equal => (column + 1) as f64,
                        std::cmp::Ordering::Greater => 0.0,
                    }
                }),
                names: named(&all[1..]),
            },
            Self::Polynomial => {
                let positions: Vec<f64> = all.iter().map(|level| *level as f64).collect();
                let basis = PolynomialBasis::new(&positions, columns);
                let matrix = basis.values(&positions);
                let name = |power: usize| match power {
                    1 => "linear".to_owned(),
                    2 => "quadratic".to_owned(),
                    3 => "cubic".to_owned(),
                    n => format!("^{n}"),
                };
                ContrastMatrix {
                    matrix,
                    names: (1..=columns).map(name).collect(),
                }
            }
        }
    }
}

/// Orthonormal polynomials over given points (Forsythe (1957), J. SIAM 5, 74-88).
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialBasis {
    /// Centre of each degree's recurrence.
    pub centres: Vec<f64>,
    /// Sum of squares over the points, of degree 0 on.
    pub norms: Vec<f64>,
}

impl PolynomialBasis {
    /// Polynomials of degree 1 to `degree` over points.
    pub fn new(points: &[f64], degree: usize) -> Self {
        let mut basis = Self {
            centres: Vec::new(),
            norms: vec![points.len() as f64],
        };
        let mut before = vec![0.0; points.len()];
        let mut now = vec![1.0; points.len()];
        for power in 0..degree {
            let square: f64 = now.iter().map(|p| p * p).sum();
            let moment: f64 = now.iter().zip(points).map(|(p, x)| p * p * x).sum();
            let centre = moment / square;
            let ratio = match power {
                0 => 0.0,
                _ => square / basis.norms[power - 1],
            };
            let next: Vec<f64> = (0..points.len())
                .map(|i| (points[i] - centre) * now[i] - ratio * before[i])
                .collect();
            basis.centres.push(centre);
            basis.norms.push(next.iter().map(|p| p * p).sum());
            before = now;
            now = next;
        }
        basis
    }

    /// Values at points, a column for each degree from 1.
    pub fn values(&self, points: &[f64]) -> DMatrix<f64> {
        let degree = self.centres.len();
        let mut matrix = DMatrix::zeros(points.len(), degree);
        for (row, x) in points.iter().enumerate() {
            let (mut before, mut now) = (0.0, 1.0);
            for power in 0..degree {
                let ratio = match power {
                    0 => 0.0,
                    _ => self.norms[power] / self.norms[power - 1],
                };
                let next = (x - self.centres[power]) * now - ratio * before;
                matrix[(row, power)] = next / self.norms[power + 1].sqrt();
                (before, now) = (now, next);
            }
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(count: usize) -> Vec<String> {
        (0..count).map(|level| level.to_string()).collect()
    }

    /// R: contr.poly(4), contr.helmert(3).
    #[test]
    fn reference_contrasts() {
        let poly = Contrast::Polynomial.matrix(&levels(4), 0).matrix;
        let expected = [-0.6708204, -0.2236068, 0.2236068, 0.6708204];
        for (row, value) in expected.iter().enumerate() {
            assert!((poly[(row, 0)] - value).abs() < 1e-7);
        }
        assert!((poly[(1, 1)] + 0.5).abs() < 1e-12);
        let helmert = Contrast::Helmert.matrix(&levels(3), 0).matrix;
        assert_eq!(helmert.as_slice(), [-1.0, 1.0, 0.0, -1.0, -1.0, 2.0]);
    }

    #[test]
    fn closed_form_columns_are_orthonormal() {
        let points: Vec<f64> = (0..30)
            .map(|i| (i as f64 * 0.37).sin() * 3.0 + 100.0)
            .collect();
        let values = PolynomialBasis::new(&points, 5).values(&points);
        let product = values.transpose() * &values;
        assert!((product - DMatrix::identity(5, 5)).abs().max() < 1e-9);
        assert!(values.row_sum().abs().max() < 1e-9);
    }
}
