//! Cells of CSV that a spreadsheet would take for a formula.
//!
//! Such a cell is written with an apostrophe before it, and read without. Both follow from
//! [`is_formula`] alone, so that every cell comes back as it was: an apostrophe of the
//! user's own is kept, and gets another one where the rest would be taken for a formula.
//!
//! # Source
//! OWASP, "CSV Injection", <https://owasp.org/www-community/attacks/CSV_Injection>, which
//! names the characters.

use std::borrow::Cow;

/// Characters with which a formula begins, also in their full width.
const BEGINNINGS: [char; 8] = ['=', '+', '-', '@', '＝', '＋', '－', '＠'];

/// Characters before a formula that a spreadsheet may pass over.
const PASSED_OVER: [char; 3] = ['\t', '\r', '\n'];

/// Whether a cell is a formula for a spreadsheet, or a formula behind apostrophes. A number
/// with its sign is none.
pub fn is_formula(cell: &str) -> bool {
    let cell = cell.trim_end();
    let rest = cell.trim_start_matches(|own: char| own == '\'' || own.is_whitespace());
    let before = &cell[..cell.len() - rest.len()];
    let begins = rest.starts_with(BEGINNINGS) || before.contains(PASSED_OVER);
    begins && !rest.is_empty() && !is_number(rest)
}

/// A number, with a decimal point or a decimal comma.
fn is_number(text: &str) -> bool {
    let point = text.replacen(',', ".", 1);
    point.parse::<f64>().is_ok()
}

/// A cell as it is written: with an apostrophe before what a spreadsheet would run.
pub fn guarded(cell: &str) -> Cow<'_, str> {
    match is_formula(cell) {
        true => Cow::Owned(format!("'{cell}")),
        false => Cow::Borrowed(cell),
    }
}

/// A cell as it was before [`guarded`].
pub fn unguarded(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(own) if is_formula(own) => own,
        _ => cell,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_formulas_get_an_apostrophe_and_numbers_none() {
        for (cell, written) in [
            ("=1+1", "'=1+1"),
            ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("-2+3", "'-2+3"),
            ("＝1", "'＝1"),
            ("\t=1", "'\t=1"),
            ("\rx", "'\rx"),
            (" =1", "' =1"),
            ("'=1", "''=1"),
            ("-", "'-"),
            ("-1.5", "-1.5"),
            ("+3", "+3"),
            ("-1,5", "-1,5"),
            ("1e-3", "1e-3"),
            ("-inf", "-inf"),
            ("\t-1.5", "\t-1.5"),
            ("'tis", "'tis"),
            ("'-1.5", "'-1.5"),
            ("a=b", "a=b"),
            ("", ""),
            ("'", "'"),
        ] {
            assert_eq!(guarded(cell), written);
            assert_eq!(unguarded(written), cell);
        }
    }
}
