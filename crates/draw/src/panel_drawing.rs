//! Panels drawn into their frames: series, named places, legends.

use crate::frame::{Frame, Rectangle};
use crate::panel::{Panel, Series, Side, Style};
use crate::svg::{Anchor, Drawing, Ink};
use crate::text_width::{cut_to, text_width};

/// A tint narrower than this could not be seen; px.
const LEAST_TINT: f64 = 2.0;

/// Height of a line of the legend; px.
const LEGEND_LINE: f64 = 15.0;

/// How much wider text is where a machine has none of the fonts that are asked for; 1.
const OTHER_FONT: f64 = 1.1;

/// Fewer points than this are drawn larger.
const FEW_POINTS: usize = 150;

/// More points than this are thinned to what the eye can tell.
pub(crate) const MOST_POINTS: usize = 4000;

/// Sizes of the labels within a panel; px.
pub(crate) struct Labels {
    /// Size of the letters.
    pub size: f64,
    /// Least distance of the lines of two labels that stand above each other.
    pub line: f64,
    /// Radius of the ring around a named place.
    pub ring: f64,
    /// Radius of dots: of few, and of many.
    pub dots: (f64, f64),
    /// Whether dots of all series are as large as those of the longest.
    pub alike: bool,
    /// Whether all points are drawn but those of lines: the caller has thinned them.
    pub whole: bool,
    /// Most points of a series, where they are thinned here.
    pub most: usize,
    /// Colours of the lines that a legend names, each once: the first is a full line, the others
    /// have dashes of their own.
    pub lines: Vec<usize>,
}

/// Colours of the named lines of some panels, in the order in which they come.
pub(crate) fn named_lines<'a>(panels: impl Iterator<Item = &'a Panel>) -> Vec<usize> {
    let mut found = Vec::new();
    for panel in panels {
        for (index, own) in labelled(panel) {
            let colour = own.colour.unwrap_or(index);
            if own.style == Style::Line && !found.contains(&colour) {
                found.push(colour);
            }
        }
    }
    found
}

/// What a legend says of a series.
type Entry = (String, Style, usize);

fn entries(panel: &Panel) -> Vec<Entry> {
    let entry = |(index, own): (usize, &Series)| {
        (own.label.clone(), own.style, own.colour.unwrap_or(index))
    };
    labelled(panel).into_iter().map(entry).collect()
}

/// A panel with nothing but a legend: what the legends of several of these panels say, once.
pub(crate) fn shared_legend(panels: &[&Panel]) -> Panel {
    let of_panels: Vec<Vec<Entry>> = panels.iter().map(|own| entries(own)).collect();
    let mut shared: Vec<Series> = Vec::new();
    for entry in of_panels.iter().flatten() {
        let again = of_panels.iter().filter(|own| own.contains(entry)).count() > 1;
        let (label, style, colour) = entry;
        let new = !shared
            .iter()
            .any(|own| own.label == *label && own.style == *style);
        if again && new {
            shared.push(Series::new(label, *style, Vec::new()).coloured(*colour));
        }
    }
    Panel::new(("", ""), ("", ""), shared)
}

/// The legend of a panel without what a shared one says, its labels no wider than this; px.
pub(crate) fn own_legend(panel: &Panel, shared: &Panel, size: f64, width: f64) -> Panel {
    let said = entries(shared);
    let own = entries(panel).into_iter().filter(|own| !said.contains(own));
    let series = own.map(|(label, style, colour)| {
        Series::new(cut_to(&label, size, width - 24.0), style, Vec::new()).coloured(colour)
    });
    Panel::new(("", ""), ("", ""), series.collect())
}

fn labelled(panel: &Panel) -> Vec<(usize, &Series)> {
    let series = panel.series.iter().enumerate();
    series
        .filter(|(_, series)| !series.label.is_empty())
        .collect()
}

/// Legend entries between two ends by their line and place in it.
fn legend_places(panel: &Panel, (left, right): (f64, f64), labels: &Labels) -> Vec<(usize, f64)> {
    let (mut line, mut x) = (0, left);
    labelled(panel)
        .iter()
        .map(|(_, series)| {
            let width = 36.0 + OTHER_FONT * text_width(&series.label, labels.size);
            if x + width > right && x > left {
                (line, x) = (line + 1, left);
            }
            let place = (line, x);
            x += width;
            place
        })
        .collect()
}

