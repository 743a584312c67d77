//! Figures of one quantity against another: loops, loading curves, spectra.

use crate::axis::axis;
use crate::frame::{Frame, Rectangle};
use crate::svg::{Anchor, Drawing, Ink};
use crate::theme::{SERIES, Theme};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Size of a panel and the room around it; px.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 330.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 22.0;
const TOP: f64 = 64.0;
const BOTTOM: f64 = 50.0;

/// A tint narrower than this could not be seen; px.
const LEAST_TINT: f64 = 2.0;

/// Height of a line of the legend, and width of a character in it; px.
const LEGEND_LINE: f64 = 15.0;
const CHARACTER: f64 = 6.4;

/// Least distance of the lines of two labels that stand above each other; px.
const LINE: f64 = 12.0;

/// Fewer points than this are drawn larger.
const FEW_POINTS: usize = 150;

/// More points than this are thinned to what the eye can tell.
const MOST_POINTS: usize = 4000;

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Dots.
    Dots,
    /// A line.
    Line,
    /// A thick line behind the others.
    Broad,
    /// A broken line across the panel at the height of each point.
    Level,
    /// A broken line.
    Dashed,
    /// A thin upright line through the panel at the place of each point.
    Upright,
    /// A tint from top to bottom of the panel between the first and the second
    /// point, the third and the fourth, and so on.
    Shade,
    /// A tinted shape with corners at the points: a band, or the area within an
    /// ellipse.
    Band,
    /// A thin upright line from the first to the second point, from the third to
    /// the fourth, and so on: intervals.
    Bars,
    /// As [`Style::Bars`], level.
    LevelBars,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// Which colour it has; that of its place among the series where it is `None`.
    pub colour: Option<usize>,
    /// The points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A series in the colour of its place among the series.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self {
            label: label.into(),
            style,
            colour: None,
            points,
        }
    }

    /// The series in a colour of its own.
    #[must_use]
    pub fn coloured(self, colour: usize) -> Self {
        let colour = Some(colour);
        Self { colour, ..self }
    }
}

/// A place that is named.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What is there.
    pub label: String,
    /// Where, in the units of the axes.
    pub at: (f64, f64),
    /// On which side of the place the label stands.
    pub side: Side,
}

/// Side of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above and to the left.
    AboveLeft,
    /// Below and to the right.
    BelowRight,
}

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Name of the horizontal axis.
    pub x: String,
    /// Its unit.
    pub x_unit: String,
    /// Name of the vertical axis.
    pub y: String,
    /// Its unit.
    pub y_unit: String,
    /// The series, drawn in their order.
    pub series: Vec<Series>,
    /// Named places.
    pub marks: Vec<Mark>,
}

impl Panel {
    /// A panel without marks, from name and unit of each axis; the unit "1" is not shown.
    pub fn new(x: (&str, &str), y: (&str, &str), series: Vec<Series>) -> Self {
        let shown = |unit: &str| if unit == "1" { "" } else { unit }.to_owned();
        Self {
            x: x.0.to_owned(),
            x_unit: shown(x.1),
            y: y.0.to_owned(),
            y_unit: shown(y.1),
            series,
            marks: Vec::new(),
        }
    }
}

/// A figure of one or more panels, one below the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its title.
    pub title: String,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Figure {
    /// A figure of some panels.
    pub fn new(title: impl Into<String>, panels: Vec<Panel>) -> Self {
        let title = title.into();
        Self { title, panels }
    }
}

/// Draws a figure as an SVG file.
pub fn svg_of_figure(figure: &Figure, theme: &Theme) -> String {
    drawing_of_figure(figure).svg(theme)
}

/// Draws a figure as an element of a page; its title describes it.
pub fn element_of_figure(figure: &Figure, theme: &Theme) -> String {
    drawing_of_figure(figure).element(theme, &figure.title)
}

