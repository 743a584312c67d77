//! Sobol points: a sequence that fills the space evenly.

use crate::error::DesignError;
use crate::finding::DesignFinding;
use crate::kind::{Design, Factor, Point, check_factors, check_numbers, check_runs, design_of};
use crate::sobol_table::{DIMENSIONS, DIRECTIONS};

/// Binary digits of a coordinate.
const BITS: usize = 30;

/// The first points of the Sobol sequence, scaled to −1 … 1.
///
/// The sequence starts with the low end of every factor and its points lie in
/// [−1, 1). They are not scrambled: the first ones stay when more are added.
///
/// # Errors
/// No factor or more than `DIMENSIONS`, categories, no run or too many.
pub fn sobol(factors: Vec<Factor>, runs: usize) -> Result<Design, DesignError> {
    check_factors("Sobol", &factors, 1)?;
    check_numbers("Sobol", &factors)?;
    if factors.len() > DIMENSIONS {
        let (kind, most, found) = ("Sobol", DIMENSIONS, factors.len());
        return Err(DesignError::FactorsTooMany { kind, most, found });
    }
    check_runs(runs as f64)?;
    if runs == 0 {
        let what = "a Sobol design".to_owned();
        return Err(DesignError::RunsTooFew {
            runs,
            least: 1,
            what,
        });
    }
    let points = unit_points(factors.len(), runs).into_iter().map(|point| {
        let coded = point.iter().map(|unit| 2.0 * unit - 1.0).collect();
        (Point::Space, coded)
    });
    let mut design = design_of("Sobol".to_owned(), factors, points.collect());
    if !runs.is_power_of_two() {
        design.findings.push(DesignFinding::NotPowerOfTwo { runs });
    }
    Ok(design)
}

/// The first points of the sequence in [0, 1), in the order of the Gray code.
///
/// Dimensions beyond `DIMENSIONS` are left out.
///
/// # Source
/// Sobol (1967), USSR Computational Mathematics and Mathematical Physics 7,
/// 86-112; Antonov and Saleev (1979) for the order.
pub fn unit_points(dimensions: usize, count: usize) -> Vec<Vec<f64>> {
    let directions: Vec<[u32; BITS]> = (0..dimensions.min(DIMENSIONS)).map(directions).collect();
    let mut state = vec![0_u32; directions.len()];
    let mut points = Vec::with_capacity(count);
    for index in 0..count {
        let scale = f64::from(1_u32 << BITS);
        points.push(state.iter().map(|bits| f64::from(*bits) / scale).collect());
        let changed = index.trailing_ones() as usize;
        for (bits, directions) in state.iter_mut().zip(&directions) {
            *bits ^= directions.get(changed).copied().unwrap_or_default();
        }
    }
    points
}

/// Direction numbers of a dimension, as binary fractions.
fn directions(dimension: usize) -> [u32; BITS] {
    let mut numbers = [0_u32; BITS];
    let Some((polynomial, initial)) = dimension.checked_sub(1).map(|d| DIRECTIONS[d]) else {
        return std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    };
    let degree = initial.len();
    for bit in 0..BITS {
        numbers[bit] = match initial.get(bit) {
            Some(first) => first << (BITS - 1 - bit),
            None => {
                // The recurrence of the polynomial, without its first and last bit.
                let back = numbers[bit - degree];
                (1..degree).fold(back ^ (back >> degree), |sum, step| {
                    let coefficient = polynomial >> (degree - step) & 1;
                    sum ^ (coefficient * numbers[bit - step])
                })
            }
        };
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.17, scipy.stats.qmc.Sobol(6, scramble=False).random(8).
    #[test]
    fn reference_first_points_of_scipy() {
        let expected = [
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5, 0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25, 0.25, 0.75, 0.75],
            [0.25, 0.75, 0.75, 0.75, 0.25, 0.25],
            [0.375, 0.375, 0.625, 0.875, 0.375, 0.125],
            [0.875, 0.875, 0.125, 0.375, 0.875, 0.625],
            [0.625, 0.125, 0.875, 0.625, 0.625, 0.875],
            [0.125, 0.625, 0.375, 0.125, 0.125, 0.375],
        ];
        let found = unit_points(6, 8);
        assert!(found.iter().zip(expected).all(|(a, b)| a[..] == b));
    }

    /// SciPy 1.17: of the integers 2^30 x of 4096 points in 40 dimensions, each
    /// times its place from 1, row after row, the exclusive or; and some of the
    /// last point.
    #[test]
    fn reference_all_dimensions_of_scipy() {
        let points = unit_points(DIMENSIONS, 4096);
        let integers = points
            .iter()
            .flatten()
            .map(|x| (x * f64::from(1_u32 << BITS)) as u64);
        let sum = integers
            .clone()
            .zip(1..)
            .fold(0, |sum, (x, place)| sum ^ (x * place));
        assert_eq!(sum, 139_183_247_065_088);
        let last: Vec<u64> = integers.skip(4095 * DIMENSIONS + 36).collect();
        assert_eq!(last, [623_116_288, 352_059_392, 177_995_776, 244_056_064]);
    }

    /// In every dimension 2^m points lie in the 2^m equal cells, one in each.
    #[test]
    fn closed_form_one_point_in_every_cell() {
        let points = unit_points(DIMENSIONS, 1024);
        for dimension in 0..DIMENSIONS {
            let mut cells: Vec<usize> = points
                .iter()
                .map(|p| (p[dimension] * 1024.0) as usize)
                .collect();
            cells.sort_unstable();
            assert_eq!(
                cells,
                (0..1024).collect::<Vec<_>>(),
                "dimension {dimension}"
            );
        }
    }
}
