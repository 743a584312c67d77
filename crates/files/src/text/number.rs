//! Numbers for people: as many digits as their uncertainty lets them have.

/// Digits shown of a standard deviation.
const SD_DIGITS: i32 = 2;

/// Digits shown of a number whose uncertainty is not known.
const PLAIN_DIGITS: i32 = 4;

/// "753599 ± 133165": both with the decimals that give the second two digits.
pub fn value_and_sd(value: f64, sd: Option<f64>) -> String {
    match sd {
        Some(sd) if sd > 0.0 && sd.is_finite() => {
            let decimals = decimals_for(sd, SD_DIGITS);
            format!("{value:.decimals$} ± {sd:.decimals$}")
        }
        _ => plain(value),
    }
}

/// "753599 ± 133165 (18 %)".
pub fn spread_text(mean: f64, sd: Option<f64>, cv: Option<f64>) -> String {
    match cv {
        Some(cv) if cv.is_finite() => format!("{} ({} %)", value_and_sd(mean, sd), percent(cv)),
        _ => value_and_sd(mean, sd),
    }
}

/// "11.35 ± 3.5 %": the standard deviation in percent of the mean.
pub fn spread_percent(mean: f64, cv: Option<f64>) -> String {
    match cv {
        // Less is the rounding of equal values.
        Some(cv) if cv.is_finite() && cv > 1e-12 => {
            let by_sd = decimals_for(cv * mean.abs(), SD_DIGITS);
            let decimals = by_sd.min(decimals_for(mean.abs(), PLAIN_DIGITS));
            format!("{mean:.decimals$} ± {} %", percent(cv))
        }
        _ => plain(mean),
    }
}

/// A number with four significant digits, never fewer than its whole digits.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && !(1e-4..1e9).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = decimals_for(size, PLAIN_DIGITS);
    format!("{value:.decimals$}")
}

fn percent(cv: f64) -> String {
    let decimals = decimals_for(100.0 * cv, 2).min(4);
    format!("{:.decimals$}", 100.0 * cv)
}

/// Decimals that show `digits` significant digits of a number.
fn decimals_for(size: f64, digits: i32) -> usize {
    if size <= 0.0 || !size.is_finite() {
        return 0;
    }
    let exponent = size.log10().floor() as i32;
    (digits - 1 - exponent).clamp(0, 12) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table 2 of the 2003 pendulum study prints its apples like this.
    #[test]
    fn reference_printed_like_the_2003_study() {
        assert_eq!(
            spread_text(753_599.2, Some(133_165.4), Some(133_165.4 / 753_599.2)),
            "753599 ± 133165 (18 %)"
        );
        assert_eq!(
            spread_text(1524.0, Some(263.0), Some(263.0 / 1524.0)),
            "1524 ± 263 (17 %)"
        );
    }

    #[test]
    fn closed_form_digits_follow_the_uncertainty() {
        assert_eq!(value_and_sd(0.478143, Some(0.0123)), "0.478 ± 0.012");
        assert_eq!(value_and_sd(0.478143, None), "0.4781");
        assert_eq!(
            spread_text(0.478143, Some(0.0123), Some(0.0257)),
            "0.478 ± 0.012 (2.6 %)"
        );
        assert_eq!(spread_percent(11.352, Some(0.035)), "11.35 ± 3.5 %");
        assert_eq!(spread_percent(753_599.2, Some(0.18)), "753599 ± 18 %");
        assert_eq!(spread_percent(0.466718, Some(1e-4)), "0.4667 ± 0.010 %");
        assert_eq!(plain(0.0), "0");
        assert_eq!(plain(1.234e-9), "1.234e-9");
        assert_eq!(plain(466_143.599), "466144");
    }
}