/// Draws a figure, whose colours a theme names later.
pub fn drawing_of_figure(figure: &Figure) -> Drawing {
    let rows: Vec<f64> = figure.panels.iter().map(legend_height).collect();
    let room = |legend: &f64| legend + HEIGHT + BOTTOM + 8.0;
    let height = 34.0 + rows.iter().map(room).sum::<f64>();
    let mut drawing = Drawing::new(WIDTH, height.max(TOP));
    drawing.text((LEFT, 22.0), Anchor::Start, 13.0, &figure.title);
    let mut top = 34.0;
    for (panel, legend) in figure.panels.iter().zip(&rows) {
        draw_panel(&mut drawing, panel, top + legend);
        top += room(legend);
    }
    drawing
}

fn labelled(panel: &Panel) -> Vec<(usize, &Series)> {
    let series = panel.series.iter().enumerate();
    series
        .filter(|(_, series)| !series.label.is_empty())
        .collect()
}

/// Legend entries by their line and place in it.
fn legend_places(panel: &Panel) -> Vec<(usize, f64)> {
    let (mut line, mut x) = (0, LEFT);
    labelled(panel)
        .iter()
        .map(|(_, series)| {
            let width = 34.0 + CHARACTER * series.label.chars().count() as f64;
            if x + width > WIDTH - RIGHT && x > LEFT {
                (line, x) = (line + 1, LEFT);
            }
            let place = (line, x);
            x += width;
            place
        })
        .collect()
}

fn legend_height(panel: &Panel) -> f64 {
    let lines = legend_places(panel).last().map_or(0, |(line, _)| line + 1);
    12.0 + LEGEND_LINE * lines as f64
}

fn range(panel: &Panel, pick: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
    let points = panel.series.iter().flat_map(|series| &series.points);
    let marks = panel.marks.iter().map(|mark| &mark.at);
    let values = points
        .chain(marks)
        .map(pick)
        .filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    match low <= high {
        true => (low, high),
        false => (0.0, 1.0),
    }
}

