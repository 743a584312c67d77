//! MATLAB files, versions 4 to 7.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::contents::{Format, TimeBase};
use windfall_formats::open::{OpenOptions, open};

/// Checksums by SciPy 1.17 (`scipy.io.loadmat`).
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/mat/scipy_big_endian.mat",
            &[
                ("floats/1", 2, 0x0018_0000_0000_0000, None),
                ("floats/2", 2, 0x0038_0000_0000_0000, None),
            ],
        ),
        (
            "daq_formats/mat/scipy_testdouble_4.2c_SOL2.mat",
            &[("testdouble", 9, 0x0492_f25d_99b4_dd7d, None)],
        ),
        (
            "daq_formats/mat/scipy_testdouble_6.5.1_GLNX86.mat",
            &[("testdouble", 9, 0x0492_f25d_99b4_dd7d, None)],
        ),
        (
            "daq_formats/mat/scipy_testdouble_7.4_GLNX86.mat",
            &[("testdouble", 9, 0x0492_f25d_99b4_dd7d, None)],
        ),
        (
            "daq_formats/mat/scipy_testmulti_7.4_GLNX86.mat",
            &[
                ("a/1", 3, 0x4018_0000_0000_0000, None),
                ("a/2", 3, 0x4000_0000_0000_0000, None),
                ("a/3", 3, 0x4008_0000_0000_0000, None),
                ("a/4", 3, 0x4010_0000_0000_0000, None),
                ("a/5", 3, 0x4014_0000_0000_0000, None),
                ("theta", 9, 0x0492_f25d_99b4_dd7d, None),
            ],
        ),
        (
            "daq_formats/mat/scipy_testvec_4_GLNX86.mat",
            &[
                ("fit_params", 2, 0x004f_5268_ca62_4553, None),
                ("xdot_filt", 2, 0xf671_50a2_0000_0000, None),
            ],
        ),
        (
            "impact/hrshm_ds1_1MSs/Unit105_Series1_1.mat",
            &[
                ("Unit105_Series1_1/1", 100000, 0xcfc7_41d4_cf07_d74d, None),
                ("Unit105_Series1_1/2", 100000, 0x7a9c_59b8_c771_bf34, None),
                ("Unit105_Series1_1/3", 100000, 0xab6f_c253_cf09_014d, None),
                ("Unit105_Series1_1/4", 100000, 0xf502_fe43_e5f3_51eb, None),
                ("Unit105_Series1_1/5", 100000, 0xf5f5_12e9_a242_0efc, None),
                ("Unit105_Series1_1/6", 100000, 0xe6ed_2451_31b8_3801, None),
                ("Unit105_Series1_1/7", 100000, 0x1eab_6d91_6864_1953, None),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Mat, channels);
    }
}

/// Checksums by SciPy 1.17; single numbers, of which these files hold nothing else.
#[test]
fn reference_nested_real_files() {
    let numbers = |names: &'static [(&'static str, f64)]| -> Vec<crate::channels::Expected> {
        let expected = |(name, value): &(&'static str, f64)| (*name, 1, value.to_bits(), None);
        names.iter().map(expected).collect()
    };
    let files = [
        (
            "daq_formats/mat/scipy_testcellnest_7.1_GLNX86.mat",
            numbers(&[
                ("testcellnest/1", 1.0),
                ("testcellnest/2/1", 2.0),
                ("testcellnest/2/2", 3.0),
                ("testcellnest/2/3/1", 4.0),
                ("testcellnest/2/3/2", 5.0),
            ]),
        ),
        (
            "daq_formats/mat/pymatreader_struct_in_cell_v6.mat",
            numbers(&[("x/test/1/int", 4.0), ("x/test/1/float", 3.2)]),
        ),
        (
            "daq_formats/mat/pymatreader_struct_in_cell_v7.mat",
            numbers(&[("x/test/1/int", 4.0), ("x/test/1/float", 3.2)]),
        ),
        ("daq_formats/mat/pymatreader_string_v7.mat", Vec::new()),
    ];
    for (file, channels) in files {
        check_file(file, Format::Mat, &channels);
    }
}

