//! Tables in text: dialects, values of real files, faults.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::Error;
use windfall_formats::contents::{Format, TimeBase};
use windfall_formats::open::{OpenOptions, open_source};
use windfall_formats::reader::{Reader, is_missing};
use windfall_formats::text::encoding::Encoding;
use windfall_formats::text::options::TextOptions;
use windfall_formats::text::rows::Separator;
use windfall_source::source::Source;

/// Every dialect of one little table: t = 0, 0.5, 1 s and F = 1234.5, -2.25, none.
#[test]
fn closed_form_one_table_in_many_dialects() {
    let utf16 = "\u{feff}t;F\n0;1234,5\n0,5;-2,25\n1;\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes);
    let dialects: Vec<(&str, Vec<u8>)> = vec![
        ("commas", b"t,F\n0,1234.5\n0.5,-2.25\n1,\n".to_vec()),
        (
            "windows line ends",
            b"t,F\r\n0,1234.5\r\n0.5,-2.25\r\n1,\r\n".to_vec(),
        ),
        ("old line ends", b"t,F\r0,1234.5\r0.5,-2.25\r1,\r".to_vec()),
        ("tabs", b"t\tF\n0\t1234.5\n0.5\t-2.25\n1\t\n".to_vec()),
        ("decimal comma", b"t;F\n0;1234,5\n0,5;-2,25\n1;\n".to_vec()),
        (
            "thousands points",
            b"t;F\n0;1.234,5\n0,5;-2,25\n1;\n".to_vec(),
        ),
        (
            "thousands apostrophes",
            b"t;F\n0;1'234.5\n0.5;-2.25\n1;\n".to_vec(),
        ),
        (
            "thousands no-break spaces",
            "t;F\n0;1\u{a0}234,5\n0,5;-2,25\n1;\n".as_bytes().to_vec(),
        ),
        (
            "quotes",
            b"\"t\",\"F\"\n\"0\",\"1,234.5\"\n\"0.5\",\"-2.25\"\n\"1\",\"\"\n".to_vec(),
        ),
        ("bars", b"t|F\n0|1234.5\n0.5|-2.25\n1|\n".to_vec()),
        (
            "comments",
            b"# made by a rig\nt,F\n0,1234.5\n# pause\n0.5,-2.25\n1,\n".to_vec(),
        ),
        (
            "trailing marks",
            b"t,F,\n0,1234.5,\n0.5,-2.25,\n1,,\n".to_vec(),
        ),
        (
            "preamble",
            b"Rig;A\nOperator;B\n\nt;F\n0;1234.5\n0.5;-2.25\n1;\n".to_vec(),
        ),
        ("units", b"t;F\n[s];[N]\n0;1234.5\n0.5;-2.25\n1;\n".to_vec()),
        (
            "exponents",
            b"t,F\n0E0,1.2345E+3\n5e-1,-2.25\n1,\n".to_vec(),
        ),
        (
            "true minus",
            "t,F\n0,1234.5\n0.5,\u{2212}2.25\n1,\n".as_bytes().to_vec(),
        ),
        (
            "mark of UTF-8",
            b"\xef\xbb\xbft,F\n0,1234.5\n0.5,-2.25\n1,\n".to_vec(),
        ),
        ("UTF-16", utf16.collect()),
        (
            "no end of the last line",
            b"t,F\n0,1234.5\n0.5,-2.25\n1,".to_vec(),
        ),
    ];
    for (name, bytes) in dialects {
        let reader = open_bytes("t.csv", bytes, Format::Text);
        let mut reader = reader.unwrap_or_else(|e| panic!("{name}: {e}"));
        let contents = reader.contents().clone();
        let names: Vec<&str> = contents.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["t", "F"], "{name}");
        assert_eq!(contents.channels[1].time, TimeBase::Channel(0), "{name}");
        let found = samples(reader.as_mut());
        assert_eq!(found[0], [0.0, 0.5, 1.0], "{name}");
        assert_eq!(found[1][..2], [1234.5, -2.25], "{name}");
        assert!(found[1][2].is_nan(), "{name}");
        if name == "units" {
            assert_eq!(contents.channels[1].unit.as_deref(), Some("N"));
        }
        if name == "preamble" {
            assert_eq!(
                contents.properties[1],
                ("Operator".to_owned(), "B".to_owned())
            );
        }
    }
}

