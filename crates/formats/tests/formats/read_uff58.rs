//! Universal files.

use crate::channels::{check_file, open_bytes};
use windfall_formats::contents::Format;

/// Checksums by pyuff 2.5.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/uff/Sample_UFF58_ascii.uff",
            &[(
                "Mic 01.0Scalar",
                79292,
                0xc121_0dd1_9c9a_20c8,
                Some((0.0, 1.52588e-05)),
            )],
        ),
        (
            "daq_formats/uff/Sample_UFF58b_bin.uff",
            &[(
                "Mic 01.0Scalar",
                79292,
                0xc6e4_6a55_a000_0000,
                Some((0.0, 1.52588e-05)),
            )],
        ),
        (
            "daq_formats/uff/sample_dataset58_psd.uff",
            &[
                (
                    "Power Spectral Density (PSD) (abscissa)",
                    3201,
                    0x73b7_8000_0000_0000,
                    None,
                ),
                (
                    "Power Spectral Density (PSD) (real)",
                    3201,
                    0x0c4b_a7eb_9165_b91f,
                    None,
                ),
                (
                    "Power Spectral Density (PSD) (imaginary)",
                    3201,
                    0x0000_0000_0000_0000,
                    None,
                ),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Uff58, channels);
    }
}

#[test]
fn rejects_files_without_functions_and_other_floats() {
    let none = b"    -1\n   164\n         1  SI: mks\n    -1\n".to_vec();
    let short = b"    -1\n    58\nNONE\n".to_vec();
    for (bytes, expected) in [
        (
            none,
            "t.uff: this universal file holds no function (data set 58 or 58b)",
        ),
        (
            short,
            "t.uff, line 4: the header of a function is incomplete",
        ),
    ] {
        let read = open_bytes("t.uff", bytes, Format::Uff58).map(|_| ());
        let message = read.unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    }
}
