//! A recording as a figure: one panel per channel over a shared time axis.

use windfall_draw::axis::{Axis, axis, unit_label};
use windfall_draw::curve::{Curve, CurvePoint};
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::text_width::{cut_to, text_width};
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Most panels of a figure.
pub const MOST_PANELS: usize = 12;

/// Size of a figure and its parts; px.
const WIDTH: f64 = 720.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 52.0;
const PANEL: f64 = 118.0;
const GAP: f64 = 30.0;
const BOTTOM: f64 = 46.0;

/// Times beyond this many lengths of the recording are counted from a round beginning.
const FAR: f64 = 100.0;

/// Up to this many points are drawn as dots as well.
const DOTS: usize = 150;

/// Draws the channels of a recording, at most [`MOST_PANELS`] of them.
///
/// Channels that overlap in time share an axis; others have their own.
///
/// * `width`: on paper; as wide as a screen shows it if left out
pub fn drawing_of_curves(title: &str, curves: &[Curve], width: Option<Width>) -> Drawing {
    let shown = &curves[..curves.len().min(MOST_PANELS)];
    let groups: Vec<&[Curve]> = shown
        .chunk_by(|a, b| a.timed == b.timed && overlap(a, b))
        .collect();
    let axes = groups.len().max(1) as f64;
    let panels = shown.len().max(1) as f64;
    let height = TOP + panels * (PANEL + GAP) - GAP + axes * BOTTOM;
    let right = width.map_or(WIDTH, Width::px) - RIGHT;
    let mut drawing = Drawing::at_width(width, WIDTH, height);
    let room = right - LEFT - 100.0;
    let title = cut_to(title, drawing.letters(13.0), room);
    drawing.text((LEFT, 20.0), Anchor::Start, 13.0, &title);
    if shown.len() < curves.len() {
        let more = format!("{} of {} channels", shown.len(), curves.len());
        drawing.text((right, 20.0), Anchor::End, 11.0, &more);
    }
    let (mut top, mut index) = (TOP, 0);
    for group in groups {
        let time = TimeAxis::of(group, right);
        for curve in group {
            panel(&mut drawing, curve, &time, top, Ink::Series(index));
            top += PANEL + GAP;
            index += 1;
        }
        time.labels(&mut drawing, top - GAP);
        top += BOTTOM;
    }
    drawing
}

/// Whether two channels were recorded at the same time, in part.
fn overlap(a: &Curve, b: &Curve) -> bool {
    match (range(a), range(b)) {
        (Some(a), Some(b)) => a.0 <= b.1 && b.0 <= a.1,
        _ => true,
    }
}

fn range(curve: &Curve) -> Option<(f64, f64)> {
    Some((curve.points.first()?.x, curve.points.last()?.x))
}

/// The shared axis of time, in a unit that suits its length.
struct TimeAxis {
    axis: Axis,
    /// Taken off times that are long beside the recording; s.
    zero: f64,
    scale: f64,
    title: String,
    /// Right end of the axis; px.
    right: f64,
}

impl TimeAxis {
    fn of(curves: &[Curve], right: f64) -> Self {
        let points = || curves.iter().flat_map(|curve| &curve.points);
        let low = points().map(|p| p.x).fold(f64::INFINITY, f64::min);
        let high = points().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = match low <= high {
            true => (low, high),
            false => (0.0, 1.0),
        };
        let timed = curves.iter().all(|curve| curve.timed);
        let (scale, unit) = match high - low {
            _ if !timed => (1.0, ""),
            span if span < 1e-3 => (1e6, "µs"),
            span if span < 1.0 => (1e3, "ms"),
            _ => (1.0, "s"),
        };
        let ticks = ((right - LEFT) / 75.0).round().clamp(3.0, 8.0) as usize;
        // Seconds since 1970, for example, would need ten digits at every tick.
        let zero = match low.abs() > FAR * (high - low) && high > low {
            true => low.floor(),
            false => 0.0,
        };
        let axis = axis((low - zero) * scale, (high - zero) * scale, ticks);
        let name = match timed {
            true => "time",
            false => "sample",
        };
        let since = match zero {
            0.0 => String::new(),
            zero => format!(" since {zero} s"),
        };
        let title = format!("{name}{since}{}", unit_label(unit, axis.power));
        Self {
            axis,
            zero,
            scale,
            title,
            right,
        }
    }

    fn place(&self, x: f64) -> f64 {
        let part =
            ((x - self.zero) * self.scale - self.axis.low) / (self.axis.high - self.axis.low);
        LEFT + part * (self.right - LEFT)
    }

    fn tick(&self, tick: f64) -> f64 {
        self.place(tick / self.scale + self.zero)
    }

    fn labels(&self, drawing: &mut Drawing, bottom: f64) {
        for (tick, label) in self.axis.ticks.iter().zip(&self.axis.labels) {
            drawing.text(
                (self.tick(*tick), bottom + 15.0),
                Anchor::Middle,
                10.5,
                label,
            );
        }
        let middle = 0.5 * (LEFT + self.right);
        drawing.text((middle, bottom + 33.0), Anchor::Middle, 11.5, &self.title);
    }
}

