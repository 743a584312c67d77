//! Spreadsheets: files of openpyxl and odfpy (`fixtures/make_fixtures.py`), and by hand.

use crate::channels::{open_bytes, samples};
use crate::seeds::{archive, le, ods_parts, xlsx_parts};
use windfall_formats::contents::{Format, TimeBase};
use windfall_formats::open::tell_format;
use windfall_formats::reader::is_missing;
use windfall_source::source::Source;

/// Samples of a channel by its name.
fn channel(bytes: &[u8], format: Format, name: &str) -> Vec<f64> {
    let mut reader = open_bytes("book", bytes.to_vec(), format).unwrap();
    let channels = &reader.contents().channels;
    let names: Vec<&str> = channels
        .iter()
        .map(|channel| channel.name.as_str())
        .collect();
    let place = names.iter().position(|found| *found == name);
    let place = place.unwrap_or_else(|| panic!("{name} is not in {names:?}"));
    reader.read_whole(&[place]).unwrap().remove(0)
}

/// Like `==`, but NaN is NaN.
fn same(found: &[f64], expected: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a == b || (a.is_nan() && b.is_nan());
    found.len() == expected.len() && found.iter().zip(expected).all(equal)
}

#[test]
fn closed_form_cells_of_every_kind() {
    let bytes = archive(&xlsx_parts());
    let source = Source::from_bytes("book.xlsx", bytes.clone());
    assert_eq!(tell_format(&source).unwrap(), Format::Xlsx);
    let mut reader = open_bytes("book.xlsx", bytes, Format::Xlsx).unwrap();
    let found = samples(reader.as_mut());
    let contents = reader.contents();
    let names: Vec<&str> = contents.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["Zeit", "F (N)", "When"]);
    assert!(
        same(&found[0], &[0.5, 1.5, 2.25, f64::NAN]),
        "{:?}",
        found[0]
    );
    assert!(
        same(&found[1], &[-1000.0, f64::NAN, f64::NAN, 1.0]),
        "{:?}",
        found[1]
    );
    assert!(is_missing(found[1][1]) && !is_missing(found[1][2]));
    assert!(
        same(&found[2], &[0.0, 21_600.0, f64::NAN, f64::NAN]),
        "{:?}",
        found[2]
    );
    assert_eq!(contents.channels[1].time, TimeBase::Channel(0));
    let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
    let missing = "\"F (N)\": 1 cell(s) taken as missing samples; the first is \"#N/A\" in line 3";
    assert!(notes.iter().any(|note| note == missing), "{notes:?}");
}

#[test]
fn closed_form_repeated_cells_of_an_open_document() {
    let bytes = archive(&ods_parts());
    assert_eq!(channel(&bytes, Format::Ods, "a/t &"), [0.5, 0.5]);
    assert_eq!(channel(&bytes, Format::Ods, "a/F (N)"), [0.0, 0.0]);
    assert_eq!(channel(&bytes, Format::Ods, "b/column_2"), [1.0]);
}

/// The numbers are those of `make_fixtures.py`, which openpyxl and odfpy wrote.
#[test]
fn reference_books_of_other_programs() {
    for (bytes, format) in [
        (&include_bytes!("fixtures/book.xlsx")[..], Format::Xlsx),
        (&include_bytes!("fixtures/book.ods")[..], Format::Ods),
    ] {
        let read = |name: &str| channel(bytes, format, name);
        let count =
            |n: i32, of: fn(f64) -> f64| (0..n).map(|i| of(f64::from(i))).collect::<Vec<_>>();
        // A title in merged cells, a remark, a row of units, blank cells.
        assert_eq!(read("Run 1/Time"), count(8, |i| i / 8.0));
        let blank = |i: f64| if i % 3.0 == 0.0 { f64::NAN } else { i / 16.0 };
        assert!(
            same(&read("Run 1/Force"), &count(8, blank)),
            "{:?}",
            read("Run 1/Force")
        );
        // Numbers as text with decimal commas, in the middle of the sheet.
        assert_eq!(read("Run 2/Zeit (s)"), count(6, |i| i / 8.0));
        assert_eq!(read("Run 2/Kraft (N)"), count(6, |i| -i));
        // Dates and times of day, a tenth of a second apart; one over midnight.
        let tenths = count(6, |i| 0.1 * i);
        for name in ["Clock/When", "Clock/Time of day"] {
            let close = read(name)
                .iter()
                .zip(&tenths)
                .all(|(a, b)| (a - b).abs() < 2e-6);
            assert!(close, "{name}: {:?}", read(name));
        }
        // Tables below each other.
        assert_eq!(read("Tests/Load (kN) (segment 1)"), count(4, |_| 0.0));
        assert_eq!(read("Tests/Load (kN) (segment 2)"), count(4, |i| i));
        assert_eq!(read("Tests/Time (s) (segment 2)"), count(4, |i| i / 2.0));
        let reader = open_bytes("book", bytes.to_vec(), format).unwrap();
        let notes: Vec<String> = reader
            .contents()
            .notes
            .iter()
            .map(ToString::to_string)
            .collect();
        let left_out = "sheet \"Remarks\" is left out: it has no table of numbers";
        assert!(notes.iter().any(|note| note == left_out), "{notes:?}");
        let units: Vec<_> = reader.contents().channels[..2]
            .iter()
            .map(|c| c.unit.clone())
            .collect();
        assert_eq!(units, [Some("s".to_owned()), Some("N".to_owned())]);
    }
}

