//! Numbers as cells and words.

use windfall_files::table::write::number_cell;

/// A number as a cell; blank where there is none.
pub fn cell(value: f64) -> String {
    number_cell((!value.is_nan()).then_some(value))
}

/// A part in percent, without the digits of its rounding: 0.29 is 29.
pub fn percent(part: f64) -> f64 {
    (1e6 * 100.0 * part).round() / 1e6
}
