//! Rows of a least-squares problem → its triangle.
//!
//! QR by Householder reflections: every submodel follows from the triangle R and Q'y
//! (Golub & Van Loan, Matrix Computations, 4th ed., §5.2-5.3). Ordinary problems are
//! reduced in twice the precision of doubles, larger ones in parallel blocks that do not
//! depend on the number of threads.

use crate::error::Error;
use crate::model::model_matrix::{BLOCK, ModelMatrix};
use nalgebra::DMatrix;
use rayon::prelude::*;
use windfall_numerics::as_written::as_written;
use windfall_numerics::double_double::DoubleDouble;

/// Up to this many products the triangle is found in twice the precision.
const ORDINARY: usize = 2_000_000;

/// Rows reduced at once, beyond that.
const BLOCK_HEIGHT: usize = 512;

/// Least part of a column's length that those before it must leave.
const DEPENDENT: f64 = 1e-12;

/// The triangle of a least-squares problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// Rows of the problem.
    pub rows: usize,
    /// R by columns: the upper triangle, square.
    pub triangle: Vec<Vec<DoubleDouble>>,
    /// Q'y, one for each column.
    pub response: Vec<DoubleDouble>,
    /// Sum of squares of y that no column reaches.
    pub rest: DoubleDouble,
}

/// A solved (sub)problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// Columns that were estimated, of those that were asked for, in their order.
    pub columns: Vec<usize>,
    /// Columns that depend on those before them.
    pub aliased: Vec<Aliased>,
    /// Estimates, one for each of `columns`.
    pub estimates: Vec<DoubleDouble>,
    /// Inverse of the triangle: (X'X)⁻¹ is its product with its transpose.
    pub inverse: DMatrix<f64>,
    /// Sum of squares that each of `columns` takes up after those before it.
    pub sequential: Vec<f64>,
    /// Residual sum of squares.
    pub residual: DoubleDouble,
    /// Largest over smallest extent of the scaled columns, a lower bound of the condition.
    pub condition: f64,
}

/// A column that depends on others.
#[derive(Clone, Debug, PartialEq)]
pub struct Aliased {
    /// The column.
    pub column: usize,
    /// It is the sum of these columns, times these numbers.
    pub combination: Vec<(usize, f64)>,
}

impl Aliased {
    /// Whether a sum of coefficients with these weights of all columns of the model keeps to the
    /// dependence, so that it can be estimated without this column.
    pub fn agrees(&self, weights: &[f64]) -> bool {
        let terms = self.combination.iter();
        let expected: f64 = terms
            .map(|(column, factor)| factor * weights[*column])
            .sum();
        let size = weights
            .iter()
            .fold(1.0, |most: f64, own| most.max(own.abs()));
        (weights[self.column] - expected).abs() <= 1e-8 * size
    }
}

/// Whether a model matrix of this size is reduced in twice the precision of doubles.
pub fn is_ordinary(rows: usize, columns: usize) -> bool {
    rows * (columns + 1) * (columns + 1) <= ORDINARY
}

/// Reduces rows to their triangle.
///
/// * `x`: model matrix, finite
/// * `y`: response, as many
pub fn reduce(x: &DMatrix<f64>, y: &[f64]) -> Reduced {
    reduce_written(x, &[], y)
}

/// [`reduce`] of columns as they are written.
///
/// * `lost`: columns with what rounding to doubles took from each row
pub fn reduce_written(x: &DMatrix<f64>, lost: &[(usize, Vec<f64>)], y: &[f64]) -> Reduced {
    match is_ordinary(x.nrows(), x.ncols()) {
        true => reduce_precisely(x, lost, y),
        false => reduce_in_blocks(x, y),
    }
}

/// [`reduce`] of a model matrix that is evaluated block by block.
///
/// # Errors
/// A value is undefined, with its row among all.
pub fn reduce_evaluated(x: &ModelMatrix, y: &[f64]) -> Result<Reduced, Error> {
    let (rows, width) = (x.rows(), x.columns() + 1);
    if is_ordinary(rows, x.columns()) {
        return Ok(reduce(&*x.whole()?, y));
    }
    // Heights divide those of blocks, so that the triangles are those of a matrix in memory.
    let height = height_of(width);
    if !BLOCK.is_multiple_of(height) {
        return Ok(reduce_in_blocks(&*x.whole()?, y));
    }
    let triangles = x.each_block(|own, x| {
        let starts = own.clone().step_by(height);
        let part = |start: usize| {
            let end = (start + height).min(own.end);
            triangle_of(
                block_of(x, &y[own.clone()], start - own.start..end - own.start),
                width,
            )
        };
        starts.map(part).collect::<Vec<_>>()
    })?;
    Ok(joined(
        triangles.into_iter().flatten().collect(),
        rows,
        width,
    ))
}

