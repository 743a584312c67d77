//! Figures of one quantity against another: loops, loading curves, spectra.

use crate::axis::axis;
use crate::frame::{Frame, Rectangle};
use crate::grid_panel::GridPanel;
pub use crate::panel::{Mark, Panel, Series, Side, Style};
use crate::panel_drawing::{
    Labels, MOST_POINTS, draw_legend, draw_within, legend_height, named_lines, shown_ranges,
};
use crate::paper::{Part, drawing_on_paper};
use crate::svg::{Anchor, Drawing};
use crate::theme::Theme;
use crate::width::Width;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Size of a panel and the room around it; px.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 330.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 22.0;
const TOP: f64 = 64.0;
const BOTTOM: f64 = 50.0;

/// Labels of panels as wide as the page.
fn labels_of(figure: &Figure) -> Labels {
    Labels {
        size: 11.0,
        line: 12.0,
        ring: 4.5,
        dots: (2.3, 1.5),
        alike: false,
        whole: false,
        most: MOST_POINTS,
        lines: named_lines(figure.panels.iter()),
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
    drawing_of_figure(figure, None).svg(theme)
}

/// Height of panels in a page, of which two rows and a caption fill half of a sheet; px.
const LOW: f64 = 100.0;

/// Panels of a page's figure that stay together; more are parts between which a page may end.
const TOGETHER: usize = 4;

/// Draws a figure as elements of a page that is printed at a width, one below the other; its title
/// describes them. A panel that stands alone is narrower.
pub fn elements_of_figure(figure: &Figure, theme: &Theme, width: Width) -> Vec<String> {
    let labels = &labels_of(figure);
    let panels = panels_of(figure);
    let width = match panels.len() {
        1 => width.min(Width::ALONE),
        _ => width,
    };
    let part = |(place, own): (usize, &[GridPanel])| {
        let part = Part {
            first: place * TOGETHER,
            whole: panels.len(),
            highest: if panels.len() > 1 { LOW } else { HEIGHT },
        };
        drawing_on_paper(own, part, &[], labels, width).element(theme, &figure.title)
    };
    panels.chunks(TOGETHER).enumerate().map(part).collect()
}

fn panels_of(figure: &Figure) -> Vec<GridPanel> {
    let panels = figure.panels.iter();
    panels.map(|own| GridPanel::new("", own.clone())).collect()
}

/// Draws a figure, whose colours a theme names later: at a width on paper, where it has no title,
/// or with panels as wide as a screen shows them.
pub fn drawing_of_figure(figure: &Figure, paper: Option<Width>) -> Drawing {
    let labels = &labels_of(figure);
    if let Some(width) = paper {
        let panels = panels_of(figure);
        return drawing_on_paper(&panels, Part::all(panels.len()), &[], labels, width);
    }
    let legend = |panel: &Panel| legend_height(panel, (LEFT, WIDTH - RIGHT), labels);
    let rows: Vec<f64> = figure.panels.iter().map(legend).collect();
    let room = |legend: &f64| legend + HEIGHT + BOTTOM + 8.0;
    let height = 34.0 + rows.iter().map(room).sum::<f64>();
    let mut drawing = Drawing::new(WIDTH, height.max(TOP));
    drawing.text((LEFT, 22.0), Anchor::Start, 13.0, &figure.title);
    let mut top = 34.0;
    for (panel, legend) in figure.panels.iter().zip(&rows) {
        draw_panel(&mut drawing, panel, top + legend, labels);
        top += room(legend);
    }
    drawing
}

fn draw_panel(drawing: &mut Drawing, panel: &Panel, top: f64, labels: &Labels) {
    let widened = |(low, high): (f64, f64), part: f64| {
        (low - part * (high - low), high + part * (high - low))
    };
    let (across, up) = shown_ranges(panel);
    let (rooms, ticks) = match panel.equal {
        true => ((0.03, 0.03), (6, 6)),
        false => ((0.02, 0.05), (8, 6)),
    };
    let (low, high) = widened(across, rooms.0);
    let horizontal = axis(low, high, ticks.0);
    let (low, high) = widened(up, rooms.1);
    let vertical = axis(low, high, ticks.1);
    let width = match panel.equal {
        true => HEIGHT,
        false => WIDTH - RIGHT - LEFT,
    };
    let frame = Frame {
        within: Rectangle {
            left: LEFT,
            top,
            width,
            height: HEIGHT,
        },
        across: horizontal,
        up: vertical,
    };
    frame.draw_grid(drawing);
    let (x, y) = ((&*panel.x, &*panel.x_unit), (&*panel.y, &*panel.y_unit));
    frame.draw_axes(drawing, x, y, LEFT - 20.0);
    draw_within(drawing, panel, &frame, labels);
    let across = Rectangle {
        width: WIDTH - RIGHT - LEFT,
        ..frame.within
    };
    draw_legend(drawing, panel, &across, labels);
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
                equal: false,
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
