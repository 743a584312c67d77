//! Reading a data set of NIST StRD for nonlinear regression.

use std::path::{Path, PathBuf};

/// One parameter as its file gives it.
pub struct Parameter {
    /// Start 1 and start 2.
    pub starts: [f64; 2],
    /// Certified value.
    pub value: f64,
    /// Certified standard deviation.
    pub sd: f64,
}

/// One data set.
pub struct DataSet {
    /// b1, b2, …
    pub parameters: Vec<Parameter>,
    /// Certified residual sum of squares.
    pub sum_of_squares: f64,
    /// Response, then the predictors, one row per observation.
    pub rows: Vec<Vec<f64>>,
}

/// Where the `.dat` files are, or would be.
pub fn folder() -> PathBuf {
    windfall_test_data::find("nist").unwrap_or_default()
}

/// Names of the sets for nonlinear regression that the folder holds, sorted.
pub fn names() -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder()) else {
        return Vec::new();
    };
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|end| end == "dat"))
        .filter(|path| read_text(path).contains("Nonlinear Least Squares Regression"))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_string()))
        .collect();
    names.sort();
    names
}

/// The set of that name, or `None` where there is no such file.
pub fn read_set(name: &str) -> Option<DataSet> {
    let path = folder().join(format!("{name}.dat"));
    path.is_file().then(|| parse(&read_text(&path)))
}

fn read_text(path: &Path) -> String {
    String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned()
}

fn parse(text: &str) -> DataSet {
    let lines: Vec<&str> = text.lines().collect();
    let parameters: Vec<Parameter> = lines.iter().filter_map(|line| parameter(line)).collect();
    let sum_of_squares = lines
        .iter()
        .find_map(|line| line.trim().strip_prefix("Residual Sum of Squares:"))
        .map(|number| number.trim().parse().unwrap())
        .unwrap();
    // "Data              (lines 61 to 274)", counted from 1.
    let (first, last) = lines.iter().take(10).find_map(|line| range(line)).unwrap();
    let rows: Vec<Vec<f64>> = lines[first - 1..last].iter().map(|l| numbers(l)).collect();
    let count = lines
        .iter()
        .find_map(|line| line.trim().strip_prefix("Number of Observations:"))
        .map(|number| number.trim().parse::<usize>().unwrap())
        .unwrap();
    assert_eq!(rows.len(), count);
    DataSet {
        parameters,
        sum_of_squares,
        rows,
    }
}

/// `b1 =   0.1         0.15          1.9027818370E-01  2.1938557035E-02`
fn parameter(line: &str) -> Option<Parameter> {
    let (name, numbers_text) = line.trim().strip_prefix('b')?.split_once('=')?;
    name.trim().parse::<usize>().ok()?;
    let [first, second, value, sd] = numbers(numbers_text).try_into().unwrap();
    Some(Parameter {
        starts: [first, second],
        value,
        sd,
    })
}

fn range(line: &str) -> Option<(usize, usize)> {
    let inside = line.trim().strip_prefix("Data ")?.trim();
    let inside = inside.strip_prefix("(lines")?.strip_suffix(')')?;
    let (first, last) = inside.split_once("to")?;
    Some((first.trim().parse().ok()?, last.trim().parse().ok()?))
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace()
        .map(|number| number.parse().unwrap())
        .collect()
}