fn reduce_precisely(x: &DMatrix<f64>, lost: &[(usize, Vec<f64>)], y: &[f64]) -> Reduced {
    let mut columns: Vec<Vec<DoubleDouble>> = x
        .column_iter()
        .map(|column| column.iter().map(|v| DoubleDouble::from(*v)).collect())
        .collect();
    for (column, lost) in lost {
        for (own, lost) in columns[*column].iter_mut().zip(lost) {
            *own += DoubleDouble::from(*lost);
        }
    }
    columns.push(y.iter().map(|v| as_written(*v)).collect());
    let count = x.ncols();
    for step in 0..count.min(x.nrows()) {
        let (before, after) = columns.split_at_mut(step + 1);
        let reflection = Reflection::new(&mut before[step], step);
        after.iter_mut().for_each(|other| reflection.apply(other));
    }
    let response = columns.pop().unwrap_or_default();
    let rest = response.iter().skip(count).map(|v| *v * *v).sum();
    let square = |mut column: Vec<DoubleDouble>| {
        column.resize(count, DoubleDouble::ZERO);
        column
    };
    Reduced {
        rows: x.nrows(),
        triangle: columns.into_iter().map(square).collect(),
        response: square(response),
        rest,
    }
}

/// Columns of a block, one behind the other, with the response last.
struct Block {
    rows: usize,
    values: Vec<f64>,
}

/// Rows that are reduced at once.
fn height_of(width: usize) -> usize {
    BLOCK_HEIGHT.max((4 * width).next_power_of_two())
}

fn reduce_in_blocks(x: &DMatrix<f64>, y: &[f64]) -> Reduced {
    let (rows, width) = (x.nrows(), x.ncols() + 1);
    let height = height_of(width);
    let starts: Vec<usize> = (0..rows).step_by(height).collect();
    let triangles = starts.into_par_iter().map(|start| {
        let end = (start + height).min(rows);
        triangle_of(block_of(x, y, start..end), width)
    });
    joined(triangles.collect(), rows, width)
}

/// Some rows of a matrix, and the response.
fn block_of(x: &DMatrix<f64>, y: &[f64], rows: std::ops::Range<usize>) -> Block {
    let (all, height) = (x.as_slice(), x.nrows());
    let mut values = Vec::with_capacity(rows.len() * (x.ncols() + 1));
    for column in 0..x.ncols() {
        let start = column * height;
        values.extend_from_slice(&all[start + rows.start..start + rows.end]);
    }
    values.extend_from_slice(&y[rows.clone()]);
    Block {
        rows: rows.len(),
        values,
    }
}

/// The triangle of some rows of a matrix, and the response.
pub(crate) fn triangle_of_rows(x: &DMatrix<f64>, y: &[f64], rows: &[usize]) -> Vec<f64> {
    let mut values = Vec::with_capacity(rows.len() * (x.ncols() + 1));
    for column in x.column_iter() {
        values.extend(rows.iter().map(|row| column[*row]));
    }
    values.extend(rows.iter().map(|row| y[*row]));
    let block = Block {
        rows: rows.len(),
        values,
    };
    triangle_of(block, x.ncols() + 1)
}

/// The triangle of all rows from those of their blocks.
pub(crate) fn joined(triangles: Vec<Vec<f64>>, rows: usize, width: usize) -> Reduced {
    let whole = join(triangles, width);
    let columns = width - 1;
    let value = |row: usize, column: usize| DoubleDouble::from(whole[column * width + row]);
    Reduced {
        rows,
        triangle: (0..columns)
            .map(|column| (0..columns).map(|row| value(row, column)).collect())
            .collect(),
        response: (0..columns).map(|row| value(row, columns)).collect(),
        rest: value(columns, columns) * value(columns, columns),
    }
}

/// One triangle of several.
pub(crate) fn join(mut triangles: Vec<Vec<f64>>, width: usize) -> Vec<f64> {
    // Some are joined until one is left, always the same ones.
    while triangles.len() > 1 {
        triangles = triangles
            .par_chunks(8)
            .map(|some| triangle_of(stacked(some, width), width))
            .collect();
    }
    triangles.pop().unwrap_or_else(|| vec![0.0; width * width])
}

