//! Numbers, probabilities and units as people read them: one rule for the terminal, reports,
//! figures and messages. The page follows it too (`format.ts`), and both are held to the cases
//! of `crates/files/src/text/number_cases.json`.
//!
//! * A number with a standard deviation has the digits that give the deviation two.
//! * A number without has four significant digits; whole ones below 10⁷ have all of theirs.
//! * From 10⁷ on and below 10⁻⁴ it carries a power of ten.
//! * Probabilities have three decimals, and below 0.001 they are "< 0.001".
//! * Exponents of units and powers are raised.
//!
//! CSV and JSON hold full precision and plain ASCII and have no part in this.

/// Digits shown of a standard deviation.
const SD_DIGITS: usize = 2;

/// Digits shown of a number whose uncertainty is not known.
const PLAIN_DIGITS: usize = 4;

/// Powers of ten between which a number is written without one.
const PLAIN_POWERS: std::ops::Range<i32> = -4..7;

/// Most decimals of a number.
const MOST_DECIMALS: i32 = 12;

/// Moves a number by less than its rounding, so that halves round away from zero.
const HALVES: f64 = 1.0 + 1e-15;

/// Smallest probability that is written as a number.
const LEAST_PROBABILITY: f64 = 0.001;

/// What stands where there is no number.
const NONE: &str = "-";

/// "750000 ± 130000" or "(1.23 ± 0.12)·10⁸": both to the second digit of the deviation.
pub fn value_and_sd(value: f64, sd: Option<f64>) -> String {
    let Some(sd) = sd.filter(|sd| *sd > 0.0 && sd.is_finite() && value.is_finite()) else {
        return plain(value);
    };
    let decimals = SD_DIGITS as i32 - 1 - power_of(sd, SD_DIGITS);
    let power = power_of(value.abs().max(sd), PLAIN_DIGITS);
    if PLAIN_POWERS.contains(&power) {
        return format!("{} ± {}", fixed(value, decimals), fixed(sd, decimals));
    }
    let shown = |size: f64| fixed(size / 10_f64.powi(power), decimals + power);
    format!(
        "({} ± {})·10{}",
        shown(value),
        shown(sd),
        raised(&power.to_string())
    )
}

/// A part of one in percent, to two digits: "18 %".
pub fn percent(part: f64) -> String {
    format!("{} %", with_digits(100.0 * part, SD_DIGITS))
}

/// A number with four significant digits.
pub fn plain(value: f64) -> String {
    with_digits(value, PLAIN_DIGITS)
}

/// A number with so many significant digits: "0.4781", "746100", "1.234·10⁻⁹".
pub fn with_digits(value: f64, digits: usize) -> String {
    match value {
        0.0 => return "0".to_owned(),
        value if value.is_nan() => return NONE.to_owned(),
        value if value.is_infinite() => return if value > 0.0 { "∞" } else { "-∞" }.to_owned(),
        _ => {}
    }
    let power = power_of(value, digits);
    if !PLAIN_POWERS.contains(&power) {
        let mantissa = fixed(value / 10_f64.powi(power), digits as i32 - 1);
        return format!("{mantissa}·10{}", raised(&power.to_string()));
    }
    // Whole numbers are counts, or were typed.
    if value.fract() == 0.0 && power >= digits as i32 {
        return format!("{value:.0}");
    }
    fixed(value, digits as i32 - 1 - power)
}

/// A probability as a number alone: "0.034", "< 0.001".
pub fn probability(p: f64) -> String {
    match p {
        p if p.is_nan() => NONE.to_owned(),
        p if p < LEAST_PROBABILITY => format!("< {LEAST_PROBABILITY}"),
        p => fixed(p, 3),
    }
}

/// A probability with its symbol: "p = 0.034", "p < 0.001".
pub fn p_value(p: f64) -> String {
    match probability(p) {
        text if text.starts_with('<') => format!("p {text}"),
        text => format!("p = {text}"),
    }
}

/// A unit with raised exponents: "N/m¹˙⁵", "m/s²".
pub fn unit_text(unit: &str) -> String {
    let mut text = String::with_capacity(unit.len());
    let mut rest = unit;
    while let Some(at) = rest.find('^') {
        text += &rest[..at];
        rest = &rest[at + 1..];
        let number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
        let end = rest.find(|c| !number(c)).unwrap_or(rest.len());
        text += &match rest[..end].parse::<f64>() {
            Ok(exponent) => raised(&shortest(exponent)),
            Err(_) => format!("^{}", &rest[..end]),
        };
        rest = &rest[end..];
    }
    text + rest
}

/// An exponent with four digits at the most, and without zeros at its end.
fn shortest(exponent: f64) -> String {
    let text = fixed(exponent, 3);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Digits, sign and decimal point as raised letters.
pub fn raised(digits: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| match c {
        '-' => '⁻',
        '.' => '˙',
        c => c.to_digit(10).map_or(c, |digit| DIGITS[digit as usize]),
    };
    digits.chars().map(raise).collect()
}

/// Power of ten of a number that is rounded to so many digits.
fn power_of(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits - 1, value * HALVES);
    let power = text
        .split_once('e')
        .and_then(|(_, power)| power.parse().ok());
    power.unwrap_or(0)
}

/// A number with so many decimals; below zero they are whole digits that are rounded.
fn fixed(value: f64, decimals: i32) -> String {
    let decimals = decimals.min(MOST_DECIMALS);
    let text = match decimals {
        0.. => format!("{:.*}", decimals as usize, value * HALVES),
        _ => {
            let unit = 10_f64.powi(-decimals);
            format!("{:.0}", (value / unit).round() * unit)
        }
    };
    match text.strip_prefix('-') {
        Some(rest) if !rest.contains(|c: char| ('1'..='9').contains(&c)) => rest.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_what_is_no_number_is_a_dash() {
        assert_eq!(plain(f64::NAN), "-");
        assert_eq!(plain(f64::NEG_INFINITY), "-∞");
        assert_eq!(probability(f64::NAN), "-");
    }
}
