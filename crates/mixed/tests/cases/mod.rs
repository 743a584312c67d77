//! Tables, models and reference numbers of `bench/mixed_reference.R`.
#![allow(dead_code, clippy::unwrap_used)]

use nalgebra::DMatrix;
use serde_json::Value;
use windfall_mixed::fit::{MixedFit, MixedMethod, MixedOptions, fit_mixed};
use windfall_mixed::term::RandomTerm;

const TABLES: &[(&str, &str)] = &[
    ("growth", include_str!("../data/growth.csv")),
    ("apple", include_str!("../data/apple.csv")),
    ("crossed", include_str!("../data/crossed.csv")),
    ("nested", include_str!("../data/nested.csv")),
    ("level", include_str!("../data/level.csv")),
    ("linked", include_str!("../data/linked.csv")),
    ("split", include_str!("../data/split.csv")),
];

/// Everything that the R script wrote.
pub fn reference() -> Value {
    serde_json::from_str(include_str!("../data/reference.json")).unwrap()
}

/// The numbers of a list.
pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().map(|v| v.as_f64().unwrap()).collect(),
        single => vec![single.as_f64().unwrap()],
    }
}

/// The rows of a list of lists.
pub fn rows(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().unwrap().iter().map(numbers).collect()
}

fn column(table: &str, name: &str) -> Vec<String> {
    let (_, text) = TABLES.iter().find(|(known, _)| *known == table).unwrap();
    let mut lines = text.lines();
    let place = lines
        .next()
        .unwrap()
        .split(',')
        .position(|head| head == name)
        .unwrap();
    lines
        .map(|line| line.split(',').nth(place).unwrap().to_owned())
        .collect()
}

pub fn number_column(table: &str, name: &str) -> Vec<f64> {
    column(table, name)
        .iter()
        .map(|cell| cell.parse().unwrap())
        .collect()
}

/// Levels in alphabetical order, and the level of each row; `a:b` for two columns.
fn levels(table: &str, names: &str) -> (Vec<usize>, Vec<String>) {
    let parts: Vec<Vec<String>> = names.split(':').map(|name| column(table, name)).collect();
    let cells: Vec<String> = (0..parts[0].len())
        .map(|row| {
            parts
                .iter()
                .map(|part| part[row].as_str())
                .collect::<Vec<_>>()
                .join(":")
        })
        .collect();
    let mut levels = cells.clone();
    levels.sort();
    levels.dedup();
    let group = cells
        .iter()
        .map(|cell| levels.binary_search(cell).unwrap())
        .collect();
    (group, levels)
}

/// A random term: `1` for the intercept, or names of columns.
pub fn term(table: &str, columns: &[&str], groups: &str, correlated: bool) -> RandomTerm {
    let (group, group_names) = levels(table, groups);
    let values = |name: &&str| match *name {
        "1" => vec![1.0; group.len()],
        name => number_column(table, name),
    };
    RandomTerm {
        name: groups.to_owned(),
        columns: columns.iter().map(values).collect(),
        column_names: columns.iter().map(|name| (*name).to_owned()).collect(),
        groups: group_names.len(),
        group,
        group_names,
        correlated,
    }
}

/// Columns of a category whose coefficients sum to zero (R's `contr.sum`).
fn sum_contrasts(table: &str, name: &str) -> Vec<Vec<f64>> {
    let (level, names) = levels(table, name);
    let last = names.len() - 1;
    let value = |level: usize, k: usize| match level {
        level if level == last => -1.0,
        level => f64::from(u8::from(level == k)),
    };
    (0..last)
        .map(|k| level.iter().map(|level| value(*level, k)).collect())
        .collect()
}

/// A model: response, fixed columns, random terms.
pub struct Case {
    pub y: Vec<f64>,
    pub x: DMatrix<f64>,
    pub names: Vec<String>,
    pub terms: Vec<RandomTerm>,
}

/// The model of a formula of the script.
pub fn case(table: &str, formula: &str) -> Case {
    let y = number_column(table, formula.split(' ').next().unwrap());
    let mut x = vec![vec![1.0; y.len()]];
    match table {
        "nested" => x.extend(sum_contrasts(table, "side")),
        "split" => {
            let storage = sum_contrasts(table, "storage");
            let height = sum_contrasts(table, "height");
            let product = |h: &Vec<f64>| h.iter().zip(&storage[0]).map(|(a, b)| a * b).collect();
            let both: Vec<Vec<f64>> = height.iter().map(product).collect();
            x.extend(storage);
            x.extend(height);
            x.extend(both);
        }
        _ => {
            let fixed = formula
                .split_once("~ ")
                .unwrap()
                .1
                .split(" + (")
                .next()
                .unwrap();
            x.extend(fixed.split(" + ").map(|name| number_column(table, name)));
        }
    }
    let one = |groups: &str| term(table, &["1"], groups, true);
    let terms = match (table, formula) {
        ("growth", f) => vec![term(table, &["1", "day"], "subject", !f.contains("||"))],
        ("apple", _) => vec![one("fruit")],
        ("crossed", f) if f.contains("1 + level |") => {
            vec![one("fruit"), term(table, &["1", "level"], "operator", true)]
        }
        ("crossed", _) => vec![one("fruit"), one("operator")],
        ("nested", _) => vec![one("fruit:variety"), one("variety")],
        ("level", _) => vec![one("group")],
        ("linked", _) => vec![term(table, &["1", "x"], "group", true)],
        ("split", _) => vec![one("orchard:storage"), one("orchard")],
        (table, formula) => panic!("{table}: {formula}"),
    };
    Case {
        names: (0..x.len()).map(|k| format!("x{k}")).collect(),
        x: DMatrix::from_fn(y.len(), x.len(), |i, j| x[j][i]),
        y,
        terms,
    }
}

/// The model of a formula, fitted.
pub fn fitted(table: &str, formula: &str, method: MixedMethod) -> MixedFit {
    let case = case(table, formula);
    let options = MixedOptions { method };
    fit_mixed(&case.y, &case.x, &case.names, &case.terms, &options).unwrap()
}

/// The fit of a case of the reference.
pub fn fitted_case(case: &Value) -> MixedFit {
    let method = match case["method"].as_str().unwrap() {
        "reml" => MixedMethod::Reml,
        _ => MixedMethod::MaximumLikelihood,
    };
    let (table, formula) = (
        case["table"].as_str().unwrap(),
        case["formula"].as_str().unwrap(),
    );
    fitted(table, formula, method)
}

/// Fails where two lists differ by more than `tolerance` of the expected size (of
/// 1e-3 at least).
pub fn assert_near(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        let difference = (found - expected).abs() / expected.abs().max(1e-3);
        assert!(
            difference <= tolerance,
            "{what}[{k}]: {found} {expected}, off by {difference:.1e}"
        );
    }
}
