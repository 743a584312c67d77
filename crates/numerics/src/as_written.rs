//! Numbers as somebody wrote them: decimals, not their nearest doubles.

use crate::double_double::{DoubleDouble, two_sum};

/// The shortest decimal number that reads as this double: "1000000000000.4"
/// where the double is 1000000000000.4000244.
///
/// Of values that share many leading digits, reading them as doubles moves the last.
pub fn as_written(value: f64) -> DoubleDouble {
    decimal(value).unwrap_or_else(|| value.into())
}

/// Digits and power of ten → twice the precision; `None` where that is not exact.
fn decimal(value: f64) -> Option<DoubleDouble> {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: i64 = format!("{whole}{fraction}").parse().ok()?;
    let power = exponent.parse::<i32>().ok()? - i32::try_from(fraction.len()).ok()?;
    // digits of at most 17 places, in two doubles without rounding
    let high = digits as f64;
    let low = (digits - high as i64) as f64;
    let (high, low) = two_sum(high, low);
    let digits = DoubleDouble { high, low };
    match power {
        // a whole number is its own double up to 2⁵³
        0..=22 => Some(digits * 10f64.powi(power).into()),
        -22..0 => Some(digits / 10f64.powi(-power).into()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_decimals_as_they_were_written() {
        // 1000000000000.4 - 1000000000000 - 0.4 is zero in decimals
        let left = as_written(1000000000000.4) - as_written(1000000000000.0) - as_written(0.4);
        assert!(left.value().abs() < 1e-19, "{left:?}");
        assert!((1000000000000.4_f64 - 1000000000000.0 - 0.4).abs() > 1e-5);
        for value in [
            0.1,
            -107.8681568,
            1e-300,
            1e300,
            0.0,
            123456789.0,
            1.0 / 3.0,
        ] {
            assert_eq!(as_written(value).high, value);
        }
    }
}