fn stacked(triangles: &[Vec<f64>], width: usize) -> Block {
    let mut values = Vec::with_capacity(triangles.len() * width * width);
    for column in 0..width {
        for triangle in triangles {
            values.extend_from_slice(&triangle[column * width..(column + 1) * width]);
        }
    }
    Block {
        rows: triangles.len() * width,
        values,
    }
}

/// The square triangle of a block, rows of zeros below it where it is short.
fn triangle_of(mut block: Block, width: usize) -> Vec<f64> {
    let rows = block.rows;
    for step in 0..width.min(rows) {
        let (before, after) = block.values.split_at_mut((step + 1) * rows);
        let own = &mut before[step * rows + step..];
        let square = dot(own, own);
        if square == 0.0 {
            continue;
        }
        let length = square.sqrt();
        let diagonal = if own[0] > 0.0 { -length } else { length };
        let scale = square - diagonal * own[0];
        own[0] -= diagonal;
        for other in after.chunks_exact_mut(rows) {
            let other = &mut other[step..];
            let factor = dot(own, other) / scale;
            for (a, b) in own.iter().zip(other) {
                *b -= factor * a;
            }
        }
        own[0] = diagonal;
        own[1..].fill(0.0);
    }
    let mut triangle = vec![0.0; width * width];
    for column in 0..width {
        let height = (column + 1).min(rows);
        let from = &block.values[column * rows..column * rows + height];
        triangle[column * width..column * width + height].copy_from_slice(from);
    }
    triangle
}

/// A dot product in eight sums, which the compiler turns into vector registers.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_parts, b_parts) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a_parts
        .remainder()
        .iter()
        .zip(b_parts.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in a_parts.zip(b_parts) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    rest + ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]))
}

impl Reduced {
    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.triangle.len()
    }

    /// Solves for some of the columns; one that depends on others is reported as aliased.
    pub fn solve(&self, wanted: &[usize]) -> Solved {
        let mut work: Vec<Vec<DoubleDouble>> = Vec::with_capacity(wanted.len() + 1);
        let mut columns = Vec::new();
        let mut dependent = Vec::new();
        let mut extents: Vec<f64> = Vec::new();
        // Columns enter one by one, each reflected by what was found before it.
        let mut reflections: Vec<Reflection> = Vec::new();
        for column in wanted {
            let mut own = self.triangle[*column].clone();
            let whole: DoubleDouble = own.iter().map(|v| *v * *v).sum();
            reflections.iter().for_each(|r| r.apply(&mut own));
            let step = columns.len();
            let left: DoubleDouble = own.iter().skip(step).map(|v| *v * *v).sum();
            let (left, whole) = (left.high.sqrt(), whole.high.sqrt());
            if step >= own.len() || left <= DEPENDENT * whole {
                own.truncate(step);
                dependent.push((*column, own));
                continue;
            }
            reflections.push(Reflection::new(&mut own, step));
            columns.push(*column);
            work.push(own);
            extents.push(left / whole);
        }
        let mut response = self.response.clone();
        reflections.iter().for_each(|r| r.apply(&mut response));
        let count = columns.len();
        let below: DoubleDouble = response.iter().skip(count).map(|v| *v * *v).sum();
        let estimates = back_substituted(&work, &response[..count]);
        let aliased = dependent.into_iter().map(|(column, mut own)| {
            own.resize(own.len().min(count), DoubleDouble::ZERO);
            let own_columns = &work[..own.len()];
            let factors = back_substituted(own_columns, &own);
            Aliased {
                column,
                combination: columns
                    .iter()
                    .copied()
                    .zip(factors.iter().map(|f| f.value()))
                    .filter(|(_, factor)| factor.abs() > 1e-9)
                    .collect(),
            }
        });
        let sequential = response[..count].iter().map(|v| (*v * *v).value());
        Solved {
            aliased: aliased.collect(),
            inverse: inverse_triangle(&work),
            sequential: sequential.collect(),
            residual: self.rest + below,
            condition: extents.iter().fold(1.0, |worst: f64, e| worst.max(1.0 / e)),
            estimates,
            columns,
        }
    }
}

/// A reflection that takes what is below a row to zero.
struct Reflection {
    row: usize,
    vector: Vec<DoubleDouble>,
    scale: DoubleDouble,
}