#[test]
fn closed_form_tables_without_names_dates_and_blanks() {
    for (text, names) in [
        // Rises evenly: the time.
        (
            "0.000\t3\n0.005\t4\n0.010\t5\n0.015\t6\n",
            ["column_1", "column_2"],
        ),
        (
            "# time (s), force (N)\n0.1  3\n0.2  4\n0.3  5\n",
            ["time (s)", "force (N)"],
        ),
        (
            "when,F\n2024-11-19 20:39:53.5,3\n2024-11-19 20:39:54.0,4\n",
            ["when", "F"],
        ),
    ] {
        let mut reader = open_bytes("t.txt", text.as_bytes().to_vec(), Format::Text).unwrap();
        let channels = &reader.contents().channels;
        let found: Vec<&str> = channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(found, names);
        assert_eq!(channels[1].time, TimeBase::Channel(0), "{text}");
        assert_eq!(samples(reader.as_mut())[1][1], 4.0);
    }
}

#[test]
fn closed_form_settings_win_over_what_is_found_out() {
    let read = |text: &[u8], settings: TextOptions| {
        let options = OpenOptions {
            format: Some(Format::Text),
            text: settings,
        };
        let source = Source::from_bytes("t", text.to_vec());
        samples(open_source(source, &options).unwrap().as_mut())
    };
    let text = b"a;b\n1,5;2,5\n3,5;4,5\n";
    assert_eq!(read(text, TextOptions::default()), [[1.5, 3.5], [2.5, 4.5]]);
    let header = TextOptions {
        header_line: Some(2),
        ..TextOptions::default()
    };
    assert_eq!(read(text, header), [[3.5], [4.5]]);
    let commas = TextOptions {
        separator: Some(Separator::Mark(b',')),
        ..TextOptions::default()
    };
    assert_eq!(read(b"1,5\n2,5\n", commas), [[1.0, 2.0], [5.0, 5.0]]);
}

#[test]
fn rejects_what_is_no_table_of_numbers_or_damaged() {
    let prose = "no table of numbers found (line 1 reads";
    for (text, expected) in [
        ("t,F\n", format!("t.csv: {prose} \"t,F\"); expected lines of")),
        ("\n \n", "t.csv: the file is empty; expected a header line".to_owned()),
        ("Dear Sir,\nhow do you do?\n", format!("t.csv: {prose} \"Dear Sir,\")")),
        (
            "t,F\n0,1\n1,x2\n2,3\n",
            "t.csv, line 3, column \"F\": \"x2\" is not a number; if it stands for a missing sample, \
             name it: missing = [\"x2\"]"
                .to_owned(),
        ),
        (
            "t;F\n0;1,5\n1;2,5\n2;3.5\n",
            "t.csv, line 4, column \"F\": \"3.5\" is not a number (the other cells have \",\" before"
                .to_owned(),
        ),
        (
            "t,F\n0,1\n1\n2,3\n",
            "t.csv, line 3: expected 2 cells, as in the lines before, but found 1".to_owned(),
        ),
        (
            "t,F\n0,1\n1,2,3\n2,3\n",
            "t.csv, line 3: expected 2 cells, as in the lines before, but found 3".to_owned(),
        ),
    ] {
        println!("{text:?}");
        let read = open_bytes("t.csv", text.as_bytes().to_vec(), Format::Text)
            .and_then(|mut reader| reader.read_whole(&[0, 1]));
        let message = read.unwrap_err().to_string();
        assert!(message.starts_with(&expected), "{text:?}: {message}");
    }
}

