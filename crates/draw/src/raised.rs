//! Parts of a text that are raised: digits above the line, and powers.

/// Size of raised parts over that of the text; 1.
pub(crate) const RAISED_SIZE: f64 = 0.72;

/// Characters above the line with those that they are raised from. Few fonts have
/// all of them, and of different heights.
pub(crate) const RAISED: [(char, char); 12] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '\u{2212}'),
    ('˙', '.'),
];

/// Text in parts, each with whether it is raised: raised characters, and numbers
/// behind a "^".
pub(crate) fn parts(text: &str) -> Vec<(String, bool)> {
    let mut parts: Vec<(String, bool)> = Vec::new();
    let mut push = |c: char, raised: bool| match parts.last_mut() {
        Some((part, of)) if *of == raised => part.push(c),
        _ => parts.push((c.to_string(), raised)),
    };
    let mut exponent = false;
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let number = |c: &char| c.is_ascii_digit() || ".-".contains(*c);
        if c == '^' && characters.peek().is_some_and(number) {
            exponent = true;
            continue;
        }
        exponent &= number(&c);
        let raised = RAISED.iter().find(|(from, _)| *from == c);
        match (raised, exponent) {
            (Some((_, to)), _) => push(*to, true),
            (None, true) => push(if c == '-' { '\u{2212}' } else { c }, true),
            (None, false) => push(c, false),
        }
    }
    parts
}
