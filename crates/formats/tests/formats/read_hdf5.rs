//! HDF5 files and those of MATLAB 7.3. How the small files were made is told in
//! `fixtures/make_fixtures.py`; their numbers follow the rules that stand there.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::contents::{ChannelContents, Format, TimeBase};
use windfall_formats::open::{OpenOptions, open, open_source};
use windfall_source::source::Source;

/// Checksums by h5py 3.16.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/mat/scipy_testhdf5_7.4_GLNX86.mat",
            &[("testdouble", 9, 0x0492_f25d_99b4_dd7d, None)],
        ),
        (
            "daq_formats/mat/pymatreader_sparse_v73.mat",
            &[
                ("i", 5, 0x4218_0000_0000_0000, None),
                ("j", 5, 0x422a_0000_0000_0000, None),
                ("v", 5, 0x3b1e_f535_8ba5_9b6e, None),
            ],
        ),
        (
            "daq_formats/mat/pymatreader_struct_in_cell_v73.mat",
            &[
                ("x/test/1/float", 1, 0x4009_9999_9999_999a, None),
                ("x/test/1/int", 1, 0x4010_0000_0000_0000, None),
            ],
        ),
        ("daq_formats/mat/pymatreader_string_v73.mat", &[]),
    ];
    for (file, channels) in files {
        check_file(file, Format::Hdf5, channels);
    }
}

#[test]
fn reference_objects_and_texts_of_matlab() {
    let Some(file) = windfall_test_data::find("daq_formats/mat/pymatreader_string_v73.mat") else {
        return;
    };
    let reader = open(&file, &OpenOptions::default()).unwrap();
    let contents = reader.contents();
    assert_eq!(contents.variant, "MATLAB v7.3");
    let text = ("my_char".to_owned(), "hello char".to_owned());
    assert!(contents.properties.contains(&text), "{contents:?}");
    let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
    assert!(
        notes
            .iter()
            .any(|n| n.contains("\"my_string\" is left out: it is an object"))
    );
}

fn force(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64 * 0.25 - 3.0).collect()
}

/// The samples of a channel by its name, and what is said of it.
fn channel(file: &[u8], name: &str) -> (Vec<f64>, ChannelContents) {
    let source = Source::from_bytes("fixture", file.to_vec());
    let mut reader = open_source(source, &OpenOptions::default()).unwrap();
    assert_eq!(reader.contents().format, Format::Hdf5);
    let channels = reader.contents().channels.clone();
    let at = channels.iter().position(|c| c.name == name);
    let at = at.unwrap_or_else(|| panic!("{name} is not among {channels:?}"));
    let samples = reader.read_whole(&[at]).unwrap().remove(0);
    assert_eq!(channels[at].length, Some(samples.len() as u64), "{name}");
    (samples, channels[at].clone())
}

const OLD: &[u8] = include_bytes!("fixtures/old.h5");
const NEW: &[u8] = include_bytes!("fixtures/new.h5");
const CHUNKS: &[u8] = include_bytes!("fixtures/chunks.h5");
const MATLAB: &[u8] = include_bytes!("fixtures/matlab73.mat");

#[test]
fn closed_form_datasets_of_old_and_new_files() {
    for file in [OLD, NEW] {
        let (samples, contents) = channel(file, "again/force");
        assert_eq!(samples, force(40));
        assert_eq!(contents.unit.as_deref(), Some("N"));
        let uniform = TimeBase::Uniform {
            start: 0.0,
            interval: 0.0005,
        };
        assert_eq!(contents.time, uniform);
        let (samples, contents) = channel(file, "again/packed");
        assert_eq!(
            samples,
            (0..200).map(|i| f64::from(3 * i)).collect::<Vec<_>>()
        );
        assert_eq!(
            contents.stored_as,
            "16-bit integer, big-endian, in packed chunks"
        );
        let (samples, _) = channel(file, "again/lzf");
        assert_eq!(
            samples,
            (0..200).map(|i| f64::from(i % 7)).collect::<Vec<_>>()
        );
        assert_eq!(
            channel(file, "table/time").0,
            [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]
        );
        assert_eq!(
            channel(file, "table/pair/2").0,
            [1.0, 3.0, 5.0, 7.0, 9.0, 11.0]
        );
        let (samples, contents) = channel(file, "table/count");
        assert_eq!(samples, [250.0, 251.0, 252.0, 253.0, 254.0, 255.0]);
        assert!(matches!(contents.time, TimeBase::Channel(_)));
        assert_eq!(channel(file, "complex (imaginary)").0, [3.0, 4.0, 5.0]);
    }
}

#[test]
fn closed_form_attributes_scalars_and_texts() {
    for file in [OLD, NEW] {
        let source = Source::from_bytes("fixture", file.to_vec());
        let reader = open_source(source, &OpenOptions::default()).unwrap();
        let contents = reader.contents();
        for (name, value) in [
            ("again/operator", "a person"),
            ("scalar", "3.5"),
            ("text", "two words"),
        ] {
            let property = (name.to_owned(), value.to_owned());
            assert!(
                contents.properties.contains(&property),
                "{name}: {contents:?}"
            );
        }
        let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
        for expected in [
            "\"soft\" is left out: it is another name of \"/run/force\"",
            "\"run\" is left out: it is another name of what is listed already",
            "\"table/name\" is left out: it is text",
        ] {
            assert!(notes.iter().any(|n| n == expected), "{expected}: {notes:?}");
        }
    }
}

