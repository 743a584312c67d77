//! WAVE files.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::contents::Format;

/// Checksums by soundfile 0.13 (float64) or, for integers above 32 bits, by
/// scipy.io.wavfile 1.17 divided by full scale.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/wav_odd/test-1234Hz-le-1ch-10S-20bit-extra.wav",
            &[(
                "channel 1",
                10,
                0x683f_fe70_0000_0000,
                Some((0.0, 1.0 / 1234.0)),
            )],
        ),
        (
            "daq_formats/wav_odd/test-44100Hz-2ch-32bit-float-be.wav",
            &[
                (
                    "channel 1",
                    441,
                    0x62f8_0cb9_4000_0000,
                    Some((0.0, 1.0 / 44100.0)),
                ),
                (
                    "channel 2",
                    441,
                    0x62f8_0cb9_4000_0000,
                    Some((0.0, 1.0 / 44100.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-44100Hz-2ch-32bit-float-le.wav",
            &[
                (
                    "channel 1",
                    441,
                    0x62f7_e1c1_4000_0000,
                    Some((0.0, 1.0 / 44100.0)),
                ),
                (
                    "channel 2",
                    441,
                    0x62f7_e1c1_4000_0000,
                    Some((0.0, 1.0 / 44100.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-44100Hz-be-1ch-4bytes.wav",
            &[(
                "channel 1",
                4410,
                0xdb0e_8c4e_d6c0_0000,
                Some((0.0, 1.0 / 44100.0)),
            )],
        ),
        (
            "daq_formats/wav_odd/test-44100Hz-le-1ch-4bytes.wav",
            &[(
                "channel 1",
                4410,
                0xdb0e_8c4e_d6c0_0000,
                Some((0.0, 1.0 / 44100.0)),
            )],
        ),
        (
            "daq_formats/wav_odd/test-48000Hz-2ch-64bit-float-le-wavex.wav",
            &[
                (
                    "channel 1",
                    480,
                    0xddec_9e81_2000_0000,
                    Some((0.0, 1.0 / 48000.0)),
                ),
                (
                    "channel 2",
                    480,
                    0xddec_9e81_2000_0000,
                    Some((0.0, 1.0 / 48000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-1ch-1byte-ulaw.wav",
            &[(
                "channel 1",
                9,
                0xfabc_0a00_0000_0000,
                Some((0.0, 1.0 / 8000.0)),
            )],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-2ch-1byteu.wav",
            &[
                (
                    "channel 1",
                    800,
                    0xf8ca_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    800,
                    0xcbe9_4000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-3ch-5S-36bit.wav",
            &[
                (
                    "channel 1",
                    5,
                    0xfe1f_ffff_ffdc_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    5,
                    0xfe1f_ffff_ff88_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    5,
                    0xd3a0_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-3ch-5S-45bit.wav",
            &[
                (
                    "channel 1",
                    5,
                    0xfe1f_ffff_ffff_ee00,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    5,
                    0xfe1f_ffff_ffff_c400,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    5,
                    0xc860_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-3ch-5S-53bit.wav",
            &[
                (
                    "channel 1",
                    5,
                    0xfe1f_ffff_ffff_ffee,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    5,
                    0xfe1f_ffff_ffff_ffc4,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    5,
                    0xbe60_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-3ch-5S-64bit.wav",
            &[
                (
                    "channel 1",
                    5,
                    0xfe20_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    5,
                    0xfe20_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    5,
                    0xb0a0_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-4ch-9S-12bit.wav",
            &[
                (
                    "channel 1",
                    9,
                    0xfb4e_d400_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    9,
                    0xfdbf_c800_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    9,
                    0xfb4e_b400_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 4",
                    9,
                    0x0000_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
        (
            "daq_formats/wav_odd/test-8000Hz-le-5ch-9S-5bit.wav",
            &[
                (
                    "channel 1",
                    9,
                    0xfb62_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 2",
                    9,
                    0xfda4_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 3",
                    9,
                    0xfb52_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 4",
                    9,
                    0x0000_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
                (
                    "channel 5",
                    9,
                    0xb952_0000_0000_0000,
                    Some((0.0, 1.0 / 8000.0)),
                ),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Wav, channels);
    }
}

fn chunk(name: &[u8], bytes: &[u8]) -> Vec<u8> {
    let mut chunk = name.to_vec();
    chunk.extend((bytes.len() as u32).to_le_bytes());
    chunk.extend(bytes);
    chunk.resize(chunk.len().next_multiple_of(2), 0);
    chunk
}

fn wav(code: u16, channels: u16, align: u16, bits: u16, data: &[u8]) -> Vec<u8> {
    let mut format = Vec::new();
    format.extend(code.to_le_bytes());
    format.extend(channels.to_le_bytes());
    format.extend(8000_u32.to_le_bytes());
    format.extend((8000 * u32::from(align)).to_le_bytes());
    format.extend(align.to_le_bytes());
    format.extend(bits.to_le_bytes());
    let mut body = b"WAVE".to_vec();
    body.extend(chunk(b"LIST", b"INFOISFT\x06\0\0\0rig 1\0"));
    body.extend(chunk(b"fmt ", &format));
    body.extend(chunk(b"data", data));
    chunk(b"RIFF", &body)
}

#[test]
fn closed_form_small_files() {
    let mut reader = open_bytes(
        "t.wav",
        wav(1, 2, 4, 16, &[0, 0x40, 0, 0x80, 1, 0, 0xff, 0xff]),
        Format::Wav,
    )
    .unwrap();
    let step = 1.0 / 32768.0;
    assert_eq!(samples(reader.as_mut()), [[0.5, step], [-1.0, -step]]);
    assert_eq!(
        reader.contents().properties,
        [("ISFT".to_owned(), "rig 1".to_owned())]
    );
}

/// Values of the tables of ITU-T G.711.
#[test]
fn reference_companded_bytes() {
    let read = |code| {
        let bytes = wav(code, 1, 1, 8, &[0x00, 0x80, 0x7f, 0xff, 0xd5, 0x55, 0xaa]);
        let mut reader = open_bytes("t.wav", bytes, Format::Wav).unwrap();
        samples(reader.as_mut())
            .remove(0)
            .into_iter()
            .map(|x| x * 32768.0)
            .collect::<Vec<_>>()
    };
    assert_eq!(read(7)[..4], [-32124.0, 32124.0, 0.0, 0.0]);
    assert_eq!(read(6)[4..], [8.0, -8.0, 32256.0]);
}

#[test]
fn recovers_what_is_there_of_a_file_that_was_cut_off() {
    let mut bytes = wav(1, 1, 2, 16, &[1; 100]);
    bytes.truncate(bytes.len() - 51);
    let mut reader = open_bytes("t.wav", bytes, Format::Wav).unwrap();
    assert_eq!(samples(reader.as_mut())[0].len(), 24);
    let notes: Vec<String> = reader
        .contents()
        .notes
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        notes[0],
        "the file is cut off: 100 bytes of samples are declared, 49 are there"
    );
}

#[test]
fn rejects_compressed_and_impossible_files() {
    for (bytes, expected) in [
        (
            wav(2, 1, 1, 4, &[0; 8]),
            "windfall does not read WAVE format 2 (Microsoft ADPCM); convert it to PCM",
        ),
        (
            wav(1, 0, 2, 16, &[0; 8]),
            "0 channels at 8000 Hz in frames of 2 bytes are impossible",
        ),
        (
            wav(3, 1, 2, 16, &[0; 8]),
            "16 bits in frames of 2 bytes for 1 channels are impossible",
        ),
        (b"RIFF\x04\0\0\0WAVE".to_vec(), "there is no chunk \"fmt \""),
        (
            b"RIFF\x04\0\0\0AVI ".to_vec(),
            "expected \"WAVE\"; this is not a WAVE file",
        ),
    ] {
        let message = open_bytes("t.wav", bytes, Format::Wav)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
}