fn notes_of(reader: &dyn Reader) -> Vec<String> {
    let notes = reader.contents().notes.iter();
    notes
        .map(|note| format!("{}: {note}", note.code()))
        .collect()
}

/// Samples and notes of a text, read with settings.
fn read_with(text: &[u8], settings: TextOptions) -> Result<(Vec<Vec<f64>>, Vec<String>), Error> {
    let options = OpenOptions {
        format: Some(Format::Text),
        text: settings,
    };
    let source = Source::from_bytes("t.csv", text.to_vec());
    let mut reader = open_source(source, &options)?;
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let found = reader.read_whole(&all)?;
    Ok((found, notes_of(reader.as_ref())))
}

#[test]
fn closed_form_missing_samples_are_told_from_blank_cells_and_said() {
    let words = [
        "NaN", "nan", "NA", "N/A", "#N/A", "null", "NULL", "None", "-", "--", ".", "?", "OVLD",
        "OVL", "OL", "OVERLOAD", "Over", "Inf", "#DIV/0!", "1.#QNAN", "-1.#IND", "\"n/a\"",
    ];
    for word in words {
        let text = format!("t,F\n0,1\n1,{word}\n2,\n3,{word}\n4,5\n");
        let (found, notes) = read_with(text.as_bytes(), TextOptions::default()).unwrap();
        assert_eq!((found[1][0], found[1][4]), (1.0, 5.0), "{word}");
        let missing: Vec<bool> = found[1].iter().map(|sample| is_missing(*sample)).collect();
        assert_eq!(missing, [false, true, false, true, false], "{word}");
        assert!(found[1][2].is_nan());
        let word = word.trim_matches('"');
        let expected = format!(
            "missing-samples: \"F\": 2 cell(s) taken as missing samples; the first is \"{word}\" in \
             line 3"
        );
        assert_eq!(notes, [expected]);
    }
    // Words and numbers of the user; a number however it is written.
    let own = TextOptions {
        missing: vec!["defect".to_owned(), "9999".to_owned()],
        ..TextOptions::default()
    };
    for text in [
        "t,F\n0,1\n1,defect\n2,9999.0\n3,4\n",
        "t F\n0 1\n1 9.999e3\n2 9999\n3 4\n",
    ] {
        let (found, notes) = read_with(text.as_bytes(), own.clone()).unwrap();
        assert!(is_missing(found[1][1]) && is_missing(found[1][2]), "{text}");
        assert_eq!(
            (found[0][3], found[1][3], notes.len()),
            (3.0, 4.0, 1),
            "{text}"
        );
    }
}

#[test]
fn closed_form_footers_and_zeros_at_the_end_are_no_rows() {
    let footer = |lines| TextOptions {
        footer: lines,
        ..TextOptions::default()
    };
    let text = "t;F\n0;1\n1;2\nMaximum;2\nEnd of file\n";
    let utf16 = |unit: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(unit).collect::<Vec<u8>>();
    let dialects = [
        text.as_bytes().to_vec(),
        text.trim_end().as_bytes().to_vec(),
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        utf16(u16::to_le_bytes),
        utf16(u16::to_be_bytes),
    ];
    for (index, mut bytes) in dialects.into_iter().enumerate() {
        for zeros in [0, 4096] {
            bytes.extend(vec![0; zeros]);
            let options = TextOptions {
                encoding: match index {
                    4 => Some(Encoding::Utf16Le),
                    5 => Some(Encoding::Utf16Be),
                    _ => None,
                },
                ..footer(2)
            };
            let (found, notes) = read_with(&bytes, options).unwrap();
            assert_eq!(found, [[0.0, 1.0], [1.0, 2.0]], "{index} {zeros}");
            assert_eq!(notes.len(), 1 + usize::from(zeros > 0), "{notes:?}");
        }
    }
    let told = read_with(text.as_bytes(), footer(9))
        .unwrap_err()
        .to_string();
    assert!(
        told.contains("footer = 9 does not fit: the file has 5 lines"),
        "{told}"
    );
    let told = read_with(text.as_bytes(), TextOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        told.contains("line 4, column \"t\"") || told.contains("footer"),
        "{told}"
    );
    // Zeros elsewhere are no text.
    assert!(read_with(b"t,F\n0,1\n1,\0\n2,3\n", TextOptions::default()).is_err());
}

