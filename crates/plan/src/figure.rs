//! The curve of a plan: power or half-width against fruit, and against cost.

use crate::outcome::{PlanOutcome, PlanRow};
use crate::text::impacts_text;
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// Fewer points are drawn as dots on the line too.
const FEW_POINTS: usize = 20;

/// A line for each number of impacts; the wanted value as a broken line.
pub(crate) fn figure_of_plan(outcome: &PlanOutcome) -> Figure {
    let by_power = outcome.curve.iter().all(|row| row.power.is_some());
    let by_power = by_power && outcome.wanted_half_width.is_none();
    let mut panels = vec![panel(outcome, by_power, (outcome.counted, ""), |row| {
        Some(row.fruit as f64)
    })];
    if outcome.curve.iter().all(|row| row.cost.is_some()) {
        panels.push(panel(outcome, by_power, ("cost", ""), |row| row.cost));
    }
    Figure::new(outcome.about.first().cloned().unwrap_or_default(), panels)
}

fn panel(
    outcome: &PlanOutcome,
    by_power: bool,
    x: (&str, &str),
    place: impl Fn(&PlanRow) -> Option<f64>,
) -> Panel {
    let value = |row: &PlanRow| match by_power {
        true => row.power.map(|power| power.value),
        false => row.half_width,
    };
    let mut impacts: Vec<usize> = outcome.curve.iter().map(|row| row.impacts).collect();
    impacts.sort_unstable();
    impacts.dedup();
    let mut series = Vec::new();
    for (colour, impacts) in impacts.into_iter().enumerate() {
        let own = outcome.curve.iter().filter(|row| row.impacts == impacts);
        let points: Vec<(f64, f64)> = own
            .clone()
            .filter_map(|row| place(row).zip(value(row)))
            .collect();
        // the error of simulations, twice to each side of the share
        let bars: Vec<(f64, f64)> = own
            .filter_map(|row| {
                let power = row.power.filter(|_| by_power)?;
                let (x, low, high) = (place(row)?, power.low?, power.high?);
                Some([(x, low), (x, high)])
            })
            .flatten()
            .collect();
        let label = format!("{} on each fruit", impacts_text(impacts));
        let few = points.len() < FEW_POINTS;
        series.push(Series::new(label, Style::Line, points.clone()).coloured(colour));
        if !bars.is_empty() {
            series.push(Series::new("", Style::Bars, bars).coloured(colour));
        }
        if few {
            series.push(Series::new("", Style::Dots, points).coloured(colour));
        }
    }
    let wanted = match by_power {
        true => outcome.wanted_power,
        false => outcome.wanted_half_width,
    };
    let first = outcome.curve.iter().find_map(&place).unwrap_or_default();
    if let Some(wanted) = wanted {
        let level = Series::new("wanted", Style::Level, vec![(first, wanted)]);
        series.push(level.coloured(WANTED));
    }
    let y = match by_power {
        true => "power",
        false => outcome.half_width_of,
    };
    Panel::new(x, (y, ""), series)
}

/// Colour of the wanted value: the last of the series, black on paper.
const WANTED: usize = 6;
