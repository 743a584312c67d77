//! Statistics for people: probabilities, numbers that may not exist, degrees of
//! freedom.

use crate::text::number::plain;

/// A probability as people read it.
pub fn probability(p: f64) -> String {
    match p {
        p if p.is_nan() => "-".to_owned(),
        p if p < 1e-4 => format!("{p:.1e}"),
        p => format!("{p:.4}"),
    }
}

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
