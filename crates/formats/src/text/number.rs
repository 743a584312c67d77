//! Parses numbers, correctly rounded, with any decimal and thousands marks.

use crate::text::power::nearest_double;
use std::borrow::Cow;

/// Powers of ten that are exact doubles.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// All integers up to this one are exact doubles.
const EXACT_INTEGER: u64 = 1 << 53;

/// Number of digits that always fits into 64 bits.
const MOST_DIGITS: usize = 19;

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// Blank.
    Blank,
    /// A finite number.
    Number(f64),
    /// Something else.
    Other,
}

/// Decimal and thousands marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marks {
    /// Decimal mark: "." or ",".
    pub decimal: u8,
    /// Thousands separator.
    pub thousands: Option<char>,
}

impl Marks {
    /// A decimal mark, and no thousands separator.
    pub const fn decimal(decimal: u8) -> Self {
        Self {
            decimal,
            thousands: None,
        }
    }
}

/// Parses a number at the start of `bytes`; returns it with its length in bytes.
///
/// Accepts digits, one decimal mark and an exponent, without blanks; `None` for
/// anything else and for numbers that overflow.
///
/// # Source
/// W. Clinger (1990), "How to read floating point numbers accurately": a product
/// or quotient of two exact doubles is correctly rounded. Other numbers take
/// slower paths.
#[inline]
pub fn leading_number(bytes: &[u8], decimal: u8) -> Option<(f64, usize)> {
    // Branch-free, as random signs would be mispredicted half of the time.
    let first = bytes.first().copied().unwrap_or(0);
    let negative = first == b'-';
    let mut at = usize::from(negative | (first == b'+'));
    let start = at;
    let mut mantissa = 0_u64;
    // Most numbers have one digit before the mark and several after it.
    at = match bytes.get(at..at + 2) {
        Some([digit @ b'0'..=b'9', mark]) if *mark == decimal => {
            mantissa = u64::from(digit - b'0');
            at + 1
        }
        _ => digits(bytes, at, &mut mantissa),
    };
    let mut count = at - start;
    let mut power = 0_i32;
    if bytes.get(at) == Some(&decimal) {
        let fraction = at + 1;
        at = digits(bytes, fraction, &mut mantissa);
        count += at - fraction;
        power = fraction as i32 - at as i32;
    }
    if count == 0 {
        return None;
    }
    if let Some(b'e' | b'E' | b'd' | b'D') = bytes.get(at) {
        let (exponent, end) = exponent(bytes, at + 1)?;
        power = power.saturating_add(exponent);
        at = end;
    }
    let exact = count <= MOST_DIGITS && mantissa <= EXACT_INTEGER && power.unsigned_abs() <= 22;
    let size = match exact {
        true if power < 0 => mantissa as f64 / EXACT_POWERS[power.unsigned_abs() as usize],
        true => mantissa as f64 * EXACT_POWERS[power as usize],
        false => match count <= MOST_DIGITS + zeros_before(&bytes[start..at], decimal, count) {
            true => nearest_double(mantissa, power),
            false => None,
        }
        .map_or_else(|| slow_number(&bytes[start..at], decimal), Some)?,
    };
    let sign = u64::from(negative) << 63;
    Some((f64::from_bits(size.to_bits() | sign), at))
}

/// Leading zeros, which take no space in the mantissa; counted only if they matter.
fn zeros_before(bytes: &[u8], decimal: u8, count: usize) -> usize {
    if count <= MOST_DIGITS {
        return 0;
    }
    let leading = bytes.iter().take_while(|b| **b == b'0' || **b == decimal);
    leading.filter(|b| **b == b'0').count()
}

/// Appends the digits from `at` to `mantissa` (at most 19 count); returns where they end.
#[inline]
fn digits(bytes: &[u8], mut at: usize, mantissa: &mut u64) -> usize {
    // Up to eight digits at a time, shifted up so that zeros precede them.
    loop {
        let left = bytes.get(at..).unwrap_or_default();
        let word = left
            .first_chunk()
            .map_or_else(|| short_word(left), |eight| u64::from_le_bytes(*eight));
        let count = leading_digits(word);
        if count == 0 {
            return at;
        }
        let shifted = word << (64 - 8 * count);
        let power = INTEGER_POWERS[count as usize];
        *mantissa = mantissa
            .wrapping_mul(power)
            .wrapping_add(eight_digits(shifted));
        at += count as usize;
        if count < 8 {
            return at;
        }
    }
}

