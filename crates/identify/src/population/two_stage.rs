//! The usual way, for comparison: fit each impact, average over the impacts of
//! each fruit, describe the averages; regress the fits on covariates as if they
//! were independent.

use crate::error::Error;
use crate::population::design::design;
use crate::population::model::{FixedEffect, PopulationData, Spread};
use nalgebra::{DMatrix, DVector};
use windfall_distribution::tail::{chi_squared_upper_quantile, t_two_sided, t_upper_quantile};

/// Results of the two-stage estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoStage {
    /// Mean of the fruit's averages of φ, with the t interval, by parameter.
    pub means: Vec<Spread>,
    /// Standard deviation of the averages, with the interval of a normal sample.
    pub sds: Vec<Spread>,
    /// Correlations of the averages: pairs (0, 1), (0, 2), (1, 2), …
    pub correlations: Vec<f64>,
    /// Least squares over all impacts, parameter by parameter, the parameter
    /// itself first.
    pub effects: Vec<FixedEffect>,
}

/// Averages and regressions of the fits `estimates` (φ of each impact).
///
/// # Errors
/// [`Error::FewMembers`].
pub fn two_stage(
    data: &PopulationData,
    estimates: &[Vec<f64>],
    confidence: f64,
) -> Result<TwoStage, Error> {
    let fruits = data.fruit.iter().max().map_or(0, |most| most + 1);
    let order: Vec<usize> = (0..data.fruit.len()).collect();
    let few = |needed| Error::FewMembers {
        fruits,
        impacts: order.len(),
        needed,
    };
    if order.is_empty() {
        return Err(few(2));
    }
    let design = design(data, &order);
    if fruits < 2 || order.len() <= design.columns {
        return Err(few(design.columns + 1));
    }
    let size = data.parameters.len();
    let averages: Vec<Vec<f64>> = (0..size)
        .map(|k| averages(data, estimates, fruits, k))
        .collect();
    let spreads = averages.iter().map(|own| spread(own, confidence));
    let (means, sds) = spreads.unzip();
    let pairs = (0..size).flat_map(|k| (k + 1..size).map(move |l| (k, l)));
    let correlations = pairs.map(|(k, l)| correlation(&averages[k], &averages[l]));
    let rows = DMatrix::from_row_slice(order.len(), design.columns, &design.rows);
    let mut effects = Vec::new();
    for k in 0..size {
        let values = estimates.iter().map(|phi| phi[k]);
        let values = DVector::from_iterator(order.len(), values);
        let found = regress(&rows, &values).ok_or_else(|| few(design.columns + 1))?;
        let df = (order.len() - design.columns) as f64;
        for (c, (value, se)) in found.into_iter().enumerate() {
            effects.push(FixedEffect {
                parameter: data.parameters[k].clone(),
                covariate: c.checked_sub(1).map(|c| design.covariates[c].0.clone()),
                ..t_interval(value, se, df, confidence)
            });
        }
    }
    Ok(TwoStage {
        means,
        sds,
        correlations: correlations.collect(),
        effects,
    })
}

/// An effect with its t interval and p-value, its names empty.
fn t_interval(value: f64, se: f64, df: f64, confidence: f64) -> FixedEffect {
    let quantile = match df > 0.0 {
        true => t_upper_quantile(0.5 * (1.0 - confidence), df),
        false => f64::INFINITY,
    };
    FixedEffect {
        parameter: String::new(),
        covariate: None,
        value,
        se,
        df,
        low: value - quantile * se,
        high: value + quantile * se,
        p: t_two_sided(value / se, df),
    }
}

fn averages(
    data: &PopulationData,
    estimates: &[Vec<f64>],
    fruits: usize,
    parameter: usize,
) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); fruits];
    for (fruit, phi) in data.fruit.iter().zip(estimates) {
        sums[*fruit].0 += phi[parameter];
        sums[*fruit].1 += 1.0;
    }
    sums.iter().map(|(sum, count)| sum / count).collect()
}

fn spread(values: &[f64], confidence: f64) -> (Spread, Spread) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let sd = (square / (n - 1.0)).sqrt();
    let t = t_interval(mean, sd / n.sqrt(), n - 1.0, confidence);
    let end = |above: f64| (square / chi_squared_upper_quantile(above, n - 1.0)).sqrt();
    let (low, high) = (end(0.5 - 0.5 * confidence), end(0.5 + 0.5 * confidence));
    (
        Spread {
            value: mean,
            interval: Some((t.low, t.high)),
        },
        Spread {
            value: sd,
            interval: (n > 1.0).then_some((low, high)),
        },
    )
}

fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (a, b) = (mean(one), mean(other));
    let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        one.iter().zip(other).map(|(x, y)| f(x - a, y - b)).sum()
    };
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Least squares: estimates with standard errors.
fn regress(rows: &DMatrix<f64>, values: &DVector<f64>) -> Option<Vec<(f64, f64)>> {
    let inverse = (rows.transpose() * rows).cholesky()?.inverse();
    let effects = &inverse * rows.tr_mul(values);
    let residual = values - rows * &effects;
    let freedom = (rows.nrows() - rows.ncols()) as f64;
    let variance = residual.norm_squared() / freedom;
    let own = effects.iter().enumerate();
    Some(
        own.map(|(i, e)| (*e, (variance * inverse[(i, i)]).sqrt()))
            .collect(),
    )
}
