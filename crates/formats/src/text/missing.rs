//! Words and numbers that stand for a missing sample.

use crate::text::number::{Marks, number};

/// The usual words, in lower case and with a decimal point.
const USUAL: &[&str] = &[
    // Python, R, databases.
    "nan",
    "-nan",
    "+nan",
    "na",
    "<na>",
    "n/a",
    "n.a.",
    "null",
    "nil",
    "none",
    "missing",
    // Written by hand.
    "-",
    "--",
    "---",
    "\u{2013}",
    "\u{2014}",
    ".",
    "?",
    // Meters and amplifiers out of range.
    "ovld",
    "ovl",
    "ol",
    "+ol",
    "-ol",
    "ovf",
    "over",
    "overload",
    "overflow",
    "overrange",
    "over range",
    "inf",
    "+inf",
    "-inf",
    "infinity",
    "+infinity",
    "-infinity",
    "\u{221e}",
    "-\u{221e}",
    // Spreadsheets.
    "#n/a",
    "#n/a n/a",
    "#na",
    "#div/0!",
    "#value!",
    "#num!",
    "#ref!",
    "#name?",
    "#null!",
    // The C library of Windows.
    "1.#qnan",
    "-1.#qnan",
    "1.#ind",
    "-1.#ind",
    "1.#inf",
    "-1.#inf",
    "nan(ind)",
    "-nan(ind)",
];

/// Longest of them; bytes.
const LONGEST: usize = 10;

/// What stands for a missing sample in the cells of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MissingWords {
    /// Words of the user, beside the usual ones.
    words: Vec<String>,
    /// Numbers of the user.
    numbers: Vec<f64>,
}

impl MissingWords {
    /// The usual words and those of the user; a number stands for every way to write it.
    pub fn new(own: &[String]) -> Self {
        let parsed = |word: &String| {
            let marks = [Marks::decimal(b'.'), Marks::decimal(b',')];
            marks.into_iter().find_map(|marks| number(word, marks))
        };
        Self {
            words: own
                .iter()
                .filter(|word| parsed(word).is_none())
                .map(|word| word.trim().to_owned())
                .collect(),
            numbers: own.iter().filter_map(parsed).collect(),
        }
    }

    /// Whether a cell that is no number is missing.
    ///
    /// * `text`: without surrounding blanks and quotes
    pub fn has(&self, text: &str) -> bool {
        self.words.iter().any(|word| word == text) || {
            text.len() <= LONGEST && {
                let plain = text.to_lowercase().replace(',', ".");
                USUAL.contains(&plain.as_str())
            }
        }
    }

    /// Whether a number stands for a missing sample.
    pub fn has_number(&self, value: f64) -> bool {
        self.numbers.contains(&value)
    }

    /// Whether every number is a sample.
    pub fn keeps_numbers(&self) -> bool {
        self.numbers.is_empty()
    }
}

/// Cells of one column that are taken as missing samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingCells {
    pub column: usize,
    pub count: usize,
    /// Line of the first, counted as its owner does.
    pub line: u64,
    /// What the first reads.
    pub word: String,
}

/// Adds cells to those of their column, which come earlier.
pub fn add_missing(all: &mut Vec<MissingCells>, more: MissingCells) {
    match all.iter_mut().find(|known| known.column == more.column) {
        Some(known) => known.count += more.count,
        None => all.push(more),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_usual_words_and_those_of_the_user() {
        let usual = MissingWords::default();
        for word in USUAL {
            assert!(word.len() <= LONGEST && usual.has(word), "{word}");
            assert!(usual.has(&word.to_uppercase()), "{word}");
        }
        assert!(usual.has("-1,#IND") && !usual.has("x") && !usual.has("defect"));
        let own = MissingWords::new(&["defect".to_owned(), "9999".to_owned(), "-1,5".to_owned()]);
        assert!(own.has("defect") && !own.has("Defect") && own.has("NaN"));
        assert!(own.has_number(9999.0) && own.has_number(-1.5) && !own.has_number(9998.0));
    }
}
