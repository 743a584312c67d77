//! How the values of a column are distributed: a histogram.

use windfall_distribution::quantile::quantile;
use windfall_draw::grid::{GridPanel, Scale};
use windfall_draw::xy::{Panel, Series, Style};
use windfall_files::text::column_title::column_title;

/// Most bins.
const MOST_BINS: usize = 60;

/// A bin with the number of its values; the upper end belongs to the next bin, but for the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Values.
    pub count: usize,
}

/// Bins of equal width over finite values, as wide as twice the distance of the quartiles over
/// the cube root of their number; by the logarithm of their number where the quartiles are equal.
///
/// # Source
/// Freedman, D. and Diaconis, P. (1981), Z. Wahrsch. verw. Gebiete 57, 453-476; Sturges, H. A.
/// (1926), J. Am. Stat. Assoc. 21, 65-66.
pub fn bins(values: &[f64]) -> Vec<Bin> {
    let finite: Vec<f64> = values
        .iter()
        .copied()
        .filter(|own| own.is_finite())
        .collect();
    let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
    let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if finite.is_empty() {
        return Vec::new();
    }
    let range = high - low;
    let count = finite.len() as f64;
    let spread = quantile(&finite, 0.75) - quantile(&finite, 0.25);
    let wanted = match spread > 0.0 {
        true => range / (2.0 * spread / count.cbrt()),
        false => count.log2() + 1.0,
    };
    // Values that are all the same fill one bin.
    let number = match range > 0.0 {
        true => (wanted.ceil() as usize).clamp(1, MOST_BINS),
        false => 1,
    };
    let (low, range) = match range > 0.0 {
        true => (low, range),
        false => {
            let half = if low == 0.0 { 0.5 } else { 0.05 * low.abs() };
            (low - half, 2.0 * half)
        }
    };
    let edge = |place: usize| low + range * place as f64 / number as f64;
    let mut counts = vec![0; number];
    for value in &finite {
        let place = ((value - low) / range * number as f64) as usize;
        counts[place.min(number - 1)] += 1;
    }
    let bins = counts.into_iter().enumerate();
    bins.map(|(place, count)| Bin {
        low: edge(place),
        high: edge(place + 1),
        count,
    })
    .collect()
}

/// The histogram of a column.
pub fn histogram_panel(column: &str, bins: &[Bin]) -> GridPanel {
    let (name, unit) = column_title(column);
    let mut outline: Vec<(f64, f64)> = bins.iter().take(1).map(|bin| (bin.low, 0.0)).collect();
    for bin in bins {
        let count = bin.count as f64;
        outline.extend([(bin.low, count), (bin.high, count)]);
    }
    outline.extend(bins.last().map(|bin| (bin.high, 0.0)));
    let sides = bins.iter().skip(1).zip(bins);
    let sides = sides.flat_map(|(own, before)| {
        let least = own.count.min(before.count) as f64;
        [(own.low, 0.0), (own.low, least)]
    });
    let series = vec![
        Series::new("", Style::Band, outline.clone()).coloured(0),
        Series::new("", Style::Bars, sides.collect()).coloured(0),
        Series::new("", Style::Line, outline).coloured(0),
    ];
    let mut own = GridPanel::new("All rows", Panel::new((&name, &unit), ("rows", ""), series));
    own.up = Scale::Reaching(0.0, 0.0);
    own.empty = "the column has no values".to_owned();
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0 to 7: the quartiles are 1.75 and 5.25, a bin 2 · 3.5/2 = 3.5 wide: 2 bins.
    #[test]
    fn closed_form_bins() {
        let values: Vec<f64> = (0..8).map(f64::from).collect();
        let counts: Vec<usize> = bins(&values).iter().map(|bin| bin.count).collect();
        assert_eq!(counts, [4, 4]);
        let same = bins(&[2.0, 2.0, f64::NAN]);
        assert!(same.len() == 1 && same[0].count == 2 && same[0].low < 2.0 && same[0].high > 2.0);
        assert!(bins(&[f64::NAN]).is_empty());
        let steep: Vec<f64> = (0..2000).map(|i| f64::from(i).powi(9)).collect();
        let counted: usize = bins(&steep).iter().map(|bin| bin.count).sum();
        assert!(counted == 2000 && bins(&steep).len() <= MOST_BINS);
    }
}
