//! What features tell about a law: information with nuisances taken out, the
//! directions that it determines and those that it does not.

use crate::feature_problem::Linearised;
use nalgebra::{DMatrix, DVector};

/// A direction whose singular value is below this part of the largest is not
/// determined at all.
const RANK: f64 = 1e-6;

/// A direction in the law's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Unit vector in the coordinates, largest part positive.
    pub vector: Vec<f64>,
    /// Standard uncertainty along it; infinite where undetermined.
    pub sd: f64,
}

/// Information on the free parameters, in their coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    /// The triangle R with information RᵀR.
    pub root: DMatrix<f64>,
    /// Directions from the best to the least determined.
    pub directions: Vec<Direction>,
    /// How many are determined.
    pub rank: usize,
    /// Covariance of the coordinates; `None` where not all are determined.
    pub covariance: Option<DMatrix<f64>>,
    /// Logarithm of the determinant; −∞ where not all are determined.
    pub log_determinant: f64,
}

/// Information on the law's coordinates, with nuisances estimated along.
pub fn information(linearised: &Linearised) -> Information {
    information_of_root(root_of(linearised))
}

/// R of the law's columns after the nuisances' have been taken out.
fn root_of(linearised: &Linearised) -> DMatrix<f64> {
    let (free, nuisances) = (linearised.by_law.ncols(), linearised.by_nuisance.ncols());
    // Fewer rows than columns would leave R without its last rows.
    let rows = linearised.by_law.nrows().max(free + nuisances);
    let mut all = DMatrix::zeros(rows, free + nuisances);
    let height = linearised.by_law.nrows();
    all.view_mut((0, 0), (height, nuisances))
        .copy_from(&linearised.by_nuisance);
    all.view_mut((0, nuisances), (height, free))
        .copy_from(&linearised.by_law);
    let triangle = all.qr().r();
    triangle
        .view((nuisances, nuisances), (free, free))
        .into_owned()
}

/// Directions, rank and covariance of a triangle R of the information.
pub fn information_of_root(root: DMatrix<f64>) -> Information {
    let free = root.ncols();
    let decomposed = root.clone().svd(false, true);
    let values = &decomposed.singular_values;
    let vectors = decomposed
        .v_t
        .unwrap_or_else(|| DMatrix::identity(free, free));
    let mut order: Vec<usize> = (0..free).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    let largest = values.max();
    let determined = |place: usize| values[place] > RANK * largest && values[place] > 0.0;
    let rank = order.iter().filter(|place| determined(**place)).count();
    let directions = order.iter().map(|place| Direction {
        vector: upright(vectors.row(*place).iter().copied().collect()),
        sd: match determined(*place) {
            true => 1.0 / values[*place],
            false => f64::INFINITY,
        },
    });
    let directions: Vec<Direction> = directions.collect();
    let full = rank == free;
    let covariance = full.then(|| {
        let mut sum = DMatrix::zeros(free, free);
        for direction in &directions {
            let vector = DVector::from_column_slice(&direction.vector);
            sum += &vector * vector.transpose() * (direction.sd * direction.sd);
        }
        sum
    });
    let logs = values.iter().map(|value| 2.0 * value.ln());
    Information {
        log_determinant: if full { logs.sum() } else { f64::NEG_INFINITY },
        root,
        directions,
        rank,
        covariance,
    }
}

/// A direction with its largest part positive.
fn upright(vector: Vec<f64>) -> Vec<f64> {
    let largest = vector.iter().copied();
    let largest = largest.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    match largest < 0.0 {
        true => vector.into_iter().map(|part| -part).collect(),
        false => vector,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line through points with a common offset known to 1: by hand, the
    /// information on the slope is Σx² − (Σx)²/(n + 1).
    #[test]
    fn closed_form_nuisance_is_taken_out() {
        let x = [1.0, 2.0, 4.0];
        let linearised = Linearised {
            residuals: DVector::zeros(4),
            by_law: DMatrix::from_column_slice(4, 1, &[1.0, 2.0, 4.0, 0.0]),
            by_nuisance: DMatrix::from_column_slice(4, 1, &[1.0; 4]),
            simulated: Vec::new(),
            features: 3,
        };
        let squares: f64 = x.iter().map(|x| x * x).sum();
        let sum: f64 = x.iter().sum();
        let expected = squares - sum * sum / 4.0;
        let found = information(&linearised);
        let covariance = found.covariance.unwrap();
        assert!((covariance[(0, 0)] * expected - 1.0).abs() < 1e-14);
        assert!((found.log_determinant - expected.ln()).abs() < 1e-14);
    }

    #[test]
    fn closed_form_direction_that_nothing_tells() {
        // Only x + 2 y is seen, to 0.5.
        let root = DMatrix::from_row_slice(2, 2, &[2.0, 4.0, 0.0, 0.0]);
        let found = information_of_root(root);
        assert_eq!(found.rank, 1);
        assert!(found.covariance.is_none());
        // Along (1, 2)/√5 the change of x + 2 y per unit is √5.
        assert!((found.directions[0].sd - 0.5 / 5f64.sqrt()).abs() < 1e-15);
        assert!(found.directions[1].sd.is_infinite());
        let null = &found.directions[1].vector;
        assert!((null[0] + 2.0 * null[1]).abs() < 1e-15, "{null:?}");
    }
}
