//! HDF5 and MATLAB 7.3 files.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod channels;

use channels::check_file;
use windfall_formats::contents::Format;

/// Checksums by h5py 3.15.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[channels::Expected])] = &[
        (
            "daq_formats/mat/pymatreader_sparse_v73.mat",
            &[
                ("i", 5, 0x4218_0000_0000_0000, None),
                ("j", 5, 0x422a_0000_0000_0000, None),
                ("v", 5, 0x3b1e_f535_8ba5_9b6e, None),
            ],
        ),
        (
            "daq_formats/mat/scipy_testhdf5_7.4_GLNX86.mat",
            &[("testdouble", 9, 0x0492_f25d_99b4_dd7d, None)],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Hdf5, channels);
    }
}
