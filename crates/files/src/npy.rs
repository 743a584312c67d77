//! Structured arrays of doubles, as NumPy reads them.
//!
//! # Source
//! NumPy enhancement proposal 1, "A simple file format for NumPy arrays", version 3.0.

use crate::text::quote::string_text;

/// Length of a header with few columns, whatever its number of rows; bytes.
const SHORTEST: usize = 128;

const DOUBLE: usize = size_of::<f64>();

/// Header of an array, whose length does not depend on the number of rows.
///
/// * `names`: of the columns
pub fn npy_header(names: &[String], rows: u64) -> Vec<u8> {
    let fields = names
        .iter()
        .map(|name| format!("({}, '<f8')", string_text(name)));
    let fields = fields.collect::<Vec<_>>().join(", ");
    let mut text =
        format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({rows:>20},), }}");
    // Twelve bytes come before it; data begin at a multiple of 64.
    let length = (12 + text.len() + 1).next_multiple_of(64).max(SHORTEST) - 12;
    text += &" ".repeat(length - 1 - text.len());
    text.push('\n');
    let mut header = b"\x93NUMPY\x03\x00".to_vec();
    header.extend((text.len() as u32).to_le_bytes());
    header.extend(text.as_bytes());
    header
}

/// The bytes of a file with a row for each sample.
///
/// * `names`: of the columns
/// * `columns`: doubles as bytes in the order of this machine, as many in each
pub fn npy_of_columns(names: &[String], columns: &[&[u8]]) -> Vec<u8> {
    let rows = columns.first().map_or(0, |own| own.len() / DOUBLE);
    let mut file = npy_header(names, rows as u64);
    let data = file.len();
    file.resize(data + rows * columns.len() * DOUBLE, 0);
    let (cells, _) = file[data..].as_chunks_mut::<DOUBLE>();
    for (place, column) in columns.iter().enumerate() {
        let cells = cells.iter_mut().skip(place).step_by(columns.len());
        for (cell, double) in cells.zip(column.as_chunks().0) {
            *cell = f64::from_ne_bytes(*double).to_le_bytes();
        }
    }
    file
}

/// Doubles that are not finite: the first one with its place, and how many there are.
///
/// * `column`: doubles as bytes in the order of this machine
pub fn not_finite(column: &[u8]) -> Option<(usize, f64, usize)> {
    let doubles = column.as_chunks().0.iter();
    let numbers = doubles.map(|own| f64::from_ne_bytes(*own));
    // Counted first, several at a time: there are almost always none.
    let lost = numbers.clone().filter(|own| !own.is_finite()).count();
    if lost == 0 {
        return None;
    }
    let (first, value) = numbers.enumerate().find(|own| !own.1.is_finite())?;
    Some((first, value, lost))
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_formats::open::{OpenOptions, open_source};
    use windfall_source::source::Source;

    fn bytes(numbers: &[f64]) -> Vec<u8> {
        numbers.iter().flat_map(|own| own.to_ne_bytes()).collect()
    }

    #[test]
    fn agrees_with_the_reader_of_arrays() {
        let columns = [[0.0, 1e-5, 2e-5], [-0.0, f64::MIN_POSITIVE, 1.0 / 3.0]];
        let given: Vec<Vec<u8>> = columns.iter().map(|own| bytes(own)).collect();
        let given: Vec<&[u8]> = given.iter().map(Vec::as_slice).collect();
        let file = npy_of_columns(&["t", "F, left"].map(String::from), &given);
        let source = Source::from_bytes("a.npy", file);
        let mut reader = open_source(source, &OpenOptions::default()).unwrap();
        let names = reader.contents().channels.iter();
        let names: Vec<_> = names.map(|own| own.name.clone()).collect();
        assert_eq!(names, ["t", "F, left"]);
        let read = reader.read_whole(&[0, 1]).unwrap();
        let read: Vec<Vec<u8>> = read.iter().map(|own| bytes(own)).collect();
        assert_eq!(read, given);
    }

    #[test]
    fn finds_what_is_not_finite() {
        assert_eq!(not_finite(&bytes(&[0.0, -1.0])), None);
        let found = not_finite(&bytes(&[0.0, f64::INFINITY, 1.0, f64::NAN]));
        assert_eq!(found, Some((1, f64::INFINITY, 2)));
    }
}
