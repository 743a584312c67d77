//! Columns of the design: linearly independent covariates.

use crate::population::finding::PopulationFinding;
use crate::population::model::PopulationData;

/// What is left of a covariate, as a share of its size, below which it follows
/// from those before it.
const DEPENDENT: f64 = 1e-8;

/// The design of a population.
pub(crate) struct Design {
    /// Columns of a row; the first is 1.
    pub columns: usize,
    /// Rows in the given order.
    pub rows: Vec<f64>,
    /// Covariates in the model: name and centre.
    pub covariates: Vec<(String, f64)>,
    /// Those left out, and why.
    pub findings: Vec<PopulationFinding>,
}

/// Rows for impacts in `order`; covariates that are constant or follow from
/// others are left out.
pub(crate) fn design(data: &PopulationData, order: &[usize]) -> Design {
    let n = order.len() as f64;
    let mut basis: Vec<Vec<f64>> = vec![vec![1.0 / n.sqrt(); order.len()]];
    let mut kept: Vec<Vec<f64>> = vec![vec![1.0; order.len()]];
    let (mut covariates, mut findings) = (Vec::new(), Vec::new());
    for covariate in &data.covariates {
        let column = order
            .iter()
            .map(|&i| covariate.values[i] - covariate.centre);
        let column: Vec<f64> = column.collect();
        let mean = column.iter().sum::<f64>() / n;
        let spread = norm(&column.iter().map(|x| x - mean).collect::<Vec<_>>());
        let size = spread + covariate.centre.abs() * n.sqrt();
        if spread <= DEPENDENT * size {
            findings.push(PopulationFinding::ConstantCovariate {
                covariate: covariate.name.clone(),
                value: covariate.values[order[0]],
            });
            continue;
        }
        let mut rest = column.clone();
        // Twice is enough (Giraud, Langou and Rozložník 2005).
        for _ in 0..2 {
            for known in &basis {
                let along: f64 = known.iter().zip(&rest).map(|(a, b)| a * b).sum();
                rest.iter_mut()
                    .zip(known)
                    .for_each(|(r, k)| *r -= along * k);
            }
        }
        let left = norm(&rest);
        if left <= DEPENDENT * spread {
            let others: Vec<&str> = covariates
                .iter()
                .map(|(n, _): &(String, f64)| n.as_str())
                .collect();
            findings.push(PopulationFinding::CollinearCovariate {
                covariate: covariate.name.clone(),
                others: others.join(", "),
            });
            continue;
        }
        basis.push(rest.iter().map(|r| r / left).collect());
        kept.push(column);
        covariates.push((covariate.name.clone(), covariate.centre));
    }
    let rows = (0..order.len()).flat_map(|i| kept.iter().map(move |column| column[i]));
    Design {
        columns: kept.len(),
        rows: rows.collect(),
        covariates,
        findings,
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
