//! Captures of sigrok.

use crate::channels::{check_file, open_bytes};
use windfall_formats::contents::Format;

/// Checksums by zipfile of Python 3 and numpy 2.4.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "encoder/sigrok_graycode-ramp-no-samplerate.sr",
            &[
                ("0", 84143, 0xb790_0000_0000_0000, None),
                ("1", 84143, 0x3810_0000_0000_0000, None),
                ("2", 84143, 0x2090_0000_0000_0000, None),
                ("3", 84143, 0x9050_0000_0000_0000, None),
                ("4", 84143, 0x5c80_0000_0000_0000, None),
                ("5", 84143, 0x8900_0000_0000_0000, None),
                ("6", 84143, 0xbbf0_0000_0000_0000, None),
                ("7", 84143, 0xc980_0000_0000_0000, None),
            ],
        ),
        (
            "encoder/sigrok_rotary-ramp.sr",
            &[
                ("0", 600000, 0xc610_0000_0000_0000, Some((0.0, 1e-06))),
                ("1", 600000, 0x5520_0000_0000_0000, Some((0.0, 1e-06))),
            ],
        ),
        (
            "encoder/sigrok_stepdir_grbl_cnc_1.sr",
            &[
                ("EN", 96727040, 0x0390_0000_0000_0000, Some((0.0, 5e-07))),
                (
                    "STEP (Y axis)",
                    96727040,
                    0x8640_0000_0000_0000,
                    Some((0.0, 5e-07)),
                ),
                ("TX", 96727040, 0x4480_0000_0000_0000, Some((0.0, 5e-07))),
                ("RX", 96727040, 0xd450_0000_0000_0000, Some((0.0, 5e-07))),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Sigrok, channels);
    }
}

#[test]
fn rejects_archives_that_are_no_captures() {
    let bytes = b"PK\x03\x04 and nothing else".to_vec();
    let message = open_bytes("t.sr", bytes, Format::Sigrok)
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("the archive has no directory at its end"),
        "{message}"
    );
}
