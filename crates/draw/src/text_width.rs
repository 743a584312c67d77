//! How wide text is in the font of the figures, so that nothing overlaps or is cut.

use crate::raised::{RAISED_SIZE, parts};

/// Advance widths of the characters from " " to "~" in Liberation Sans, which are those of Arial
/// and Helvetica; 1/2048 of the size of the letters.
const PLAIN: [u16; 95] = [
    569, 569, 727, 1139, 1139, 1821, 1366, 391, 682, 682, 797, 1196, 569, 682, 569, 569, 1139,
    1139, 1139, 1139, 1139, 1139, 1139, 1139, 1139, 1139, 569, 569, 1196, 1196, 1196, 1139, 2079,
    1366, 1366, 1479, 1479, 1366, 1251, 1593, 1479, 569, 1024, 1366, 1139, 1706, 1479, 1593, 1366,
    1593, 1479, 1366, 1251, 1479, 1366, 1933, 1366, 1366, 1251, 569, 569, 569, 961, 1139, 682,
    1139, 1139, 1024, 1139, 1139, 569, 1139, 1139, 455, 455, 1024, 455, 1706, 1139, 1139, 1139,
    1139, 682, 1024, 569, 1139, 1024, 1479, 1024, 1024, 1024, 684, 532, 684, 1196,
];

/// Of the characters that figures have besides.
const OTHERS: [(char, u16); 12] = [
    ('\u{a0}', 569),
    ('\u{2212}', 1196),
    ('·', 682),
    ('±', 1124),
    ('°', 819),
    ('µ', 1180),
    ('×', 1196),
    ('–', 1139),
    ('…', 2048),
    ('Δ', 1368),
    ('’', 455),
    ('χ', 1075),
];

/// At most of a letter with an accent or of another alphabet, and of anything else.
const LETTER: u16 = 1600;
const ANYTHING: u16 = 2560;

/// Width of a character; 1/2048 of the size of the letters. Of what is not in the tables it is at
/// least as wide as it can be.
fn advance(c: char) -> u16 {
    let plain = (c as usize).checked_sub(0x20);
    if let Some(width) = plain.and_then(|place| PLAIN.get(place)) {
        return *width;
    }
    match OTHERS.iter().find(|(own, _)| *own == c) {
        Some((_, width)) => *width,
        None if (c as u32) < 0x0590 => LETTER,
        None => ANYTHING,
    }
}

/// Width of a text in letters of this size; px. Raised parts count as they are drawn.
pub fn text_width(text: &str, size: f64) -> f64 {
    let width = |part: &str| part.chars().map(|c| f64::from(advance(c))).sum::<f64>();
    let parts = parts(text).into_iter();
    let parts = parts.map(|(part, raised)| width(&part) * if raised { RAISED_SIZE } else { 1.0 });
    parts.sum::<f64>() * size / 2048.0
}

/// A text that is no wider than this; px. What is left out is marked.
pub fn cut_to(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept: Vec<char> = text.chars().collect();
    loop {
        kept.pop();
        let cut: String = kept.iter().chain(&['…']).collect();
        if kept.is_empty() || text_width(&cut, size) <= width {
            return cut;
        }
    }
}

/// A text in lines that are no wider than this, broken between words; px. A word that is wider is
/// cut.
pub fn lines_of(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    // A number stays with its percent sign.
    for word in text.replace(" %", "\u{a0}%").split([' ', '\n']) {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|own| text_width(own, size) <= width) {
            Some(longer) => {
                lines.pop();
                lines.push(longer);
            }
            None => lines.push(cut_to(word, size, width)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// "N" is 1479, "m" 1706, "-" 682 and a digit 1139 of 2048 wide in the font.
    #[test]
    fn closed_form_widths_and_raised_parts() {
        assert!((text_width("Nm", 2048.0) - 3185.0).abs() < 1e-9);
        let raised = text_width("m²", 2048.0);
        assert!((raised - 1706.0 - RAISED_SIZE * 1139.0).abs() < 1e-9);
        assert_eq!(cut_to("mmmm", 2048.0, 1706.0 + 2048.0), "m…");
        assert_eq!(
            lines_of("mm mm 5 %", 2048.0, 4200.0),
            ["mm", "mm", "5\u{a0}%"]
        );
    }
}