fn draw_panel(drawing: &mut Drawing, panel: &Panel, top: f64) {
    let (left, right, bottom) = (LEFT, WIDTH - RIGHT, top + HEIGHT);
    let widened = |(low, high): (f64, f64), part: f64| {
        (low - part * (high - low), high + part * (high - low))
    };
    let (low, high) = widened(range(panel, |p| p.0), 0.02);
    let horizontal = axis(low, high, 8);
    let (low, high) = widened(range(panel, |p| p.1), 0.05);
    let vertical = axis(low, high, 6);
    let frame = Frame {
        within: Rectangle {
            left,
            top,
            width: right - left,
            height: HEIGHT,
        },
        across: horizontal,
        up: vertical,
    };
    frame.draw_grid(drawing);
    let (x, y) = ((&*panel.x, &*panel.x_unit), (&*panel.y, &*panel.y_unit));
    frame.draw_axes(drawing, x, y, LEFT - 20.0);

    // Tints first; lines over a cloud of dots, a few dots over lines.
    let layer = |series: &Series| match series.style {
        Style::Shade | Style::Band => 0,
        Style::Dots if series.points.len() >= FEW_POINTS => 1,
        Style::Dots => 3,
        _ => 2,
    };
    for drawn in 0..=3 {
        let series = panel.series.iter().enumerate();
        for (index, series) in series.filter(|(_, s)| layer(s) == drawn) {
            let index = series.colour.unwrap_or(index);
            let points: Vec<(f64, f64)> = thinned(series)
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .map(|point| frame.place(point))
                .collect();
            match series.style {
                Style::Level => points.iter().for_each(|(_, y)| {
                    draw_series(drawing, &[(left, *y), (right, *y)], Style::Level, index);
                }),
                Style::Upright => points.iter().for_each(|(x, _)| {
                    draw_series(drawing, &[(*x, top), (*x, bottom)], Style::Upright, index);
                }),
                Style::Shade => points.chunks_exact(2).for_each(|ends| {
                    let width = (ends[1].0 - ends[0].0).max(LEAST_TINT);
                    drawing.tint((ends[0].0, top), (width, HEIGHT), Ink::Series(index));
                }),
                style => draw_series(drawing, &points, style, index),
            }
        }
    }
    // Where labels would cover each other, the first is shown; the data have all.
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for mark in &panel.marks {
        let at = frame.place(mark.at);
        drawing.ring(at, 4.5, Ink::Text);
        let (x, y, anchor) = match mark.side {
            Side::AboveLeft => (at.0 - 9.0, at.1 - 7.0, Anchor::End),
            Side::BelowRight => (at.0 + 9.0, at.1 + 13.0, Anchor::Start),
        };
        // A label that would leave the panel moves to the other side.
        let length = CHARACTER * mark.label.chars().count() as f64;
        let (x, anchor) = match anchor {
            Anchor::End if x - length < left => (at.0 + 9.0, Anchor::Start),
            Anchor::Start if x + length > right => (at.0 - 9.0, Anchor::End),
            anchor => (x, anchor),
        };
        let (from, to) = match anchor {
            Anchor::End => (x - length, x),
            _ => (x, x + length),
        };
        let covers =
            |(a, b, level): &(f64, f64, f64)| *a < to && from < *b && (level - y).abs() < LINE;
        if !taken.iter().any(covers) {
            drawing.text((x, y), anchor, 11.0, &mark.label);
            taken.push((from, to, y));
        }
    }
    let base = top - legend_height(panel) + 4.0;
    for ((index, series), (line, x)) in labelled(panel).into_iter().zip(legend_places(panel)) {
        let index = series.colour.unwrap_or(index);
        let y = base + LEGEND_LINE * line as f64 + 4.0;
        let sample = match series.style {
            Style::Upright => [(x + 9.0, y - 5.0), (x + 9.0, y), (x + 9.0, y + 5.0)],
            Style::Shade => [(x, y - 5.0), (x + 18.0, y + 5.0), (x, y)],
            Style::Band => [(x, y - 5.0), (x + 18.0, y - 5.0), (x + 18.0, y + 5.0)],
            Style::Bars => [(x + 9.0, y - 6.0), (x + 9.0, y + 6.0), (x, y)],
            _ => [(x, y), (x + 9.0, y), (x + 18.0, y)],
        };
        draw_series(drawing, &sample, series.style, index);
        drawing.text((x + 24.0, y + 3.8), Anchor::Start, 11.0, &series.label);
    }
}

/// * `index`: position of the series, which has its colour; when colours repeat,
///   lines are dashed
fn draw_series(drawing: &mut Drawing, points: &[(f64, f64)], style: Style, index: usize) {
    let ink = Ink::Series(index);
    match style {
        Style::Level | Style::Dashed => drawing.dashed(points, ink, 1.4),
        Style::Upright => drawing.polyline(points, ink, 0.8),
        Style::Shade => {
            let [from, to] = [points[0], points[1]];
            drawing.tint(from, (to.0 - from.0, to.1 - from.1), ink);
        }
        Style::Line if index >= SERIES => drawing.dashed(points, ink, 1.4),
        Style::Line => drawing.polyline(points, ink, 1.4),
        Style::Broad => drawing.polyline(points, ink, 4.0),
        Style::Band => drawing.tinted_shape(points, ink),
        Style::Bars | Style::LevelBars => {
            for ends in points.chunks_exact(2) {
                drawing.polyline(ends, ink, 0.8);
            }
        }
        Style::Dots => {
            let radius = if points.len() < FEW_POINTS { 2.3 } else { 1.5 };
            for point in points {
                drawing.dot(*point, radius, ink);
            }
        }
    }
}

/// Every point, or so many that the eye sees no difference: of a line the lowest
/// and the highest of each stretch, so that no peak is lost.
fn thinned(series: &Series) -> Box<dyn Iterator<Item = (f64, f64)> + '_> {
    let points = &series.points;
    let step = points.len().div_ceil(MOST_POINTS).max(1);
    match series.style {
        Style::Line if step > 1 => Box::new(points.chunks(2 * step).flat_map(extremes)),
        _ => Box::new(points.iter().step_by(step).copied()),
    }
}

