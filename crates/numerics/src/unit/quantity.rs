//! Physical units at the boundary: text such as `"0.868 N/mm^1.91"` becomes an
//! SI value with a checked dimension. Inside windfall all numbers are SI.
//!
//! Syntax of a unit: symbols with optional SI prefix, joined by a space, `*` or
//! `·` (product) and `/` (quotient), with powers `^-1.5`, `^(1/2)`, `²` or
//! plain digits (`s-1`). Nothing is multiplied after a `/`: write `N/(m s)`.
//! `g` is the gram; standard gravity is `g0`.

pub use crate::unit::dimension::{Dimension, EXPONENT_TOLERANCE, Unit, exponent_text};
pub use crate::unit::error::UnitError;
use crate::unit::symbol::{CELSIUS, CELSIUS_ZERO};
pub use crate::unit::syntax::parse_unit;
use crate::unit::syntax::parse_unit_at;

/// A number with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value; SI.
    pub value: f64,
    /// Dimension of the value.
    pub dimension: Dimension,
}

/// Reads a number with its unit; a number alone has no dimension.
///
/// `degC` is accepted as the whole unit and gives the absolute temperature.
///
/// # Errors
/// [`UnitError`] when the number or the unit cannot be read.
///
/// # Example
/// ```
/// use windfall_numerics::unit::quantity::parse_quantity;
/// assert_eq!(parse_quantity("4.8 g")?.value, 0.0048);
/// # Ok::<(), windfall_numerics::unit::quantity::UnitError>(())
/// ```
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    let (number, unit_start) = parse_number(text)?;
    let unit_text = text[unit_start..].trim();
    if unit_text.is_empty() {
        return Ok(Quantity {
            value: number,
            dimension: Dimension::default(),
        });
    }
    let quantity = if CELSIUS.contains(&unit_text) {
        Quantity {
            value: number + CELSIUS_ZERO,
            dimension: parse_unit("K")?.dimension,
        }
    } else {
        let unit = parse_unit_at(text, unit_start)?;
        Quantity {
            value: unit.si_from(number),
            dimension: unit.dimension,
        }
    };
    match quantity.value.abs() <= LARGEST {
        true => Ok(quantity),
        false => Err(UnitError::NotFinite { text: text.into() }),
    }
}

/// The largest number of SI units that is read: what is beyond it is a slip, and its square
/// would be infinite.
pub const LARGEST: f64 = 1e100;

/// Reads a quantity of the dimension of `unit` and returns its SI value.
///
/// A number alone is taken as SI where `unit` is an SI unit without a factor;
/// where it has one (`"counts/rev"`, `"mm"`), the unit must be written.
///
/// # Errors
/// [`UnitError`] when the text cannot be read or has another dimension, and
/// when `unit` itself cannot be read.
///
/// # Example
/// ```
/// use windfall_numerics::unit::quantity::parse_as;
/// assert_eq!(parse_as("8 mm", "m")?, 0.008);
/// assert_eq!(parse_as("753599", "N/m^1.5")?, 753599.0);
/// let error = parse_as("8 mm", "N").unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "\"8 mm\" is a length (m), but a force in N was expected: write it like \"1 N\""
/// );
/// # Ok::<(), windfall_numerics::unit::quantity::UnitError>(())
/// ```
pub fn parse_as(text: &str, unit: &str) -> Result<f64, UnitError> {
    if text.contains('±') {
        let text = text.trim().into();
        return Err(UnitError::NoUncertainty { text });
    }
    let expected = parse_unit(unit)?;
    let (_, unit_start) = parse_number(text)?;
    let quantity = parse_quantity(text)?;
    if quantity.dimension.matches(&expected.dimension) && !text[unit_start..].trim().is_empty() {
        return Ok(quantity.value);
    }
    // A number alone.
    if text[unit_start..].trim().is_empty() {
        return match expected.multiply == 1.0 && expected.divide == 1.0 {
            true => Ok(quantity.value),
            false => Err(UnitError::MissingUnit {
                text: text.trim().into(),
                expected: unit.into(),
            }),
        };
    }
    Err(UnitError::WrongDimension {
        text: text.trim().into(),
        found: format!(
            "{} ({})",
            quantity_name(&quantity.dimension),
            quantity.dimension
        ),
        expected: match unit {
            "1" => quantity_name(&expected.dimension).into(),
            _ => format!("{} in {unit}", quantity_name(&expected.dimension)),
        },
        example: match unit {
            "1" => "1".into(),
            _ => format!("1 {unit}"),
        },
        gravity: with_standard_gravity(text, unit_start, &expected.dimension),
    })
}

