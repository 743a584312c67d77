//! Panels as a journal prints them: letters of one size, a grid that fits a width, one legend.

use crate::axis::{Axis, sparse, unit_label};
use crate::frame::{Frame, Rectangle};
use crate::grid_panel::{GridPanel, Scale, axis_of, inside};
use crate::panel::Panel;
use crate::panel_drawing::{
    Labels, draw_legend, draw_within, legend_height, own_legend, shared_legend,
};
use crate::svg::{Anchor, Drawing, Ink};
use crate::text_width::{cut_to, lines_of, text_width};
use crate::width::{LETTERS, Width};

/// Distance of lines of text; px.
const LINE: f64 = 13.0;

/// Room between panels side by side, and at the right end of each; px.
const GAP: f64 = 8.0;
const RIGHT: f64 = 16.0;

/// Room between labels of an axis; px.
const APART: f64 = 8.0;

/// Height of panels over their width, and the heights between which it holds; px.
const LOW: f64 = 0.66;
const LEAST: f64 = 110.0;
const MOST: f64 = 290.0;

/// How much higher panels are whose axes are equal; 1.
const EQUAL: f64 = 1.3;

/// Height of a page, and of the lowest panel; px.
const PAGE: f64 = 880.0;
const LOWEST: f64 = 96.0;

/// Most dots of a series: more cannot be told apart on paper, and make files large.
const MOST_DOTS: usize = 1500;

/// Height of a name at a vertical axis; px.
const NAME: f64 = 14.0;

/// Longest name at an axis; px.
const LONGEST_NAME: f64 = 110.0;

/// Which part of a figure is drawn.
pub(crate) struct Part {
    /// Panels of the figure that come before it.
    pub first: usize,
    /// Panels of the whole figure.
    pub whole: usize,
    /// Most height of axes, but where names need more; px.
    pub highest: f64,
}

impl Part {
    /// A figure of so many panels.
    pub fn all(whole: usize) -> Self {
        Self {
            first: 0,
            whole,
            highest: MOST,
        }
    }
}

/// A panel with what is measured of it before it is drawn.
struct Cell<'a> {
    own: &'a GridPanel,
    across: Axis,
    up: Axis,
    /// Lines of the title above it, and of those of the axes.
    title: Vec<String>,
    x_title: Vec<String>,
    y_title: Vec<String>,
    legend: Panel,
    /// Size of the rectangle of the axes.
    size: (f64, f64),
    /// Names that are turned upright, and their longest; px.
    steep: Option<f64>,
}

/// Draws panels in a grid that fits a width, no higher than a page as far as they can be lower.
///
/// Panels of a figure of several are lettered. What legends of several panels say is said once,
/// above all of them.
pub(crate) fn drawing_on_paper(
    panels: &[GridPanel],
    part: Part,
    notes: &[String],
    labels: &Labels,
    width: Width,
) -> Drawing {
    let labels = &Labels {
        size: LETTERS,
        line: LINE,
        most: MOST_DOTS,
        lines: labels.lines.clone(),
        ..*labels
    };
    let across = width.px();
    let columns = columns(panels, width);
    let cell = (across - GAP * (columns - 1) as f64) / columns as f64;
    let shown: Vec<&Panel> = panels.iter().map(|own| &own.panel).collect();
    let shared = shared_legend(&shown);
    let shared = own_legend(
        &shared,
        &Panel::new(("", ""), ("", ""), Vec::new()),
        LETTERS,
        across,
    );
    let laid = |highest: f64| {
        let height = (LOW * 0.75 * cell).max(LEAST).min(highest);
        let rooms = panels.iter().map(|own| room_beside(own, height));
        let left = rooms.fold(0.0, f64::max);
        let cells = panels.iter().enumerate().map(|(place, own)| {
            let letter = (part.whole > 1).then(|| letter_of(part.first + place));
            Cell::of(own, letter, &shared, (cell, left, highest))
        });
        let cells: Vec<Cell> = cells.collect();
        let rows = cells.chunks(columns).map(|row| Row::of(row, cell, labels));
        let rows: Vec<Row> = rows.collect();
        (cells, rows, left)
    };
    let (mut cells, mut rows, mut left) = laid(part.highest);
    let over = rows.iter().map(Row::height).sum::<f64>() - PAGE;
    if over > 0.0 {
        let plots: f64 = rows.iter().map(|own| own.plot).sum();
        (cells, rows, left) = laid(((plots - over) / rows.len() as f64).max(LOWEST));
    }

    let ends = (4.0, across);
    let top = match shared.series.is_empty() {
        true => 4.0,
        false => legend_height(&shared, ends, labels),
    };
    let notes = notes
        .iter()
        .flat_map(|own| lines_of(own, LETTERS, across - 8.0));
    let notes: Vec<String> = notes.collect();
    let panels: f64 = rows.iter().map(Row::height).sum();
    let total = top + panels + LINE * notes.len() as f64 + 4.0;
    let mut drawing = Drawing::at_width(Some(width), 0.0, total);
    let below = Rectangle {
        left: ends.0,
        top,
        width: across - ends.0,
        height: 0.0,
    };
    draw_legend(&mut drawing, &shared, &below, labels);
    let mut y = top;
    for (row, found) in cells.chunks(columns).zip(&rows) {
        for (place, own) in row.iter().enumerate() {
            let x = place as f64 * (cell + GAP);
            own.draw(&mut drawing, (x, y), (cell, left), (found, labels));
        }
        y += found.height();
    }
    for (line, note) in notes.iter().enumerate() {
        let at = (4.0, y + LINE * line as f64 + 9.0);
        drawing.text(at, Anchor::Start, LETTERS, note);
    }
    drawing
}

