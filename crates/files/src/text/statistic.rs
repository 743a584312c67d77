//! Statistics for people: probabilities, numbers that may not exist, degrees of
//! freedom.

use crate::text::number::{p_value, plain};

pub use windfall_numerics::written::probability;

/// A number, or a dash where there is none.
pub fn number(value: f64) -> String {
    match value.is_finite() {
        true => plain(value),
        false => "-".to_owned(),
    }
}

/// Degrees of freedom: whole where they are.
pub fn freedom(df: f64) -> String {
    match df.fract() == 0.0 {
        true => df.to_string(),
        false => plain(df),
    }
}

/// A chi-square with its degrees of freedom and, where it is known, its probability:
/// "χ²(4) = 12.30, p = 0.015".
pub fn chi_square(statistic: f64, df: f64, p: Option<f64>) -> String {
    let told = p.map_or_else(String::new, |p| format!(", {}", p_value(p)));
    format!("χ²({}) = {}{told}", freedom(df), number(statistic))
}
