//! Linear regression against the certified values of the NIST Statistical Reference
//! Datasets (StRD). Filip (data in `fixtures/filip.csv`) and the Wampler sets, which
//! are formulas, are always checked; the others are read from `$WINDFALL_DATA/nist`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::formula;
use windfall_statistics::model::linear_model::{LinearFit, fit_reduced};
use windfall_statistics::model::model_rows::model_rows;
use windfall_statistics::model::reduced::reduce_written;
use windfall_statistics::table::{Cells, Column, Table};

fn table(columns: &[(&str, Vec<f64>)]) -> Table {
    let columns = columns.iter().map(|(name, values)| Column {
        name: (*name).to_owned(),
        cells: Cells::Numbers(values.clone().into()),
    });
    Table {
        columns: columns.collect(),
    }
}

fn fit(text: &str, table: &Table) -> LinearFit {
    let formula = formula(text, &[]).unwrap();
    let rows = model_rows(&formula, table, Contrast::Treatment, &[]).unwrap();
    let wanted: Vec<usize> = (0..rows.x.ncols()).collect();
    let reduced = reduce_written(&rows.x, &rows.lost, &rows.y);
    fit_reduced(&rows.frame, &rows.x, &rows.y, &reduced, &wanted, 0.95).unwrap()
}

/// Digits that agree, at most 15.
fn digits(found: f64, certified: f64) -> f64 {
    let error = match certified == 0.0 {
        true => found.abs(),
        false => (found / certified - 1.0).abs(),
    };
    (-error.log10()).min(15.0)
}

fn check(name: &str, fit: &LinearFit, certified: &[(f64, f64)], least: f64) {
    assert_eq!(fit.coefficients.len(), certified.len(), "{name}");
    let (mut estimates, mut errors) = (15.0_f64, 15.0_f64);
    for (found, (estimate, se)) in fit.coefficients.iter().zip(certified) {
        estimates = estimates.min(digits(found.estimate, *estimate));
        errors = errors.min(digits(found.se, *se));
    }
    println!("{name}: digits of estimates {estimates:.1}, of standard errors {errors:.1}");
    assert!(estimates >= least && errors >= least, "{name}");
}

const POLYNOMIAL_5: &str = "y ~ x + x^2 + x^3 + x^4 + x^5";

#[test]
fn reference_filip() {
    let text = include_str!("fixtures/filip.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    let table = table(&[("y", column(0)), ("x", column(1))]);
    let certified = [
        (-1467.48961422980, 298.084530995537),
        (-2772.17959193342, 559.779865474950),
        (-2316.37108160893, 466.477572127796),
        (-1127.97394098372, 227.204274477751),
        (-354.478233703349, 71.6478660875927),
        (-75.1242017393757, 15.2897178747400),
        (-10.8753180355343, 2.23691159816033),
        (-1.06221498588947, 0.221624321934227),
        (-0.670191154593408E-01, 0.142363763154724E-01),
        (-0.246781078275479E-02, 0.535617408889821E-03),
        (-0.402962525080404E-04, 0.896632837373868E-05),
    ];
    let powers: Vec<String> = (1..=10).map(|power| format!("x^{power}")).collect();
    check(
        "Filip",
        &fit(&format!("y ~ {}", powers.join(" + ")), &table),
        &certified,
        9.0,
    );
}

#[test]
fn reference_wampler() {
    let x: Vec<f64> = (0..21).map(f64::from).collect();
    let sum = |x: f64, base: f64| (0..6).map(|power| (base * x).powi(power)).sum::<f64>();
    let deltas = [
        759.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 1838.0, -2048.0, 2048.0,
        -2048.0, 1838.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 759.0,
    ];
    // Wampler2 is given with five decimals.
    let y2 = x
        .iter()
        .map(|x| (sum(*x, 0.1) * 1e5).round() / 1e5)
        .collect();
    let exact: [(f64, f64); 6] = [(1.0, 0.0); 6];
    let tenths = [1.0, 0.1, 0.01, 0.001, 1e-4, 1e-5].map(|estimate| (estimate, 0.0));
    let errors = [
        2152.32624678170,
        2363.55173469681,
        779.343524331583,
        101.475507550350,
        5.64566512170752,
        0.112324854679312,
    ];
    let y1: Vec<f64> = x.iter().map(|x| sum(*x, 1.0)).collect();
    let with = |scale: f64| -> Vec<f64> {
        y1.iter()
            .zip(&deltas)
            .map(|(y, delta)| y + scale * delta)
            .collect()
    };
    for (name, y, certified) in [
        ("Wampler1", y1.clone(), exact),
        ("Wampler2", y2, tenths),
        ("Wampler3", with(1.0), errors.map(|se| (1.0, se))),
        ("Wampler4", with(1e2), errors.map(|se| (1.0, 1e2 * se))),
        ("Wampler5", with(1e4), errors.map(|se| (1.0, 1e4 * se))),
    ] {
        let table = table(&[("y", y), ("x", x.clone())]);
        check(name, &fit(POLYNOMIAL_5, &table), &certified, 9.0);
    }
}

/// Rows of numbers, and certified estimates with their standard errors.
type Collected = (Vec<Vec<f64>>, Vec<(f64, f64)>);

/// What a file of the collection holds.
fn read(name: &str) -> Option<Collected> {
    let file = windfall_test_data::find(&format!("nist/{name}.dat"))?;
    let text = std::fs::read_to_string(file).unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace()
            .map_while(|word| word.parse().ok())
            .collect()
    };
    let certified = text.lines().filter_map(|line| {
        let rest = line.trim().strip_prefix('B')?;
        let (_, rest) = rest.split_once(char::is_whitespace)?;
        match numbers(rest)[..] {
            [estimate, se] => Some((estimate, se)),
            _ => None,
        }
    });
    let rows = text
        .lines()
        .skip(60)
        .map(numbers)
        .filter(|row| !row.is_empty());
    Some((rows.collect(), certified.collect()))
}

#[test]
fn reference_files_of_the_collection() {
    let names = ["y", "x", "x2", "x3", "x4", "x5", "x6"];
    for (name, formula) in [
        ("Norris", "y ~ x"),
        ("Pontius", "y ~ x + x^2"),
        ("NoInt1", "y ~ 0 + x"),
        ("NoInt2", "y ~ 0 + x"),
        ("Longley", "y ~ x + x2 + x3 + x4 + x5 + x6"),
        ("Wampler1", POLYNOMIAL_5),
        ("Wampler2", POLYNOMIAL_5),
    ] {
        let Some((rows, certified)) = read(name) else {
            continue;
        };
        let columns: Vec<(&str, Vec<f64>)> = names
            .iter()
            .take(rows[0].len())
            .enumerate()
            .map(|(index, column)| (*column, rows.iter().map(|row| row[index]).collect()))
            .collect();
        check(name, &fit(formula, &table(&columns)), &certified, 9.0);
    }
}
