//! TDMS files.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::contents::{Format, TimeBase};

/// Checksums by npTDMS 1.10.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/tdms/NIspec_IncrementalMeta_step1.tdms",
            &[
                ("group/channel1", 3, 0x4018_0000_0000_0000, None),
                ("group/channel2", 3, 0x40c4_0000_0000_0000, None),
            ],
        ),
        (
            "daq_formats/tdms/NIspec_IncrementalMeta_step2.tdms",
            &[
                ("group/channel1", 6, 0x0000_0000_0000_0000, None),
                ("group/channel2", 6, 0x02f0_0000_0000_0000, None),
            ],
        ),
        (
            "daq_formats/tdms/NIspec_IncrementalMeta_step3.tdms",
            &[
                ("group/channel1", 9, 0x3fb8_0000_0000_0000, None),
                ("group/channel2", 9, 0x4684_0000_0000_0000, None),
            ],
        ),
        (
            "daq_formats/tdms/NIspec_IncrementalMeta_step4.tdms",
            &[
                ("group/channel1", 12, 0xff40_0000_0000_0000, None),
                ("group/channel2", 12, 0x0b80_0000_0000_0000, None),
                ("group/voltage", 5, 0x4378_0000_0000_0000, None),
            ],
        ),
        (
            "daq_formats/tdms/nptdms_big_endian.tdms",
            &[
                (
                    "Measured Data/Amplitude sweep",
                    3500,
                    0xe4ab_11ab_6488_4633,
                    Some((0.0, 0.001)),
                ),
                (
                    "Measured Data/Phase sweep",
                    3500,
                    0x2c7d_962a_691a_fc2e,
                    Some((0.0, 0.001)),
                ),
            ],
        ),
        (
            "daq_formats/tdms/nptdms_raw1.tdms",
            &[
                (
                    "Layer Data/First  Channel",
                    2000,
                    0x3550_2ae0_55bf_cf01,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Second Chan",
                    2000,
                    0xa077_778e_ef1e_4a99,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Third Chan",
                    2000,
                    0x6254_c2e9_85d2_1541,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Fourth Chan",
                    2000,
                    0x8535_c9eb_93d6_4991,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Fifth Chan",
                    2000,
                    0x4a62_6224_c449_0f7f,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Sixth Chan",
                    2000,
                    0xaf0a_9bb5_3769_fc6f,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
                (
                    "Layer Data/Seventh Cha",
                    2000,
                    0x612b_c2b7_856e_3e3e,
                    Some((0.0, 1.9999999999999998e-05)),
                ),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Tdms, channels);
    }
}

fn text(text: &str) -> Vec<u8> {
    let mut bytes = (text.len() as u32).to_le_bytes().to_vec();
    bytes.extend(text.as_bytes());
    bytes
}

enum Value<'a> {
    Text(&'a str),
    Number(f64),
    Count(u32),
}

fn object(path: &str, index: &[u8], properties: &[(&str, Value)]) -> Vec<u8> {
    let mut bytes = text(path);
    bytes.extend(index);
    bytes.extend((properties.len() as u32).to_le_bytes());
    for (name, value) in properties {
        bytes.extend(text(name));
        match value {
            Value::Text(value) => {
                bytes.extend(0x20_u32.to_le_bytes());
                bytes.extend(text(value));
            }
            Value::Number(value) => {
                bytes.extend(10_u32.to_le_bytes());
                bytes.extend(value.to_le_bytes());
            }
            Value::Count(value) => {
                bytes.extend(7_u32.to_le_bytes());
                bytes.extend(value.to_le_bytes());
            }
        }
    }
    bytes
}