#[test]
fn closed_form_times_of_day_go_on_after_midnight() {
    let text = b"clock,F\n23:59:59.5,1\n23:59:59.75,2\n00:00:00,3\n00:00:00.25,4\n";
    let (found, notes) = read_with(text, TextOptions::default()).unwrap();
    assert_eq!(found[0], [0.0, 0.25, 0.5, 0.75]);
    let told =
        "assumed: the times of day in \"clock\" pass midnight after 2 rows and go on from there";
    assert!(notes.iter().any(|note| note == told), "{notes:?}");
    // With dates nothing is added, and a clock that was set back a little is not midnight.
    let text = b"clock,F\n2024-12-31 23:59:59.5,1\n2025-01-01 00:00:00,2\n";
    assert_eq!(
        read_with(text, TextOptions::default()).unwrap().0[0],
        [0.0, 0.5]
    );
    let text = b"clock,F\n12:00:05,1\n12:00:03,2\n";
    assert_eq!(
        read_with(text, TextOptions::default()).unwrap().0[0],
        [0.0, -2.0]
    );
}

/// Whether three digits follow a decimal mark or a mark between groups: the likelier
/// reading, and what says so.
#[test]
fn closed_form_marks_that_could_be_either_are_asked_about() {
    for (text, first, asked) in [
        ("20.123;21.456\n22.456;21.567\n", 20.123, true),
        ("20,123;21,456\n22,456;21,567\n", 20.123, true),
        ("20,123\t21,456\n22,456\t21,567\n", 20.123, true),
        ("1,234\t5\n678\t6\n2,345\t7\n", 1234.0, true),
        ("\"1,234\",5\n\"2,345\",6\n", 1.234, true),
        ("\"1,234\",5\n\"2,34\",6\n", 1.234, false),
        ("20.123,21.456\n22.456,21.567\n", 20.123, false),
        ("0,5;1.234\n0,7;2.345\n", 0.5, true),
        // One cell shows it.
        ("20.123;0.5\n22.456;1.5\n", 20.123, false),
        ("1.234,5;7\n2.345,6;8\n", 1234.5, false),
        ("1.234.567;7\n2.345;8\n", 1_234_567.0, false),
        ("1.234e0;7\n2.345e0;8\n", 1.234, false),
    ] {
        let (found, notes) = read_with(text.as_bytes(), TextOptions::default()).unwrap();
        assert_eq!(found[0][0], first, "{text:?} {notes:?}");
        let told = notes
            .iter()
            .any(|note| note.starts_with("decimal-or-thousands: \""));
        assert_eq!(told, asked, "{text:?} {notes:?}");
    }
    let settled = TextOptions {
        decimal: Some(','),
        thousands: Some('.'),
        ..TextOptions::default()
    };
    let (found, notes) = read_with(b"20.123;21.456\n22.456;21.567\n", settled).unwrap();
    assert_eq!((found[0][0], notes.len()), (20_123.0, 0));
}

#[test]
fn recovers_a_file_that_was_cut_off() {
    let text = b"t,F,x\n0,1,2\n1,2,3\n2,".to_vec();
    let mut reader = open_bytes("t.csv", text, Format::Text).unwrap();
    let read = reader.read_whole(&[0, 1, 2]).unwrap();
    assert_eq!(read, [[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]]);
    let notes: Vec<String> = reader
        .contents()
        .notes
        .iter()
        .map(ToString::to_string)
        .collect();
    let expected = "the file is cut off: its last line, 4, has 2 of 3 cells and is left out";
    assert_eq!(notes, [expected]);
}

