//! Predictions for known and for new groups.

use crate::basis::add_scaled;
use crate::error::MixedError;
use crate::fit::MixedFit;
use crate::inference::{VarianceUncertainty, degrees_of_freedom, half_width};
use crate::minimise::differences;
use crate::model::MixedModel;
use crate::row::{Row, RowWork};
use crate::slope::slopes;
use crate::term::{check_finite, check_length};
use crate::theta::place_of;
use nalgebra::{DMatrix, DVector};

/// Where to predict.
#[derive(Clone, Debug, PartialEq)]
pub struct NewRows {
    /// Columns of the fixed effects.
    pub x: DMatrix<f64>,
    /// The random terms, in the model's order.
    pub terms: Vec<NewTerm>,
    /// Level of the residual variance of each row; none where there is one variance.
    pub level: Vec<usize>,
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
    #[schema(value_type = Option<f64>)]
    pub se: f64,
    /// Degrees of freedom of `se`.
    #[serde(skip)]
    pub df: f64,
    /// Lower end of the interval of that mean.
    #[schema(value_type = Option<f64>)]
    pub mean_low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
    pub mean_high: f64,
    /// Lower end of the interval of one new measurement.
    #[schema(value_type = Option<f64>)]
    pub low: f64,
    /// Upper end.
    #[schema(value_type = Option<f64>)]
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
    let prepared: Vec<(Row, Vec<bool>)> = (0..rows.x.nrows())
        .map(|row| prepare(fit, rows, row))
        .collect();
    let at = |coordinates: &[f64]| -> Option<Vec<f64>> {
        let (model, state) = fit.at(coordinates)?;
        let (_, projections) = slopes(&model, &state);
        let mut work = RowWork::default();
        let variances = prepared.iter().map(|(row, _)| {
            let (random, fixed) = row.variances(&model, &state, &projections, &mut work)?;
            Some(random + fixed)
        });
        variances.collect()
    };
    let here = fit.coordinates();
    let variances = at(&here).ok_or(MixedError::NoCriterion)?;
    let changes = differences(&at, &here).ok_or(MixedError::NoCriterion)?;

    let (sigma, ratios) = (fit.residual_sd, fit.level_ratios());
    let predictions = prepared.iter().enumerate().map(|(row, (_, unseen))| {
        let (population, value) = expected(fit, rows, row, unseen);
        // with a further measurement, or without
        let half = |further: bool| {
            let mut slope: Vec<f64> = changes
                .iter()
                .map(|change| change[row] * sigma * sigma)
                .collect();
            let mut relative = variances[row];
            if further {
                let level = rows.level.get(row).copied().unwrap_or_default();
                relative += ratios[level];
                if level > 0 {
                    slope[fit.estimate.theta.len() + level - 1] += ratios[level] * sigma * sigma;
                }
            }
            slope.push(2.0 * sigma * sigma * relative);
            let variance = relative * sigma * sigma;
            let df = degrees_of_freedom(uncertainty, variance, &DVector::from_vec(slope));
            (
                variance.sqrt(),
                df,
                half_width(confidence, df) * variance.sqrt(),
            )
        };
        let (se, df, mean) = half(false);
        // More degrees of freedom must not make a measurement surer than its mean.
        let single = half(true).2.max(mean);
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
    if let Some(levels) = &model.levels {
        check_length("levels of the new rows", rows.level.len(), n)?;
        let known = levels.names.len();
        let missing = rows.level.iter().position(|own| *own >= known);
        if let Some(row) = missing {
            return Err(MixedError::UnknownLevel {
                column: levels.column.clone(),
                row: row + 1,
            });
        }
    }
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
///
/// * `unseen`: whether each term's group was not measured
fn expected(fit: &MixedFit, rows: &NewRows, row: usize, unseen: &[bool]) -> (f64, f64) {
    let population: f64 = rows
        .x
        .row(row)
        .iter()
        .zip(&fit.coefficients)
        .map(|(x, b)| x * b)
        .sum();
    let mut value = population;
    for (term, new) in rows.terms.iter().enumerate() {
        if let (Some(group), false) = (new.group[row], unseen[term]) {
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

/// A row in the model's own columns, and whether each term's group was not measured.
fn prepare(fit: &MixedFit, rows: &NewRows, row: usize) -> (Row, Vec<bool>) {
    let model = &fit.model;
    let given = DVector::from_iterator(model.coefficients(), rows.x.row(row).iter().copied());
    let x = model.basis.r.tr_solve_upper_triangular(&given);
    let mut prepared = Row {
        x: x.unwrap_or(given).as_slice().to_vec(),
        known: Vec::new(),
        new: Vec::new(),
    };
    let mut unseen = Vec::new();
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
        unseen.push(group.is_none());
        match group {
            None => prepared.new.push((factor, z.as_slice().to_vec())),
            Some(group) => {
                let mut known = prepared.known.iter_mut();
                match known.find(|(f, g, _)| (*f, *g) == (factor, group)) {
                    Some((_, _, sum)) => add_scaled(sum, 1.0, z.as_slice()),
                    None => {
                        let own = (factor, group, z.as_slice().to_vec());
                        prepared.known.push(own);
                    }
                }
            }
        }
    }
    (prepared, unseen)
}