#[test]
fn rejects_faults_with_their_place() {
    let with = |from: &str, to: &str| {
        let mut parts = xlsx_parts();
        let text = String::from_utf8(parts[3].1.clone()).unwrap();
        assert!(text.contains(from), "{from}");
        parts[3].1 = text.replace(from, to).into();
        let mut reader = open_bytes("book.xlsx", archive(&parts), Format::Xlsx)?;
        let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
        reader.read_whole(&all).map(|_| ())
    };
    let number = "<c r=\"B3\" t=\"e\"><v>#N/A</v></c>";
    let word = "<c r=\"B3\" t=\"str\"><v>broken</v></c>";
    for (from, to, told) in [
        (
            number,
            word,
            "book.xlsx/a, line 3, column \"F (N)\": \"broken\" is not a number",
        ),
        (
            "<row r=\"5\"><c r=\"B5\"",
            "<row r=\"90000\"><c r=\"B90000\"",
            "89995 blank rows stand above row 90000",
        ),
        ("</sheetData></worksheet>", "", "cannot be read"),
    ] {
        let message = with(from, to).unwrap_err().to_string();
        assert!(message.contains(told), "{message}");
    }
}

/// A zip archive of one deflated member that declares a size.
fn archive_of(name: &str, packed: &[u8], size: u32) -> Vec<u8> {
    let lengths = le(&[
        &[0; 4],
        &(packed.len() as u32).to_le_bytes(),
        &size.to_le_bytes(),
    ]);
    let name_length = (name.len() as u16).to_le_bytes();
    let method = [0, 0, 0, 0, 8, 0, 0, 0, 0, 0];
    let local = le(&[
        b"PK\x03\x04",
        &method,
        &lengths,
        &name_length,
        &[0; 2],
        name.as_bytes(),
        packed,
    ]);
    let rest = le(&[&name_length, &[0; 16]]);
    let central = le(&[
        b"PK\x01\x02",
        &[0; 2],
        &method,
        &lengths,
        &rest,
        name.as_bytes(),
    ]);
    let place = le(&[
        &(central.len() as u32).to_le_bytes(),
        &(local.len() as u32).to_le_bytes(),
    ]);
    le(&[
        &local,
        &central,
        b"PK\x05\x06",
        &[0; 4],
        &[1, 0, 1, 0],
        &place,
        &[0; 2],
    ])
}

/// A gibibyte of zeros packs into a megabyte.
#[test]
fn rejects_bombs_before_they_are_unpacked() {
    // A block of blanks that is repeated as often as wanted: deflate forgets nothing of it.
    let mut packer = flate2::Compress::new(flate2::Compression::fast(), false);
    let mut block = Vec::with_capacity(1 << 16);
    packer
        .compress_vec(
            &vec![b' '; 1 << 20],
            &mut block,
            flate2::FlushCompress::Full,
        )
        .unwrap();
    let packed = block.repeat(1 << 10);
    let bomb = |told: u32| archive_of("xl/workbook.xml", &packed, told);
    let honest = open_bytes("bomb.xlsx", bomb(1 << 30), Format::Xlsx);
    let message = honest.map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("this one unpacks to 1024 MiB"),
        "{message}"
    );
    let lying = open_bytes("bomb.xlsx", bomb(1 << 20), Format::Xlsx);
    let message = lying.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("do not fit the size"), "{message}");
}
