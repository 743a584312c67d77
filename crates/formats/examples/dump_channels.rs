//! Prints what files hold, one line of JSON each, for comparison with other
//! programs: names, lengths, times, and a checksum over all bits.

#![allow(clippy::print_stdout)]

use serde_json::{Value, json};
use std::path::Path;
use windfall_formats::Error;
use windfall_formats::contents::TimeBase;
use windfall_formats::open::{OpenOptions, open};

fn main() {
    for file in std::env::args().skip(1) {
        let line =
            dump(Path::new(&file)).unwrap_or_else(|error| json!({ "error": error.to_string() }));
        println!("{}", json!({ "file": file, "found": line }));
    }
}

fn dump(path: &Path) -> Result<Value, Error> {
    let mut reader = open(path, &OpenOptions::default())?;
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let samples = reader.read_whole(&all)?;
    let contents = reader.contents();
    let channels = contents
        .channels
        .iter()
        .zip(&samples)
        .map(|(channel, samples)| {
            let (start, interval, time) = match channel.time {
                TimeBase::Unknown => (None, None, None),
                TimeBase::Uniform { start, interval } => (Some(start), Some(interval), None),
                TimeBase::Channel(at) => (None, None, Some(&contents.channels[at].name)),
            };
            json!({
                "name": channel.name,
                "unit": channel.unit,
                "length": samples.len(),
                "checksum": format!("{:016x}", checksum(samples)),
                "start": start,
                "interval": interval,
                "time": time,
                "first": samples.first(),
                "last": samples.last(),
                "stored_as": channel.stored_as,
            })
        });
    let notes: Vec<String> = contents.notes.iter().map(ToString::to_string).collect();
    Ok(json!({
        "format": contents.format.to_string(),
        "variant": contents.variant,
        "channels": channels.collect::<Vec<_>>(),
        "notes": notes,
    }))
}

/// A sum over all bits that depends on the order; NaN count as one NaN.
fn checksum(samples: &[f64]) -> u64 {
    let bits = |x: f64| match x.is_nan() {
        true => 0x7ff8_0000_0000_0000,
        false => x.to_bits(),
    };
    let term = |(i, x): (u64, &f64)| bits(*x).wrapping_mul(2 * i + 1);
    (0..).zip(samples).map(term).fold(0, u64::wrapping_add)
}
