//! Damaged MAT and HDF5 files: cut off anywhere, with any byte changed, with
//! extreme numbers in any place. Each is read or refused; none makes the reader
//! panic or hand over more than the file can hold.

use windfall_formats::Error;
use windfall_formats::contents::Format;
use windfall_formats::open::{OpenOptions, open_source};
use windfall_formats::reader::Sink;
use windfall_source::source::Source;

struct Counted(u64);

impl Sink for Counted {
    fn take(&mut self, _: usize, samples: &[f64]) -> Result<(), Error> {
        self.0 += samples.len() as u64;
        Ok(())
    }
}

/// Reads all of a file; the number of samples.
fn read(format: Format, bytes: Vec<u8>) -> Result<u64, Error> {
    let options = OpenOptions {
        format: Some(format),
        ..OpenOptions::default()
    };
    let mut reader = open_source(Source::from_bytes("damaged", bytes), &options)?;
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let mut counted = Counted(0);
    reader.read(&all, &mut counted)?;
    Ok(counted.0)
}

/// Deflate packs at most 1032 bytes into one; a small part may be unwritten.
fn most_samples(bytes: &[u8]) -> u64 {
    1032 * bytes.len() as u64 + (1 << 16)
}

fn check(format: Format, bytes: Vec<u8>, refused: &mut u64) {
    let most = most_samples(&bytes);
    match read(format, bytes) {
        Ok(samples) => assert!(samples <= most, "{samples} samples"),
        Err(error) => {
            assert!(error.to_string().starts_with("damaged"), "{error}");
            *refused += 1;
        }
    }
}

fn damage(file: &[u8], format: Format) {
    let whole = read(format, file.to_vec()).unwrap();
    assert!(whole > 20);
    let mut refused = 0;
    for length in 0..file.len() {
        check(format, file[..length].to_vec(), &mut refused);
    }
    assert!(refused > 20);
    // Every place of a short file and some of a longer one; all of them where
    // WINDFALL_DAMAGE is set, which takes minutes.
    let all = std::env::var_os("WINDFALL_DAMAGE").is_some();
    let step = if all { 1 } else { file.len() / 1000 + 1 };
    for at in (0..file.len()).step_by(step) {
        for value in [0, 1, 2, 0x7f, 0x80, 0xff, file[at] ^ 1, file[at] ^ 0x10] {
            let mut bytes = file.to_vec();
            bytes[at] = value;
            check(format, bytes, &mut refused);
        }
        for word in [u64::MAX, u64::MAX >> 1, 1 << 40, 0x7fff_ffff, 1 << 20, 0] {
            for width in [4, 8] {
                let mut bytes = file.to_vec();
                let end = (at + width).min(bytes.len());
                bytes[at..end].copy_from_slice(&word.to_le_bytes()[..end - at]);
                check(format, bytes, &mut refused);
            }
        }
    }
}

#[test]
fn rejects_or_reads_damaged_mat_files_of_version_4() {
    damage(include_bytes!("fixtures/version4.mat"), Format::Mat);
}

#[test]
fn rejects_or_reads_damaged_mat_files() {
    damage(include_bytes!("fixtures/plain.mat"), Format::Mat);
}

#[test]
fn rejects_or_reads_damaged_compressed_mat_files() {
    damage(include_bytes!("fixtures/packed.mat"), Format::Mat);
}

#[test]
fn rejects_or_reads_damaged_old_hdf5_files() {
    damage(include_bytes!("fixtures/old.h5"), Format::Hdf5);
}

#[test]
fn rejects_or_reads_damaged_new_hdf5_files() {
    damage(include_bytes!("fixtures/new.h5"), Format::Hdf5);
}

#[test]
fn rejects_or_reads_damaged_indices_of_chunks() {
    damage(include_bytes!("fixtures/chunks.h5"), Format::Hdf5);
}

#[test]
fn rejects_or_reads_damaged_matlab_73_files() {
    damage(include_bytes!("fixtures/matlab73.mat"), Format::Hdf5);
}
