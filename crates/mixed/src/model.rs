//! A linear mixed model made ready: checked, scaled, summed by groups.

use crate::basis::{Basis, Dependent, norm, orthonormal_basis};
use crate::blocks::{Factor, Leaf, TermPlace, Trunk, fixed_square, leaf_of, trunk_of};
use crate::error::MixedError;
use crate::residual_levels::ResidualLevels;
use crate::term::{RandomTerm, check_finite, check_length, check_term};
use crate::weights::Weights;
use nalgebra::{DMatrix, DVector};

/// A residual shorter than this share of the response is rounding.
const NO_RESIDUAL: f64 = 1e-12;

/// A linear mixed model y = X β + Z b + ε, b ~ N(0, σ² Λ Λ'), ε ~ N(0, σ² I),
/// with everything that does not depend on the variances computed once.
///
/// Fixed columns are made orthonormal and the response is replaced by its ordinary
/// least squares residual, so that no digits are lost to large means.
#[derive(Clone, Debug)]
pub struct MixedModel {
    /// What the rows weigh; response and columns are times the roots of it.
    pub(crate) weights: Weights,
    /// The response.
    pub(crate) y: Vec<f64>,
    pub(crate) x_names: Vec<String>,
    /// Fixed columns as given.
    pub(crate) x: DMatrix<f64>,
    /// Orthonormal fixed columns and their triangle.
    pub(crate) basis: Basis,
    /// What ordinary least squares leaves of the response.
    pub(crate) residual: Vec<f64>,
    /// Which level decides on the residual variance of each row; none where there is one.
    pub(crate) levels: Option<ResidualLevels>,
    /// Coefficients of ordinary least squares on the orthonormal columns.
    pub(crate) ordinary: DVector<f64>,
    /// Random terms as given.
    pub(crate) terms: Vec<RandomTerm>,
    /// Terms by grouping factor, the leaf first.
    pub(crate) factors: Vec<Factor>,
    /// For each term, the factor's group of each of the term's groups.
    pub(crate) group_place: Vec<Vec<Option<usize>>>,
    /// Cross-products of the leaf.
    pub(crate) leaf: Leaf,
    /// Cross-products of the other factors.
    pub(crate) trunk: Trunk,
    /// Cross-products of orthonormal columns and residual, by rows.
    pub(crate) fixed: Vec<f64>,
}

impl MixedModel {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.y.len()
    }

    /// Number of fixed coefficients.
    pub fn coefficients(&self) -> usize {
        self.x_names.len()
    }

    /// What the rows weigh.
    pub fn weights(&self) -> &Weights {
        &self.weights
    }

    /// Which level decides on the residual variance of each row; none where there is one.
    pub fn levels(&self) -> Option<&ResidualLevels> {
        self.levels.as_ref()
    }

    /// The random terms.
    pub fn terms(&self) -> &[RandomTerm] {
        &self.terms
    }

    /// Names of the fixed coefficients.
    pub fn names(&self) -> &[String] {
        &self.x_names
    }
}

/// Checks a model and sums its cross-products.
///
/// * `y`: response
/// * `x`: columns of the fixed effects, a row per observation; the intercept is
///   one of them
/// * `terms`: at least one random term
///
/// # Errors
/// Lists of different length, numbers that are not finite, columns that follow from
/// others ([`MixedError::DependentColumn`]), and variances that cannot be told apart
/// ([`MixedError::FewGroups`], [`MixedError::ManyRandomEffects`]).
pub fn prepare_mixed(
    y: &[f64],
    x: &DMatrix<f64>,
    x_names: &[String],
    terms: &[RandomTerm],
) -> Result<MixedModel, MixedError> {
    prepare_weighted((y, &Weights::default()), x, x_names, terms)
}