/// Lowest and highest point of a stretch, in the order in which they come.
fn extremes(stretch: &[(f64, f64)]) -> [(f64, f64); 2] {
    let (mut low, mut high) = (0, 0);
    for (index, (_, y)) in stretch.iter().enumerate() {
        if *y < stretch[low].1 {
            low = index;
        }
        if *y > stretch[high].1 {
            high = index;
        }
    }
    [stretch[low.min(high)], stretch[low.max(high)]]
}

/// What the figure shows, as CSV: one row per point.
pub fn csv_of_figure(figure: &Figure) -> Result<String, Error> {
    let header = ["panel", "series", "x", "x_unit", "y", "y_unit"];
    let mut rows = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let row = |series: &str, (x, y): (f64, f64)| {
            vec![
                (index + 1).to_string(),
                series.to_owned(),
                x.to_string(),
                panel.x_unit.clone(),
                y.to_string(),
                panel.y_unit.clone(),
            ]
        };
        for series in &panel.series {
            rows.extend(series.points.iter().map(|point| row(&series.label, *point)));
        }
        rows.extend(panel.marks.iter().map(|mark| row(&mark.label, mark.at)));
    }
    csv_text(&header.map(str::to_owned), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theme::LIGHT;

    fn figure(points: Vec<(f64, f64)>) -> Figure {
        Figure {
            title: "a < b".to_owned(),
            panels: vec![Panel {
                x: "deformation".to_owned(),
                x_unit: "mm".to_owned(),
                y: "force".to_owned(),
                y_unit: "N".to_owned(),
                series: vec![Series {
                    label: "measured".to_owned(),
                    style: Style::Dots,
                    colour: None,
                    points,
                }],
                marks: vec![Mark {
                    label: "bioyield".to_owned(),
                    at: (1.0, 2.0),
                    side: Side::AboveLeft,
                }],
            }],
        }
    }

    #[test]
    fn conserves_every_point_in_the_drawing_and_the_table() {
        let figure = figure(vec![(0.0, 0.0), (1.0, 2.0), (f64::NAN, 1.0), (2.0, 1.0)]);
        let svg = svg_of_figure(&figure, &LIGHT);
        assert_eq!(svg.matches(r#"r="2.3""#).count(), 3 + 3);
        assert!(svg.contains("bioyield") && svg.contains("a &lt; b") && svg.contains("force (N)"));
        let table = csv_of_figure(&figure).unwrap();
        assert_eq!(table.lines().count(), 1 + 4 + 1);
        assert!(table.contains("1,measured,1,mm,2,N"));
    }

    /// A peak of one sample among many is drawn: at the top of the panel.
    #[test]
    fn conserves_a_peak_of_one_sample() {
        let mut points: Vec<(f64, f64)> = (0..20_000).map(|i| (f64::from(i), 0.0)).collect();
        points[12_345].1 = 9.0;
        let series = Series {
            label: String::new(),
            style: Style::Line,
            colour: None,
            points,
        };
        let drawn: Vec<(f64, f64)> = thinned(&series).collect();
        assert!(drawn.len() <= MOST_POINTS && drawn.contains(&(12_345.0, 9.0)));
        assert!(drawn.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn closed_form_tints_and_uprights_are_drawn_behind() {
        let mut figure = figure(vec![(0.0, 0.0), (4.0, 2.0)]);
        for style in [Style::Upright, Style::Shade] {
            figure.panels[0].series.push(Series {
                label: format!("{style:?}"),
                style,
                colour: None,
                points: vec![(1.0, 0.0), (2.0, 0.0)],
            });
        }
        let svg = svg_of_figure(&figure, &LIGHT);
        let (tint, dot) = (
            svg.find("fill-opacity").unwrap(),
            svg.find("circle").unwrap(),
        );
        assert!(tint < dot && svg.contains("Upright"), "{svg}");
    }

    #[test]
    fn closed_form_no_points_no_panic() {
        assert!(svg_of_figure(&figure(Vec::new()), &LIGHT).ends_with("</svg>\n"));
    }
}