/// How many panels stand side by side: one where names at a horizontal axis need the width.
fn columns(panels: &[GridPanel], width: Width) -> usize {
    let columns = width.columns(panels.len());
    let room = width.px() / columns as f64 - 80.0;
    let crowded = panels.iter().any(|own| match &own.across {
        Scale::Names(names) => LINE * names.len() as f64 > room,
        _ => false,
    });
    if crowded { 1 } else { columns }
}

/// "(a)", "(b)" … and "(27)" after the alphabet.
fn letter_of(place: usize) -> String {
    let letter = u8::try_from(place).ok().filter(|own| *own < 26);
    match letter {
        Some(own) => format!("({})", char::from(b'a' + own)),
        None => format!("({})", place + 1),
    }
}

/// Room beside a panel of this height: labels of the vertical axis and its title; px.
fn room_beside(own: &GridPanel, height: f64) -> f64 {
    let axis = vertical(own, height);
    let widths = axis.labels.iter().map(|label| text_width(label, LETTERS));
    let title = upright_title(own, &axis, height);
    10.0 + widths.fold(0.0, f64::max) + LINE * title.len() as f64 + 8.0
}

/// Lines of the title of a vertical axis of this height; px.
fn upright_title(own: &GridPanel, axis: &Axis, height: f64) -> Vec<String> {
    let unit = unit_label(&own.panel.y_unit, axis.power);
    let title = format!("{}{unit}", own.panel.y);
    match title.as_str() {
        "" => Vec::new(),
        title => {
            let mut lines = lines_of(title, LETTERS, height + 8.0);
            lines.truncate(3);
            lines
        }
    }
}

/// The vertical axis of a panel of this height; px.
fn vertical(own: &GridPanel, height: f64) -> Axis {
    let (_, range) = own.ranges();
    let room = if own.panel.equal { 0.03 } else { 0.07 };
    let mut found = axis_of(&own.up, range, ((height / 34.0) as usize).clamp(3, 6), room);
    for label in &mut found.labels {
        *label = cut_to(label, LETTERS, LONGEST_NAME);
    }
    found
}

/// The horizontal axis of a panel of this width, with as many ticks as their labels leave room
/// for; px.
fn horizontal(own: &GridPanel, width: f64) -> Axis {
    let (range, _) = own.ranges();
    let fits = |axis: &Axis| {
        let place = |tick: &f64| width * (tick - axis.low) / (axis.high - axis.low);
        let ends = axis.ticks.iter().zip(&axis.labels).map(|(tick, label)| {
            let half = 0.5 * text_width(label, LETTERS);
            (place(tick) - half, place(tick) + half)
        });
        let ends: Vec<(f64, f64)> = ends.collect();
        ends.windows(2).all(|pair| pair[1].0 - pair[0].1 > APART)
    };
    let try_ticks = |count: &usize| axis_of(&own.across, range, *count, 0.03);
    let mut tried = [6, 5, 4, 3].iter().map(try_ticks);
    tried.find(fits).unwrap_or_else(|| match own.across {
        Scale::Names(_) => try_ticks(&3),
        _ => sparse(&try_ticks(&3)),
    })
}

/// Sizes that the panels of a row share; px.
struct Row {
    title: f64,
    legend: f64,
    plot: f64,
    below: f64,
}

impl Row {
    fn of(cells: &[Cell], width: f64, labels: &Labels) -> Self {
        let most = |of: &dyn Fn(&Cell) -> f64| cells.iter().map(of).fold(0.0, f64::max);
        Self {
            title: most(&|own| LINE * own.title.len() as f64),
            legend: most(&|own| match own.legend.series.is_empty() {
                true => 4.0,
                false => legend_height(&own.legend, (0.0, width - 4.0), labels),
            }),
            plot: most(&|own| own.size.1),
            below: most(&|own| own.below()),
        }
    }

    fn height(&self) -> f64 {
        self.title + self.legend + self.plot + self.below
    }
}

