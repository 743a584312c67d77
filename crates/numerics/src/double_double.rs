//! Numbers of twice the precision of a double.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// An unevaluated sum of two doubles: about 31 digits (Dekker, T. J. (1971),
/// Numerische Mathematik 18, 224-242; products by fused multiply-add).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The nearest double.
    pub high: f64,
    /// What is left, at most half a unit in the last place of `high`.
    pub low: f64,
}

/// The sum of two doubles and its rounding error, exactly (Knuth).
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The product of two doubles and its rounding error, exactly.
#[inline]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

#[inline]
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

impl DoubleDouble {
    /// Zero.
    pub const ZERO: Self = Self {
        high: 0.0,
        low: 0.0,
    };
    /// One.
    pub const ONE: Self = Self {
        high: 1.0,
        low: 0.0,
    };

    /// The nearest double.
    #[inline]
    pub fn value(self) -> f64 {
        self.high
    }

    /// The square root; zero of what is not positive.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        // One step of Newton's method from the root of the double.
        let root = Self::from(self.high.sqrt());
        root + (self - root * root) / Self::from(2.0 * root.high)
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// A whole power.
    #[must_use]
    pub fn powi(self, power: u32) -> Self {
        let (mut result, mut base, mut power) = (Self::ONE, self, power);
        while power > 0 {
            if power & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            power >>= 1;
        }
        result
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, rest) = two_sum(self.low, other.low);
        let first = quick_two_sum(high, error + low);
        quick_two_sum(first.high, first.low + rest)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (high, error) = two_product(self.high, other.high);
        quick_two_sum(
            high,
            error + (self.high * other.low + self.low * other.high),
        )
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        quick_two_sum(first, second) + Self::from(rest.high / other.high)
    }
}

impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for DoubleDouble {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Sum for DoubleDouble {
    fn sum<I: Iterator<Item = Self>>(values: I) -> Self {
        values.fold(Self::ZERO, |sum, value| sum + value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/3, √2 and 1.1¹⁰ to 32 digits (arbitrary-precision arithmetic): the high
    /// part is the nearest double, the low part what that leaves.
    #[test]
    fn reference_thirty_digits() {
        let third = DoubleDouble::ONE / DoubleDouble::from(3.0);
        assert_eq!(third.high, 1.0 / 3.0);
        assert!((third.low - 1.850371707708594e-17).abs() < 1e-32);
        let root = DoubleDouble::from(2.0).sqrt();
        assert!((root.low - -9.667293313452913e-17).abs() < 1e-31);
        let back = root * root - DoubleDouble::from(2.0);
        assert!(back.high.abs() < 1e-31);
    }

    #[test]
    fn closed_form_cancellation_loses_nothing() {
        let sum: DoubleDouble = [1e16, 1.0, -1e16].map(DoubleDouble::from).into_iter().sum();
        assert_eq!(sum.value(), 1.0);
        let (product, error) = two_product(0.1, 0.1);
        assert!(error != 0.0 && (product + error) == product);
        assert_eq!(DoubleDouble::from(3.0).powi(5).value(), 243.0);
    }
}
