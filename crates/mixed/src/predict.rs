//! Predictions for known and for new groups.

use crate::basis::dot;
use crate::error::MixedError;
use crate::evaluate::{LeafScratch, State, eliminate, evaluate, solve_lower};
use crate::fit::MixedFit;
use crate::inference::{VarianceUncertainty, degrees_of_freedom, half_width};
use crate::minimise::differences;
use crate::model::MixedModel;
use crate::slope::{Projections, slopes};
use crate::term::{check_finite, check_length};
use crate::theta::{blocks_of, place_of};
use nalgebra::{DMatrix, DVector};

/// Where to predict.
#[derive(Clone, Debug, PartialEq)]
pub struct NewRows {
    /// Columns of the fixed effects.
    pub x: DMatrix<f64>,
    /// The random terms, in the model's order.
    pub terms: Vec<NewTerm>,
}

/// One random term where to predict.
#[derive(Clone, Debug, PartialEq)]
pub struct NewTerm {
    /// Its columns.
    pub columns: Vec<Vec<f64>>,
    /// The group of each row; `None` for a new group, whose effect is zero on average.
    pub group: Vec<Option<usize>>,
}

/// Prediction of one row.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct MixedPrediction {
    /// Fixed effects alone.
    pub population: f64,
    /// Fixed effects and the effects of the row's groups; `population` for an unknown group.
    pub predicted: f64,
    /// Standard error of `predicted` as a mean, from coefficients and effects.
    pub se: f64,
    /// Degrees of freedom of `se`.
    #[serde(skip)]
    pub df: f64,
    /// Lower end of the interval of that mean.
    pub mean_low: f64,
    /// Upper end.
    pub mean_high: f64,
    /// Lower end of the interval of one new measurement.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Predicts at new rows, with intervals of this confidence.
///
/// Variances are taken at their estimates (as usual for best linear unbiased
/// predictions); that they are estimates enters by Satterthwaite's degrees of
/// freedom of the prediction's variance.
///
/// # Errors
/// [`MixedError::WrongLength`], [`MixedError::NotFinite`] and
/// [`MixedError::UnknownGroup`] for rows that do not fit the model.
///
/// # Source
/// Variance of prediction: Henderson (1975), Biometrics 31, 423-447.
pub fn predict_mixed(
    fit: &MixedFit,
    uncertainty: &VarianceUncertainty,
    rows: &NewRows,
    confidence: f64,
) -> Result<Vec<MixedPrediction>, MixedError> {
    check_rows(&fit.model, rows)?;
    let prepared: Vec<Row> = (0..rows.x.nrows())
        .map(|row| prepare(fit, rows, row))
        .collect();
    let at = |theta: &[f64]| -> Option<Vec<f64>> {
        let state = evaluate(
            &fit.model,
            &blocks_of(&fit.model, &fit.estimate.entries, theta),
        )?;
        let (_, projections) = slopes(&fit.model, &state);
        let variances = prepared
            .iter()
            .map(|row| row.variance(&fit.model, &state, &projections));
        variances.collect()
    };
    let variances = at(&fit.estimate.theta).ok_or(MixedError::NoCriterion)?;
    let changes = differences(&at, &fit.estimate.theta).ok_or(MixedError::NoCriterion)?;

    let sigma = fit.residual_sd;
    let predictions = prepared.iter().enumerate().map(|(row, prepared)| {
        let (population, value) = expected(fit, rows, row, prepared);
        let half = |relative: f64| {
            let mut slope: Vec<f64> = changes
                .iter()
                .map(|change| change[row] * sigma * sigma)
                .collect();
            slope.push(2.0 * sigma * relative);
            let variance = relative * sigma * sigma;
            let df = degrees_of_freedom(uncertainty, variance, &DVector::from_vec(slope));
            (
                variance.sqrt(),
                df,
                half_width(confidence, df) * variance.sqrt(),
            )
        };
        let (se, df, mean) = half(variances[row]);
        let (_, _, single) = half(variances[row] + 1.0);
        MixedPrediction {
            population,
            predicted: value,
            se,
            df,
            mean_low: value - mean,
            mean_high: value + mean,
            low: value - single,
            high: value + single,
        }
    });
    Ok(predictions.collect())
}

fn check_rows(model: &MixedModel, rows: &NewRows) -> Result<(), MixedError> {
    let n = rows.x.nrows();
    check_length(
        "columns of the new fixed effects",
        rows.x.ncols(),
        model.coefficients(),
    )?;
    for (name, column) in model.x_names.iter().zip(rows.x.column_iter()) {
        check_finite(&format!("new rows, {name}"), column.as_slice())?;
    }
    check_length(
        "random terms of the new rows",
        rows.terms.len(),
        model.terms.len(),
    )?;
    for (new, term) in rows.terms.iter().zip(&model.terms) {
        let of = |what: &str| format!("new rows, random term ({}), {what}", term.name);
        check_length(&of("columns"), new.columns.len(), term.columns.len())?;
        check_length(&of("groups"), new.group.len(), n)?;
        for (column, name) in new.columns.iter().zip(&term.column_names) {
            check_length(&of(name), column.len(), n)?;
            check_finite(&of(name), column)?;
        }
        let groups = new.group.iter().enumerate();
        for (row, group) in groups.filter_map(|(row, group)| Some((row, (*group)?))) {
            if group >= term.groups {
                return Err(MixedError::UnknownGroup {
                    term: term.name.clone(),
                    row: row + 1,
                    group,
                    groups: term.groups,
                });
            }
        }
    }
    Ok(())
}

