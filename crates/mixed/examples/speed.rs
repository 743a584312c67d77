//! Seconds that one mixed model takes, for `bench/compare-mixed`.
//!
//!     speed FILE MODEL
//!
//! FILE has lines `y,x,group,other` of numbers, without a header; MODEL is
//! `intercept`, `slope`, or `both` (intercepts of both columns of groups). Reading
//! is not timed. Prints the seconds of the fit, those of the fit with Satterthwaite's
//! degrees of freedom, then the criterion, the residual standard deviation and those
//! of the effects.
#![allow(clippy::print_stdout)]

use nalgebra::DMatrix;
use std::time::Instant;
use windfall_mixed::fit::{MixedOptions, fit_mixed};
use windfall_mixed::inference::{coefficient_tests, variance_uncertainty};
use windfall_mixed::term::{RandomTerm, random_intercept};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (file, model) = match (arguments.next(), arguments.next()) {
        (Some(file), Some(model)) => (file, model),
        _ => return Err("give FILE and MODEL".into()),
    };
    let columns = read(&std::fs::read_to_string(file)?)?;
    let groups = |k: usize| -> Vec<usize> { columns[k].iter().map(|v| *v as usize).collect() };
    let terms = terms_of(&model, &columns[1], &groups(2), &groups(3))?;
    let rows = columns[0].len();
    let x = DMatrix::from_fn(rows, 2, |row, k| if k == 0 { 1.0 } else { columns[1][row] });
    let names = ["(Intercept)".to_owned(), "x".to_owned()];

    let start = Instant::now();
    let fit = fit_mixed(&columns[0], &x, &names, &terms, &MixedOptions::default())?;
    let alone = start.elapsed().as_secs_f64();
    let tests = coefficient_tests(&fit, &variance_uncertainty(&fit)?, 0.95);
    let with_tests = start.elapsed().as_secs_f64();
    let sds: Vec<f64> = fit.variances.iter().flat_map(|v| v.sds.clone()).collect();
    println!(
        "{alone} {with_tests} {} {} {sds:?}",
        fit.criterion, fit.residual_sd
    );
    let findings: Vec<&str> = fit.findings.iter().map(|finding| finding.code()).collect();
    println!(
        "{} evaluations, df {}, {findings:?}",
        fit.evaluations, tests[1].df
    );
    Ok(())
}

fn read(text: &str) -> Result<Vec<Vec<f64>>, std::num::ParseFloatError> {
    let mut columns = vec![Vec::new(); 4];
    for line in text.lines() {
        for (column, cell) in columns.iter_mut().zip(line.split(',')) {
            column.push(cell.parse()?);
        }
    }
    Ok(columns)
}

fn terms_of(
    model: &str,
    x: &[f64],
    group: &[usize],
    other: &[usize],
) -> Result<Vec<RandomTerm>, String> {
    let names = |group: &[usize]| -> Vec<String> {
        let count = group.iter().max().map_or(0, |last| last + 1);
        (0..count).map(|k| k.to_string()).collect()
    };
    let first = random_intercept("group", group, &names(group));
    match model {
        "intercept" => Ok(vec![first]),
        "slope" => Ok(vec![RandomTerm {
            columns: vec![vec![1.0; x.len()], x.to_vec()],
            column_names: vec!["(Intercept)".to_owned(), "x".to_owned()],
            ..first
        }]),
        "both" => Ok(vec![first, random_intercept("other", other, &names(other))]),
        other => Err(format!("no model {other}")),
    }
}
