//! Parameters against what the tables say of impacts and specimens.

use crate::figures::parameters::{estimated_parameters, groups_of_impacts};
use itertools::Itertools;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_campaign::settings::model::ImpactCampaign;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_files::text::column_title::column_title;
use windfall_statistics::model::straight_line::{fit_straight_line, line_at};

/// Level of the band.
const CONFIDENCE: f64 = 0.95;

/// Points of a line and its band.
const POINTS: usize = 60;

/// Columns with fewer different values than this show no course.
const FEWEST_VALUES: usize = 3;

/// Covariates with a relative span below this show measurement noise, not a course; 1.
const LEAST_SPAN: f64 = 0.01;

/// Columns that say where in a recording an impact is.
const PLACES: [&str; 2] = ["from_s", "to_s"];

/// A number that each impact has, or some of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariate {
    /// Name of the column, or "impact velocity".
    pub name: String,
    /// Unit; "" where the name of the column says it.
    pub unit: String,
    /// Value of each impact.
    pub values: Vec<Option<f64>>,
}

/// The velocity at first touch, then the columns of impacts.csv and specimens.csv
/// that hold numbers of which at least three differ.
pub fn covariates_of(campaign: &ImpactCampaign, impacts: &[&ImpactOutcome]) -> Vec<Covariate> {
    let velocity = |impact: &&ImpactOutcome| impact.fitted("impact_velocity");
    let mut found = vec![Covariate {
        name: "impact velocity".to_owned(),
        unit: "m/s".to_owned(),
        values: impacts.iter().map(velocity).collect(),
    }];
    let shared = &campaign.shared;
    let columns = shared.entries.iter().flat_map(|entry| &entry.cells);
    let of_specimens = shared.specimens.iter().flat_map(|s| &s.cells);
    let names = columns.chain(of_specimens).map(|(name, _)| name).unique();
    for name in names.filter(|name| !PLACES.contains(&name.as_str())) {
        let cells = impacts.iter().map(|impact| cell(campaign, impact, name));
        let cells: Vec<Option<&str>> = cells.collect();
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        let mut filled = cells
            .iter()
            .flatten()
            .filter(|cell| !cell.trim().is_empty());
        if filled.any(|cell| number(cell).is_none()) {
            continue;
        }
        found.push(Covariate {
            name: name.to_string(),
            unit: String::new(),
            values: cells.iter().map(|cell| number((*cell)?)).collect(),
        });
    }
    found.retain(|covariate| varies(&covariate.values));
    found
}

/// The cell of an impact's row, or of its specimen's.
fn cell<'a>(campaign: &'a ImpactCampaign, impact: &ImpactOutcome, column: &str) -> Option<&'a str> {
    let mut entries = campaign.shared.entries.iter();
    let entry = entries.find(|entry| entry.id == impact.id)?;
    let specimen = campaign.shared.specimen_of(entry);
    let of_specimen = specimen.map_or(&[][..], |s| &s.cells);
    let mut cells = entry.cells.iter().chain(of_specimen);
    let found = cells.find(|(name, _)| name == column)?;
    Some(&found.1)
}

/// Whether the values differ enough to show a course.
fn varies(values: &[Option<f64>]) -> bool {
    let mut sorted: Vec<f64> = values.iter().flatten().copied().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else {
        return false;
    };
    sorted.len() >= FEWEST_VALUES && high - low >= LEAST_SPAN * low.abs().max(high.abs())
}

/// Each estimated parameter against a covariate: impacts with their 95 % intervals, and a line
/// through each group with its 95 % band; `None` where nothing was estimated.
pub fn figure_of_covariate(
    law: &str,
    impacts: &[&ImpactOutcome],
    covariate: &Covariate,
) -> Option<NamedFigure> {
    let panels: Vec<Panel> = estimated_parameters(impacts)
        .into_iter()
        .map(|parameter| panel(impacts, covariate, parameter))
        .collect();
    if panels.is_empty() {
        return None;
    }
    let name = &covariate.name;
    Some(NamedFigure {
        name: file_name(&format!("{law}-over-{}", name.replace(' ', "-"))),
        caption: format!(
            "Parameters over {name}, one point per impact with its 95 % interval. Line and band: \
             least squares through the points of a group and the 95 % interval of its mean; \
             several impacts on one fruit are taken as independent here, \
             `windfall population` does not do so."
        ),
        figure: Figure::new(format!("{law}: parameters over {name}"), panels),
    })
}

