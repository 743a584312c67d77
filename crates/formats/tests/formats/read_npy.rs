//! Arrays of NumPy, made by it (`fixtures/make_fixtures.py`).

use crate::channels::{open_bytes, samples};
use windfall_formats::contents::{Format, TimeBase};

type Read = (Vec<(String, Vec<f64>)>, Vec<TimeBase>, Vec<String>);

fn read(bytes: &[u8]) -> Read {
    let mut reader = open_bytes("a", bytes.to_vec(), Format::Npy).unwrap();
    let found = samples(reader.as_mut());
    let contents = reader.contents();
    let names = contents.channels.iter().map(|channel| channel.name.clone());
    let times = contents
        .channels
        .iter()
        .map(|channel| channel.time)
        .collect();
    let notes = contents.notes.iter().map(ToString::to_string).collect();
    (names.zip(found).collect(), times, notes)
}

fn count(n: i32, of: fn(f64) -> f64) -> Vec<f64> {
    (0..n).map(|i| of(f64::from(i))).collect()
}

#[test]
fn reference_records_and_matrices() {
    let (found, times, notes) = read(include_bytes!("fixtures/record.npy"));
    let expected = [
        ("t", count(5, |i| i / 4.0)),
        ("F", count(5, |i| i - 2.0)),
        ("pair/1", count(5, |i| 2.0 * i)),
        ("pair/2", count(5, |i| 2.0 * i + 1.0)),
    ];
    assert_eq!(
        found,
        expected.map(|(name, samples)| (name.to_owned(), samples))
    );
    assert_eq!(times[1], TimeBase::Channel(0));
    assert!(
        notes.contains(&"\"name\" is left out: it holds text".to_owned()),
        "{notes:?}"
    );
    let (found, times, notes) = read(include_bytes!("fixtures/matrix.npy"));
    let expected = [
        ("array/1", count(6, |i| i / 2.0)),
        ("array/2", count(6, |i| i / 2.0 + 0.25)),
    ];
    assert_eq!(
        found,
        expected.map(|(name, samples)| (name.to_owned(), samples))
    );
    assert_eq!(times[1], TimeBase::Channel(0));
    assert!(
        notes[0].contains("rises evenly and is taken as the time"),
        "{notes:?}"
    );
}

#[test]
fn reference_archives() {
    let (found, times, notes) = read(include_bytes!("fixtures/arrays.npz"));
    let expected = [
        ("force", count(40, |i| i * 0.25 - 3.0)),
        ("run/x/1", vec![0.0, 2.0, 4.0]),
        ("run/x/2", vec![1.0, 3.0, 5.0]),
        ("z (real)", count(3, |i| i)),
        ("z (imaginary)", count(3, |i| i + 3.0)),
        ("on", vec![1.0, 0.0]),
    ];
    assert_eq!(
        found,
        expected.map(|(name, samples)| (name.to_owned(), samples))
    );
    let (start, interval) = (0.0, 1.0 / 2000.0);
    assert_eq!(times[0], TimeBase::Uniform { start, interval });
    let notes = notes.join("\n");
    for told in [
        "\"half\" is left out: its numbers are of an unusual size",
        "\"words\" is left out: it holds text",
        "\"fs\" is taken as the sampling rate in Hz of 5 channels",
    ] {
        assert!(notes.contains(told), "{notes}");
    }
}

#[test]
fn rejects_what_was_cut_off_or_is_no_array() {
    let whole = include_bytes!("fixtures/matrix.npy");
    let message = |bytes: &[u8]| {
        let found = open_bytes("a.npy", bytes.to_vec(), Format::Npy);
        found.map(|_| ()).unwrap_err().to_string()
    };
    let cut = message(&whole[..whole.len() - 1]);
    assert!(
        cut.contains("the array needs 96 bytes, 95 are left"),
        "{cut}"
    );
    let mut damaged = whole.to_vec();
    damaged[10] = b'[';
    assert!(message(&damaged).contains("the header is not a dictionary"));
}
