//! Ranges of quantities: "0 … 50 N s/m", "> 0 N", "at most 6".

use crate::unit::error::UnitError;
use crate::unit::quantity::parse_as;
use crate::unit::uncertain::number_and_unit;

/// What stands between the ends of a range.
const BETWEEN: [&str; 4] = ["…", "...", "..", " to "];
/// What stands before the only end: the lower one, the upper one.
const LOWER: [&str; 4] = ["≥", ">=", ">", "at least"];
const UPPER: [&str; 4] = ["≤", "<=", "<", "at most"];

/// The ends of a range in SI units; infinite where there is none.
///
/// The unit stands behind both ends or behind the last.
///
/// # Example
/// ```
/// use windfall_numerics::unit::range::parse_range;
/// assert_eq!(parse_range("0 … 50 N s/mm", "N s/m")?, (0.0, 50e3));
/// assert_eq!(parse_range(">= 1 kN", "N")?, (1e3, f64::INFINITY));
/// # Ok::<(), windfall_numerics::unit::quantity::UnitError>(())
/// ```
///
/// # Errors
/// An end is no quantity of the unit, or the ends are not in order.
pub fn parse_range(text: &str, unit: &str) -> Result<(f64, f64), UnitError> {
    let text = text.trim();
    let after = |signs: &[&str]| {
        let mut signs = signs.iter();
        signs
            .find_map(|sign| text.strip_prefix(sign))
            .map(str::trim)
    };
    if let Some(end) = after(&LOWER) {
        return Ok((parse_as(end, unit)?, f64::INFINITY));
    }
    if let Some(end) = after(&UPPER) {
        return Ok((f64::NEG_INFINITY, parse_as(end, unit)?));
    }
    let wrong = |problem| UnitError::BadRange {
        text: text.into(),
        problem,
    };
    let parts = BETWEEN.iter().find_map(|sign| text.split_once(sign));
    let Some((low, high)) = parts.map(|(low, high)| (low.trim(), high.trim())) else {
        return Err(wrong("one end alone has its sign before it, as in \"> 0\""));
    };
    let ((_, of_low), (_, of_high)) = (number_and_unit(low), number_and_unit(high));
    let low = match of_low.is_empty() && !of_high.is_empty() {
        true => parse_as(&format!("{low} {of_high}"), unit)?,
        false => parse_as(low, unit)?,
    };
    let high = parse_as(high, unit)?;
    match low < high {
        true => Ok((low, high)),
        false => Err(wrong("its lower end is not below its upper end")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_ends_in_si() {
        let inf = f64::INFINITY;
        for (text, unit, ends) in [
            ("0 … 50 N s/m", "N s/m", (0.0, 50.0)),
            ("1 kN/m...2 kN/m", "N/m", (1e3, 2e3)),
            ("-1 mm .. 1 mm", "m", (-1e-3, 1e-3)),
            ("1.2 to 1.8", "1", (1.2, 1.8)),
            ("> 0 N", "N", (0.0, inf)),
            ("at most 6", "1", (-inf, 6.0)),
            ("≤ 2 ms", "s", (-inf, 2e-3)),
        ] {
            assert_eq!(parse_range(text, unit).unwrap(), ends, "{text}");
        }
    }

    #[test]
    fn rejects_ranges_that_are_none() {
        for (text, said) in [
            ("50 N", "\"> 0\""),
            ("50 … 0 N", "lower end is not below"),
            ("1 … 1 N", "lower end is not below"),
            ("0 m … 50 N", "length"),
            ("… 50 N", "number"),
            ("0 … 50 ± 1 N", "takes no ±"),
            ("nan … 1 N", "number"),
        ] {
            let error = parse_range(text, "N").unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
