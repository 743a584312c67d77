//! Figures of one quantity against another: loops, loading curves, spectra.

use crate::axis::axis;
use crate::frame::{Frame, Rectangle};
pub use crate::panel::{Mark, Panel, Series, Side, Style};
use crate::panel_drawing::{Labels, draw_legend, draw_within, legend_height, range};
use crate::svg::{Anchor, Drawing};
use crate::theme::Theme;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Size of a panel and the room around it; px.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 330.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 22.0;
const TOP: f64 = 64.0;
const BOTTOM: f64 = 50.0;

/// Labels of a panel as wide as the page.
const LABELS: Labels = Labels {
    size: 11.0,
    character: 6.4,
    line: 12.0,
    ring: 4.5,
    dots: (2.3, 1.5),
    alike: false,
    whole: false,
};

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
    let legend = |panel: &Panel| legend_height(panel, (LEFT, WIDTH - RIGHT), &LABELS);
    let rows: Vec<f64> = figure.panels.iter().map(legend).collect();
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

fn draw_panel(drawing: &mut Drawing, panel: &Panel, top: f64) {
    let widened = |(low, high): (f64, f64), part: f64| {
        (low - part * (high - low), high + part * (high - low))
    };
    let (low, high) = widened(range(panel, |p| p.0), 0.02);
    let horizontal = axis(low, high, 8);
    let (low, high) = widened(range(panel, |p| p.1), 0.05);
    let vertical = axis(low, high, 6);
    let frame = Frame {
        within: Rectangle {
            left: LEFT,
            top,
            width: WIDTH - RIGHT - LEFT,
            height: HEIGHT,
        },
        across: horizontal,
        up: vertical,
    };
    frame.draw_grid(drawing);
    let (x, y) = ((&*panel.x, &*panel.x_unit), (&*panel.y, &*panel.y_unit));
    frame.draw_axes(drawing, x, y, LEFT - 20.0);
    draw_within(drawing, panel, &frame, &LABELS);
    draw_legend(drawing, panel, &frame, &LABELS);
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
