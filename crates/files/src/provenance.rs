//! Where a result comes from: digests of inputs, version, time.

use crate::error::Error;
use crate::inputs::{check_regular, protect};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// Version of windfall, part of every result.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Revision of the numbers that windfall gives, part of the key of every stored result.
/// It is raised with every change that moves a number, whatever the version: results of
/// another revision are made again. A test holds the digests of reference results
/// against it.
pub const REVISION: u32 = 13;

/// Bytes read at once: few enough for the stack.
const CHUNK: usize = 1 << 14;

/// SHA-256 of a text, as 64 hexadecimal digits.
///
/// # Source
/// NIST FIPS 180-4.
pub fn digest_text(text: &str) -> String {
    digest_bytes(text.as_bytes())
}

/// SHA-256 of bytes, as 64 hexadecimal digits.
pub fn digest_bytes(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 of an input, as 64 hexadecimal digits, without holding it in memory.
///
/// # Errors
/// The file cannot be read.
pub fn digest_file(path: &Path) -> Result<String, Error> {
    check_regular(path)?;
    protect(path);
    digest_of_file(path)
}

/// [`digest_file`] of a file that is no input.
///
/// # Errors
/// The file cannot be read.
pub fn digest_of_file(path: &Path) -> Result<String, Error> {
    let failed = |source| Error::access(path, "read", source);
    let mut file = File::open(path).map_err(failed)?;
    let mut digest = Sha256::new();
    let mut chunk = [0; CHUNK];
    loop {
        match file.read(&mut chunk).map_err(failed)? {
            0 => return Ok(hexadecimal(&digest.finalize())),
            read => digest.update(&chunk[..read]),
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    let digit = |value: u8| char::from(DIGITS[usize::from(value)]);
    let pairs = bytes.iter().map(|byte| [byte >> 4, byte & 15]);
    pairs.flatten().map(digit).collect()
}

/// Now, as "2026-11-20T22:49:00Z".
pub fn time_now() -> String {
    let seconds = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    time_text(seconds)
}

/// Time of day in UTC from seconds since 1970.
///
/// # Source
/// H. Hinnant, "chrono-compatible low-level date algorithms" (2013),
/// `civil_from_days`.
fn time_text(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let shifted = days + 719_468;
    let era = shifted / 146_097;
    let day_of_era = shifted % 146_097;
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    let (hour, minute, second) = (rest / 3_600, rest / 60 % 60, rest % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-4 example: SHA-256 of "abc".
    #[test]
    fn reference_sha256_of_abc() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(digest_text("abc"), expected);
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("abc");
        std::fs::write(&path, "abc").unwrap();
        assert_eq!(digest_file(&path).unwrap(), expected);
    }

    /// By `date -u -d @SECONDS` of GNU coreutils.
    #[test]
    fn reference_dates() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_234_567_890, "2009-02-13T23:31:30Z"),
            (4_107_542_399, "2100-02-28T23:59:59Z"),
        ] {
            assert_eq!(time_text(seconds), text);
        }
    }
}
