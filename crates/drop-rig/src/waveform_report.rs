//! From the minimum of a waveform calibration to estimates with uncertainties.

use crate::arrow_system::{Arrow, OWN, SHARED};
use crate::waveform::{Estimate, RecordFit, WaveformFit, WeakDirection};
use crate::waveform_parameters::{LEVEL, MASS, ONSET, Parameters, Point, VELOCITY};
use windfall_distribution::tail::t_upper_quantile;
use windfall_identify::error::Error;

/// Normal quantile of a two-sided 95 % interval.
const NORMAL: f64 = 1.959_963_984_540_054;
/// Records from which their scatter is taken for an uncertainty.
const LEAST_RECORDS: usize = 8;
/// Their scatter rules when it exceeds the noise's by this factor.
const BEYOND_NOISE: f64 = 1.5;
/// Steps of the power method for the weakest direction.
const POWER_STEPS: usize = 200;

/// The minimum with what it is the minimum of.
pub(crate) struct Solution<'a> {
    pub parameters: &'a Parameters,
    pub point: &'a Point,
    pub arrow: &'a Arrow,
    pub evaluations: usize,
    pub converged: bool,
}

type Square = [[f64; SHARED]; SHARED];

/// Estimates, intervals and the weakest direction.
pub(crate) fn report(solution: &Solution) -> Result<WaveformFit, Error> {
    let Solution {
        parameters, arrow, ..
    } = solution;
    let by_noise = arrow.covariance().ok_or(Error::Unidentified {
        law: parameters.law.kind().name(),
    })?;
    let misfit = misfit(solution);
    // A misfit above 1 is noise that was not seen before the drops, or a law
    // that does not fit: either way the estimates are less certain.
    let inflated = by_noise.map(|row| row.map(|value| value * misfit.max(1.0)));
    let by_records = by_records(arrow, &by_noise);
    let to_natural = natural(parameters);
    let names: Vec<String> = parameters.shared.iter().map(|p| p.name.clone()).collect();
    let sd_of_noise = deviations(parameters, &transformed(&inflated, &to_natural));
    let sd_of_records = by_records.map_or_else(Vec::new, |covariance| {
        deviations(parameters, &transformed(&covariance, &to_natural))
    });
    let records_rule = sd_of_records
        .iter()
        .zip(&sd_of_noise)
        .any(|(records, noise)| *records > BEYOND_NOISE * noise);
    let (covariance, quantile) = match by_records {
        Some(covariance) if records_rule => (covariance, student(arrow.records.len())),
        _ => (inflated, NORMAL),
    };
    let covariance = transformed(&covariance, &to_natural);
    let values = parameters.values(&solution.point.shared);
    let estimates = parameters
        .shared
        .iter()
        .map(|p| {
            let sd = covariance[p.place][p.place].sqrt();
            estimate(values[p.place], sd, quantile, p.logarithmic)
        })
        .collect();
    let places: Vec<usize> = parameters.shared.iter().map(|p| p.place).collect();
    let law = parameters.law(&values)?;
    let first = solution.point.own.first().map_or(0.0, |own| own[MASS]);
    Ok(WaveformFit {
        law,
        rig: parameters.rig(&values, first.exp()),
        estimates,
        weakest: weakest(&places, &covariance),
        covariance: places
            .iter()
            .map(|&i| places.iter().map(|&j| covariance[i][j]).collect())
            .collect(),
        logarithmic: parameters.shared.iter().map(|p| p.logarithmic).collect(),
        names,
        sd_of_noise,
        sd_of_records,
        by_records: records_rule,
        records: records(solution, &by_noise, misfit.max(1.0)),
        cost: arrow.cost(),
        samples: arrow.samples(),
        misfit,
        evaluations: solution.evaluations,
        converged: solution.converged,
    })
}

fn misfit(solution: &Solution) -> f64 {
    let free = solution.parameters.shared.len() + 2 * solution.point.own.len();
    let freedom = solution.arrow.samples().saturating_sub(free).max(1);
    let cost: f64 = solution.arrow.records.iter().map(|r| r.cost).sum();
    cost / freedom as f64
}

fn student(records: usize) -> f64 {
    t_upper_quantile(0.025, records.saturating_sub(1).max(1) as f64)
}

