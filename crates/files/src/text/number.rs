//! Numbers for people, by the rule of [`windfall_numerics::written`].

pub use windfall_numerics::written::{
    p_value, percent, plain, raised, unit_text, value_and_sd, with_digits,
};

/// "750000 ± 130000 (18 %)".
pub fn spread_text(mean: f64, sd: Option<f64>, cv: Option<f64>) -> String {
    match cv {
        Some(cv) if cv.is_finite() => format!("{} ({})", value_and_sd(mean, sd), percent(cv)),
        _ => value_and_sd(mean, sd),
    }
}

/// "11.35 ± 3.5 %": the standard deviation in percent of the mean, which goes as far as its
/// second digit, but has four digits at the most.
pub fn spread_percent(mean: f64, cv: Option<f64>) -> String {
    match cv {
        // Less is the rounding of equal values.
        Some(cv) if cv.is_finite() && cv > 1e-12 => {
            let digits = digits_beside(mean, cv * mean.abs()).clamp(1, DIGITS.0);
            format!("{} ± {}", with_digits(mean, digits as usize), percent(cv))
        }
        _ => plain(mean),
    }
}

/// Fewest and most digits of a number whose deviation stands elsewhere.
const DIGITS: (i32, i32) = (4, 10);

/// Part of the width of a 95 % interval that is about a standard deviation; 1.
const DEVIATION: f64 = 0.25;

/// A number whose standard deviation stands in another column: with the digits that give the
/// deviation two, and four at the least. A dash where there is none.
pub fn beside_sd(value: f64, sd: f64) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    let digits = digits_beside(value, sd);
    with_digits(value, digits.clamp(DIGITS.0, DIGITS.1) as usize)
}

/// Digits of a number that go as far as the second digit of its deviation.
fn digits_beside(value: f64, sd: f64) -> i32 {
    let power = |size: f64| size.abs().log10().floor();
    let digits = power(value) - power(sd) + 2.0;
    match digits.is_finite() {
        true => digits as i32,
        false => DIGITS.0,
    }
}

/// Both ends of a 95 % interval, with the digits of [`beside_sd`]: "645723", "645861".
pub fn ends(low: f64, high: f64) -> [String; 2] {
    [low, high].map(|end| beside_sd(end, DEVIATION * (high - low)))
}

/// An interval in words: "645723 to 645861".
pub fn interval(low: f64, high: f64) -> String {
    ends(low, high).join(" to ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::statistic::{chi_square, probability};
    use serde_json::Value;

    /// Cases that the page is held to as well.
    fn cases(name: &str) -> Vec<(Vec<Value>, String)> {
        let all: Value = serde_json::from_str(include_str!("number_cases.json")).unwrap();
        let cases = all[name].as_array().unwrap().iter().map(|case| {
            let (written, of) = case.as_array().unwrap().split_last().unwrap();
            (of.to_vec(), written.as_str().unwrap().to_owned())
        });
        let cases: Vec<_> = cases.collect();
        assert!(cases.len() > 2, "{name}");
        cases
    }

    fn check(name: &str, write: impl Fn(&[f64]) -> String) {
        for (of, written) in cases(name) {
            let of: Vec<f64> = of.iter().map(|n| n.as_f64().unwrap()).collect();
            assert_eq!(write(&of), written, "{name} of {of:?}");
        }
    }

    #[test]
    fn closed_form_cases_of_both_languages() {
        check("number", |n| plain(n[0]));
        check("digits", |n| with_digits(n[0], n[1] as usize));
        check("value_and_sd", |n| value_and_sd(n[0], n.get(1).copied()));
        check("percent", |n| percent(n[0]));
        check("probability", |n| probability(n[0]));
        check("p_value", |n| p_value(n[0]));
        check("chi_square", |n| chi_square(n[0], n[1], n.get(2).copied()));
        for (of, written) in cases("unit") {
            assert_eq!(unit_text(of[0].as_str().unwrap()), written);
        }
    }

    #[test]
    fn closed_form_ends_show_the_width() {
        assert_eq!(interval(645_723.2, 645_861.1), "645723 to 645861");
        assert_eq!(interval(677_380.0, 816_933.5), "677380 to 816900");
        assert_eq!(interval(0.38766, 0.38834), "0.38766 to 0.38834");
        assert_eq!(interval(f64::NEG_INFINITY, 1.0), "- to 1.000");
        assert_eq!(beside_sd(394_849.6, 78.54), "394850");
        assert_eq!(beside_sd(743_891.2, 35_548.0), "743900");
        assert_eq!(beside_sd(2.0664, 0.2557), "2.066");
        assert_eq!(beside_sd(f64::NAN, 1.0), "-");
    }

    /// Mean, deviation and its share of the apples in Table 2 of the 2003 pendulum study.
    #[test]
    fn closed_form_spreads_go_as_far_as_the_deviation() {
        assert_eq!(
            spread_text(753_599.2, Some(133_165.4), Some(133_165.4 / 753_599.2)),
            "750000 ± 130000 (18 %)"
        );
        assert_eq!(
            spread_text(0.478143, Some(0.0123), Some(0.0257)),
            "0.478 ± 0.012 (2.6 %)"
        );
        assert_eq!(spread_percent(11.352, Some(0.035)), "11.35 ± 3.5 %");
        assert_eq!(spread_percent(13.0213, Some(0.37)), "13.0 ± 37 %");
        assert_eq!(spread_percent(300.0, Some(0.48)), "300 ± 48 %");
        assert_eq!(spread_percent(753_599.2, Some(0.18)), "750000 ± 18 %");
        assert_eq!(spread_percent(0.466718, Some(1e-4)), "0.4667 ± 0.010 %");
    }
}