/// A file made by SciPy (`fixtures/make_fixtures.py`), plain and compressed.
#[test]
fn closed_form_structs_cells_and_arrays_of_any_class() {
    let force: Vec<f64> = (0..40).map(|i| f64::from(i) * 0.25 - 3.0).collect();
    for bytes in [
        &include_bytes!("fixtures/plain.mat")[..],
        &include_bytes!("fixtures/packed.mat")[..],
    ] {
        let mut reader = open_bytes("f.mat", bytes.to_vec(), Format::Mat).unwrap();
        let contents = reader.contents().clone();
        let all = samples(reader.as_mut());
        let find = |name: &str| {
            let at = contents.channels.iter().position(|c| c.name == name);
            at.unwrap_or_else(|| panic!("{name} is not there"))
        };
        assert_eq!(all[find("F")], force);
        assert_eq!(all[find("run/x")], [-2.0, -1.0, 0.0, 1.0, 2.0]);
        let x = &contents.channels[find("run/x")];
        assert_eq!(x.time, TimeBase::Channel(find("run/time")));
        assert_eq!(x.unit.as_deref(), Some("mm"));
        assert_eq!(contents.channels[find("run/time")].unit, None);
        assert_eq!(all[find("cells/2")], [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(all[find("z (real)")], [0.0, 1.0, 2.0]);
        assert_eq!(all[find("z (imaginary)")], [3.0, 4.0, 5.0]);
        // Element (i, j, k) of the cube is 12 i + 4 j + k.
        assert_eq!(all[find("cube/3/2")], [9.0, 21.0]);
        assert_eq!(all[find("on")], [1.0, 0.0, 1.0]);
        let uniform = TimeBase::Uniform {
            start: 0.0,
            interval: 0.0005,
        };
        assert_eq!(contents.channels[find("F")].time, uniform);
        let label = ("label".to_owned(), "Kraft (µN)".to_owned());
        assert!(contents.properties.contains(&label), "{contents:?}");
        let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
        for expected in [
            "\"sparse\" is left out: it is a sparse matrix; save full(…) of it",
            "\"nothing\" is left out: it is empty",
        ] {
            assert!(notes.iter().any(|n| n == expected), "{notes:?}");
        }
        let backwards: Vec<usize> = (0..all.len()).rev().collect();
        let mut found = reader.read_whole(&backwards).unwrap();
        found.reverse();
        assert_eq!(found, all);
    }
}

#[test]
fn rejects_a_wrong_checksum_of_compressed_data() {
    let mut bytes = include_bytes!("fixtures/packed.mat").to_vec();
    // The first variable: its tag stands at byte 128, its checksum ends it.
    let length = u32::from_le_bytes([bytes[132], bytes[133], bytes[134], bytes[135]]) as usize;
    bytes[136 + length - 1] ^= 1;
    // A small variable is read to its end when the file is opened.
    let message = open_bytes("f.mat", bytes, Format::Mat)
        .and_then(|mut reader| reader.read_whole(&[0]))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("at byte 136: the compressed data"),
        "{message}"
    );
}

#[test]
fn rejects_numbers_of_other_machines() {
    let mut bytes = include_bytes!("fixtures/version4.mat").to_vec();
    bytes[..4].copy_from_slice(&2000_u32.to_le_bytes());
    let message = open_bytes("v.mat", bytes, Format::Mat)
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "v.mat, at byte 0: windfall does not read VAX D-float numbers; load the file in MATLAB \
         and save it again"
    );
}

#[test]
fn reference_nested_texts_and_numbers() {
    let Some(file) =
        windfall_test_data::find("daq_formats/mat/scipy_teststructnest_7.4_GLNX86.mat")
    else {
        return;
    };
    let reader = open(&file, &OpenOptions::default()).unwrap();
    let properties = &reader.contents().properties;
    let has = |name: &str, value: &str| properties.contains(&(name.to_owned(), value.to_owned()));
    assert!(has("teststructnest/one", "1"), "{properties:?}");
    assert!(
        has("teststructnest/two/three", "number 3"),
        "{properties:?}"
    );
}

