//! A small writer of SVG: what the figures of windfall are drawn with.

use crate::colour_map::{Rgb, css};
use crate::raised::{RAISED_SIZE, parts};
use crate::shapes::{PATTERNS, SHAPES, shading};
use crate::theme::{SCALE, SERIES, Theme};
use crate::width::{LEAST_LINE, LETTERS, Width, mm_text};
use std::collections::BTreeSet;
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

/// What something is drawn with; the [`Theme`] says which colour that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Axes and ticks.
    Frame,
    /// Lines behind the data.
    Grid,
    /// Text, and rings around named places.
    Text,
    /// The colour behind everything.
    Background,
    /// Series of this number; the colours repeat after [`SERIES`].
    Series(usize),
    /// This step of the scale from low to high; steps beyond it are its ends.
    Scale(usize),
}

/// First of the characters that stand for colours until the theme is known. Text
/// cannot hold them: they are for private use, and [`escaped`] blanks them.
const FIRST_INK: u32 = 0xE000;

/// Colours besides those of series.
const PLAIN_INKS: usize = 4;

impl Ink {
    /// The character that stands for it.
    fn mark(self) -> char {
        let index = match self {
            Self::Frame => 0,
            Self::Grid => 1,
            Self::Text => 2,
            Self::Background => 3,
            Self::Series(series) => PLAIN_INKS + series % SERIES,
            Self::Scale(step) => PLAIN_INKS + SERIES + step.min(SCALE - 1),
        };
        char::from_u32(FIRST_INK + index as u32).unwrap_or(' ')
    }
}

/// Colour that a character stands for, if it stands for one.
fn colour_of(mark: char, theme: &Theme) -> Option<&'static str> {
    let index = (mark as u32).checked_sub(FIRST_INK)? as usize;
    let plain = [theme.frame, theme.grid, theme.text, theme.background];
    let inks = plain.iter().chain(&theme.series).chain(&theme.scale);
    inks.copied().nth(index)
}

/// A drawing of a given size; px, y downwards.
#[derive(Clone, Debug)]
pub struct Drawing {
    width: f64,
    height: f64,
    /// Whether its size on paper is given: then all letters have one size, and lines are not
    /// thinner than a press can print.
    paper: bool,
    /// Part at the top that is not shown: that of a title which is left out; px.
    above: f64,
    body: String,
    /// Colours of balls: each has a shading of its own.
    balls: BTreeSet<Rgb>,
}