impl Reflection {
    fn new(own: &mut [DoubleDouble], row: usize) -> Self {
        let square: DoubleDouble = own[row..].iter().map(|v| *v * *v).sum();
        let length = square.sqrt();
        let diagonal = if own[row].high > 0.0 { -length } else { length };
        // v = x - d e, v'v = 2 (d² - d x); of a column of zeros nothing is taken.
        let scale = match length.high == 0.0 {
            true => DoubleDouble::ONE,
            false => square - diagonal * own[row],
        };
        let mut vector = own[row..].to_vec();
        vector[0] -= diagonal;
        own[row] = diagonal;
        own[row + 1..].fill(DoubleDouble::ZERO);
        Self { row, vector, scale }
    }

    fn apply(&self, other: &mut [DoubleDouble]) {
        let other = &mut other[self.row..];
        let pairs = self.vector.iter().zip(other.iter());
        let projected: DoubleDouble = pairs.map(|(a, b)| *a * *b).sum();
        let factor = projected / self.scale;
        for (a, b) in self.vector.iter().zip(other) {
            *b -= factor * *a;
        }
    }
}

fn back_substituted(columns: &[Vec<DoubleDouble>], right: &[DoubleDouble]) -> Vec<DoubleDouble> {
    let mut left = right.to_vec();
    for step in (0..columns.len()).rev() {
        left[step] = left[step] / columns[step][step];
        let value = left[step];
        for row in 0..step {
            left[row] -= columns[step][row] * value;
        }
    }
    left
}

fn inverse_triangle(columns: &[Vec<DoubleDouble>]) -> DMatrix<f64> {
    let count = columns.len();
    let mut inverse = DMatrix::zeros(count, count);
    for step in 0..count {
        let mut unit = vec![DoubleDouble::ZERO; step + 1];
        unit[step] = DoubleDouble::ONE;
        let found = back_substituted(&columns[..=step], &unit);
        for (row, value) in found.iter().enumerate() {
            inverse[(row, step)] = value.value();
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(rows: usize, columns: usize) -> (DMatrix<f64>, Vec<f64>) {
        let x = DMatrix::from_fn(rows, columns, |row, column| match column {
            0 => 1.0,
            _ => ((row * column) as f64 * 0.7351 + column as f64).sin(),
        });
        let y = (0..rows)
            .map(|row| (row as f64 * 0.113).cos() * 3.0)
            .collect();
        (x, y)
    }

    /// Both ways of reducing give one solution.
    #[test]
    fn conserves_the_solution_in_blocks() {
        let (x, y) = wave(5000, 7);
        let wanted: Vec<usize> = (0..7).collect();
        let precise = reduce_precisely(&x, &[], &y).solve(&wanted);
        let blocks = reduce_in_blocks(&x, &y).solve(&wanted);
        for (a, b) in precise.estimates.iter().zip(&blocks.estimates) {
            assert!((a.value() - b.value()).abs() < 1e-13);
        }
        assert!((precise.residual.value() / blocks.residual.value() - 1.0).abs() < 1e-13);
        let normal = &precise.inverse * precise.inverse.transpose() * (x.transpose() * &x);
        assert!((normal - DMatrix::identity(7, 7)).abs().max() < 1e-11);
    }

    #[test]
    fn repeats_the_bits_with_any_number_of_threads() {
        let (x, y) = wave(20_000, 4);
        let reduce_with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| reduce_in_blocks(&x, &y))
        };
        assert_eq!(reduce_with(1), reduce_with(2));
    }

    /// x₃ = 2 x₁ - x₂ + 1 is found and named.
    #[test]
    fn closed_form_dependence_is_named() {
        let (mut x, y) = wave(50, 4);
        for row in 0..50 {
            x[(row, 3)] = 2.0 * x[(row, 1)] - x[(row, 2)] + 1.0;
        }
        let solved = reduce(&x, &y).solve(&[0, 1, 2, 3]);
        assert_eq!(solved.columns, [0, 1, 2]);
        let found = &solved.aliased[0];
        assert_eq!(found.column, 3);
        for ((column, factor), (expected, value)) in
            found
                .combination
                .iter()
                .zip([(0, 1.0), (1, 2.0), (2, -1.0)])
        {
            assert_eq!(*column, expected);
            assert!((factor - value).abs() < 1e-10);
        }
        // Fewer rows than columns: what cannot be estimated is left out.
        let (x, y) = wave(3, 4);
        assert_eq!(reduce(&x, &y).solve(&[0, 1, 2, 3]).columns.len(), 3);
    }
}
