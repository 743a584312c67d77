//! A small writer of SVG: what the figures of windfall are drawn with.

use std::fmt::Write;

/// Fonts of figures, as journals ask for them.
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// Where the text of a label is fixed to its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// Colours that colour-blind people tell apart.
///
/// # Source
/// M. Okabe, K. Ito (2008), "Color Universal Design".
pub const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// A drawing of a given size; px, y downwards.
#[derive(Clone, Debug)]
pub struct Drawing {
    width: f64,
    height: f64,
    body: String,
}

impl Drawing {
    /// An empty drawing on white.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            body: String::new(),
        }
    }

    /// A straight line of the colour of frames and ticks.
    pub fn rule(&mut self, from: (f64, f64), to: (f64, f64), colour: &str) {
        let _ = writeln!(
            self.body,
            r#"<line x1="{:.2}" y1="{:.2}" x2="{:.2}" y2="{:.2}" stroke="{colour}" stroke-width="0.8"/>"#,
            from.0, from.1, to.0, to.1
        );
    }

    /// A line through points.
    pub fn polyline(&mut self, points: &[(f64, f64)], colour: &str, width: f64) {
        self.body += r#"<polyline points=""#;
        for (x, y) in points {
            let _ = write!(self.body, "{x:.2},{y:.2} ");
        }
        let _ = writeln!(
            self.body,
            r#"" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>"#
        );
    }

    /// A dashed line through points.
    pub fn dashed(&mut self, points: &[(f64, f64)], colour: &str, width: f64) {
        self.body += r#"<polyline points=""#;
        for (x, y) in points {
            let _ = write!(self.body, "{x:.2},{y:.2} ");
        }
        let _ = writeln!(
            self.body,
            r#"" fill="none" stroke-dasharray="5 3" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>"#
        );
    }

    /// A tinted rectangle.
    ///
    /// * `size`: width and height; px
    pub fn tint(&mut self, at: (f64, f64), size: (f64, f64), colour: &str) {
        let _ = writeln!(
            self.body,
            r#"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="{colour}" fill-opacity="0.16"/>"#,
            at.0, at.1, size.0, size.1
        );
    }

    /// A dot.
    pub fn dot(&mut self, at: (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius}" fill="{colour}"/>"#,
            at.0, at.1
        );
    }

    /// A text; what XML would misread is escaped.
    pub fn text(&mut self, at: (f64, f64), anchor: Anchor, size: f64, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            r#"<text x="{:.2}" y="{:.2}" text-anchor="{anchor}" font-size="{size}">{}</text>"#,
            at.0,
            at.1,
            escaped(text)
        );
    }

    /// A text turned to read upwards, about its middle.
    pub fn turned_text(&mut self, at: (f64, f64), size: f64, text: &str) {
        let (x, y) = at;
        let _ = writeln!(
            self.body,
            r#"<text x="{x:.2}" y="{y:.2}" text-anchor="middle" font-size="{size}" transform="rotate(-90 {x:.2} {y:.2})">{}</text>"#,
            escaped(text)
        );
    }

    /// A circle that is not filled.
    pub fn ring(&mut self, at: (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius}" fill="none" stroke="{colour}" stroke-width="1.3"/>"#,
            at.0, at.1
        );
    }

    /// The whole as an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" fill=\"#222\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Text as it stands in XML; control characters, which XML cannot hold, become
/// blanks.
fn escaped(text: &str) -> String {
    let mut whole = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => whole += "&amp;",
            '<' => whole += "&lt;",
            '>' => whole += "&gt;",
            c if c.is_control() => whole.push(' '),
            c => whole.push(c),
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_text_is_escaped() {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.text((1.0, 2.0), Anchor::End, 9.0, "F < 3 & \u{1}g");
        assert!(drawing.svg().contains(">F &lt; 3 &amp;  g</text>"));
    }
}
