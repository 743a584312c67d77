//! Axes of figures: round ticks and their labels.

use windfall_files::text::number::raised;

/// Powers of ten beyond which an axis carries a factor in its title.
const PLAIN_POWERS: std::ops::RangeInclusive<i32> = -2..=4;

/// Rounding of an end, as a part of the distance of ticks; 1.
const ROUNDING: f64 = 1e-9;

/// Fewest ticks of an axis: two could not be told from those of a logarithm.
const FEWEST: i64 = 3;

/// One axis: its range, ticks, and the factor that its labels leave out.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Lower end; unit of the data.
    pub low: f64,
    /// Upper end, above `low`.
    pub high: f64,
    /// Ticks within the range, rising.
    pub ticks: Vec<f64>,
    /// Labels of the ticks, divided by 10^`power`.
    pub labels: Vec<String>,
    /// Power of ten that the labels leave out; 0 for none.
    pub power: i32,
}

/// An axis over data from `low` to `high` with about `count` round ticks.
///
/// Ticks are 1, 2 or 5 times a power of ten apart, and at least three. Data of one value gets
/// a range around it.
pub fn axis(low: f64, high: f64, count: usize) -> Axis {
    let (low, high) = widened(low, high);
    let mut step = round_step((high - low) / count.max(1) as f64);
    // An end that is round but for rounding has its tick.
    let first = |step: f64| (low / step - ROUNDING).ceil() as i64;
    let last = |step: f64| (high / step + ROUNDING).floor() as i64;
    // The next two smaller steps, at the most: a range that is no number has no ticks.
    for _ in 0..2 {
        if last(step) - first(step) + 1 < FEWEST {
            step = round_step(0.35 * step);
        }
    }
    of_step((low, high), step, 0)
}

/// An axis over the same range with ticks as far apart as three allow, for labels that stand in
/// each other's way otherwise: 1, 2, 2.5, 3, 4 or 5 times a power of ten.
pub(crate) fn sparse(axis: &Axis) -> Axis {
    let (low, high) = (axis.low, axis.high);
    let power = 10_f64.powf(((high - low) / 2.0).log10().floor());
    let steps = [
        (5.0, 0),
        (4.0, 0),
        (3.0, 0),
        (2.5, 1),
        (2.0, 0),
        (1.0, 0),
        (0.5, 0),
        (0.4, 0),
    ];
    let steps = steps.map(|(step, more)| of_step((low, high), step * power, more));
    let enough = |own: &&Axis| own.ticks.len() as i64 >= FEWEST;
    steps.iter().find(enough).unwrap_or(axis).clone()
}

/// An axis with ticks at the multiples of a step.
///
/// * `more`: decimals beyond the first digit of the step
fn of_step((low, high): (f64, f64), step: f64, more: i32) -> Axis {
    let first = (low / step - ROUNDING).ceil() as i64;
    let last = (high / step + ROUNDING).floor() as i64;
    let ticks: Vec<f64> = (first..=last).map(|i| i as f64 * step).collect();
    let largest = low.abs().max(high.abs());
    let magnitude = largest.log10().floor() as i32;
    let power = match PLAIN_POWERS.contains(&magnitude) {
        true => 0,
        false => magnitude,
    };
    let decimals =
        (power - (step * (1.0 + ROUNDING)).log10().floor() as i32 + more).max(0) as usize;
    let labels = ticks
        .iter()
        .map(|tick| label(tick / 10_f64.powi(power), decimals))
        .collect();
    Axis {
        low,
        high,
        ticks,
        labels,
        power,
    }
}

/// A number for an axis, with a true minus sign and no negative zero.
fn label(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// " (unit)", " (10⁻³ unit)", or nothing.
pub fn unit_label(unit: &str, power: i32) -> String {
    let factor = match power {
        0 => String::new(),
        power => format!("10{}", raised(&power.to_string())),
    };
    match (unit, factor.as_str()) {
        ("", "") => String::new(),
        ("", factor) => format!(" ({factor})"),
        (unit, "") => format!(" ({unit})"),
        (unit, factor) => format!(" ({factor} {unit})"),
    }
}

fn widened(low: f64, high: f64) -> (f64, f64) {
    if high > low {
        return (low, high);
    }
    let half = match low.abs() {
        0.0 => 1.0,
        size => 0.1 * size,
    };
    (low - half, low + half)
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0];
    let found = steps
        .into_iter()
        .find(|s| s * power >= least * (1.0 - 1e-9));
    found.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_round_ticks() {
        let found = axis(-0.31, 1.05, 5);
        assert_eq!(found.labels, ["0.0", "0.5", "1.0"]);
        let found = axis(-3.0, 12.0, 4);
        assert_eq!(found.labels, ["0", "5", "10"]);
        let found = axis(0.0, 4.2e-6, 4);
        assert_eq!((found.power, found.labels[1].as_str()), (-6, "2"));
        let found = axis(-8.0, 8.0, 4);
        assert_eq!(found.labels, ["\u{2212}5", "0", "5"]);
        let found = axis(5.0, 5.0, 4);
        assert!(found.low < 5.0 && found.high > 5.0 && !found.ticks.is_empty());
        assert_eq!(unit_label("N", -6), " (10⁻⁶ N)");
    }

    /// Wherever the ends lie, three ticks are found, and about half of the range lies between two.
    #[test]
    fn closed_form_sparse_axes_have_three_ticks() {
        for i in 0..500 {
            let low = (f64::from(i) - 250.0) * 0.37;
            for width in [0.013, 0.7, 1.01, 2.9, 49.0, 777.0] {
                let dense = axis(low, low + width, 6);
                let found = sparse(&dense);
                assert!((3..=5).contains(&found.ticks.len()), "{found:?}");
                assert!(found.ticks.len() <= dense.ticks.len());
                let told = |(tick, label): (&f64, &String)| {
                    let label: f64 = label.replace('\u{2212}', "-").parse().unwrap();
                    (label * 10_f64.powi(found.power) - tick).abs() < 1e-9 * (tick.abs() + width)
                };
                assert!(found.ticks.iter().zip(&found.labels).all(told), "{found:?}");
            }
        }
    }

    #[test]
    fn closed_form_ticks_lie_within_the_range() {
        for (low, high) in [(0.0, 1.0), (1e9, 1.0001e9), (-1e-12, 1e-12), (377.1, 377.2)] {
            let found = axis(low, high, 5);
            assert!(
                found.ticks.iter().all(|t| (low..=high).contains(t)),
                "{low}"
            );
            assert!((3..=7).contains(&found.ticks.len()), "{found:?}");
            let mut labels = found.labels.clone();
            labels.dedup();
            assert_eq!(labels.len(), found.labels.len(), "{found:?}");
        }
    }
}
