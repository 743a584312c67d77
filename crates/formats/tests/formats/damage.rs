//! Files cut off, with bytes changed and with absurd sizes: an error or samples,
//! never a panic, never more samples than the file can hold.

use crate::seeds::seeds;
use windfall_formats::Error;
use windfall_formats::contents::Format;
use windfall_formats::open::{OpenOptions, open_source};
use windfall_formats::reader::Sink;
use windfall_source::source::Source;

/// Samples per byte that a file can give: a bit of a digital line, or a short
/// number with its separator, and several channels in one place.
const PER_BYTE: usize = 16;

struct Counter {
    samples: usize,
    faults: usize,
}

impl Sink for Counter {
    fn take(&mut self, _: usize, samples: &[f64]) -> Result<(), Error> {
        self.samples += samples.len();
        Ok(())
    }

    fn fault(&mut self, _: Error) -> Result<(), Error> {
        self.faults += 1;
        Ok(())
    }
}

/// Reads all of a file; the number of samples.
fn read(format: Format, bytes: &[u8]) -> Result<usize, Error> {
    let options = OpenOptions {
        format: Some(format),
        ..OpenOptions::default()
    };
    let mut reader = open_source(Source::from_bytes("damaged", bytes.to_vec()), &options)?;
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let mut counter = Counter {
        samples: 0,
        faults: 0,
    };
    reader.read(&all, &mut counter)?;
    Ok(counter.samples)
}

pub fn check(name: &str, format: Format, bytes: &[u8]) {
    let read = std::panic::catch_unwind(|| read(format, bytes));
    let read = read.unwrap_or_else(|_| panic!("{name}: panic on {}", bytes.escape_ascii()));
    match read {
        Ok(samples) => assert!(
            samples <= PER_BYTE * bytes.len(),
            "{name}: {samples} samples"
        ),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

#[test]
fn closed_form_seeds_are_valid() {
    for (name, format, bytes) in seeds() {
        let samples = read(format, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(samples >= 4, "{name}: {samples}");
        let told = windfall_formats::open::tell_format(&Source::from_bytes(name, bytes)).unwrap();
        assert_eq!(told, format, "{name}");
    }
}

#[test]
fn rejects_or_reads_files_cut_off_anywhere() {
    for (name, format, bytes) in seeds() {
        for length in 0..bytes.len() {
            check(name, format, &bytes[..length]);
        }
    }
}

#[test]
fn rejects_or_reads_files_with_any_byte_changed() {
    for (name, format, bytes) in seeds() {
        for at in 0..bytes.len() {
            for value in [
                0,
                1,
                0x7f,
                0x80,
                0xff,
                b'9',
                b'\n',
                bytes[at] ^ 1,
                bytes[at].wrapping_add(3),
            ] {
                let mut damaged = bytes.clone();
                damaged[at] = value;
                check(name, format, &damaged);
            }
        }
    }
}

#[test]
fn rejects_or_reads_files_with_absurd_sizes() {
    // Spreadsheets are archives like "zip"; numbers in them are texts, see damage_members.
    let binary = |format| !matches!(format, Format::Xlsx | Format::Ods);
    for (name, format, bytes) in seeds().into_iter().filter(|seed| binary(seed.1)) {
        for at in 0..bytes.len().saturating_sub(8) {
            for value in [
                u64::MAX,
                u64::MAX >> 1,
                1 << 63,
                1 << 32,
                u64::from(u32::MAX),
                1 << 31,
                0,
            ] {
                for width in [4, 8] {
                    let mut damaged = bytes.clone();
                    damaged[at..at + width].copy_from_slice(&value.to_le_bytes()[..width]);
                    check(name, format, &damaged);
                    damaged[at..at + width].copy_from_slice(&value.to_be_bytes()[8 - width..]);
                    check(name, format, &damaged);
                }
            }
        }
    }
}