/// Fewer than eight bytes, the first one lowest, with zeros above them.
#[inline]
fn short_word(bytes: &[u8]) -> u64 {
    // Reads that overlap need no loop.
    if let (Some(first), Some(last)) = (bytes.first_chunk(), bytes.last_chunk()) {
        let last = u64::from(u32::from_le_bytes(*last)) << (8 * (bytes.len() - 4));
        return u64::from(u32::from_le_bytes(*first)) | last;
    }
    let byte = |place: usize| u64::from(bytes[place]) << (8 * place);
    match bytes.len() {
        0 => 0,
        length => byte(0) | byte(length / 2) | byte(length - 1),
    }
}

/// Powers of ten as integers.
const INTEGER_POWERS: [u64; 9] = [
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000,
];

/// Length of the run of digits at the low end of eight bytes.
#[inline]
fn leading_digits(word: u64) -> u32 {
    // A byte is a digit if its high nibble is 3 both before and after adding 6.
    let high = word & 0xf0f0_f0f0_f0f0_f0f0;
    let over = (word & 0x7f7f_7f7f_7f7f_7f7f).wrapping_add(0x0606_0606_0606_0606);
    let other =
        (high ^ 0x3030_3030_3030_3030) | ((over & 0xf0f0_f0f0_f0f0_f0f0) ^ 0x3030_3030_3030_3030);
    other.trailing_zeros() / 8
}