/// Height of the legend of a panel with these ends, with the room below it; px.
pub(crate) fn legend_height(panel: &Panel, ends: (f64, f64), labels: &Labels) -> f64 {
    let places = legend_places(panel, ends, labels);
    let lines = places.last().map_or(0, |(line, _)| line + 1);
    12.0 + LEGEND_LINE * lines as f64
}

/// Range of what a panel shows that is finite.
pub(crate) fn range(panel: &Panel, pick: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
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

/// What a panel shows of each axis: the same of both where they are equal.
pub(crate) fn shown_ranges(panel: &Panel) -> ((f64, f64), (f64, f64)) {
    let (x, y) = (range(panel, |point| point.0), range(panel, |point| point.1));
    let both = (x.0.min(y.0), x.1.max(y.1));
    match panel.equal {
        true => (both, both),
        false => (x, y),
    }
}

/// Draws the series and the named places of a panel into its frame.
pub(crate) fn draw_within(drawing: &mut Drawing, panel: &Panel, frame: &Frame, labels: &Labels) {
    let within = &frame.within;
    let (left, right, top, bottom) = (within.left, within.right(), within.top, within.bottom());
    // Tints first; lines over a cloud of dots, a few dots over lines.
    let layer = |series: &Series| match series.style {
        Style::Shade | Style::Band => 0,
        Style::Dots if series.points.len() >= FEW_POINTS => 1,
        Style::Dots => 3,
        Style::Spots | Style::ThickBars | Style::LevelThickBars => 4,
        _ => 2,
    };
    let dots = panel.series.iter().filter(|own| own.style == Style::Dots);
    let longest = dots.map(|own| own.points.len()).max().unwrap_or(0);
    let many = (labels.alike && longest >= FEW_POINTS).then_some(labels.dots.1);
    let labels = &Labels {
        dots: (many.unwrap_or(labels.dots.0), labels.dots.1),
        lines: labels.lines.clone(),
        ..*labels
    };
    for drawn in 0..=4 {
        let series = panel.series.iter().enumerate();
        for (index, series) in series.filter(|(_, s)| layer(s) == drawn) {
            let index = series.colour.unwrap_or(index);
            let points: Vec<(f64, f64)> = thinned(series, labels.whole, labels.most)
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .map(|point| frame.place(point))
                .collect();
            match series.style {
                Style::Level => points.iter().for_each(|(_, y)| {
                    draw_series(
                        drawing,
                        &[(left, *y), (right, *y)],
                        (Style::Level, index),
                        labels,
                    );
                }),
                Style::Upright => points.iter().for_each(|(x, _)| {
                    draw_series(
                        drawing,
                        &[(*x, top), (*x, bottom)],
                        (Style::Upright, index),
                        labels,
                    );
                }),
                Style::Shade => points.chunks_exact(2).for_each(|ends| {
                    let width = (ends[1].0 - ends[0].0).max(LEAST_TINT);
                    drawing.tint((ends[0].0, top), (width, within.height), Ink::Series(index));
                }),
                style => draw_series(drawing, &points, (style, index), labels),
            }
        }
    }
    draw_marks(drawing, panel, frame, labels);
}

/// Named places. Where labels would cover each other or other places, the first is shown; the data
/// have all.
fn draw_marks(drawing: &mut Drawing, panel: &Panel, frame: &Frame, labels: &Labels) {
    let (left, right, top) = (frame.within.left, frame.within.right(), frame.within.top);
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for mark in &panel.marks {
        let at = frame.place(mark.at);
        drawing.ring(at, labels.ring, Ink::Text);
        let length = text_width(&mark.label, labels.size);
        let place = |side: Side| {
            let (x, y, anchor) = match side {
                Side::AboveLeft => (at.0 - 9.0, at.1 - 7.0, Anchor::End),
                Side::BelowRight => (at.0 + 9.0, at.1 + 13.0, Anchor::Start),
            };
            let y = y.clamp(top + 0.9 * labels.size, frame.within.bottom() - 3.0);
            // A label that would leave the panel moves to the other side.
            let (x, anchor) = match anchor {
                Anchor::End if x - length < left => (at.0 + 9.0, Anchor::Start),
                Anchor::Start if x + length > right => (at.0 - 9.0, Anchor::End),
                anchor => (x, anchor),
            };
            let (from, to) = match anchor {
                Anchor::End => (x - length, x),
                _ => (x, x + length),
            };
            ((x, y), anchor, (from, to))
        };
        let covers = |(y, (from, to)): (f64, (f64, f64))| {
            let mut taken = taken.iter();
            taken.any(|(a, b, level)| *a < to && from < *b && (level - y).abs() < labels.line)
        };
        let meets = |(y, (from, to)): (f64, (f64, f64))| {
            let others = panel.marks.iter().filter(|own| own.at != mark.at);
            let mut others = others.map(|own| frame.place(own.at));
            let high = 0.5 * labels.line + labels.ring;
            others.any(|(px, py)| {
                let middle = y - 0.35 * labels.size;
                px > from - labels.ring && px < to + labels.ring && (py - middle).abs() < high
            })
        };
        // Rather on the other side than over another place.
        let other = match mark.side {
            Side::AboveLeft => Side::BelowRight,
            Side::BelowRight => Side::AboveLeft,
        };
        let free = |side: &Side| {
            let ((_, y), _, ends) = place(*side);
            !covers((y, ends)) && !meets((y, ends))
        };
        let side = match [mark.side, other].into_iter().find(free) {
            None if taken.is_empty() => mark.side,
            None => continue,
            Some(side) => side,
        };
        let ((x, y), anchor, (from, to)) = place(side);
        drawing.text((x, y), anchor, labels.size, &mark.label);
        taken.push((from, to, y));
    }
}

/// Draws the legend of a panel above a rectangle, as wide as it.
pub(crate) fn draw_legend(
    drawing: &mut Drawing,
    panel: &Panel,
    below: &Rectangle,
    labels: &Labels,
) {
    let ends = (below.left, below.right());
    let base = below.top - legend_height(panel, ends, labels) + 4.0;
    let places = legend_places(panel, ends, labels);
    for ((index, series), (line, x)) in labelled(panel).into_iter().zip(places) {
        let index = series.colour.unwrap_or(index);
        let y = base + LEGEND_LINE * line as f64 + 4.0;
        let sample = match series.style {
            Style::Upright => [(x + 9.0, y - 5.0), (x + 9.0, y), (x + 9.0, y + 5.0)],
            Style::Shade | Style::Band => [(x, y - 5.0), (x + 18.0, y + 5.0), (x, y)],
            Style::Bars | Style::ThickBars => [(x + 9.0, y - 6.0), (x + 9.0, y + 6.0), (x, y)],
            _ => [(x, y), (x + 9.0, y), (x + 18.0, y)],
        };
        let style = match series.style {
            Style::Band => Style::Shade,
            style => style,
        };
        let sample = match style {
            Style::Spots => &sample[1..2],
            _ => &sample[..],
        };
        draw_series(drawing, sample, (style, index), labels);
        drawing.text(
            (x + 24.0, y + 3.8),
            Anchor::Start,
            labels.size,
            &series.label,
        );
    }
}

/// * `index`: position of the series, which has its colour, the shape of its dots and the dashes of
///   its line
fn draw_series(
    drawing: &mut Drawing,
    points: &[(f64, f64)],
    (style, index): (Style, usize),
    labels: &Labels,
) {
    let ink = Ink::Series(index);
    match style {
        Style::Level | Style::Dashed => drawing.dashed(points, ink, 1.4),
        Style::Upright => drawing.polyline(points, ink, 0.8),
        Style::Shade => {
            let [from, to] = [points[0], points[1]];
            drawing.tint(from, (to.0 - from.0, to.1 - from.1), ink);
        }
        Style::Line => {
            let among = labels.lines.iter().position(|own| *own == index);
            drawing.patterned(points, among.unwrap_or(0), ink, 1.4);
        }
        Style::Broad => drawing.polyline(points, ink, 4.0),
        Style::Band => drawing.tinted_shape(points, ink),
        Style::Bars | Style::LevelBars => {
            for ends in points.chunks_exact(2) {
                drawing.polyline(ends, ink, 0.8);
            }
        }
        Style::ThickBars | Style::LevelThickBars => {
            for ends in points.chunks_exact(2) {
                drawing.polyline(ends, ink, 2.0);
            }
        }
        Style::Spots => points.iter().for_each(|at| drawing.spot(*at, 3.2, ink)),
        Style::Dots => {
            let (few, many) = labels.dots;
            let radius = if points.len() < FEW_POINTS { few } else { many };
            for point in points {
                drawing.mark(*point, radius, index, ink);
            }
        }
    }
}

/// Every point, or so many that the eye sees no difference: of a line the lowest
/// and the highest of each stretch, so that no peak is lost; pairs stay together.
fn thinned(series: &Series, whole: bool, most: usize) -> Box<dyn Iterator<Item = (f64, f64)> + '_> {
    let points = &series.points;
    let most = match series.style {
        Style::Dots => most,
        _ => MOST_POINTS,
    };
    let step = points.len().div_ceil(most).max(1);
    match series.style {
        Style::Line if step > 1 => Box::new(points.chunks(2 * step).flat_map(extremes)),
        _ if whole || step == 1 => Box::new(points.iter().copied()),
        style if style.has_ends() && style != Style::Band => {
            Box::new(points.chunks(2).step_by(step).flatten().copied())
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::Mark;

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
        let drawn: Vec<(f64, f64)> = thinned(&series, false, MOST_POINTS).collect();
        assert!(drawn.len() <= MOST_POINTS && drawn.contains(&(12_345.0, 9.0)));
        assert!(drawn.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        // Of bars whole ones are left out, and none where the caller has thinned them.
        let bars = Series {
            style: Style::Bars,
            ..series
        };
        let drawn: Vec<(f64, f64)> = thinned(&bars, false, MOST_POINTS).collect();
        assert!(drawn.len() <= MOST_POINTS);
        assert!(drawn.chunks(2).all(|own| own[1].0 == own[0].0 + 1.0));
        assert_eq!(thinned(&bars, true, MOST_POINTS).count(), 20_000);
    }

    /// Places that lie close together keep their rings, and only labels that cover none of them.
    #[test]
    fn closed_form_labels_cover_no_other_place() {
        let marks = (0..12).map(|i| Mark {
            label: format!("{}: 12.345 N", i + 1),
            at: (100.0 * (1.0 - 0.6_f64.powi(i)), 40.0 * 0.5_f64.powi(i)),
            side: Side::BelowRight,
        });
        let line = Series::new("force", Style::Line, vec![(0.0, 0.0), (110.0, 44.0)]);
        let panel = Panel {
            marks: marks.collect(),
            ..Panel::new(("time", "ms"), ("force", "N"), vec![line])
        };
        let figure = crate::xy::Figure {
            title: "drop".to_owned(),
            panels: vec![panel],
        };
        let svg = crate::xy::svg_of_figure(&figure, &crate::theme::LIGHT);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let number = |node: &roxmltree::Node, name: &str| -> f64 {
            node.attribute(name).unwrap().parse().unwrap()
        };
        let named = |name: &'static str| {
            let all = document.descendants();
            all.filter(move |node| node.has_tag_name(name))
                .collect::<Vec<_>>()
        };
        let rings: Vec<(f64, f64)> = named("circle")
            .iter()
            .map(|node| (number(node, "cx"), number(node, "cy")))
            .collect();
        assert_eq!(rings.len(), 12);
        let text = |node: &roxmltree::Node| node.text().unwrap_or_default().to_owned();
        let labels: Vec<_> = named("text")
            .into_iter()
            .filter(|node| text(node).ends_with(" N"))
            .collect();
        assert!((3..12).contains(&labels.len()), "{}", labels.len());
        for label in labels {
            let size = number(&label, "font-size");
            let (x, y, length) = (
                number(&label, "x"),
                number(&label, "y"),
                text_width(&text(&label), size),
            );
            let left = match label.attribute("text-anchor") {
                Some("end") => x - length,
                _ => x,
            };
            let inside = |(cx, cy): &(f64, f64)| {
                (left..left + length).contains(cx) && (y - 0.7 * size..y).contains(cy)
            };
            assert!(!rings.iter().any(inside), "{}", text(&label));
        }
    }
}