/// Fixed effects, and with the effects of the row's groups.
fn expected(fit: &MixedFit, rows: &NewRows, row: usize, prepared: &Row) -> (f64, f64) {
    let population: f64 = rows
        .x
        .row(row)
        .iter()
        .zip(&fit.coefficients)
        .map(|(x, b)| x * b)
        .sum();
    let mut value = population;
    for (term, new) in rows.terms.iter().enumerate() {
        if let (Some(group), false) = (new.group[row], prepared.unseen[term]) {
            let effects = &fit.effects[term].values[group];
            value += new
                .columns
                .iter()
                .zip(effects)
                .map(|(z, b)| z[row] * b)
                .sum::<f64>();
        }
    }
    (population, value)
}

/// A row in the model's own columns.
struct Row {
    /// Fixed columns.
    x: DVector<f64>,
    /// Groups that were measured: factor, group, columns.
    known: Vec<(usize, usize, DVector<f64>)>,
    /// Groups that were not: factor, columns, each its own.
    new: Vec<(usize, DVector<f64>)>,
    /// Whether each term's group was not measured.
    unseen: Vec<bool>,
}

fn prepare(fit: &MixedFit, rows: &NewRows, row: usize) -> Row {
    let model = &fit.model;
    let given = DVector::from_iterator(model.coefficients(), rows.x.row(row).iter().copied());
    let x = model.basis.r.tr_solve_upper_triangular(&given);
    let mut prepared = Row {
        x: x.unwrap_or(given),
        known: Vec::new(),
        new: Vec::new(),
        unseen: Vec::new(),
    };
    for (term, new) in rows.terms.iter().enumerate() {
        let (factor, place) = place_of(model, term);
        let mut z = DVector::zeros(model.factors[factor].width);
        for (k, column) in new.columns.iter().enumerate() {
            z[place.offset + k] = column[row];
        }
        let z = model.factors[factor]
            .basis
            .tr_solve_upper_triangular(&z)
            .unwrap_or(z);
        let group = new.group[row].and_then(|group| model.group_place[term][group]);
        prepared.unseen.push(group.is_none());
        match group {
            None => prepared.new.push((factor, z)),
            Some(group) => {
                let mut known = prepared.known.iter_mut();
                match known.find(|(f, g, _)| (*f, *g) == (factor, group)) {
                    Some((_, _, sum)) => *sum += z,
                    None => prepared.known.push((factor, group, z)),
                }
            }
        }
    }
    prepared
}

impl Row {
    /// Variance of the prediction's error over σ²: z'Λ A⁻¹ Λ'z + d'(X'V⁻¹X)⁻¹d with
    /// d = x - X'V⁻¹Z Λ Λ' z, and what new groups add.
    fn variance(
        &self,
        model: &MixedModel,
        state: &State,
        projections: &Projections,
    ) -> Option<f64> {
        let p = model.coefficients();
        let mut d = self.x.clone();
        let mut sum = 0.0;
        let mut trunk = vec![0.0; model.trunk.envelope.rows()];
        for (factor, group, z) in &self.known {
            let width = model.factors[*factor].width;
            let block = &state.blocks[*factor];
            let root = block.tr_mul(z);
            let smooth = block * &root;
            for column in 0..width {
                let row = &projections[*factor][(group * width + column) * (p + 1)..][..p];
                d.iter_mut()
                    .zip(row)
                    .for_each(|(d, b)| *d -= b * smooth[column]);
            }
            if *factor == 0 {
                sum += leaf_variance(model, state, *group, root, &mut trunk)?;
            } else {
                let first = model.trunk.offsets[factor - 1] + group * width;
                (0..width).for_each(|k| trunk[first + k] += z[k]);
            }
        }
        let mut solved = crate::evaluate::times_blocks(
            model,
            &state.blocks,
            &trunk,
            crate::evaluate::Side::Transposed,
        );
        model
            .trunk
            .envelope
            .solve_lower(&state.trunk_factor, &mut solved, 1);
        sum += dot(&solved, &solved);
        for (factor, z) in &self.new {
            sum += state.blocks[*factor].tr_mul(z).norm_squared();
        }
        Some(sum + (d.transpose() * &state.covariance * d)[(0, 0)])
    }
}

/// |L⁻¹Λ'z|² of a leaf group; takes K'L⁻¹Λ'z from the trunk's columns.
fn leaf_variance(
    model: &MixedModel,
    state: &State,
    group: usize,
    root: DVector<f64>,
    trunk: &mut [f64],
) -> Option<f64> {
    let leaf = &model.leaf;
    let mut scratch = LeafScratch::default();
    eliminate(leaf, &state.blocks[0], group, &mut scratch)?;
    let mut solved = root.as_slice().to_vec();
    solve_lower(&scratch.factor, leaf.width, &mut solved, 1);
    let met = &leaf.met[leaf.met_start[group]..leaf.met_start[group + 1]];
    let wide = met.len() + model.coefficients() + 1;
    for (row, value) in scratch.cross.chunks_exact(wide).zip(&solved) {
        for (column, k) in met.iter().zip(row) {
            trunk[*column] -= k * value;
        }
    }
    Some(dot(&solved, &solved))
}