/// Lengths and checksums by pandas 3.0 (`read_csv`, `float_precision="round_trip"`)
/// and, for blanks, by numpy 2.4 (`loadtxt`).
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "impact/impack_water/2mps_sphere_1_100gPR_20kHz.csv",
            &[
                ("time_s", 40_000, 0x2e40_9c07_24bd_b165, None),
                ("x_g", 40_000, 0x2a0b_4a23_e11a_b2ec, None),
                ("y_g", 40_000, 0xece2_27fa_19b6_083a, None),
                ("z_g", 40_000, 0xd8a6_dc1e_7778_e49b, None),
            ],
        ),
        (
            "impact/foam_pads/author_tau_Fpeak_table.csv",
            &[
                ("h", 35, 0x9bc1_0000_0000_0000, None),
                ("Run", 35, 0x5f9c_0000_0000_0000, None),
                ("tau", 35, 0x5c04_7ae1_47ae_1507, None),
                ("F_peak", 35, 0x9a3c_51eb_851e_b88e, None),
            ],
        ),
        (
            "compression/fruit_grip/kiwi_20241119_203953.csv",
            &[
                ("column_1", 705, 0x1c45_0000_0000_0000, None),
                ("Time", 705, 0x9e3c_6ed2_79eb_102d, None),
                ("Force", 705, 0x0b7d_196f_0800_0000, None),
                ("GoalForce", 705, 0x07ec_5361_a000_0000, None),
                ("Pos", 705, 0x492e_3df3_2000_0000, None),
                ("k", 705, 0x0c74_9b15_62a7_66a8, None),
            ],
        ),
        (
            "compression/elastomer_tension_ODbL/Dragon Skin 20.csv",
            &[
                ("Time (s)", 404, 0x62f8_7333_3333_32f9, None),
                ("True Strain", 404, 0x0c0a_dada_df00_9a05, None),
                ("True Stress (MPa)", 404, 0x9555_effd_5fc0_ea17, None),
                ("Engineering Strain", 404, 0x50ba_d3ab_c277_507a, None),
                ("Engineering Stress (MPa)", 404, 0x3535_2525_f532_109e, None),
            ],
        ),
        (
            "impact/hrshm_ds5_txt/acc_pcb_a0.txt",
            &[
                ("time(s)", 5500, 0x0311_c2e3_31e7_18ec, None),
                ("acceleration(g)", 5500, 0x86e9_071f_d1dc_1df9, None),
            ],
        ),
        (
            "impact/hrshm_ds11_lvm200k/HM_b04_12in_10.lvm",
            &[
                ("column_1", 20_000, 0xc0a7_8572_9b27_e021, None),
                ("column_2", 20_000, 0x4c82_da64_c91c_47bf, None),
                ("column_3", 20_000, 0xafea_f5cd_cc16_609b, None),
                ("column_4", 20_000, 0x9fda_efd4_38d1_d8a5, None),
            ],
        ),
        (
            "impact/hrshm_ds1_1MSs/accel_1.csv",
            &[
                ("time", 5000, 0x8324_6e08_f217_663b, None),
                ("accel 1", 5000, 0x4485_9b1b_a92e_1a99, None),
                ("accel 2", 5000, 0x6f9d_a707_4c60_1d6b, None),
                ("accel 3", 5000, 0xf9b6_7641_94a8_7087, None),
                ("accel 4", 5000, 0xe338_bf8d_b3f4_f470, None),
                ("accel top", 5000, 0x2af5_8ab8_4611_b583, None),
            ],
        ),
        (
            "encoder/ibl_wheel/training_ge5_encoderPositions.raw.ssv",
            &[
                ("column_1", 936, 0x718c_79c6_b800_0000, None),
                ("column_2", 936, 0xe494_8000_0000_0000, None),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Text, channels);
    }
}
