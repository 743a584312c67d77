//! Dimensions and units as numbers.

use crate::unit::symbol::BASE_UNITS;
use std::fmt;

/// Largest difference of exponents that still counts as the same dimension:
/// exponents of fitted power laws are written with a few digits only.
pub const EXPONENT_TOLERANCE: f64 = 1e-6;

/// Exponents of the base units of
/// [`BASE_UNITS`]: m, kg, s, A, K, rad, count, line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dimension {
    /// One exponent per base unit; 1.
    pub exponents: [f64; 8],
}

impl Dimension {
    /// Whether both are the same within [`EXPONENT_TOLERANCE`].
    pub fn matches(&self, other: &Self) -> bool {
        self.exponents
            .iter()
            .zip(&other.exponents)
            .all(|(a, b)| (a - b).abs() <= EXPONENT_TOLERANCE)
    }
}

/// SI base units with powers: `m^-0.5 kg s^-1`; `1` when there is none.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts: Vec<String> = BASE_UNITS
            .iter()
            .zip(&self.exponents)
            .filter(|(_, exponent)| exponent.abs() > EXPONENT_TOLERANCE)
            .map(|(unit, &exponent)| match exponent {
                1.0 => (*unit).to_string(),
                _ => format!("{unit}^{}", exponent_text(exponent)),
            })
            .collect();
        match parts.is_empty() {
            true => f.write_str("1"),
            false => f.write_str(&parts.join(" ")),
        }
    }
}

/// An exponent without the noise of its last digits: `2.91`, not
/// `2.9099999999999997`.
pub fn exponent_text(exponent: f64) -> String {
    format!("{}", (exponent * 1e9).round() / 1e9)
}

/// A unit: `multiply / divide` SI units of its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Numerator of its size in SI units.
    pub multiply: f64,
    /// Denominator of its size in SI units.
    pub divide: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

impl Unit {
    /// The number one.
    pub const ONE: Self = Self {
        multiply: 1.0,
        divide: 1.0,
        dimension: Dimension {
            exponents: [0.0; 8],
        },
    };

    /// SI value of `value` of these units.
    pub fn si_from(&self, value: f64) -> f64 {
        value * self.multiply / self.divide
    }

    /// This unit times `other` to the given power.
    pub(crate) fn product(self, other: Self, power: f64) -> Self {
        let other = other.raised(power);
        let (multiply, divide) =
            reduced(self.multiply * other.multiply, self.divide * other.divide);
        let mut dimension = self.dimension;
        for (sum, term) in dimension
            .exponents
            .iter_mut()
            .zip(other.dimension.exponents)
        {
            *sum += term;
        }
        Self {
            multiply,
            divide,
            dimension,
        }
    }

    fn raised(self, power: f64) -> Self {
        let (multiply, divide) = match power < 0.0 {
            true => (self.divide, self.multiply),
            false => (self.multiply, self.divide),
        };
        Self {
            multiply: multiply.powf(power.abs()),
            divide: divide.powf(power.abs()),
            dimension: Dimension {
                exponents: self.dimension.exponents.map(|exponent| exponent * power),
            },
        }
    }
}

/// The same ratio with a common factor removed, so that mm/ms is exactly m/s.
pub(crate) fn reduced(multiply: f64, divide: f64) -> (f64, f64) {
    if multiply % divide == 0.0 {
        (multiply / divide, 1.0)
    } else if divide % multiply == 0.0 {
        (1.0, divide / multiply)
    } else {
        (multiply, divide)
    }
}