/// [`prepare_mixed`] of rows whose residual variance is σ² over their weight.
///
/// # Errors
/// As [`prepare_mixed`]; a number of weights other than that of rows.
pub fn prepare_weighted(
    (y, weights): (&[f64], &Weights),
    x: &DMatrix<f64>,
    x_names: &[String],
    terms: &[RandomTerm],
) -> Result<MixedModel, MixedError> {
    if !weights.is_empty() {
        check_length("rows of the fixed effects", x.nrows(), y.len())?;
        check_length("weights", weights.len(), y.len())?;
        for term in terms {
            check_term(term, y.len())?;
        }
        let mut model = prepare_mixed(
            &weights.weigh(y),
            &weights.weigh_columns(x),
            x_names,
            &terms
                .iter()
                .map(|own| weighted(own, weights))
                .collect::<Vec<_>>(),
        )?;
        model.weights = weights.clone();
        return Ok(model);
    }
    check_fixed(y, x, x_names)?;
    if terms.is_empty() {
        let name = "the random part of the mixed model".to_owned();
        return Err(MixedError::NoColumns { name });
    }
    for term in terms {
        check_term(term, y.len())?;
    }
    let columns: Vec<&[f64]> = x.as_slice().chunks_exact(y.len()).collect();
    let basis = orthonormal_basis(&columns)
        .map_err(|found| dependent_error("the fixed effects", x_names, &found))?;
    let (ordinary, residual) = ordinary_residual(y, &basis)?;
    let (factors, group_place) = factors_of(terms)?;

    let mut fixed: Vec<&[f64]> = basis.q.iter().map(Vec::as_slice).collect();
    fixed.push(&residual);
    let trunk = trunk_of(&factors, &fixed);
    let leaf = leaf_of(&factors, &trunk, &fixed);
    let fixed = fixed_square(&fixed);
    Ok(MixedModel {
        weights: Weights::default(),
        y: y.to_vec(),
        x_names: x_names.to_vec(),
        x: x.clone(),
        basis,
        residual,
        levels: None,
        ordinary,
        terms: terms.to_vec(),
        factors,
        group_place,
        leaf,
        trunk,
        fixed,
    })
}

/// A term with its columns times the roots of weights.
fn weighted(term: &RandomTerm, weights: &Weights) -> RandomTerm {
    let columns = term.columns.iter();
    RandomTerm {
        columns: columns.map(|own| weights.weigh(own).into_owned()).collect(),
        ..term.clone()
    }
}

fn check_fixed(y: &[f64], x: &DMatrix<f64>, x_names: &[String]) -> Result<(), MixedError> {
    check_length("rows of the fixed effects", x.nrows(), y.len())?;
    check_length("names of the fixed effects", x_names.len(), x.ncols())?;
    check_finite("response", y)?;
    if x.ncols() == 0 {
        let name = "the fixed part of the mixed model".to_owned();
        return Err(MixedError::NoColumns { name });
    }
    if y.len() <= x.ncols() {
        return Err(MixedError::FewRows {
            rows: y.len(),
            coefficients: x.ncols(),
        });
    }
    for (name, column) in x_names.iter().zip(x.column_iter()) {
        check_finite(name, column.as_slice())?;
    }
    Ok(())
}

fn dependent_error(model: &str, names: &[String], found: &Dependent) -> MixedError {
    MixedError::DependentColumn {
        model: model.to_owned(),
        name: names[found.column].clone(),
        on: found.on.iter().map(|on| names[*on].clone()).collect(),
    }
}

/// Coefficients of the orthonormal columns, and the residual.
fn ordinary_residual(y: &[f64], basis: &Basis) -> Result<(DVector<f64>, Vec<f64>), MixedError> {
    let mut residual = y.to_vec();
    let mut ordinary = DVector::zeros(basis.q.len());
    for _ in 0..2 {
        for (k, column) in basis.q.iter().enumerate() {
            let share = crate::basis::dot(column, &residual);
            ordinary[k] += share;
            residual
                .iter_mut()
                .zip(column)
                .for_each(|(r, q)| *r -= share * q);
        }
    }
    let left = norm(&residual) / norm(y).max(f64::MIN_POSITIVE);
    if left <= NO_RESIDUAL {
        return Err(MixedError::NoResidual {
            what: "the fixed effects",
            residual: left,
        });
    }
    Ok((ordinary, residual))
}

type GroupPlace = Vec<Option<usize>>;