#[test]
fn closed_form_every_index_of_chunks() {
    assert_eq!(channel(CHUNKS, "fixed").0, force(30));
    assert_eq!(channel(CHUNKS, "grows").0, force(60));
    for name in ["grows in columns", "grows both ways"] {
        for column in 0..4 {
            let (samples, _) = channel(CHUNKS, &format!("{name}/{}", column + 1));
            let expected: Vec<f64> = (0..3).map(|row| f64::from(4 * row + column)).collect();
            assert_eq!(samples, expected, "{name}");
        }
    }
    let (samples, _) = channel(CHUNKS, "one");
    assert_eq!(samples, (0..12).map(f64::from).collect::<Vec<_>>());
    let gap = |i| if (7..9).contains(&i) { 1.0 } else { -3.0 };
    assert_eq!(
        channel(CHUNKS, "gaps").0,
        (0..20).map(gap).collect::<Vec<_>>()
    );
    assert_eq!(channel(CHUNKS, "many/c11").0, [11.0, 12.0]);
}

#[test]
fn closed_form_cells_structs_and_columns_of_matlab() {
    assert_eq!(channel(MATLAB, "matrix/2").0, [1.0, 9.0, 25.0]);
    assert_eq!(channel(MATLAB, "cell/1").0, [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(channel(MATLAB, "cell/2").0, [0.0, 1.0, 2.0, 3.0, 4.0]);
    let (samples, contents) = channel(MATLAB, "run/F");
    assert_eq!(samples, [-2.0, -1.0, 0.0, 1.0, 2.0]);
    assert!(matches!(contents.time, TimeBase::Channel(_)));
    let reader = open_bytes("m.mat", MATLAB.to_vec(), Format::Hdf5).unwrap();
    let label = ("label".to_owned(), "Kraft".to_owned());
    assert!(reader.contents().properties.contains(&label));
}

#[test]
fn closed_form_parts_of_the_channels_in_any_order() {
    let mut reader = open_bytes("c.h5", CHUNKS.to_vec(), Format::Hdf5).unwrap();
    let all = samples(reader.as_mut());
    let count = all.len();
    let backwards: Vec<usize> = (0..count).rev().collect();
    let mut found = reader.read_whole(&backwards).unwrap();
    found.reverse();
    assert_eq!(found, all);
}

#[test]
fn rejects_what_is_no_hdf5_file_or_damaged() {
    let refused = |bytes: &[u8]| {
        open_bytes("x.h5", bytes.to_vec(), Format::Hdf5)
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    for (bytes, expected) in [
        (&b""[..], "x.h5: the file is empty; expected a recording"),
        (
            &[7; 3000],
            "x.h5, at byte 0: expected the signature of HDF5; this is not an HDF5 file",
        ),
        (&OLD[..60], "a structure ends before what it declares"),
        (
            &OLD[..90],
            "the complete file needs 14880 bytes, 90 are left",
        ),
    ] {
        let message = refused(bytes);
        assert!(message.contains(expected), "{message}");
    }
    // A byte of a chunk with a checksum.
    let mut broken = OLD.to_vec();
    let at = (0..broken.len())
        .find(|&at| {
            let mut bytes = OLD.to_vec();
            bytes[at] ^= 0x40;
            let mut reader = match open_bytes("x.h5", bytes, Format::Hdf5) {
                Ok(reader) => reader,
                Err(_) => return false,
            };
            let names: Vec<String> = reader
                .contents()
                .channels
                .iter()
                .map(|c| c.name.clone())
                .collect();
            let packed = names.iter().position(|n| n == "again/packed");
            packed.is_some_and(|packed| reader.read_whole(&[packed]).is_err())
        })
        .unwrap();
    broken[at] ^= 0x40;
    let mut reader = open_bytes("x.h5", broken, Format::Hdf5).unwrap();
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let message = reader.read_whole(&all).unwrap_err().to_string();
    assert!(message.contains("in \"again/packed\""), "{message}");
}

#[test]
fn rejects_or_notes_a_file_that_was_cut_off() {
    let (mut noted, mut refused) = (0, 0);
    for length in 100..MATLAB.len() {
        match open_bytes("x.h5", MATLAB[..length].to_vec(), Format::Hdf5) {
            Ok(reader) => {
                let expected = format!(
                    "the file is cut off: {} bytes were written, {length} are there",
                    MATLAB.len()
                );
                let notes = reader.contents().notes.iter().map(ToString::to_string);
                assert!(notes.into_iter().any(|n| n == expected));
                noted += 1;
            }
            Err(error) if length > 608 => {
                assert!(error.to_string().contains("ends too early"), "{error}");
                refused += 1;
            }
            Err(_) => {}
        }
    }
    assert!(noted > 100 && refused > 100, "{noted}, {refused}");
}
