//! Cross-products of a mixed model, group by group.
//!
//! The grouping factor with most random effects is the leaf: its groups are
//! eliminated one by one in small blocks. What remains of the other factors, the
//! trunk, is one symmetric matrix inside an envelope.

use crate::basis::{add_scaled, dot};
use crate::envelope::Envelope;
use nalgebra::DMatrix;

/// Terms that share their groups.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    /// The terms: index, first column, number of columns.
    pub terms: Vec<TermPlace>,
    /// Number of columns of all terms.
    pub width: usize,
    /// Number of groups that have rows.
    pub groups: usize,
    /// Group of each row.
    pub group: Vec<usize>,
    /// Scaled design columns row by row; those of a correlated term are orthonormal.
    pub design: Vec<f64>,
    /// Upper triangle that gives the columns of the terms: terms = design · basis.
    pub basis: DMatrix<f64>,
}

/// A term's place in its factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TermPlace {
    /// Index among the terms of the model.
    pub term: usize,
    /// First of its columns.
    pub offset: usize,
    /// Number of its columns.
    pub width: usize,
}

/// Cross-products of the leaf factor, with the orthonormal fixed columns and the response.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    /// Columns of the factor.
    pub width: usize,
    pub groups: usize,
    /// Zⱼ'Zⱼ of each group, one after another.
    pub square: Vec<f64>,
    /// Zⱼ'[trunk columns met in the group, fixed columns] of each group by rows.
    pub cross: Vec<f64>,
    /// First entry of each group in `cross`; one more at the end.
    pub cross_start: Vec<usize>,
    /// Trunk columns met in each group, ascending.
    pub met: Vec<usize>,
    /// First entry of each group in `met`; one more at the end.
    pub met_start: Vec<usize>,
}

/// Random effects of one group in the trunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrunkBlock {
    pub factor: usize,
    /// First column in the trunk.
    pub offset: usize,
    /// Number of columns.
    pub width: usize,
}

/// Cross-products of all other factors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trunk {
    pub blocks: Vec<TrunkBlock>,
    /// First column of each factor's first group.
    pub offsets: Vec<usize>,
    /// Shape of the matrix after the leaf is eliminated.
    pub envelope: Envelope,
    /// Z'Z.
    pub square: Vec<f64>,
    /// Z'[fixed columns], by rows.
    pub fixed: Vec<f64>,
}

/// Cross-products of the leaf `factors[0]` with fixed columns and the trunk.
pub(crate) fn leaf_of(factors: &[Factor], trunk: &Trunk, fixed: &[&[f64]]) -> Leaf {
    let factor = &factors[0];
    let (width, m) = (factor.width, fixed.len());
    let rows = rows_by_group(factor);
    let mut leaf = Leaf {
        width,
        groups: factor.groups,
        square: vec![0.0; factor.groups * width * width],
        cross: Vec::new(),
        cross_start: vec![0],
        met: Vec::new(),
        met_start: vec![0],
    };
    let mut place = vec![0; trunk.envelope.rows()];
    for (group, rows) in rows.iter().enumerate() {
        let met = columns_met(&factors[1..], trunk, rows);
        met.iter()
            .enumerate()
            .for_each(|(i, column)| place[*column] = i);
        let wide = met.len() + m;
        let begin = leaf.cross.len();
        leaf.cross.resize(begin + width * wide, 0.0);
        for row in rows {
            let z = &factor.design[row * width..(row + 1) * width];
            for a in 0..width {
                let square = &mut leaf.square[(group * width + a) * width..][..width];
                add_scaled(square, z[a], z);
                let cross = &mut leaf.cross[begin + a * wide..][..wide];
                for (index, other) in factors[1..].iter().enumerate() {
                    let design = &other.design[row * other.width..(row + 1) * other.width];
                    let column = trunk.offsets[index] + other.group[*row] * other.width;
                    let cross = &mut cross[place[column]..][..other.width];
                    add_scaled(cross, z[a], design);
                }
                let cross = &mut cross[met.len()..];
                cross
                    .iter_mut()
                    .zip(fixed)
                    .for_each(|(sum, column)| *sum += z[a] * column[*row]);
            }
        }
        leaf.met.extend(met);
        leaf.met_start.push(leaf.met.len());
        leaf.cross_start.push(leaf.cross.len());
    }
    leaf
}