fn values(code: u32, count: u64) -> Vec<u8> {
    let mut bytes = 20_u32.to_le_bytes().to_vec();
    bytes.extend(code.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(count.to_le_bytes());
    bytes
}

const META: u32 = 2 | 4;
const RAW: u32 = 8;
const INTERLEAVED: u32 = 32;

fn segment(flags: u32, objects: &[Vec<u8>], raw: &[u8]) -> Vec<u8> {
    let mut metadata = (objects.len() as u32).to_le_bytes().to_vec();
    metadata.extend(objects.concat());
    let mut bytes = b"TDSm".to_vec();
    bytes.extend(flags.to_le_bytes());
    bytes.extend(4713_u32.to_le_bytes());
    bytes.extend(((metadata.len() + raw.len()) as u64).to_le_bytes());
    bytes.extend((metadata.len() as u64).to_le_bytes());
    bytes.extend(metadata);
    bytes.extend(raw);
    bytes
}

fn read(bytes: Vec<u8>) -> Vec<Vec<f64>> {
    samples(open_bytes("t.tdms", bytes, Format::Tdms).unwrap().as_mut())
}

fn scaled(path: &str, code: u32, count: u64) -> Vec<u8> {
    object(
        path,
        &values(code, count),
        &[
            ("wf_increment", Value::Number(0.5)),
            ("unit_string", Value::Text("N")),
            ("NI_Number_Of_Scales", Value::Count(1)),
            ("NI_Scale[0]_Scale_Type", Value::Text("Linear")),
            ("NI_Scale[0]_Linear_Slope", Value::Number(2.0)),
            ("NI_Scale[0]_Linear_Y_Intercept", Value::Number(1.0)),
        ],
    )
}

#[test]
fn closed_form_interleaved_and_contiguous_segments() {
    let objects = [
        scaled("/'g'/'it''s'", 2, 2),
        object("/'g'/'u'", &values(5, 2), &[]),
    ];
    let interleaved = segment(META | RAW | INTERLEAVED, &objects, &[1, 0, 7, 255, 255, 8]);
    let contiguous = segment(META | RAW, &objects, &[3, 0, 4, 0, 9, 10]);
    let bytes = [interleaved, contiguous.clone(), contiguous].concat();
    let mut reader = open_bytes("t.tdms", bytes, Format::Tdms).unwrap();
    let channel = &reader.contents().channels[0];
    let time = TimeBase::Uniform {
        start: 0.0,
        interval: 0.5,
    };
    assert_eq!((channel.name.as_str(), channel.time), ("g/it's", time));
    assert_eq!(channel.unit.as_deref(), Some("N"));
    let found = samples(reader.as_mut());
    assert_eq!(found[0], [3.0, -1.0, 7.0, 9.0, 7.0, 9.0]);
    assert_eq!(found[1], [7.0, 8.0, 9.0, 10.0, 9.0, 10.0]);
}

/// What is read in blocks is what is read at once, in any choice of channels.
#[test]
fn repeats_in_blocks() {
    struct Blocks(Vec<Vec<f64>>);
    impl windfall_formats::reader::Sink for Blocks {
        fn take(&mut self, at: usize, samples: &[f64]) -> Result<(), windfall_formats::Error> {
            assert!(samples.len() <= 1 << 18);
            self.0[at].extend(samples);
            Ok(())
        }
    }
    let n = 300_000_u64;
    let raw: Vec<u8> = (0..n)
        .flat_map(|i| (i as i16).to_le_bytes())
        .chain((0..n).map(|i| i as u8))
        .collect();
    let objects = [
        scaled("/'g'/'a'", 2, n),
        object("/'g'/'u'", &values(5, n), &[]),
    ];
    let bytes = segment(META | RAW, &objects, &raw);
    let mut reader = open_bytes("t.tdms", bytes, Format::Tdms).unwrap();
    let whole = samples(reader.as_mut());
    let mut blocks = Blocks(vec![Vec::new(); 2]);
    reader.read(&[1, 0], &mut blocks).unwrap();
    assert!(blocks.0[0] == whole[1] && blocks.0[1] == whole[0]);
    assert_eq!(whole[0][299_999], 2.0 * f64::from(299_999_u32 as i16) + 1.0);
}

#[test]
fn recovers_what_is_complete_in_a_file_that_was_cut_off() {
    let objects = [
        object("/'g'/'a'", &values(2, 2), &[]),
        object("/'g'/'u'", &values(5, 2), &[]),
    ];
    let bytes = segment(META | RAW, &objects, &[1, 0, 2, 0, 3, 4]);
    let cut = |left: usize| read(bytes[..bytes.len() - left].to_vec());
    assert_eq!(cut(0), [vec![1.0, 2.0], vec![3.0, 4.0]]);
    assert_eq!(cut(1), [vec![1.0, 2.0], vec![3.0]]);
    assert_eq!(cut(3), [vec![1.0], vec![]]);
    let reader = open_bytes("t.tdms", bytes[..bytes.len() - 1].to_vec(), Format::Tdms).unwrap();
    assert_eq!(reader.contents().notes[0].code(), "cut-off");
}

#[test]
fn rejects_damaged_files_and_says_where() {
    let objects = [object("/'g'/'a'", &values(2, 2), &[])];
    let good = segment(META | RAW, &objects, &[1, 0, 2, 0]);
    let with = |at: usize, new: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        bytes
    };
    let second = [good.clone(), with(0, b"TDSx")].concat();
    let same = segment(META | RAW, &[object("/'g'/'a'", &[0; 4], &[])], &[1, 0]);
    for (bytes, expected) in [
        (
            with(0, b"TDSh"),
            "t.tdms, at byte 0: this is an index file (.tdms_index)",
        ),
        (second, "at byte 72: expected a segment, which begins with"),
        (
            with(20, &[0xff, 0xff, 0, 0]),
            "the raw data begin at 65535, after the end of their segment at 44",
        ),
        (with(48, &[0x77]), "the data type 0x77 is not known"),
        (same, "/'g'/'a' refers to an index that was never defined"),
    ] {
        let message = open_bytes("t.tdms", bytes, Format::Tdms)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn rejects_scales_that_go_in_a_circle_and_leaves_the_channel_out() {
    let circle = object(
        "/'g'/'a'",
        &values(2, 1),
        &[
            ("NI_Number_Of_Scales", Value::Count(1)),
            ("NI_Scale[0]_Scale_Type", Value::Text("Linear")),
            ("NI_Scale[0]_Linear_Slope", Value::Number(2.0)),
            ("NI_Scale[0]_Linear_Y_Intercept", Value::Number(1.0)),
            ("NI_Scale[0]_Linear_Input_Source", Value::Count(0)),
        ],
    );
    let reader = open_bytes(
        "t.tdms",
        segment(META | RAW, &[circle], &[1, 0]),
        Format::Tdms,
    )
    .unwrap();
    assert!(reader.contents().channels.is_empty());
    let note = reader.contents().notes[0].to_string();
    assert!(note.contains("its scales are cyclic"), "{note}");
}