impl Drawing {
    /// An empty drawing.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            paper: false,
            above: 0.0,
            body: String::new(),
            balls: BTreeSet::new(),
        }
    }

    /// An empty drawing that is printed at a width; of [`new`](Self::new) where none is given.
    ///
    /// * `plain`: width where none is given; px
    pub fn at_width(width: Option<Width>, plain: f64, height: f64) -> Self {
        let drawing = Self::new(width.map_or(plain, Width::px), height);
        Self {
            paper: width.is_some(),
            ..drawing
        }
    }

    /// Draws the title of a figure at its top. On paper there is none, as the caption says it, and
    /// its room is left out.
    ///
    /// * `room`: how far down the title reaches; px
    pub fn title(&mut self, left: f64, room: f64, title: &str) {
        match self.paper {
            true => self.above = room,
            false => self.text((left, 22.0), Anchor::Start, 13.0, title),
        }
    }

    /// Size of letters that are drawn with this one; px.
    pub fn letters(&self, size: f64) -> f64 {
        if self.paper { LETTERS } else { size }
    }

    /// Width of lines that are drawn with this one; px.
    fn stroke(&self, width: f64) -> f64 {
        match self.paper {
            true => width.max((LEAST_LINE * 1e3).ceil() / 1e3),
            false => width,
        }
    }

    /// A straight line of the colour of frames and ticks.
    pub fn rule(&mut self, from: (f64, f64), to: (f64, f64), ink: Ink) {
        let ink = ink.mark();
        let _ = writeln!(
            self.body,
            r#"<line x1="{:.2}" y1="{:.2}" x2="{:.2}" y2="{:.2}" stroke="{ink}" stroke-width="0.8"/>"#,
            from.0, from.1, to.0, to.1
        );
    }

    /// A line through points.
    pub fn polyline(&mut self, points: &[(f64, f64)], ink: Ink, width: f64) {
        self.line(points, "", ink, width);
    }

    /// A dashed line through points.
    pub fn dashed(&mut self, points: &[(f64, f64)], ink: Ink, width: f64) {
        self.line(points, r#" stroke-dasharray="5 3""#, ink, width);
    }

    /// A line through points in the dashes of this number, so that lines can be told apart without
    /// colours; 0 is a full line.
    pub fn patterned(&mut self, points: &[(f64, f64)], pattern: usize, ink: Ink, width: f64) {
        let dashes = match PATTERNS[pattern % PATTERNS.len()] {
            "" => String::new(),
            dashes => format!(r#" stroke-dasharray="{dashes}""#),
        };
        self.line(points, &dashes, ink, width);
    }

    fn line(&mut self, points: &[(f64, f64)], dashes: &str, ink: Ink, width: f64) {
        let width = self.stroke(width);
        let look = format!(
            r#"fill="none"{dashes} stroke="{}" stroke-width="{width}" stroke-linejoin="round""#,
            ink.mark()
        );
        self.through("polyline", points, 2, &look);
    }

    /// An element with points, each with so many decimals.
    fn through(&mut self, element: &str, points: &[(f64, f64)], decimals: usize, look: &str) {
        let _ = write!(self.body, r#"<{element} points=""#);
        for (x, y) in points {
            let _ = write!(self.body, "{x:.decimals$},{y:.decimals$} ");
        }
        let _ = writeln!(self.body, r#"" {look}/>"#);
    }

    /// A tinted rectangle.
    ///
    /// * `size`: width and height; px
    pub fn tint(&mut self, at: (f64, f64), size: (f64, f64), ink: Ink) {
        let ink = ink.mark();
        let _ = writeln!(
            self.body,
            r#"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="{ink}" fill-opacity="0.16"/>"#,
            at.0, at.1, size.0, size.1
        );
    }

    /// A dot.
    pub fn dot(&mut self, at: (f64, f64), radius: f64, ink: Ink) {
        let ink = ink.mark();
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius}" fill="{ink}"/>"#,
            at.0, at.1
        );
    }

    /// A filled mark of this shape, as large as a [`dot`](Self::dot): series can be told apart
    /// without colours. 0 is a dot.
    pub fn mark(&mut self, at: (f64, f64), radius: f64, shape: usize, ink: Ink) {
        let corners = match SHAPES[shape % SHAPES.len()] {
            [] => return self.dot(at, radius, ink),
            corners => corners.iter(),
        };
        let corners: Vec<(f64, f64)> = corners
            .map(|(x, y)| (at.0 + radius * x, at.1 + radius * y))
            .collect();
        let look = format!(r#"fill="{}""#, ink.mark());
        self.through("polygon", &corners, 2, &look);
    }

    /// A text; what XML would misread is escaped.
    pub fn text(&mut self, at: (f64, f64), anchor: Anchor, size: f64, text: &str) {
        let size = self.letters(size);
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
            set_text(text, size)
        );
    }

    /// A text turned to read upwards, about its middle.
    pub fn turned_text(&mut self, at: (f64, f64), size: f64, text: &str) {
        self.upwards(at, "middle", size, text);
    }

    /// A text turned to read upwards, which ends at its place.
    pub fn steep_text(&mut self, at: (f64, f64), size: f64, text: &str) {
        self.upwards(at, "end", size, text);
    }

    fn upwards(&mut self, (x, y): (f64, f64), anchor: &str, size: f64, text: &str) {
        let size = self.letters(size);
        let _ = writeln!(
            self.body,
            r#"<text x="{x:.2}" y="{y:.2}" text-anchor="{anchor}" font-size="{size}" transform="rotate(-90 {x:.2} {y:.2})">{}</text>"#,
            set_text(text, size)
        );
    }

    /// A circle that is not filled.
    pub fn ring(&mut self, at: (f64, f64), radius: f64, ink: Ink) {
        let ink = ink.mark();
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius}" fill="none" stroke="{ink}" stroke-width="1.3"/>"#,
            at.0, at.1
        );
    }

    /// A tinted shape with corners at points.
    pub fn tinted_shape(&mut self, points: &[(f64, f64)], ink: Ink) {
        self.veil(points, ink, 0.16);
    }

    /// A filled area that closed lines enclose: what lies within an odd number of
    /// them.
    pub fn area(&mut self, loops: &[Vec<(f64, f64)>], ink: Ink) {
        let ink = ink.mark();
        self.body += r#"<path d=""#;
        for points in loops {
            for (index, (x, y)) in points.iter().enumerate() {
                let command = if index == 0 { 'M' } else { 'L' };
                let _ = write!(self.body, "{command}{x:.1} {y:.1}");
            }
            self.body.push('Z');
        }
        let _ = writeln!(self.body, r#"" fill="{ink}" fill-rule="evenodd"/>"#);
    }

    /// A filled shape with corners at points, within a thin line.
    pub fn facet(&mut self, points: &[(f64, f64)], fill: Ink, edge: Ink) {
        let look = format!(
            r#"fill="{}" stroke="{}" stroke-width="{}" stroke-linejoin="round""#,
            fill.mark(),
            edge.mark(),
            self.stroke(0.5)
        );
        self.through("polygon", points, 1, &look);
    }

    /// A filled circle within a line of the background's colour, which sets it off
    /// from what is below it.
    pub fn spot(&mut self, at: (f64, f64), radius: f64, ink: Ink) {
        let (ink, around) = (ink.mark(), Ink::Background.mark());
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius}" fill="{ink}" stroke="{around}" stroke-width="1.2"/>"#,
            at.0, at.1
        );
    }

    /// A ball lit from above on the left.
    pub fn ball(&mut self, at: (f64, f64), radius: f64, colour: Rgb) {
        self.balls.insert(colour);
        let name = &css(colour)[1..];
        let _ = writeln!(
            self.body,
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius:.2}" fill="url(#ball-{name})"/>"#,
            at.0, at.1
        );
    }

    /// An upright bar of colours, the first at its foot.
    pub fn colour_bar(&mut self, at: (f64, f64), size: (f64, f64), colours: &[Rgb]) {
        self.body += r#"<linearGradient id="colours" x1="0" y1="1" x2="0" y2="0">"#;
        let last = colours.len().saturating_sub(1).max(1) as f64;
        for (k, colour) in colours.iter().enumerate() {
            let (offset, colour) = (k as f64 / last, css(*colour));
            let _ = write!(
                self.body,
                r#"<stop offset="{offset:.4}" stop-color="{colour}"/>"#
            );
        }
        let _ = writeln!(
            self.body,
            r#"</linearGradient><rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="url(#colours)"/>"#,
            at.0, at.1, size.0, size.1
        );
    }

    /// A translucent shape with corners at points.
    pub fn veil(&mut self, points: &[(f64, f64)], ink: Ink, opacity: f64) {
        let look = format!(r#"fill="{}" fill-opacity="{opacity}""#, ink.mark());
        self.through("polygon", points, 2, &look);
    }

    /// A thin translucent line.
    pub fn faint_line(&mut self, [from, to]: [(f64, f64); 2], ink: Ink, opacity: f64) {
        let ink = ink.mark();
        let _ = writeln!(
            self.body,
            r#"<line x1="{:.2}" y1="{:.2}" x2="{:.2}" y2="{:.2}" stroke="{ink}" stroke-width="0.9" stroke-opacity="{opacity}" stroke-linecap="round"/>"#,
            from.0, from.1, to.0, to.1
        );
    }

    /// [`text`](Self::text) with a rim of another colour, to be read over lines.
    pub fn text_over(
        &mut self,
        at: (f64, f64),
        (anchor, size): (Anchor, f64),
        text: &str,
        rim: Ink,
    ) {
        let rim = rim.mark();
        let _ = write!(
            self.body,
            r#"<g stroke="{rim}" stroke-width="3" stroke-linejoin="round" paint-order="stroke">"#
        );
        self.text(at, anchor, size, text);
        self.body += "</g>\n";
    }

    /// The whole as an SVG file.
    pub fn svg(&self, theme: &Theme) -> String {
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}",
            self.element(theme, "")
        )
    }

    /// The whole as an element of a page, described by `label` for those who do not
    /// see it; "" for a picture that is described elsewhere.
    pub fn element(&self, theme: &Theme, label: &str) -> String {
        let (width, height, above) = (self.width, self.height - self.above, self.above);
        let size = |length: f64| match self.paper {
            true => mm_text(length),
            false => length.to_string(),
        };
        let at = match above {
            0.0 => String::new(),
            above => format!(r#" y="{above}""#),
        };
        let (across, down) = (size(width), size(height));
        let described = match label {
            "" => String::new(),
            label => format!(r#" role="img" aria-label="{}""#, escaped(label)),
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{across}\" height=\"{down}\" \
             viewBox=\"0 {above} {width} {height}\" font-family=\"{FONTS}\" fill=\"{}\"{described}>\n\
             <rect{at} width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
            theme.text, theme.background
        );
        for colour in &self.balls {
            svg += &shading(*colour);
        }
        for c in self.body.chars() {
            match colour_of(c, theme) {
                Some(colour) => svg += colour,
                None => svg.push(c),
            }
        }
        svg + "</svg>\n"
    }
}

/// Text escaped for XML; what XML cannot hold (control characters, U+FFFE and U+FFFF)
/// becomes a blank, and so do characters that stand for colours.
fn escaped(text: &str) -> String {
    let mut whole = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => whole += "&amp;",
            '<' => whole += "&lt;",
            '>' => whole += "&gt;",
            '"' => whole += "&quot;",
            '\u{E000}'..='\u{F8FF}' => whole.push(' '),
            '\u{FFFE}' | '\u{FFFF}' => whole.push(' '),
            c if c.is_control() => whole.push(' '),
            c => whole.push(c),
        }
    }
    whole
}