/// Terms by their groups, the factor with most random effects first.
fn factors_of(terms: &[RandomTerm]) -> Result<(Vec<Factor>, Vec<GroupPlace>), MixedError> {
    let mut factors: Vec<(Vec<usize>, usize, Vec<usize>)> = Vec::new();
    let mut places = Vec::with_capacity(terms.len());
    for (index, term) in terms.iter().enumerate() {
        let (group, groups, place) = in_order_of_rows(term);
        places.push(place);
        match factors.iter_mut().find(|(known, ..)| *known == group) {
            Some((_, _, members)) => members.push(index),
            None => factors.push((group, groups, vec![index])),
        }
    }
    let mut factors = factors
        .into_iter()
        .map(|(group, groups, members)| factor_of(terms, group, groups, &members))
        .collect::<Result<Vec<_>, _>>()?;
    factors.sort_by_key(|factor| std::cmp::Reverse(factor.groups * factor.width));
    Ok((factors, places))
}

/// Groups numbered as the rows meet them: equal for equal partitions.
fn in_order_of_rows(term: &RandomTerm) -> (Vec<usize>, usize, GroupPlace) {
    let mut place: GroupPlace = vec![None; term.groups];
    let mut groups = 0;
    let group = term.group.iter().map(|group| {
        *place[*group].get_or_insert_with(|| {
            groups += 1;
            groups - 1
        })
    });
    let group = group.collect();
    (group, groups, place)
}

fn factor_of(
    terms: &[RandomTerm],
    group: Vec<usize>,
    groups: usize,
    members: &[usize],
) -> Result<Factor, MixedError> {
    check_independent(terms, members)?;
    let rows = group.len();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut places = Vec::new();
    let width: usize = members
        .iter()
        .map(|index| terms[*index].columns.len())
        .sum();
    let mut basis = DMatrix::zeros(width, width);
    for index in members {
        let term = &terms[*index];
        let place = TermPlace {
            term: *index,
            offset: columns.len(),
            width: term.columns.len(),
        };
        let (scaled, triangle) = scaled_columns(term)?;
        basis
            .view_mut((place.offset, place.offset), (place.width, place.width))
            .copy_from(&triangle);
        columns.extend(scaled);
        places.push(place);
    }
    let mut design = Vec::with_capacity(rows * width);
    for row in 0..rows {
        design.extend(columns.iter().map(|column| column[row]));
    }
    Ok(Factor {
        terms: places,
        width,
        groups,
        group,
        design,
        basis,
    })
}

/// Columns of mean square 1, orthogonal in a correlated term, and the triangle back.
fn scaled_columns(term: &RandomTerm) -> Result<(Vec<Vec<f64>>, DMatrix<f64>), MixedError> {
    let root = (term.group.len() as f64).sqrt();
    let scaled = |basis: Basis| {
        let mut q = basis.q;
        q.iter_mut().flatten().for_each(|value| *value *= root);
        (q, basis.r / root)
    };
    let columns: Vec<&[f64]> = term.columns.iter().map(Vec::as_slice).collect();
    let failed = |found: Dependent| {
        let model = format!("random term ({})", term.name);
        dependent_error(&model, &term.column_names, &found)
    };
    if term.correlated {
        return orthonormal_basis(&columns).map(scaled).map_err(failed);
    }
    let mut all = Vec::new();
    let mut triangle = DMatrix::zeros(columns.len(), columns.len());
    for (k, column) in columns.iter().enumerate() {
        let one = orthonormal_basis(&[column]).map(scaled);
        let (q, r) = one.map_err(|found| {
            failed(Dependent {
                column: k,
                on: found.on,
            })
        })?;
        triangle[(k, k)] = r[(0, 0)];
        all.extend(q);
    }
    Ok((all, triangle))
}

/// Columns of all terms of one factor must be independent.
fn check_independent(terms: &[RandomTerm], members: &[usize]) -> Result<(), MixedError> {
    let members: Vec<&RandomTerm> = members.iter().map(|index| &terms[*index]).collect();
    let columns: Vec<&[f64]> = members
        .iter()
        .flat_map(|term| term.columns.iter().map(Vec::as_slice))
        .collect();
    orthonormal_basis(&columns).map(|_| ()).map_err(|found| {
        let names: Vec<String> = members
            .iter()
            .flat_map(|term| {
                term.column_names
                    .iter()
                    .map(|column| format!("{column} of ({})", term.name))
            })
            .collect();
        dependent_error("random terms of the same groups", &names, &found)
    })
}