/// The number at the start of the text and the byte offset behind it.
fn parse_number(text: &str) -> Result<(f64, usize), UnitError> {
    let bytes = text.as_bytes();
    let start = text.len() - text.trim_start().len();
    let skip_digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let skip_sign = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let mut end = skip_digits(skip_sign(start));
    let comma = bytes.get(end) == Some(&b',') && skip_digits(end + 1) > end + 1;
    if comma {
        return Err(UnitError::DecimalComma {
            text: text.trim().into(),
            suggestion: text.trim().replacen(',', ".", 1),
        });
    }
    if bytes.get(end) == Some(&b'.') {
        end = skip_digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let digits = skip_sign(end + 1);
        if skip_digits(digits) > digits {
            end = skip_digits(digits);
        }
    }
    let number: f64 = text[start..end]
        .parse()
        .map_err(|_| UnitError::MissingNumber {
            text: text.trim().into(),
        })?;
    match number.abs() <= LARGEST {
        true => Ok((number, end)),
        false => Err(UnitError::NotFinite {
            text: text.trim().into(),
        }),
    }
}

/// The text with `g0` in place of `g`, if that has the dimension expected.
fn with_standard_gravity(text: &str, unit_start: usize, expected: &Dimension) -> Option<String> {
    let mut replaced = text[..unit_start].to_string();
    let mut previous = ' ';
    let mut rest = text[unit_start..].chars().peekable();
    while let Some(c) = rest.next() {
        replaced.push(c);
        let alone = !previous.is_alphabetic() && !rest.peek().is_some_and(|n| n.is_alphanumeric());
        if c == 'g' && alone {
            replaced.push('0');
        }
        previous = c;
    }
    let quantity = parse_quantity(&replaced).ok()?;
    quantity
        .dimension
        .matches(expected)
        .then(|| replaced.trim().to_string())
}

/// Name of the physical quantity of a dimension, with its article.
fn quantity_name(dimension: &Dimension) -> &'static str {
    const NAMES: [(&str, &str); 22] = [
        ("1", "a plain number"),
        ("m", "a length"),
        ("m^3", "a volume"),
        ("kg", "a mass"),
        ("s", "a time"),
        ("Hz", "a frequency"),
        ("N", "a force"),
        ("J", "an energy"),
        ("Pa", "a pressure or modulus"),
        ("N s", "an impulse"),
        ("m/s", "a velocity"),
        ("m/s^2", "an acceleration"),
        ("kg m^2", "a moment of inertia"),
        ("V", "a voltage"),
        ("A", "a current"),
        ("K", "a temperature"),
        ("rad", "an angle"),
        ("rad/s", "an angular velocity"),
        ("V/N", "a force sensitivity"),
        ("V s^2/m", "an acceleration sensitivity"),
        ("count", "a number of counts"),
        ("count/rad", "an encoder resolution"),
    ];
    let same = |unit: &str| parse_unit(unit).is_ok_and(|unit| unit.dimension.matches(dimension));
    if let Some((_, name)) = NAMES.iter().find(|(unit, _)| same(unit)) {
        return name;
    }
    // Stiffness N/m^n and damping N s/m^n of any exponent.
    let [_, mass, time, others @ ..] = dimension.exponents;
    match (mass, time, others) {
        (1.0, -2.0, [0.0, 0.0, 0.0, 0.0, 0.0]) => "a stiffness",
        (1.0, -1.0, [0.0, 0.0, 0.0, 0.0, 0.0]) => "a damping",
        _ => "a quantity",
    }
}