/// Most characters of a text that is drawn; further ones would lie outside of the picture, and
/// the time to lay them out grows with their square.
const LONGEST: usize = 500;

/// [`escaped`] text whose raised parts are set as such at font size `size`.
fn set_text(text: &str, size: f64) -> String {
    if let Some((end, _)) = text.char_indices().nth(LONGEST) {
        return set_text(&text[..end], size) + "…";
    }
    let rise = 0.36 * size;
    let (mut whole, mut above) = (String::new(), false);
    for (part, raised) in parts(text) {
        let part = escaped(&part);
        let _ = match (raised, above) {
            (true, _) => write!(
                whole,
                r#"<tspan dy="{:.2}" font-size="{:.2}">{part}</tspan>"#,
                -rise,
                RAISED_SIZE * size
            ),
            // Back to the line.
            (false, true) => write!(whole, r#"<tspan dy="{rise:.2}">{part}</tspan>"#),
            (false, false) => write!(whole, "{part}"),
        };
        above = raised;
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raised::RAISED;
    use crate::theme::{DARK, LIGHT};
    use proptest::prelude::Strategy;

    #[test]
    fn closed_form_text_is_escaped() {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.text((1.0, 2.0), Anchor::End, 9.0, "F < 3 & \u{1}g");
        let svg = drawing.svg(&LIGHT);
        assert!(svg.contains(">F &lt; 3 &amp;  g</text>"));
    }

    #[test]
    fn closed_form_a_long_text_ends_with_an_ellipsis() {
        let long = "y".repeat(LONGEST);
        assert_eq!(set_text(&long, 9.0), long);
        assert_eq!(set_text(&(long.clone() + "zz"), 9.0), long + "…");
    }

    #[test]
    fn closed_form_inks_get_the_colours_of_the_theme_and_text_keeps_none() {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.rule((0.0, 0.0), (1.0, 1.0), Ink::Series(SERIES + 1));
        drawing.text((1.0, 2.0), Anchor::End, 9.0, "\u{E000}a");
        for theme in [&LIGHT, &DARK] {
            let svg = drawing.svg(theme);
            let stroke = format!(r#"stroke="{}""#, theme.series[1]);
            assert!(svg.contains(&stroke) && svg.contains("> a</text>"), "{svg}");
            assert!(!svg.contains('\u{E000}'));
        }
    }

    /// An XML parser finds the drawing as it was drawn, whatever its words are.
    fn check_words(words: &str) {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.text((1.0, 2.0), Anchor::End, 9.0, words);
        let svg = drawing.element(&LIGHT, words);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let blank = |c: char| match c {
            '\u{E000}'..='\u{F8FF}' | '\u{FFFE}' | '\u{FFFF}' => ' ',
            c if c.is_control() => ' ',
            c => c,
        };
        let expected: String = words.chars().map(blank).collect();
        let names = document.descendants().filter(|own| own.is_element());
        let names = names.map(|own| own.tag_name().name());
        let names: Vec<_> = names.filter(|name| *name != "tspan").collect();
        assert_eq!(names, ["svg", "rect", "text"], "{words:?}");
        let root = document.root_element();
        let label = root.attribute("aria-label").unwrap_or_default();
        assert_eq!(label, expected);
        let texts = root.descendants().filter(|own| own.is_text());
        let written: String = texts.filter_map(|own| own.text()).collect();
        let raised = |c: char| c == '^' || RAISED.iter().any(|(own, _)| *own == c);
        if !words.contains(raised) {
            assert_eq!(written, format!("\n\n{expected}\n"));
        }
    }

    proptest::proptest! {
        #![proptest_config(proptest::test_runner::Config::with_cases(2000))]
        #[test]
        fn repeats_any_words(pieces in proptest::collection::vec(
            proptest::prop_oneof![
                proptest::sample::select(vec![
                    "<", ">", "&", "\"", "'", "]]>", "<![CDATA[", "<!--", "-->", "</text>", "</svg>", "<?xml",
                    "<script>hit()</script>", "\" onload=\"hit()", "&amp;", "&#10;", "&lt", "\0", "\n", "\r",
                    "\u{85}", "\u{2028}", "\u{E000}", "\u{FFFE}", "\u{FFFF}", "^2", "²", "🍏", "a",
                ]).prop_map(str::to_owned),
                proptest::prelude::any::<String>(),
            ],
            1..6,
        )) {
            check_words(&pieces.concat());
        }
    }

    #[test]
    fn closed_form_powers_are_raised_and_what_follows_is_not() {
        assert_eq!(
            set_text("10⁻³ m/s²", 10.0),
            "10<tspan dy=\"-3.60\" font-size=\"7.20\">\u{2212}3</tspan>\
             <tspan dy=\"3.60\"> m/s</tspan><tspan dy=\"-3.60\" font-size=\"7.20\">2</tspan>"
        );
        let found = parts("k (N/m^1.5) f^ 2");
        let words: Vec<&str> = found.iter().map(|(part, _)| part.as_str()).collect();
        assert_eq!(words, ["k (N/m", "1.5", ") f^ 2"]);
    }
}