impl<'a> Cell<'a> {
    /// * `shared`: the legend above all panels
    /// * `cell`, `left`: width of the cell, and room beside its axes; px
    /// * `highest`: most height of its axes, but where names need more; px
    fn of(
        own: &'a GridPanel,
        letter: Option<String>,
        shared: &Panel,
        (cell, left, highest): (f64, f64, f64),
    ) -> Self {
        let panel = &own.panel;
        let width = cell - left - RIGHT;
        let height = match &own.up {
            Scale::Names(names) => (NAME * names.len() as f64).max(60.0),
            _ => (LOW * width).max(LEAST).min(highest),
        };
        let size = match panel.equal {
            true => [width.min(EQUAL * highest); 2].into(),
            false => (width, height),
        };
        let (mut across, up) = (horizontal(own, size.0), vertical(own, size.1));
        let mut steep = None;
        if let Scale::Names(names) = &own.across {
            let room = size.0 / names.len().max(1) as f64;
            let widest = |names: &[String]| {
                let widths = names.iter().map(|name| text_width(name, LETTERS));
                widths.fold(0.0, f64::max)
            };
            across.labels = names
                .iter()
                .map(|own| cut_to(own, LETTERS, LONGEST_NAME))
                .collect();
            steep = (widest(&across.labels) > room - 4.0).then(|| widest(&across.labels));
        }
        let words = [letter.unwrap_or_default(), own.title.clone()].join(" ");
        let lines = |text: &str, width: f64| match text.trim() {
            "" => Vec::new(),
            text => lines_of(text, LETTERS, width),
        };
        let x_title = format!("{}{}", panel.x, unit_label(&panel.x_unit, across.power));
        Self {
            title: lines(&words, cell - 4.0),
            x_title: lines(&x_title, size.0 + RIGHT + 0.5 * left),
            y_title: upright_title(own, &up, size.1),
            legend: own_legend(panel, shared, LETTERS, cell - 4.0),
            own,
            across,
            up,
            size,
            steep,
        }
    }

    /// Room below the axes; px.
    fn below(&self) -> f64 {
        let labels = self.steep.unwrap_or(LINE) + 6.0;
        labels + LINE * self.x_title.len() as f64 + 14.0
    }

    fn draw(
        &self,
        drawing: &mut Drawing,
        (x, y): (f64, f64),
        (cell, left): (f64, f64),
        (row, labels): (&Row, &Labels),
    ) {
        for (line, text) in self.title.iter().enumerate() {
            let at = (x + 4.0, y + 10.0 + LINE * line as f64);
            drawing.text(at, Anchor::Start, LETTERS, text);
        }
        let within = Rectangle {
            left: x + left,
            top: y + row.title + row.legend,
            width: self.size.0,
            height: self.size.1,
        };
        let mut frame = Frame {
            within,
            across: self.across.clone(),
            up: self.up.clone(),
        };
        let empty = self.own.is_empty();
        if empty {
            frame.across.ticks.clear();
            frame.up.ticks.clear();
        }
        frame.draw_grid(drawing);
        self.draw_axes(drawing, &frame, left);
        if empty {
            return self.draw_reason(drawing, &frame.within);
        }
        draw_within(drawing, &inside(&self.own.panel, &frame), &frame, labels);
        let across = Rectangle {
            left: x + 4.0,
            width: cell - 4.0,
            ..frame.within
        };
        draw_legend(drawing, &self.legend, &across, labels);
        for (at, text) in &self.own.texts {
            let (x, y) = frame.place(*at);
            drawing.text_over(
                (x, y + 3.6),
                (Anchor::Middle, LETTERS),
                text,
                Ink::Background,
            );
        }
    }

    fn draw_axes(&self, drawing: &mut Drawing, frame: &Frame, left: f64) {
        let within = &frame.within;
        match self.steep {
            None => frame.draw_ticks(drawing),
            Some(_) => {
                let names = frame.across.labels.iter();
                for (tick, name) in frame.across.ticks.iter().zip(names) {
                    let (x, _) = frame.place((*tick, frame.up.low));
                    drawing.steep_text((x + 3.8, within.bottom() + 6.0), LETTERS, name);
                }
                let mut bare = frame.clone();
                bare.across.ticks.clear();
                bare.draw_ticks(drawing);
            }
        }
        let middle = within.left + 0.5 * within.width;
        let first = within.bottom() + self.steep.unwrap_or(LINE) + 6.0 + LINE;
        for (line, text) in self.x_title.iter().enumerate() {
            // A title that is wider than its axis stays within the cell.
            let half = 0.5 * text_width(text, LETTERS);
            let at = middle.min(within.right() + RIGHT - half);
            drawing.text(
                (at, first + LINE * line as f64),
                Anchor::Middle,
                LETTERS,
                text,
            );
        }
        let middle = within.top + 0.5 * within.height;
        for (line, text) in self.y_title.iter().enumerate() {
            let x = within.left - left + LINE * (line + 1) as f64;
            drawing.turned_text((x, middle), LETTERS, text);
        }
    }

    fn draw_reason(&self, drawing: &mut Drawing, within: &Rectangle) {
        let why = match self.own.empty.as_str() {
            "" => "no finite numbers to draw",
            why => why,
        };
        let middle = within.left + 0.5 * within.width;
        let top = within.top + 0.3 * within.height;
        for (line, text) in lines_of(why, LETTERS, 0.9 * within.width)
            .iter()
            .enumerate()
        {
            let at = (middle, top + LINE * line as f64);
            drawing.text(at, Anchor::Middle, LETTERS, text);
        }
    }
}
