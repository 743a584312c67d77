//! Figures of small panels side by side: diagnostics of a model, groups, effects.

use crate::frame::{Frame, Rectangle};
use crate::grid_panel::{CHARACTER, LONGEST_NAME, axis_of, cut, cut_apart, fitting, inside};
pub use crate::grid_panel::{GridPanel, Scale};
use crate::panel::Panel;
use crate::panel_drawing::{
    Labels, MOST_POINTS, draw_legend, draw_within, legend_height, named_lines,
};
use crate::paper::{Part, drawing_on_paper};
use crate::svg::{Anchor, Drawing, Ink};
use crate::width::Width;

/// Room around a panel and above all of them; px.
const RIGHT: f64 = 14.0;
const BELOW: f64 = 50.0;
const TITLE: f64 = 20.0;
const TOP: f64 = 34.0;

/// Room beside an axis of numbers; px.
const BESIDE: f64 = 58.0;

/// Height of a line of the notes below the panels; px.
const NOTE: f64 = 14.0;

/// Width of a character of titles, and of labels; px.
const TITLE_CHARACTER: f64 = 6.3;
const LABEL_CHARACTER: f64 = 5.8;

/// Labels within small panels.
pub(crate) fn small_labels(lines: Vec<usize>) -> Labels {
    Labels {
        size: 10.0,
        line: 10.5,
        ring: 3.6,
        dots: (1.9, 1.2),
        alike: true,
        whole: true,
        most: MOST_POINTS,
        lines,
    }
}

/// A figure of panels side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Its title.
    pub title: String,
    /// Panels, row after row.
    pub panels: Vec<GridPanel>,
    /// How many stand side by side.
    pub columns: usize,
    /// Width and height of each panel; px.
    pub size: (f64, f64),
    /// What a reader must know, below the panels.
    pub notes: Vec<String>,
}

/// Draws a grid, whose colours a theme names later, at a width on paper or as large as it is.
///
/// A panel without a finite point shows why it is empty. Places beyond the ends of a scale are
/// not drawn.
pub fn drawing_of_grid(grid: &Grid, paper: Option<Width>) -> Drawing {
    let labels = &small_labels(named_lines(grid.panels.iter().map(|own| &own.panel)));
    match paper {
        Some(width) => {
            let part = Part::all(grid.panels.len());
            drawing_on_paper(&grid.panels, part, &grid.notes, labels, width)
        }
        None => plain_drawing(grid, labels),
    }
}

fn plain_drawing(grid: &Grid, labels: &Labels) -> Drawing {
    let columns = grid.columns.clamp(1, grid.panels.len().max(1));
    let (width, height) = grid.size;
    let beside = grid.panels.iter().map(room_beside).fold(BESIDE, f64::max);
    let step = beside + width + RIGHT;
    let whole = step * columns as f64;
    let legend = |own: &GridPanel| {
        legend_height(&with_short_labels(&own.panel, width), (0.0, width), labels)
    };
    let rows: Vec<f64> = grid
        .panels
        .chunks(columns)
        .map(|row| row.iter().map(legend).fold(0.0, f64::max))
        .collect();
    let notes = grid.notes.iter();
    let letters = ((whole - 28.0) / CHARACTER) as usize;
    let notes: Vec<String> = notes.flat_map(|note| wrapped(note, letters)).collect();
    let titled = grid.panels.iter().any(|own| !own.title.is_empty());
    let above = if titled { TITLE } else { 0.0 };
    let panels: f64 = rows.iter().map(|own| above + own + height + BELOW).sum();
    let total = TOP + panels + NOTE * notes.len() as f64 + 8.0;
    let mut drawing = Drawing::new(whole, total);
    drawing.text((14.0, 22.0), Anchor::Start, 13.0, &grid.title);
    let mut top = TOP;
    for (row, legend) in grid.panels.chunks(columns).zip(&rows) {
        for (place, own) in row.iter().enumerate() {
            let within = Rectangle {
                left: place as f64 * step + beside,
                top: top + above + legend,
                width,
                height,
            };
            let title = (within.left, top + 14.0);
            let most = (step / TITLE_CHARACTER) as usize;
            drawing.text(title, Anchor::Start, 11.5, &cut(&own.title, most));
            draw_panel(&mut drawing, own, within, labels);
        }
        top += above + legend + height + BELOW;
    }
    for (line, note) in notes.iter().enumerate() {
        let at = (14.0, top + NOTE * line as f64 + 6.0);
        drawing.text(at, Anchor::Start, 10.5, note);
    }
    drawing
}

/// Room beside a panel for the longest name at its vertical axis; px.
fn room_beside(own: &GridPanel) -> f64 {
    let Scale::Names(names) = &own.up else {
        return BESIDE;
    };
    let longest = names.iter().map(|name| name.chars().count()).max();
    let longest = longest.unwrap_or(0).min(LONGEST_NAME);
    40.0 + CHARACTER * longest as f64
}

