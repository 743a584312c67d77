//! Zip archives of tables of text, and tables below each other in one text.

use crate::channels::{open_bytes, samples};
use crate::seeds::{archive, zip_parts};
use windfall_formats::contents::{Format, TimeBase};
use windfall_formats::open::{OpenOptions, open_source};
use windfall_formats::text::options::TextOptions;
use windfall_source::source::Source;

#[test]
fn closed_form_tables_of_an_archive() {
    let bytes = archive(&zip_parts());
    let mut reader = open_bytes("phone.zip", bytes, Format::Zip).unwrap();
    let found = samples(reader.as_mut());
    let contents = reader.contents();
    let names: Vec<&str> = contents.channels.iter().map(|c| c.name.as_str()).collect();
    let expected = [
        "a/t (s) (segment 1)",
        "a/F (N) (segment 1)",
        "a/t (s) (segment 2)",
        "a/F (N) (segment 2)",
        "b/c/x",
        "b/c/y",
    ];
    assert_eq!(names, expected);
    assert_eq!(found[1], [1.0, 2.0, 3.0]);
    assert_eq!(found[3], [1.0, 2.0, 3.0]);
    assert_eq!(found[4], [1.5, 2.5]);
    assert_eq!(contents.channels[3].time, TimeBase::Channel(2));
    let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
    let expected = [
        "\"meta/device.csv\" is left out: it describes the recording and holds no samples",
        "\"readme.md\" is left out: it is not a text by its name",
    ];
    assert_eq!(notes, expected);
}

#[test]
fn closed_form_one_table_keeps_its_names() {
    let parts = [(
        "x/Raw Data.csv",
        b"\"Time (s)\",\"a (m/s^2)\"\n0,1\n0.5,2\n".to_vec(),
    )];
    let mut reader = open_bytes("phone.zip", archive(&parts), Format::Zip).unwrap();
    assert_eq!(reader.contents().channels[1].name, "a (m/s^2)");
    assert_eq!(samples(reader.as_mut())[1], [1.0, 2.0]);
}

#[test]
fn closed_form_segments_of_a_text_in_every_encoding() {
    let text = "Test 1\r\nOperator;M\u{fc}ller\r\nZeit;Kraft\r\ns;N\r\n0;1,5\r\n1;2,5\r\n2;-3\r\n\r\n\
                Test 2\r\nZeit;Weg;Kraft\r\ns;mm;N\r\n0;0,1;1,5\r\n1;0,2;2,5\r\n2;;\r\n";
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let windows: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [text.into(), [vec![0xff, 0xfe], utf16].concat(), windows] {
        let mut reader = open_bytes("t.csv", bytes, Format::Text).unwrap();
        let found = samples(reader.as_mut());
        let channels = &reader.contents().channels;
        let names: Vec<&str> = channels.iter().map(|c| c.name.as_str()).collect();
        let expected = [
            "Zeit (segment 1)",
            "Kraft (segment 1)",
            "Zeit (segment 2)",
            "Weg (segment 2)",
            "Kraft (segment 2)",
        ];
        assert_eq!(names, expected);
        assert_eq!(found[1], [1.5, 2.5, -3.0]);
        assert_eq!(found[3][..2], [0.1, 0.2]);
        assert!(found[3][2].is_nan() && found[4][2].is_nan());
        assert_eq!(channels[4].unit.as_deref(), Some("N"));
        assert_eq!(channels[4].time, TimeBase::Channel(2));
        let operator = ("Operator (segment 1)".to_owned(), "M\u{fc}ller".to_owned());
        assert!(reader.contents().properties.contains(&operator));
    }
}

#[test]
fn rejects_faults_with_the_line_of_the_file() {
    let text = "t,F\n0,1\n1,2\n2,3\n\nt,F\n0,1\n1,x\n2,3\n3,4\n";
    let mut reader = open_bytes("t.csv", text.into(), Format::Text).unwrap();
    let message = reader.read_whole(&[0, 1, 2, 3]).unwrap_err().to_string();
    assert!(
        message.starts_with("t.csv, line 8, column \"F\": \"x\" is not a number"),
        "{message}"
    );
    // Where the user names the header line, everything below it is one table.
    let options = OpenOptions {
        text: TextOptions {
            header_line: Some(1),
            ..TextOptions::default()
        },
        ..OpenOptions::default()
    };
    let source = Source::from_bytes("t.csv", text.into());
    let reader = open_source(source, &options).unwrap();
    assert_eq!(reader.contents().channels.len(), 2);
}

#[test]
fn rejects_archives_without_a_recording() {
    for (parts, told) in [
        (
            vec![("a.csv", b"only words\n".to_vec())],
            "phone.zip/a.csv: no table of numbers found",
        ),
        (
            vec![("meta/a.csv", b"1,2\n".to_vec())],
            "this zip archive holds no recording",
        ),
    ] {
        let found = open_bytes("phone.zip", archive(&parts), Format::Zip);
        let message = found.map(|_| ()).unwrap_err().to_string();
        assert!(
            message.starts_with("phone.zip") && message.contains(told),
            "{message}"
        );
    }
}
