//! Figures of a calibration: the line of equally good laws with what tells them
//! apart, and the surfaces of the design.

use crate::calibrate::outcome::{CalibrateOutcome, DesignWayOutcome, FamilyLine};
use windfall_draw::files::{FigureFolder, write_figure};
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_files::error::Error;

/// Writes the figures of a calibration into a directory.
///
/// # Errors
/// The directory or a file cannot be written.
pub fn write_calibrate_figures(
    folder: &FigureFolder,
    outcome: &CalibrateOutcome,
) -> Result<(), Error> {
    if let Some(family) = outcome.family.as_ref().filter(|f| f.members.len() > 1) {
        write_figure(folder, "family", &figure_of_family(outcome, family))?;
    }
    if let Some(design) = &outcome.design {
        write_figure(folder, "design", &figure_of_design(outcome, design))?;
    }
    Ok(())
}

/// The line in the planes of the first parameter and each other, then the peak at
/// every height over the first parameter, as parts of that of the first member.
pub fn figure_of_family(outcome: &CalibrateOutcome, family: &FamilyLine) -> Figure {
    let units = outcome.parameter_units();
    let first = (outcome.free[0].as_str(), units[0].as_str());
    let mut panels: Vec<Panel> = (1..outcome.free.len())
        .map(|place| {
            let members = family.members.iter();
            let points: Vec<(f64, f64)> = members
                .map(|m| (m.parameters[0], m.parameters[place]))
                .collect();
            let mut all = vec![
                Series::new("same first peak and interval", Style::Line, points.clone()),
                Series::new("", Style::Dots, points),
            ];
            let line = outcome.design.iter().flat_map(|design| &design.family);
            let line: Vec<_> = line.map(|m| (m.levels[0], m.levels[place])).collect();
            if !line.is_empty() {
                all.push(Series::new("the same by the surfaces", Style::Dashed, line));
            }
            let mut panel = Panel::new(first, (&outcome.free[place], &units[place]), all);
            panel.marks.extend(fitted_mark(outcome, place));
            panel
        })
        .collect();
    for (name, title) in [
        ("peak_support_force_1", "first peak"),
        ("interval_1", "interval"),
    ] {
        let title = format!("{title}, over that of the first law");
        panels.push(Panel::new(first, (&title, ""), ratios(family, name)));
    }
    Figure {
        title: "Laws that one height cannot tell apart, and what other heights say".to_owned(),
        panels,
    }
}

/// Where the features of all drops put the law, if they do.
fn fitted_mark(outcome: &CalibrateOutcome, place: usize) -> Option<Mark> {
    let features = outcome.features.as_ref()?;
    features.parameters[place].sd?;
    let value = |place: usize| features.parameters[place].written.value;
    Some(Mark {
        label: "all drops".to_owned(),
        at: (value(0), value(place)),
        side: Side::BelowRight,
    })
}

/// A feature along the line at each height, over that of its first member.
fn ratios(family: &FamilyLine, name: &str) -> Vec<Series> {
    let count = family.members[0].heights.len();
    (0..count)
        .map(|place| {
            let value = |member: usize| {
                let at = &family.members[member].heights[place];
                at.features.get(name).copied().unwrap_or(f64::NAN)
            };
            let points = family.members.iter().enumerate();
            let points = points.map(|(i, m)| (m.parameters[0], value(i) / value(0)));
            let height = 1e3 * family.members[0].heights[place].height;
            Series::new(format!("{height:.0} mm"), Style::Line, points.collect())
        })
        .collect()
}

/// Each surface along each factor, with the simulated runs and the measured value.
pub fn figure_of_design(outcome: &CalibrateOutcome, design: &DesignWayOutcome) -> Figure {
    let mut panels = Vec::new();
    for (place, surface) in design.surfaces.iter().enumerate() {
        let (scale, unit) = match surface.unit.as_str() {
            "s" => (1e3, "ms"),
            unit => (1.0, unit),
        };
        let factors = design.factors.iter().enumerate();
        let curves = factors.map(|(factor, own)| {
            let points = curve(design, place, factor);
            let points = points.into_iter().map(|(x, y)| (x, scale * y));
            let name = format!("{} ({}), the others at their centre", own.letter, own.name);
            Series::new(name, Style::Line, points.collect())
        });
        let mut all: Vec<Series> = curves.collect();
        // Runs on the axis of a factor, where its curve should pass.
        let on_axis = (0..design.factors.len()).flat_map(|factor| {
            let own = design.runs.iter().filter(move |run| {
                let mut others = run.coded.iter().enumerate().filter(|(i, _)| *i != factor);
                others.all(|(_, x)| x.abs() < 1e-9)
            });
            own.map(move |run| (run.coded[factor], scale * run.responses[place]))
        });
        all.push(Series::new("simulated", Style::Dots, on_axis.collect()));
        let target = outcome.target.features.get(&surface.response);
        if let Some(target) = target {
            let level = vec![(0.0, scale * target.value)];
            all.push(Series::new("measured", Style::Level, level));
        }
        panels.push(Panel::new(
            ("coded level", ""),
            (&surface.response, unit),
            all,
        ));
    }
    Figure {
        title: "Responses over the factors of the design: surfaces and simulator".to_owned(),
        panels,
    }
}

/// Points of a curve.
const POINTS: usize = 41;

/// A surface along one factor, the others at the centre.
fn curve(design: &DesignWayOutcome, place: usize, factor: usize) -> Vec<(f64, f64)> {
    let letter = &design.factors[factor].letter;
    let surface = &design.surfaces[place];
    (0..POINTS)
        .map(|step| {
            let part = step as f64 / (POINTS - 1) as f64;
            let x = design.alpha * (2.0 * part - 1.0);
            let terms = surface.terms.iter().map(|term| {
                let power = match term.term.strip_prefix(letter.as_str()) {
                    _ if is_constant(&term.term) => Some(0),
                    Some("") => Some(1),
                    Some(rest) => rest.strip_prefix('^').and_then(|p| p.parse::<i32>().ok()),
                    None => None,
                };
                power.map_or(0.0, |power| term.coded * x.powi(power))
            });
            (x, terms.sum())
        })
        .collect()
}

/// Whether a term is the intercept.
fn is_constant(term: &str) -> bool {
    term.is_empty() || term == "1" || term == "(Intercept)"
}