fn panel(
    impacts: &[&ImpactOutcome],
    covariate: &Covariate,
    (name, unit): (String, String),
) -> Panel {
    let value_of = |impact: &ImpactOutcome| {
        let place = impacts
            .iter()
            .position(|other| std::ptr::eq(*other, impact));
        covariate.values[place?]
    };
    let mut series = Vec::new();
    for (index, (group, members)) in groups_of_impacts(impacts).into_iter().enumerate() {
        let (mut points, mut bars) = (Vec::new(), Vec::new());
        for impact in &members {
            let (Some(x), Some(estimate)) = (value_of(impact), impact.parameters.get(&name)) else {
                continue;
            };
            points.push((x, estimate.value));
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                bars.extend([(x, low), (x, high)]);
            }
        }
        let drawn = |label: &str, style, points| Series::new(label, style, points).coloured(index);
        if let Some((line, band)) = line_and_band(&points) {
            series.push(drawn("", Style::Band, band));
            series.push(drawn("", Style::Line, line));
        }
        series.push(drawn("", Style::Bars, bars));
        series.push(drawn(&group, Style::Dots, points));
    }
    let (x, x_unit) = match covariate.unit.as_str() {
        "" => column_title(&covariate.name),
        unit => (covariate.name.clone(), unit.to_owned()),
    };
    Panel::new((&x, &x_unit), (&name, &unit), series)
}

type Line = Vec<(f64, f64)>;

/// The line through some points, and the corners of its band.
fn line_and_band(points: &[(f64, f64)]) -> Option<(Line, Line)> {
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    // On two points the band would be the whole plane.
    let fit = fit_straight_line(&x, &y, CONFIDENCE).ok()?;
    let (&low, &high) = x.iter().minmax_by(|a, b| a.total_cmp(b)).into_option()?;
    let places: Vec<f64> = (0..POINTS)
        .map(|i| low + (high - low) * i as f64 / (POINTS - 1) as f64)
        .collect();
    let found = line_at(&fit, &places);
    let at = |pick: fn(&windfall_statistics::model::prediction::Prediction) -> f64| {
        let values = places.iter().zip(&found);
        values.map(|(x, p)| (*x, pick(p))).collect::<Line>()
    };
    let mut band = at(|p| p.mean_high);
    band.extend(at(|p| p.mean_low).into_iter().rev());
    Some((at(|p| p.mean), band))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_what_varies() {
        assert!(varies(&[Some(1.0), None, Some(2.0), Some(3.0)]));
        assert!(!varies(&[Some(1.0), Some(2.0), Some(2.0)]), "two levels");
        assert!(!varies(&[Some(0.388), Some(0.3881), Some(0.3882)]), "noise");
        assert!(!varies(&[None, None]));
    }

    #[test]
    fn closed_form_line_and_band_span_the_points() {
        let points = [(1.0, 2.1), (2.0, 3.9), (3.0, 6.2), (4.0, 7.8), (5.0, 10.1)];
        let (line, band) = line_and_band(&points).unwrap();
        assert!((line[0].1 - 2.04).abs() < 1e-12 && line[0].0 == 1.0);
        assert!((line[POINTS - 1].1 - 10.0).abs() < 1e-12);
        assert_eq!(band.len(), 2 * POINTS);
        // Up along the upper side, back along the lower.
        assert!(band[0].1 > line[0].1 && band[2 * POINTS - 1].1 < line[0].1);
        assert!(line_and_band(&points[..2]).is_none());
    }
}
