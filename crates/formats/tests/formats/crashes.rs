//! Files that once made a reader panic, found by `scripts/fuzz`.

use windfall_formats::Error;
use windfall_formats::contents::Format;
use windfall_formats::open::{OpenOptions, open_source};
use windfall_source::source::Source;

/// Reads all of a file, as what it was taken for.
fn read(name: &str, bytes: &[u8], format: Format) -> Result<usize, Error> {
    let options = OpenOptions {
        format: Some(format),
        ..OpenOptions::default()
    };
    let mut reader = open_source(Source::from_bytes(name, bytes.to_vec()), &options)?;
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    Ok(reader.read_whole(&all)?.iter().map(Vec::len).sum())
}

#[test]
fn rejects_or_reads_what_once_crashed() {
    for (name, bytes, format) in [
        (
            "two_header_ends_in_a_line.lvm",
            &include_bytes!("fixtures/crashes/two_header_ends_in_a_line.lvm")[..],
            Format::Lvm,
        ),
        (
            "rows_of_text_without_columns.mat",
            &include_bytes!("fixtures/crashes/rows_of_text_without_columns.mat")[..],
            Format::Mat,
        ),
        (
            "nothing_beyond_the_end.h5",
            &include_bytes!("fixtures/crashes/nothing_beyond_the_end.h5")[..],
            Format::Hdf5,
        ),
    ] {
        match read(name, bytes, format) {
            Ok(samples) => assert!(samples <= 8 * bytes.len(), "{name}: {samples} samples"),
            Err(error) => assert!(error.to_string().starts_with(name), "{error}"),
        }
    }
}