fn draw_panel(drawing: &mut Drawing, own: &GridPanel, within: Rectangle, labels: &Labels) {
    let empty = own.is_empty();
    let (x, y) = own.ranges();
    let across = axis_of(&own.across, x, 5, 0.03);
    let up = axis_of(&own.up, y, 5, if own.panel.equal { 0.03 } else { 0.1 });
    let side = match own.panel.equal {
        true => within.width.min(within.height),
        false => within.width,
    };
    let (whole, within) = (
        within,
        Rectangle {
            width: side,
            ..within
        },
    );
    let mut frame = Frame { within, across, up };
    if empty {
        frame.across.ticks.clear();
        frame.up.ticks.clear();
    }
    if let Scale::Names(names) = &own.across {
        frame.across.labels = fitting(names, within.width / names.len().max(1) as f64);
    }
    frame.draw_grid(drawing);
    let panel = &own.panel;
    let (x, y) = ((&*panel.x, &*panel.x_unit), (&*panel.y, &*panel.y_unit));
    frame.draw_axes(drawing, x, y, room_beside(own) - 14.0);
    if empty {
        let why = match own.empty.is_empty() {
            true => "no finite numbers to draw",
            false => &own.empty,
        };
        let letters = (0.9 * within.width / CHARACTER) as usize;
        let middle = within.left + 0.5 * within.width;
        for (line, text) in wrapped(why, letters).iter().enumerate() {
            let at = (
                middle,
                within.top + 0.35 * within.height + NOTE * line as f64,
            );
            drawing.text(at, Anchor::Middle, 10.5, text);
        }
        return;
    }
    draw_within(drawing, &inside(panel, &frame), &frame, labels);
    let legend = with_short_labels(panel, whole.width);
    draw_legend(drawing, &legend, &whole, labels);
    for (at, text) in &own.texts {
        let (x, y) = frame.place(*at);
        drawing.text_over((x, y + 3.6), (Anchor::Middle, 10.5), text, Ink::Background);
    }
}

/// The panel with labels of its legend that end within a width; px.
fn with_short_labels(panel: &Panel, width: f64) -> Panel {
    let most = ((width - 24.0) / LABEL_CHARACTER) as usize;
    let mut panel = panel.clone();
    let given = panel.series.iter().map(|own| own.label.clone());
    let given: Vec<String> = given.filter(|own| !own.is_empty()).collect();
    let mut short = cut_apart(&given, most).into_iter();
    for series in &mut panel.series {
        if !series.label.is_empty() {
            series.label = short.next().unwrap_or_default();
        }
        series.points.clear();
    }
    panel
}

/// A text in lines of at most so many characters, broken between words.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    // A number stays with its percent sign.
    for word in text.replace(" %", "\u{a0}%").split([' ', '\n']) {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::{Series, Style};
    use crate::theme::LIGHT;

    fn panel(points: Vec<(f64, f64)>) -> GridPanel {
        let series = vec![Series::new("rows", Style::Dots, points)];
        GridPanel::new("title", Panel::new(("x", ""), ("y", "N"), series))
    }

    fn svg(panels: Vec<GridPanel>) -> String {
        let grid = Grid {
            title: "a grid".to_owned(),
            panels,
            columns: 2,
            size: (200.0, 180.0),
            notes: vec!["a note".to_owned()],
        };
        drawing_of_grid(&grid, None).svg(&LIGHT)
    }

    #[test]
    fn closed_form_an_empty_panel_says_why() {
        let mut own = panel(vec![(f64::NAN, 1.0)]);
        own.empty = "no degrees of freedom are left".to_owned();
        let text = svg(vec![own, panel(Vec::new())]);
        assert!(text.contains("no degrees of freedom") && text.contains("no finite numbers"));
        assert!(!text.contains("NaN") && !text.contains("circle"), "{text}");
    }

    /// What lies beyond the ends is not drawn; names stand at whole places and are cut.
    #[test]
    fn closed_form_scales() {
        let mut own = panel(vec![(0.0, 1.0), (1.0, 2.0), (1.0, 9.0)]);
        own.up = Scale::Between(0.0, 3.0);
        let names = ["Gala", "a name that is far too long for its place"];
        own.across = Scale::Names(names.map(str::to_owned).to_vec());
        let text = svg(vec![own]);
        // Two points, and three dots of the legend.
        assert_eq!(text.matches("<circle").count(), 2 + 3);
        assert!(
            text.contains(">Gala<") && text.contains("a name that is f…"),
            "{text}"
        );
        let mut own = panel(vec![(0.0, 1.0), (1.0, 2.0)]);
        own.up = Scale::Reaching(0.0, 0.0);
        assert_eq!(axis_of(&own.up, (1.0, 2.0), 5, 0.06).low, 0.0);
    }

    /// Names that begin alike are told apart by what differs.
    #[test]
    fn closed_form_names_are_cut_apart() {
        let cut = |names: &[&str]| {
            cut_apart(
                &names
                    .iter()
                    .map(|own| (*own).to_owned())
                    .collect::<Vec<_>>(),
                9,
            )
            .join(" | ")
        };
        let lots = [
            "Golden Delicious (lot 1 of the store)",
            "Golden Delicious (lot 12 of the store)",
        ];
        assert_eq!(cut(&lots), "…1… | …12…");
        assert_eq!(cut(&["Gala of the north", "Fuji"]), "Gala of … | Fuji");
        assert_eq!(
            cut(&["aaaaaaaaaaaa1", "aaaaaaaaaaaa2"]),
            "aaaaaaaa… | aaaaaaaa…"
        );
        assert_eq!(
            cut(&["a b c d e f g h 1", "a b c d e f g h 1"]),
            "a b c d … | a b c d …"
        );
        assert_eq!(cut(&[]), "");
    }

    #[test]
    fn closed_form_lines_break_between_words() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("incomprehensible", 5), ["incomprehensible"]);
        assert!(svg(vec![panel(vec![(1.0, 1.0)]); 3]).contains("a note"));
    }
}