fn panel(drawing: &mut Drawing, curve: &Curve, time: &TimeAxis, top: f64, ink: Ink) {
    let low = curve
        .points
        .iter()
        .map(|p| p.smallest)
        .fold(f64::INFINITY, f64::min);
    let high = curve
        .points
        .iter()
        .map(|p| p.largest)
        .fold(f64::NEG_INFINITY, f64::max);
    let (low, high) = match low <= high {
        true => (low, high),
        false => (0.0, 1.0),
    };
    let room = 0.06 * (high - low);
    let values = axis(low - room, high + room, 4);
    let place = |y: f64| top + PANEL * (values.high - y) / (values.high - values.low);
    let (left, right) = (LEFT, time.right);

    for tick in &time.axis.ticks {
        let x = time.tick(*tick);
        drawing.rule((x, top), (x, top + PANEL), Ink::Grid);
        drawing.rule((x, top + PANEL), (x, top + PANEL + 4.0), Ink::Frame);
    }
    for (tick, label) in values.ticks.iter().zip(&values.labels) {
        let y = place(*tick);
        drawing.rule((left, y), (right, y), Ink::Grid);
        drawing.rule((left - 4.0, y), (left, y), Ink::Frame);
        drawing.text((left - 7.0, y + 3.6), Anchor::End, 10.5, label);
    }
    drawing.rule((left, top), (left, top + PANEL), Ink::Frame);
    drawing.rule((left, top + PANEL), (right, top + PANEL), Ink::Frame);
    // A unit that the name already says is not said again.
    let unit = curve.unit.as_deref().unwrap_or("");
    let said =
        curve.name.contains(&format!("({unit})")) || curve.name.contains(&format!("[{unit}]"));
    let unit = unit_label(if said { "" } else { unit }, values.power);
    let size = drawing.letters(11.5);
    let name = cut_to(&curve.name, size, right - left - text_width(&unit, size));
    let title = format!("{name}{unit}");
    drawing.text((left, top - 6.0), Anchor::Start, 11.5, &title);

    let line = outline(&curve.points, |x| time.place(x), place);
    drawing.polyline(&line, ink, 1.1);
    if curve.points.len() <= DOTS {
        for point in &curve.points {
            drawing.dot((time.place(point.x), place(point.first)), 1.9, ink);
        }
    }
}

/// A line through first, smallest, largest and last of each column of pixels.
fn outline(
    points: &[CurvePoint],
    place_x: impl Fn(f64) -> f64,
    place_y: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let column = |point: &CurvePoint| (2.0 * place_x(point.x)).round();
    let mut line: Vec<(f64, f64)> = Vec::new();
    for group in points.chunk_by(|a, b| column(a) == column(b)) {
        let (Some(first), Some(last)) = (group.first(), group.last()) else {
            continue;
        };
        let smallest = group
            .iter()
            .map(|p| p.smallest)
            .fold(f64::INFINITY, f64::min);
        let largest = group
            .iter()
            .map(|p| p.largest)
            .fold(f64::NEG_INFINITY, f64::max);
        let x = match group.len() {
            1 => place_x(first.x),
            _ => 0.5 * column(first),
        };
        for value in [first.first, smallest, largest, last.last] {
            let at = (x, place_y(value));
            if line.last() != Some(&at) {
                line.push(at);
            }
        }
    }
    line
}

/// What the figure shows, as CSV: one row per stretch of a channel.
pub fn csv_of_curves(curves: &[Curve]) -> Result<String, Error> {
    let header = ["channel", "time_s", "first", "smallest", "largest", "last"];
    let rows = curves.iter().take(MOST_PANELS).flat_map(|curve| {
        curve.points.iter().map(|p| {
            vec![
                curve.name.clone(),
                p.x.to_string(),
                p.first.to_string(),
                p.smallest.to_string(),
                p.largest.to_string(),
                p.last.to_string(),
            ]
        })
    });
    csv_text(&header.map(str::to_owned), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_draw::theme::LIGHT;

    fn point(x: f64, y: f64) -> CurvePoint {
        CurvePoint {
            x,
            first: y,
            last: y,
            smallest: y,
            largest: y,
        }
    }

    #[test]
    fn conserves_a_spike_of_one_sample_among_many() {
        let mut points: Vec<CurvePoint> = (0..4000).map(|i| point(f64::from(i), 0.0)).collect();
        points[1234] = point(1234.0, 9.0);
        let line = outline(&points, |x| x / 10.0, |y| y);
        assert!(
            line.iter()
                .any(|(x, y)| *y == 9.0 && (x - 123.4).abs() < 0.5)
        );
        assert!(line.len() < 2000);
    }

    #[test]
    fn closed_form_few_points_are_drawn_where_they_are() {
        let points = [point(0.0, 1.0), point(100.0, 2.0)];
        let line = outline(&points, |x| x, |y| 10.0 * y);
        assert_eq!(line, [(0.0, 10.0), (100.0, 20.0)]);
    }

    #[test]
    fn closed_form_no_channels_no_panic() {
        let svg = drawing_of_curves("nothing", &[], None).svg(&LIGHT);
        assert!(svg.ends_with("</svg>\n"));
        let empty = Curve {
            name: "x".to_owned(),
            unit: None,
            timed: false,
            points: Vec::new(),
        };
        let svg = drawing_of_curves("empty", &[empty], None).svg(&LIGHT);
        assert!(svg.contains("sample"));
    }
}
