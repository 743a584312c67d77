//! Archives whose members are damaged while their checksums are right, so that the damage
//! reaches the readers of the members.

use crate::damage::check;
use crate::seeds::{Parts, archive, npz_parts, ods_parts, xlsx_parts, zip_parts};
use windfall_formats::contents::Format;

fn archives() -> Vec<(&'static str, Format, Parts)> {
    vec![
        ("xlsx", Format::Xlsx, xlsx_parts()),
        ("ods", Format::Ods, ods_parts()),
        ("zip", Format::Zip, zip_parts()),
        ("npz", Format::Npy, npz_parts()),
    ]
}

/// Checks archives in which `change` has made something else of one member.
fn check_all(change: impl Fn(&[u8]) -> Vec<Vec<u8>>) {
    for (name, format, parts) in archives() {
        for at in 0..parts.len() {
            for damaged in change(&parts[at].1) {
                let mut parts = parts.clone();
                parts[at].1 = damaged;
                check(name, format, &archive(&parts));
            }
        }
    }
}

#[test]
fn rejects_or_reads_members_cut_off_anywhere() {
    check_all(|bytes| {
        (0..bytes.len())
            .map(|length| bytes[..length].to_vec())
            .collect()
    });
}

#[test]
fn rejects_or_reads_members_with_any_byte_changed() {
    check_all(|bytes| {
        let values = |at: usize| [0, b'9', b'<', b'>', b'"', b'\n', 0x80, bytes[at] ^ 1];
        let places = (0..bytes.len()).flat_map(|at| values(at).map(|value| (at, value)));
        let changed = places.map(|(at, value)| {
            let mut damaged = bytes.to_vec();
            damaged[at] = value;
            damaged
        });
        changed.collect()
    });
}

#[test]
fn rejects_or_reads_members_without_any_part() {
    // Elements that are gone, or stand there twice.
    check_all(|bytes| {
        let starts: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b'<').collect();
        let pairs = starts.iter().enumerate().flat_map(|(first, &from)| {
            let ends = starts[first + 1..].iter().take(12);
            ends.map(move |&to| (from, to)).collect::<Vec<_>>()
        });
        let changed = pairs.flat_map(|(from, to)| {
            let gone = [&bytes[..from], &bytes[to..]].concat();
            let twice = [&bytes[..to], &bytes[from..]].concat();
            [gone, twice]
        });
        changed.collect()
    });
}

#[test]
fn rejects_or_reads_numbers_that_are_absurd() {
    check_all(|bytes| {
        let quotes: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b'"').collect();
        let mut changed = Vec::new();
        for pair in quotes.windows(2) {
            for value in [
                "",
                "-1",
                "0",
                "4294967295",
                "1048576",
                "XFD1048576",
                "99999999999999999999",
            ] {
                changed.push([&bytes[..=pair[0]], value.as_bytes(), &bytes[pair[1]..]].concat());
            }
        }
        changed
    });
}
