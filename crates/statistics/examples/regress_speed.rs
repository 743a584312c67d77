//! Times linear regression in memory.
//!
//!     regress_speed FILE COLUMNS ROUNDS
//!
//! FILE holds doubles, column after column, the response last. Prints the seconds
//! of each round on one line (estimates, errors, probabilities, residuals and
//! leverages), then the estimates.

#![allow(clippy::print_stdout)]

use nalgebra::DMatrix;
use std::time::Instant;
use windfall_statistics::model::linear_model::fit_linear;
use windfall_statistics::model::model_frame::ModelFrame;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, columns, rounds] = &arguments[..] else {
        println!("regress_speed FILE COLUMNS ROUNDS");
        return Ok(());
    };
    let (columns, rounds): (usize, usize) = (columns.parse()?, rounds.parse()?);
    let bytes = std::fs::read(file)?;
    let values: Vec<f64> = bytes
        .chunks_exact(8)
        .map(|b| f64::from_le_bytes(b.try_into().unwrap_or_default()))
        .collect();
    let rows = values.len() / (columns + 1);
    let x = DMatrix::from_column_slice(rows, columns, &values[..rows * columns]);
    let y = &values[rows * columns..];
    let frame = ModelFrame {
        atoms: Vec::new(),
        terms: Vec::new(),
        intercept: true,
        names: (0..columns).map(|column| format!("x{column}")).collect(),
    };
    let wanted: Vec<usize> = (0..columns).collect();
    let mut seconds = Vec::new();
    let mut estimates = Vec::new();
    for _ in 0..rounds {
        let start = Instant::now();
        let fit = fit_linear(&frame, &x, y, &wanted, 0.95)?;
        seconds.push(format!("{:.6}", start.elapsed().as_secs_f64()));
        estimates = fit.coefficients.iter().map(|c| c.estimate).collect();
    }
    println!("{}", seconds.join(" "));
    println!("{estimates:?}");
    Ok(())
}
