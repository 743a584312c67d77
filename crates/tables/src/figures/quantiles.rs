//! Ordered values against the quantiles of a distribution, with a band that holds all of them.

use crate::figures::words::percent;
use windfall_distribution::tail::{normal_quantile, t_upper_quantile};
use windfall_draw::grid::{GridPanel, Scale};
use windfall_draw::xy::{Mark, Panel, Series, Side, Style};
use windfall_statistics::residuals::quantile_band::{local_level, probability_band};

/// An ordered value with what it is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrderedValue {
    /// Place of the value in the list that was given.
    pub row: usize,
    /// The value.
    pub value: f64,
    /// Normal score of its rank (Blom 1958: (i − 3/8)/(n + 1/4)).
    pub score: f64,
    /// Quantile of its distribution at the same probability.
    pub expected: f64,
    /// Lower end of the band.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The distribution that values are held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The normal distribution of variance 1.
    Normal,
    /// Student's t with these degrees of freedom.
    Student(f64),
}

impl Held {
    /// Quantile above which this probability lies.
    pub fn upper(self, probability: f64) -> f64 {
        match self {
            Self::Normal => -normal_quantile(probability),
            Self::Student(df) => t_upper_quantile(probability, df),
        }
    }
}

/// Orders values and holds them against a distribution.
///
/// * `values`: those that are no numbers are left out
/// * `drawn`: whether the value at a place is drawn; the others count only in the ranks
/// * `confidence`: that independent values of the distribution lie all within the band
pub fn ordered_values(
    values: &[f64],
    drawn: &dyn Fn(usize) -> bool,
    held: Held,
    confidence: f64,
) -> Vec<OrderedValue> {
    let finite = values.iter().copied().enumerate();
    let mut sorted: Vec<(usize, f64)> = finite.filter(|(_, value)| value.is_finite()).collect();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let count = sorted.len();
    if count == 0 {
        return Vec::new();
    }
    let level = local_level(count, confidence);
    let shown = sorted.into_iter().enumerate();
    shown
        .filter(|(_, (row, _))| drawn(*row))
        .map(|(rank, (row, value))| {
            let probability = (rank as f64 + 0.625) / (count as f64 + 0.25);
            let (below, above) = probability_band(rank, count, level);
            OrderedValue {
                row,
                value,
                score: normal_quantile(probability),
                expected: -held.upper(probability),
                low: -held.upper(below),
                high: held.upper(above),
            }
        })
        .collect()
}

/// Words of a panel of quantiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuantileWords<'a> {
    /// What stands above it.
    pub title: &'a str,
    /// Name of the values.
    pub values: &'a str,
    /// Their unit.
    pub unit: &'a str,
    /// Why it is empty, where it is.
    pub empty: &'a str,
}

/// The panel of ordered values, with the ends of the band cut to what the values need.
///
/// * `label`: of the value at a place of the list, "" for none
pub fn quantile_panel(
    words: QuantileWords,
    ordered: &[OrderedValue],
    confidence: f64,
    label: &dyn Fn(usize) -> String,
) -> GridPanel {
    let ends = ordered.iter().flat_map(|own| [own.value, own.expected]);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let room = 0.12 * (high - low);
    let (low, high) = (low - room, high + room);
    let band = |pick: fn(&OrderedValue) -> f64| {
        let points = ordered.iter();
        points.map(move |own| (own.score, pick(own).clamp(low, high)))
    };
    let mut around: Vec<(f64, f64)> = Vec::new();
    if low <= high {
        around.extend(band(|own| own.low));
        around.extend(band(|own| own.high).collect::<Vec<_>>().into_iter().rev());
    }
    let band_title = format!("{} % band", percent(confidence));
    let line = ordered.iter().map(|own| (own.score, own.expected));
    let dots = ordered.iter().map(|own| (own.score, own.value));
    let series = vec![
        Series::new(band_title, Style::Band, around).coloured(1),
        Series::new("", Style::Dashed, line.collect()).coloured(6),
        Series::new("", Style::Dots, dots.collect()).coloured(0),
    ];
    let mut panel = Panel::new(("normal score", ""), (words.values, words.unit), series);
    let named = ordered.iter().map(|own| (own, label(own.row)));
    let marks = named.filter(|(_, label)| !label.is_empty());
    panel.marks = marks
        .map(|(own, label)| Mark {
            label,
            at: (own.score, own.value),
            side: match own.score < 0.0 {
                true => Side::BelowRight,
                false => Side::AboveLeft,
            },
        })
        .collect();
    let mut own = GridPanel::new(words.title, panel);
    if low < high {
        own.up = Scale::Between(low, high);
    }
    words.empty.clone_into(&mut own.empty);
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of three values Blom's scores are Φ⁻¹(0.1923), 0, −Φ⁻¹(0.1923) = 0.8694; the one that
    /// is no number does not count.
    #[test]
    fn reference_scores_of_three_values() {
        let values = [2.0, f64::NAN, 0.0, 1.0];
        let found = ordered_values(&values, &|_| true, Held::Normal, 0.95);
        let rows: Vec<usize> = found.iter().map(|own| own.row).collect();
        assert_eq!(rows, [2, 3, 0]);
        assert!((found[2].score - 0.869_424).abs() < 1e-6 && found[1].score.abs() < 1e-12);
        assert!(
            found
                .iter()
                .all(|own| own.low < own.expected && own.expected < own.high)
        );
        let few = ordered_values(&values, &|row| row == 0, Held::Student(3.0), 0.95);
        assert!(few.len() == 1 && few[0].score == found[2].score);
        assert!(few[0].high > found[2].high);
    }
}
