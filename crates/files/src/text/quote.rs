//! Text in other languages: one function for each, whatever the text holds.
//!
//! CSV is [`crate::table::write`], SVG is `windfall_draw::svg`, and HTML is what `maud`
//! makes of it.

use std::fmt::Write;
use std::path::Path;

/// Longest text in a comment; characters. Engines read lines of 1024 bytes.
const LONGEST_COMMENT: usize = 200;

/// Characters without a form of their own: they change the order of what is shown, or hide.
const HIDDEN: [(char, char); 11] = [
    ('\u{ad}', '\u{ad}'),
    ('\u{61c}', '\u{61c}'),
    ('\u{180e}', '\u{180e}'),
    ('\u{200b}', '\u{200f}'),
    ('\u{2028}', '\u{202e}'),
    ('\u{2060}', '\u{206f}'),
    ('\u{fe00}', '\u{fe0f}'),
    ('\u{feff}', '\u{feff}'),
    ('\u{fff9}', '\u{fffb}'),
    ('\u{fffe}', '\u{ffff}'),
    ('\u{e0000}', '\u{e0fff}'),
];

/// Whether a character is not seen as itself: control characters, ends of lines, marks of
/// direction, what has no width.
pub fn is_hidden(own: char) -> bool {
    own.is_control()
        || HIDDEN
            .iter()
            .any(|(low, high)| (*low..=*high).contains(&own))
}

/// A text between double quotes, in a form that Python and TOML have in common.
pub fn string_text(text: &str) -> String {
    let mut whole = String::with_capacity(text.len() + 2);
    whole.push('"');
    for own in text.chars() {
        // Writing to a string cannot fail.
        let _ = match own {
            '"' | '\\' => write!(whole, "\\{own}"),
            own if is_hidden(own) && own > '\u{ffff}' => write!(whole, "\\U{:08x}", own as u32),
            own if is_hidden(own) => write!(whole, "\\u{:04x}", own as u32),
            own => write!(whole, "{own}"),
        };
    }
    whole.push('"');
    whole
}

/// A text as a comment of one line in a deck or a program, in which nothing is acted on, and
/// nothing at its end draws the next line into the comment: `&` of LAMMPS, `\` and the
/// trigraph `??/` of C++. What could do so is `_` or a blank; a long text is cut off.
pub fn comment_text(text: &str) -> String {
    let plain = |own: char| match own {
        '&' | '"' | '\'' | '$' | '\\' => '_',
        own if is_hidden(own) => ' ',
        own => own,
    };
    let mut characters = text.chars();
    let mut whole: String = characters
        .by_ref()
        .take(LONGEST_COMMENT)
        .map(plain)
        .collect();
    if characters.next().is_some() {
        whole.push('…');
    }
    whole.replace("??/", "??_")
}

/// A word as a shell takes it. Control characters are escaped as bash and zsh have it: a
/// terminal would act on them.
pub fn shell_word(word: &str) -> String {
    let plain = |own: char| own.is_ascii_alphanumeric() || "-_./=,:+@%".contains(own);
    // zsh takes what follows a first "=" for a command.
    if !word.is_empty() && !word.starts_with('=') && word.chars().all(plain) {
        return word.to_owned();
    }
    if !word.contains(is_hidden) {
        return format!("'{}'", word.replace('\'', r"'\''"));
    }
    let mut whole = "$'".to_owned();
    for own in word.chars() {
        match own {
            '\'' | '\\' => whole.extend(['\\', own]),
            own if is_hidden(own) => {
                // In octal, where no digit that follows can be taken along.
                for byte in own.encode_utf8(&mut [0; 4]).bytes() {
                    let _ = write!(whole, "\\{byte:03o}");
                }
            }
            own => whole.push(own),
        }
    }
    whole + "'"
}

/// A file or directory as an argument: none that would be an option.
pub fn path_word(path: impl AsRef<Path>) -> String {
    let path = path.as_ref().display().to_string();
    match path.starts_with('-') {
        true => format!("./{path}"),
        false => path,
    }
}

/// `windfall WORD …`, with what a shell would take apart in quotes.
pub fn command(words: &[&str]) -> String {
    let words = words.iter().map(|word| shell_word(word));
    let all = std::iter::once("windfall".to_owned()).chain(words);
    all.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_strings_of_python_and_toml() {
        for (text, written) in [
            ("Äpfel 🍏", r#""Äpfel 🍏""#),
            ("a\"b\\c", r#""a\"b\\c""#),
            ("a\nb\0", r#""a\u000ab\u0000""#),
            ("\u{202e}x", r#""\u202ex""#),
            ("\u{e0041}", r#""\U000e0041""#),
        ] {
            assert_eq!(string_text(text), written);
            let document = format!("text = {written}");
            let read: toml::Table = document.parse().unwrap();
            assert_eq!(read["text"].as_str(), Some(text));
        }
    }

    #[test]
    fn rejects_nothing_but_blanks_what_ends_a_comment() {
        for (text, written) in [
            ("apple\nimport os", "apple import os"),
            ("apple &", "apple _"),
            ("apple \\", "apple _"),
            ("apple ??/", "apple ??_"),
            ("${x} \"\"\" 'y'", "_{x} ___ _y_"),
            ("a\u{2028}b\u{85}c\u{202e}d", "a b c d"),
        ] {
            assert_eq!(comment_text(text), written);
        }
        let long = comment_text(&"🍏".repeat(5000));
        assert_eq!(long.chars().count(), LONGEST_COMMENT + 1);
        assert!(long.len() < 1000);
    }

    #[test]
    fn closed_form_quotes_what_a_shell_would_take_apart() {
        for (word, written) in [
            ("fit", "fit"),
            ("", "''"),
            ("it's here", r"'it'\''s here'"),
            ("$(id)", "'$(id)'"),
            ("=ls", "'=ls'"),
            ("a\n\u{1b}[2Jb'\\", r"$'a\012\033[2Jb\'\\'"),
            ("\u{202e}1", r"$'\342\200\2561'"),
        ] {
            assert_eq!(shell_word(word), written);
        }
    }
}