/// Rows of each group.
pub(crate) fn rows_by_group(factor: &Factor) -> Vec<Vec<usize>> {
    let mut counts = vec![0; factor.groups];
    factor.group.iter().for_each(|group| counts[*group] += 1);
    let mut rows: Vec<Vec<usize>> = counts.into_iter().map(Vec::with_capacity).collect();
    for (row, group) in factor.group.iter().enumerate() {
        rows[*group].push(row);
    }
    rows
}

/// Trunk columns that the rows touch, ascending.
fn columns_met(others: &[Factor], trunk: &Trunk, rows: &[usize]) -> Vec<usize> {
    let mut met = Vec::new();
    for (other, offset) in others.iter().zip(&trunk.offsets) {
        let mut groups: Vec<usize> = rows.iter().map(|row| other.group[*row]).collect();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            let first = offset + group * other.width;
            met.extend(first..first + other.width);
        }
    }
    met
}

/// Cross-products of the factors after the first.
pub(crate) fn trunk_of(factors: &[Factor], fixed: &[&[f64]]) -> Trunk {
    let others = &factors[1..];
    let m = fixed.len();
    let mut trunk = Trunk::default();
    let mut columns = 0;
    for (index, other) in others.iter().enumerate() {
        trunk.offsets.push(columns);
        for _ in 0..other.groups {
            trunk.blocks.push(TrunkBlock {
                factor: index + 1,
                offset: columns,
                width: other.width,
            });
            columns += other.width;
        }
    }
    trunk.envelope = envelope_of(factors, &trunk, columns);
    trunk.square = vec![0.0; trunk.envelope.entries()];
    trunk.fixed = vec![0.0; columns * m];
    for row in 0..factors[0].group.len() {
        add_row(&mut trunk, others, fixed, row);
    }
    trunk
}

/// Envelope of the trunk columns that one leaf group couples.
fn envelope_of(factors: &[Factor], trunk: &Trunk, columns: usize) -> Envelope {
    let mut first: Vec<usize> = vec![0; columns];
    for block in &trunk.blocks {
        first[block.offset..block.offset + block.width].fill(block.offset);
    }
    for rows in rows_by_group(&factors[0]) {
        let met = columns_met(&factors[1..], trunk, &rows);
        for column in &met {
            first[*column] = first[*column].min(met[0]);
        }
    }
    Envelope::of_first(first)
}

fn add_row(trunk: &mut Trunk, others: &[Factor], fixed: &[&[f64]], row: usize) {
    let entries: Vec<(usize, f64)> = others
        .iter()
        .zip(&trunk.offsets)
        .flat_map(|(other, offset)| {
            let first = offset + other.group[row] * other.width;
            let design = &other.design[row * other.width..(row + 1) * other.width];
            design.iter().enumerate().map(move |(k, z)| (first + k, *z))
        })
        .collect();
    for (place, (i, a)) in entries.iter().enumerate() {
        for (j, b) in &entries[..=place] {
            trunk.square[trunk.envelope.place(*i, *j)] += a * b;
        }
        let sums = &mut trunk.fixed[i * fixed.len()..][..fixed.len()];
        sums.iter_mut()
            .zip(fixed)
            .for_each(|(sum, column)| *sum += a * column[row]);
    }
}

/// Cross-products of the fixed columns with each other, by rows.
pub(crate) fn fixed_square(fixed: &[&[f64]]) -> Vec<f64> {
    let mut square = Vec::with_capacity(fixed.len() * fixed.len());
    for a in fixed {
        square.extend(fixed.iter().map(|b| dot(a, b)));
    }
    square
}
