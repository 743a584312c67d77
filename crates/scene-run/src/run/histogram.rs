//! Distributions over fruit of the loads of a scene.

use serde::Serialize;
use windfall_draw::axis::axis;
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// A histogram of fruit over a quantity.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct HistogramOutcome {
    /// The quantity, of each fruit the largest.
    pub quantity: String,
    /// Its unit; SI.
    pub unit: &'static str,
    /// Edges of the bins, one more than bins; SI. A value on an edge is in the bin above it.
    pub edges: Vec<f64>,
    /// Fruit in each bin.
    pub fruit: Vec<usize>,
}

/// Bins at most, about.
const BINS: usize = 25;

/// Bins of round width from zero to the largest value; `None` without values.
pub fn histogram(quantity: &str, unit: &'static str, values: &[f64]) -> Option<HistogramOutcome> {
    let finite = values.iter().copied().filter(|own| own.is_finite());
    let largest = finite.clone().fold(f64::NEG_INFINITY, f64::max);
    if largest < 0.0 {
        return None;
    }
    let ticks = axis(0.0, largest.max(f64::MIN_POSITIVE), BINS).ticks;
    let width = match ticks[..] {
        [first, second, ..] => second - first,
        _ => largest.max(1.0),
    };
    let bins = (largest / width).floor() as usize + 1;
    let mut fruit = vec![0; bins];
    for value in finite {
        fruit[((value / width) as usize).min(bins - 1)] += 1;
    }
    Some(HistogramOutcome {
        quantity: quantity.to_owned(),
        unit,
        edges: (0..=bins).map(|edge| edge as f64 * width).collect(),
        fruit,
    })
}

/// The histograms, one panel each.
///
pub fn figure_of_histograms(title: &str, histograms: &[HistogramOutcome]) -> Figure {
    let panel = |own: &HistogramOutcome| {
        let (unit, scale) = shown(own.unit);
        let mut outline = vec![(scale * own.edges[0], 0.0)];
        for (ends, count) in own.edges.windows(2).zip(&own.fruit) {
            let count = *count as f64;
            outline.extend([(scale * ends[0], count), (scale * ends[1], count)]);
        }
        outline.push((scale * own.edges[own.fruit.len()], 0.0));
        let series = |style| Series {
            label: String::new(),
            style,
            colour: Some(0),
            points: outline.clone(),
        };
        Panel {
            x: own.quantity.clone(),
            x_unit: unit.to_owned(),
            y: "fruit".to_owned(),
            y_unit: String::new(),
            series: vec![series(Style::Band), series(Style::Line)],
            marks: Vec::new(),
            equal: false,
        }
    };
    Figure {
        title: title.to_owned(),
        panels: histograms.iter().map(panel).collect(),
    }
}

/// The unit that a person reads, and how many of it are one of SI.
fn shown(unit: &'static str) -> (&'static str, f64) {
    match unit {
        "J" => ("mJ", 1e3),
        "m^3" => ("mm³", 1e9),
        unit => (unit, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_every_fruit() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.1).collect();
        let own = histogram("peak force", "N", &values).unwrap();
        assert_eq!(own.fruit.iter().sum::<usize>(), 1000);
        assert_eq!(own.edges.len(), own.fruit.len() + 1);
        for (bin, count) in own.fruit.iter().enumerate() {
            let within = |value: &&f64| **value >= own.edges[bin] && **value < own.edges[bin + 1];
            assert_eq!(values.iter().filter(within).count(), *count, "{bin}");
        }
        // Fruit that suffered nothing are fruit too.
        let none = histogram("bruise", "m^3", &[0.0, 0.0]).unwrap();
        assert_eq!(none.fruit.iter().sum::<usize>(), 2);
        assert!(histogram("bruise", "m^3", &[]).is_none());
    }
}