/// The value of eight digits, the first in the lowest byte.
#[inline]
fn eight_digits(word: u64) -> u64 {
    let ones = word & 0x0f0f_0f0f_0f0f_0f0f;
    let pairs = (ones.wrapping_mul(10).wrapping_add(ones >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100).wrapping_add(pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xffff_ffff
}

/// Parses an exponent at `at`; returns it, clamped, and its end.
fn exponent(bytes: &[u8], mut at: usize) -> Option<(i32, usize)> {
    let sign = bytes.get(at);
    let negative = sign == Some(&b'-');
    at += usize::from(matches!(sign, Some(b'-' | b'+')));
    let mut value = 0;
    let end = digits(bytes, at, &mut value);
    let value = match end - at {
        0 => return None,
        1..=9 => value as i32,
        // Too large, or zeros, which the standard library sorts out.
        _ => 99_999,
    };
    Some((if negative { -value } else { value }, end))
}

/// Parses with the standard library; `None` if not finite.
fn slow_number(bytes: &[u8], decimal: u8) -> Option<f64> {
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    if decimal == b'.'
        && let Ok(text) = std::str::from_utf8(bytes)
        && let Ok(value) = text.parse()
    {
        return finite(value);
    }
    let text: String = bytes
        .iter()
        .map(|&byte| match byte {
            b if b == decimal => '.',
            b'd' | b'D' => 'e',
            b => char::from(b),
        })
        .collect();
    text.parse().ok().and_then(finite)
}

/// Parses a cell; surrounding quotes and blanks are allowed.
pub fn cell(text: &str, marks: Marks) -> Cell {
    let text = bare(text);
    if text.is_empty() {
        return Cell::Blank;
    }
    // Some programs write a true minus sign.
    let text: Cow<'_, str> = match text.strip_prefix('\u{2212}') {
        Some(rest) => format!("-{rest}").into(),
        None => text.into(),
    };
    let whole = |text: &str| {
        let (value, used) = leading_number(text.as_bytes(), marks.decimal)?;
        (used == text.len()).then_some(value)
    };
    let grouped = || {
        let plain = without_groups(&text, marks.thousands?, char::from(marks.decimal))?;
        whole(&plain)
    };
    whole(&text)
        .or_else(grouped)
        .map_or(Cell::Other, Cell::Number)
}

/// The number in a cell.
pub fn number(text: &str, marks: Marks) -> Option<f64> {
    match cell(text, marks) {
        Cell::Number(value) => Some(value),
        _ => None,
    }
}

/// Whether values rise in even steps, other than row numbers.
pub fn rises_evenly(values: &[f64]) -> bool {
    if values.len() < 3 {
        return false;
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    let even = |pair: &[f64]| ((pair[1] - pair[0]) - step).abs() < 0.2 * step;
    step > 0.0 && step != 1.0 && values.windows(2).all(even)
}

/// A cell without surrounding blanks and quotes.
pub fn bare(text: &str) -> &str {
    let text = text.trim();
    let inner = text
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.map_or(text, str::trim)
}

/// Removes thousands separators; `None` unless they separate groups of three digits.
pub fn without_groups(text: &str, mark: char, decimal: char) -> Option<String> {
    let (integer, rest) = match text.find([decimal, 'e', 'E']) {
        // Nobody writes groups before an exponent: "1.234e5" has decimals.
        Some(at) if text[at..].starts_with(['e', 'E']) => return None,
        Some(at) => text.split_at(at),
        None => (text, ""),
    };
    let (sign, digits) = match integer.strip_prefix(['-', '+']) {
        Some(digits) => (&integer[..1], digits),
        None => ("", integer),
    };
    let is_mark = |c| c == mark || (mark == '\u{a0}' && c == '\u{202f}');
    // Most cells have none.
    if !digits.contains(is_mark) {
        return None;
    }
    let mut groups = digits.split(is_mark);
    let first = groups.next()?;
    let is_digits = |group: &str| group.bytes().all(|b| b.is_ascii_digit());
    let first_fits = (1..=3).contains(&first.len()) && is_digits(first) && first != "0";
    let mut plain = format!("{sign}{first}");
    for group in groups {
        if group.len() != 3 || !is_digits(group) {
            return None;
        }
        plain += group;
    }
    plain += rest;
    first_fits.then_some(plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const POINT: Marks = Marks::decimal(b'.');

    #[test]
    fn reference_numbers_as_the_standard_library_reads_them() {
        for text in [
            "0",
            "-0",
            "1",
            "-1.5",
            "+.5",
            "5.",
            "123456789012345678",
            "0.1",
            "1e22",
            "1e23",
            "9007199254740993",
            "9007199254740992",
            "1.7976931348623157e308",
            "5e-324",
            "2.2250738585072011e-308",
            "0.000000000000000000000000000001",
            "12345678.12345678",
            "1e-400",
            "00000000000000000000000000000001.5",
            "8.98846567431158e307",
            // Exponents with zeros before them.
            "1e00000000030",
            "25e-0000000000001",
            "0e99999999999",
        ] {
            let expected: f64 = text.parse().unwrap();
            let (value, used) = leading_number(text.as_bytes(), b'.').unwrap();
            assert_eq!(
                (value.to_bits(), used),
                (expected.to_bits(), text.len()),
                "{text}"
            );
        }
        for text in [
            "", "-", ".", "e5", "1e", "1e+", "abc", "1e400", "nan", "inf",
        ] {
            let found = leading_number(text.as_bytes(), b'.');
            assert!(
                found.is_none_or(|(_, used)| used < text.len()),
                "{text} {found:?}"
            );
        }
    }

    #[test]
    fn closed_form_thousands() {
        let marks = |decimal, thousands| Marks {
            decimal,
            thousands: Some(thousands),
        };
        for (text, marks, value) in [
            ("1.234,5", marks(b',', '.'), 1234.5),
            ("1,234,567.25", marks(b'.', ','), 1_234_567.25),
            ("-12'345.5", marks(b'.', '\''), -12_345.5),
            ("1\u{a0}234,5", marks(b',', '\u{a0}'), 1234.5),
            ("1\u{202f}234,5", marks(b',', '\u{a0}'), 1234.5),
            ("\" 1 234 \"", marks(b',', ' '), 1234.0),
            ("\u{2212}3,5", marks(b',', '.'), -3.5),
            ("1.5D+02", POINT, 150.0),
        ] {
            assert_eq!(cell(text, marks), Cell::Number(value), "{text}");
        }
        for text in ["1.23,5", "0.123", "1234.567", "1..234"] {
            assert_eq!(cell(text, marks(b',', '.')), Cell::Other, "{text}");
        }
        assert_eq!(cell("  ", POINT), Cell::Blank);
    }

    proptest! {
        #[test]
        fn reference_every_double_is_read_back(bits in any::<u64>(), shape in 0..3) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            let text = match shape {
                0 => format!("{value}"),
                1 => format!("{value:e}"),
                _ => format!("{value:.17e}"),
            };
            for decimal in [b'.', b','] {
                let text = text.replace('.', &char::from(decimal).to_string());
                let (read, used) = leading_number(text.as_bytes(), decimal).unwrap();
                prop_assert_eq!(used, text.len());
                prop_assert_eq!(read.to_bits(), value.to_bits());
            }
        }

        #[test]
        fn reference_decimals_of_any_length(text in "-?[0-9]{0,25}\\.[0-9]{1,25}(e-?[0-9]{1,3})?") {
            let expected: f64 = text.parse().unwrap();
            match leading_number(text.as_bytes(), b'.') {
                Some((value, used)) => {
                    prop_assert_eq!(used, text.len());
                    prop_assert_eq!(value.to_bits(), expected.to_bits());
                }
                None => prop_assert!(expected.is_infinite()),
            }
        }
    }
}
