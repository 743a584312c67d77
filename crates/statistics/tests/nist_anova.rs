//! NIST Statistical Reference Datasets: one-way analysis of variance and
//! univariate summaries against their certified values.
//!
//! The files are not part of windfall; `WINDFALL_DATA` names the folder with
//! `nist/` in it. Every file of both kinds that is there is tried.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_statistics::accurate_sum::{mean, standard_deviation};
use windfall_statistics::compare::one_way_anova::one_way_anova;

/// The file's lines, or `None` where it is not there.
fn nist(name: &str) -> Option<Vec<String>> {
    let file = windfall_test_data::find(&format!("nist/{name}.dat"))?;
    let bytes = std::fs::read(file).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    Some(text.lines().map(str::to_owned).collect())
}

/// Numbers in a line.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// Number of digits that agree.
fn digits(found: f64, certified: f64) -> f64 {
    if found == certified {
        return 16.0;
    }
    let error = match certified == 0.0 {
        true => found.abs(),
        false => (found / certified - 1.0).abs(),
    };
    -error.log10()
}

/// The data after the line that starts with "Data:" for the last time.
fn data_rows(lines: &[String]) -> Vec<Vec<f64>> {
    let start = lines.iter().rposition(|line| line.starts_with("Data:"));
    lines[start.unwrap() + 1..]
        .iter()
        .map(|line| numbers(line))
        .filter(|row| !row.is_empty())
        .collect()
}

/// Sets of analysis of variance. Doubles alone hold four digits of the last three
/// (thirteen leading digits in common: a step of 0.1 is 820 units in the last
/// place); the decimals that were written hold all.
const ANOVA: [&str; 11] = [
    "SiRstv", "SmLs01", "SmLs02", "SmLs03", "AtmWtAg", "SmLs04", "SmLs05", "SmLs06", "SmLs07",
    "SmLs08", "SmLs09",
];

/// Digits to reach in every set.
const ANOVA_DIGITS: f64 = 12.5;

#[test]
fn reference_nist_analysis_of_variance() {
    for name in ANOVA {
        let Some(lines) = nist(name) else { continue };
        let row = |start: &str| {
            let line = lines.iter().find(|line| line.starts_with(start)).unwrap();
            numbers(line)
        };
        let between = row("Between ");
        let within = row("Within ");
        let after = |text: &str| {
            let place = lines.iter().position(|line| line.contains(text)).unwrap();
            let line = lines[place..].iter().find(|line| !numbers(line).is_empty());
            numbers(line.unwrap())[0]
        };
        let mut groups: Vec<Vec<f64>> = Vec::new();
        for row in data_rows(&lines) {
            let group = row[0] as usize;
            groups.resize(groups.len().max(group), Vec::new());
            groups[group - 1].push(row[1]);
        }
        let found = one_way_anova(&groups).unwrap();
        assert_eq!(found.between_df, between[0]);
        assert_eq!(found.within_df, within[0]);
        let reached = [
            digits(found.between_ss, between[1]),
            digits(found.within_ss, within[1]),
            digits(found.f, between[3]),
            digits(found.eta_squared, after("Certified R-Squared")),
            digits(found.residual_sd, after("Standard Deviation")),
        ];
        println!("{name}: digits of SS between, SS within, F, R², SD: {reached:.1?}");
        let enough = reached.iter().all(|digits| *digits >= ANOVA_DIGITS);
        assert!(enough, "{name}: {reached:?}");
    }
}

/// Sets of univariate summaries.
const UNIVARIATE: [&str; 8] = [
    "Lottery", "Lew", "Mavro", "Michelso", "NumAcc1", "NumAcc2", "NumAcc3", "NumAcc4",
];

/// Digits to reach in every set.
const UNIVARIATE_DIGITS: f64 = 13.0;

#[test]
fn reference_nist_univariate() {
    for name in UNIVARIATE {
        let Some(lines) = nist(name) else { continue };
        let certified = |text: &str| {
            let line = lines.iter().find(|line| line.starts_with(text)).unwrap();
            let (_, value) = line.rsplit_once(':').unwrap();
            numbers(value)[0]
        };
        let values: Vec<f64> = data_rows(&lines).iter().map(|row| row[0]).collect();
        assert_eq!(values.len() as f64, certified("Number of Observations"));
        let reached = [
            digits(mean(&values).value(), certified("Sample Mean")),
            digits(standard_deviation(&values), certified("Sample Standard")),
        ];
        println!("{name}: digits of mean, SD: {reached:.1?}");
        let enough = reached.iter().all(|digits| *digits >= UNIVARIATE_DIGITS);
        assert!(enough, "{name}: {reached:?}");
    }
}