/// An element of version 5: its tag, its data, and blanks up to eight bytes.
fn element(code: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = code.to_le_bytes().to_vec();
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn array(class: u32, rows: i32, columns: i32, name: &str, rest: &[u8]) -> Vec<u8> {
    let mut flags = class.to_le_bytes().to_vec();
    flags.extend([0; 4]);
    let size = [rows.to_le_bytes(), columns.to_le_bytes()].concat();
    let parts = [
        element(6, &flags),
        element(5, &size),
        element(1, name.as_bytes()),
    ];
    element(14, &[parts.concat(), rest.to_vec()].concat())
}

fn doubles(values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    element(9, &bytes)
}

fn file(variables: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(variables.concat());
    bytes
}

#[test]
fn closed_form_times_of_vectors_and_matrices() {
    let matrix = array(6, 3, 2, "m", &doubles(&[0.0, 0.5, 1.0, 7.0, 8.0, 9.0]));
    let bytes = file(&[
        array(6, 1, 3, "F", &doubles(&[1.0, 2.0, 3.0])),
        array(6, 3, 1, "time", &doubles(&[0.0, 0.1, 0.2])),
        matrix,
        array(6, 1, 4, "x", &doubles(&[1.0, 2.0, 3.0, 4.0])),
        array(6, 1, 1, "fs", &doubles(&[200.0])),
    ]);
    let mut reader = open_bytes("t.mat", bytes, Format::Mat).unwrap();
    let contents = reader.contents().clone();
    let times: Vec<(&str, TimeBase)> = contents
        .channels
        .iter()
        .map(|c| (c.name.as_str(), c.time))
        .collect();
    let uniform = TimeBase::Uniform {
        start: 0.0,
        interval: 0.005,
    };
    let expected = [
        ("F", TimeBase::Channel(1)),
        ("time", TimeBase::Unknown),
        ("m/1", TimeBase::Channel(1)),
        ("m/2", TimeBase::Channel(2)),
        ("x", uniform),
    ];
    assert_eq!(times, expected);
    assert_eq!(samples(reader.as_mut())[3], [7.0, 8.0, 9.0]);
}

#[test]
fn rejects_damaged_files_and_says_where() {
    let good = file(&[array(6, 1, 3, "F", &doubles(&[1.0, 2.0, 3.0]))]);
    let wrong_size = file(&[array(6, 1, 4, "F", &doubles(&[1.0, 2.0, 3.0]))]);
    let no_order = {
        let mut bytes = good.clone();
        bytes[126] = b'X';
        bytes
    };
    let deflated = file(&[element(15, &[1, 2, 3, 4, 5, 6, 7, 8])]);
    for (bytes, expected) in [
        (
            wrong_size,
            "at byte 128: in the variable that begins here: \"F\" has 4 elements and 24 bytes of double",
        ),
        (
            no_order,
            "at byte 124: expected version 256 and \"IM\" or \"MI\"",
        ),
        (
            deflated,
            "at byte 136: the compressed data that begin here are damaged",
        ),
    ] {
        let message = open_bytes("t.mat", bytes, Format::Mat)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
    let two = file(&[
        array(6, 1, 3, "F", &doubles(&[1.0, 2.0, 3.0])),
        array(6, 1, 3, "G", &doubles(&[1.0, 2.0, 3.0])),
    ]);
    let mut cut = open_bytes("t.mat", two[..two.len() - 1].to_vec(), Format::Mat).unwrap();
    let note = cut.contents().notes[0].to_string();
    assert_eq!(
        note,
        "the file is cut off: a variable at byte 224 needs 80 bytes, 79 are left"
    );
    assert_eq!(samples(cut.as_mut()), [[1.0, 2.0, 3.0]]);
    let message = open_bytes("t.mat", good[..good.len() - 1].to_vec(), Format::Mat)
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(message.contains("the file ends too early"), "{message}");
}
