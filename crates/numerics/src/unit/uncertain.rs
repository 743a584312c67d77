//! Quantities with their standard uncertainty: "0.01435 ± 0.0002 kg m^2".

use crate::unit::error::UnitError;
use crate::unit::quantity::parse_as;

/// What stands between a value and its uncertainty.
const SIGNS: [&str; 3] = ["±", "+/-", "+-"];

/// A value and its standard uncertainty, where the text has one, in SI units.
///
/// The unit stands behind both numbers or behind the last; the uncertainty may be in % of
/// the value.
///
/// # Example
/// ```
/// use windfall_numerics::unit::uncertain::parse_uncertain;
/// assert_eq!(parse_uncertain("505 ± 2 mm", "m")?, (0.505, Some(0.002)));
/// assert_eq!(parse_uncertain("0.5 kg ± 1 %", "kg")?, (0.5, Some(0.005)));
/// assert_eq!(parse_uncertain("0.5 kg", "kg")?, (0.5, None));
/// # Ok::<(), windfall_numerics::unit::quantity::UnitError>(())
/// ```
///
/// # Errors
/// Either is no quantity of the unit, or the uncertainty is negative or without a unit that
/// the value has.
pub fn parse_uncertain(text: &str, unit: &str) -> Result<(f64, Option<f64>), UnitError> {
    let split = |sign: &&str| text.split_once(*sign);
    let Some((value, sd)) = SIGNS.iter().find_map(split) else {
        return Ok((parse_as(text, unit)?, None));
    };
    let sd = sd.replace('−', "-");
    let (value, sd) = (value.trim(), sd.trim());
    let wrong = |problem| UnitError::BadUncertainty {
        text: text.trim().into(),
        problem,
    };
    let (_, of_value) = number_and_unit(value);
    let (number, of_sd) = number_and_unit(sd);
    if number.is_empty() {
        return Err(wrong("no number stands there"));
    }
    if SIGNS.iter().any(|sign| sd.contains(sign)) {
        return Err(wrong("there are two"));
    }
    if number.starts_with('-') {
        return Err(wrong("it is negative"));
    }
    let of_percent = of_sd.strip_prefix('%').map(str::trim);
    let common = of_percent.unwrap_or(of_sd);
    if common.is_empty() && of_percent.is_none() && !of_value.is_empty() {
        return Err(wrong("it has no unit"));
    }
    let value = match of_value.is_empty() && !common.is_empty() {
        true => parse_as(&format!("{value} {common}"), unit)?,
        false => parse_as(value, unit)?,
    };
    let sd = match of_percent {
        Some(_) => value.abs() * parse_as(number, "1")? / 100.0,
        None => parse_as(sd, unit)?,
    };
    Ok((value, Some(sd)))
}

/// A text cut behind its number.
pub(crate) fn number_and_unit(text: &str) -> (&str, &str) {
    let of_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let end = text.find(|c| !of_number(c)).unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    (number.trim(), unit.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_values_with_their_uncertainties() {
        for (text, unit, value, sd) in [
            ("0.01435 ± 0.0002 kg m^2", "kg m^2", 0.01435, 0.0002),
            ("505 mm ± 0.2 cm", "m", 0.505, 0.002),
            ("505 mm +/- 1 %", "m", 0.505, 0.00505),
            ("20 us +- 2 us", "s", 20e-6, 2e-6),
            ("0.01435 ± 1 % kg m^2", "kg m^2", 0.01435, 0.0001435),
            ("0.5 ± 1 %", "kg", 0.5, 0.005),
            ("0.5 ± 0.01", "kg", 0.5, 0.01),
            ("1e-3 ± 1e-5 m", "m", 1e-3, 1e-5),
        ] {
            let (found, of) = parse_uncertain(text, unit).unwrap();
            assert!((found / value - 1.0).abs() < 1e-12, "{text}: {found}");
            let of = of.unwrap();
            assert!((of / sd - 1.0).abs() < 1e-12, "{text}: {of}");
        }
    }

    #[test]
    fn rejects_uncertainties_without_unit_or_below_zero() {
        for (text, said) in [
            ("0.5 kg ± 0.1", "has no unit"),
            ("0.5 ± -0.1 kg", "is negative"),
            ("0.5 kg ± 0.1 m", "is a length"),
            ("0.5 kg ±", "no number stands there"),
            ("0.5 ± −0.1 kg", "is negative"),
            ("0.5 ± 0.1 ± 0.1 kg", "there are two"),
            ("0.5 ± nan kg", "no number stands there"),
            ("± 0.1 kg", "number"),
        ] {
            let error = parse_uncertain(text, "kg").unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
        // Where only a value is asked for.
        let error = parse_as("0.5 ± 0.1 kg", "kg").unwrap_err().to_string();
        assert!(error.contains("takes no ±"), "{error}");
    }
}
