//! A channel as a small plot in a terminal, drawn with braille dots.

use crate::curve::Curve;
use std::fmt::Write;
use windfall_files::text::number::plain;

/// First of the 256 braille patterns.
const BRAILLE: u32 = 0x2800;

/// Bit of a dot in its pattern, by column and row.
const DOT_BITS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Width of the labels at the left; characters.
const LABEL: usize = 11;

/// A channel as lines of text.
///
/// * `columns`: width of the terminal; characters
/// * `rows`: height of the plot; characters
pub fn terminal_plot(curve: &Curve, columns: usize, rows: usize) -> String {
    let width = columns.saturating_sub(LABEL + 1).clamp(10, 200);
    let unit = curve.unit.as_deref().filter(|unit| {
        let said = [format!("({unit})"), format!("[{unit}]")];
        !said.iter().any(|said| curve.name.contains(said))
    });
    let unit = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
    let mut text = format!("{}{unit}\n", curve.name);
    let points = &curve.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return text + "  no samples\n";
    };
    let low = points
        .iter()
        .map(|p| p.smallest)
        .fold(f64::INFINITY, f64::min);
    let high = points
        .iter()
        .map(|p| p.largest)
        .fold(f64::NEG_INFINITY, f64::max);
    let dots = dots(curve, (low, high), (2 * width, 4 * rows));
    for row in 0..rows {
        let label = match row {
            0 => plain(high),
            row if row + 1 == rows => plain(low),
            _ => String::new(),
        };
        let line: String = (0..width)
            .map(|column| cell(&dots, 2 * width, column, row))
            .collect();
        let _ = writeln!(
            text,
            "{label:>LABEL$} {}",
            line.trim_end_matches('\u{2800}')
        );
    }
    let unit = if curve.timed { " s" } else { "" };
    let (start, end) = (
        format!("{}{unit}", plain(first.x)),
        format!("{}{unit}", plain(last.x)),
    );
    let room = width.saturating_sub(start.chars().count());
    let _ = writeln!(text, "{:LABEL$} {start}{end:>room$}", "");
    text
}

/// Which dots are set, row by row.
fn dots(curve: &Curve, (low, high): (f64, f64), (width, height): (usize, usize)) -> Vec<bool> {
    let (first, last) = (curve.points[0].x, curve.points[curve.points.len() - 1].x);
    let span = if last > first { last - first } else { 1.0 };
    let range = if high > low { high - low } else { 1.0 };
    let column = |x: f64| (((x - first) / span) * (width - 1) as f64).round() as usize;
    let row = |y: f64| (((high - y) / range) * (height - 1) as f64).round() as usize;
    let mut dots = vec![false; width * height];
    let mut set = |x: usize, from: usize, to: usize| {
        for y in from.min(to)..=from.max(to) {
            dots[y.min(height - 1) * width + x.min(width - 1)] = true;
        }
    };
    let mut before: Option<(usize, usize)> = None;
    for point in &curve.points {
        let x = column(point.x);
        set(x, row(point.smallest), row(point.largest));
        if let Some((x0, y0)) = before {
            // Columns without a point are joined by a straight line.
            let y1 = row(point.first);
            let y_at = |at: usize| {
                let part = (at - x0) as f64 / (x - x0).max(1) as f64;
                (y0 as f64 + (y1 as f64 - y0 as f64) * part).round() as usize
            };
            for at in x0 + 1..=x {
                set(at, y_at(at - 1), y_at(at));
            }
        }
        before = Some((x, row(point.last)));
    }
    dots
}

fn cell(dots: &[bool], width: usize, column: usize, row: usize) -> char {
    let mut pattern = BRAILLE;
    for (x, bits) in DOT_BITS.iter().enumerate() {
        for (y, bit) in bits.iter().enumerate() {
            if dots[(4 * row + y) * width + 2 * column + x] {
                pattern |= bit;
            }
        }
    }
    char::from_u32(pattern).unwrap_or(' ')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::CurvePoint;

    #[test]
    fn closed_form_a_rising_line() {
        let points = (0..=39).map(|i| {
            let y = f64::from(i);
            CurvePoint {
                x: y,
                first: y,
                last: y,
                smallest: y,
                largest: y,
            }
        });
        let curve = Curve {
            name: "force (N)".to_owned(),
            unit: Some("N".to_owned()),
            timed: true,
            points: points.collect(),
        };
        let text = terminal_plot(&curve, LABEL + 1 + 20, 10);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "force (N)");
        assert_eq!(lines.len(), 12);
        // 40 points on 40 × 40 dots: the diagonal, two dots high by the joins.
        let blank = "\u{2800}".repeat(18);
        assert_eq!(lines[1].trim_start(), format!("39.00 {blank}⣠⠞"));
        assert_eq!(lines[10].trim_start(), "0 ⣠⠞⠁");
        assert!(lines[11].trim_start().starts_with("0 s") && lines[11].ends_with("39.00 s"));
    }
}