fn estimate(value: f64, sd: f64, quantile: f64, logarithmic: bool) -> Estimate {
    match logarithmic {
        true => Estimate {
            value,
            sd: value * sd,
            low: value * (-quantile * sd).exp(),
            high: value * (quantile * sd).exp(),
        },
        false => Estimate {
            value,
            sd,
            low: value - quantile * sd,
            high: value + quantile * sd,
        },
    }
}

/// Sandwich of the records' pulls (Liang and Zeger 1986, Biometrika 73:13),
/// with the factor R/(R − 1) for few records.
fn by_records(arrow: &Arrow, by_noise: &Square) -> Option<Square> {
    let count = arrow.records.len();
    if count < LEAST_RECORDS {
        return None;
    }
    let mut middle = [[0.0; SHARED]; SHARED];
    for pull in arrow.pulls()? {
        for i in 0..SHARED {
            for j in 0..SHARED {
                middle[i][j] += pull[i] * pull[j];
            }
        }
    }
    let factor = count as f64 / (count as f64 - 1.0);
    let half: Square = product(by_noise, &middle);
    Some(product(&half, by_noise).map(|row| row.map(|value| value * factor)))
}

fn product(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..SHARED).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Derivatives of the logarithm (or the value) of each parameter by what is
/// moved.
fn natural(parameters: &Parameters) -> Square {
    let mut matrix = [[0.0; SHARED]; SHARED];
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for parameter in &parameters.shared {
        for &exponent in &parameter.exponents {
            matrix[parameter.place][exponent] = -parameters.reference;
        }
    }
    matrix
}

fn transformed(covariance: &Square, matrix: &Square) -> Square {
    let transposed: Square = std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]));
    product(&product(matrix, covariance), &transposed)
}

/// Standard uncertainties of logarithms and plain values.
fn deviations(parameters: &Parameters, covariance: &Square) -> Vec<f64> {
    let shared = parameters.shared.iter();
    shared
        .map(|p| covariance[p.place][p.place].sqrt())
        .collect()
}

/// Largest eigenvalue of the covariance with its direction.
fn weakest(places: &[usize], covariance: &Square) -> Option<WeakDirection> {
    if places.len() < 2 {
        return None;
    }
    let mut direction = vec![1.0; places.len()];
    let mut size = 0.0;
    for _ in 0..POWER_STEPS {
        let next: Vec<f64> = places
            .iter()
            .map(|&i| {
                let row = places.iter().zip(&direction);
                row.map(|(&j, part)| covariance[i][j] * part).sum()
            })
            .collect();
        size = next.iter().map(|v: &f64| v * v).sum::<f64>().sqrt();
        if size == 0.0 {
            return None;
        }
        direction = next.iter().map(|value| value / size).collect();
    }
    let largest = direction
        .iter()
        .copied()
        .fold(0.0, |a: f64, b: f64| if b.abs() > a.abs() { b } else { a });
    Some(WeakDirection {
        sd: size.sqrt(),
        shares: direction.iter().map(|value| value / largest).collect(),
    })
}

fn records(solution: &Solution, shared: &Square, inflation: f64) -> Vec<RecordFit> {
    let arrow = solution.arrow;
    let records = solution.point.own.iter().enumerate();
    records
        .map(|(index, own)| {
            let covariance = arrow.own_covariance(index, shared);
            let sd = |place: usize| {
                covariance.map_or(f64::NAN, |c| (c[place][place] * inflation).sqrt())
            };
            let held =
                |place: usize| arrow.records[index].normal[SHARED + place][SHARED + place] == 0.0;
            let one = |place: usize, value: f64, logarithmic: bool| match held(place) {
                true => estimate(value, 0.0, NORMAL, false),
                false => estimate(value, sd(place), NORMAL, logarithmic),
            };
            let record: &[f64; OWN] = own;
            RecordFit {
                onset: one(ONSET, record[ONSET], false),
                velocity: one(VELOCITY, record[VELOCITY].exp(), true),
                mass: one(MASS, record[MASS].exp(), true),
                level: one(LEVEL, record[LEVEL], false),
                misfit: arrow.records[index].cost / arrow.records[index].samples.max(1) as f64,
                samples: arrow.records[index].samples,
            }
        })
        .collect()
}
