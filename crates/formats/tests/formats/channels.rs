//! What the tests of all readers share.

use windfall_formats::Error;
use windfall_formats::contents::{Format, TimeBase};
use windfall_formats::open::{OpenOptions, open, open_source};
use windfall_formats::reader::Reader;
use windfall_source::source::Source;

/// Opens bytes as a format.
pub fn open_bytes(name: &str, bytes: Vec<u8>, format: Format) -> Result<Box<dyn Reader>, Error> {
    let options = OpenOptions {
        format: Some(format),
        ..OpenOptions::default()
    };
    open_source(Source::from_bytes(name, bytes), &options)
}

/// All samples of all channels.
pub fn samples(reader: &mut dyn Reader) -> Vec<Vec<f64>> {
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    reader.read_whole(&all).unwrap()
}

/// A sum over all bits that depends on the order; NaN count as one NaN.
pub fn checksum(samples: &[f64]) -> u64 {
    let bits = |x: f64| match x.is_nan() {
        true => 0x7ff8_0000_0000_0000,
        false => x.to_bits(),
    };
    let term = |(i, x): (u64, &f64)| bits(*x).wrapping_mul(2 * i + 1);
    (0..).zip(samples).map(term).fold(0, u64::wrapping_add)
}

/// One channel as another program reads it: name, length, checksum, start and
/// interval where the file has them.
pub type Expected = (&'static str, usize, u64, Option<(f64, f64)>);

/// Whether a real file holds these channels, by name, in this order.
pub fn check_file(file: &str, format: Format, expected: &[Expected]) {
    let Some(path) = windfall_test_data::find(file) else {
        return;
    };
    let mut reader = open(&path, &OpenOptions::default()).unwrap();
    assert_eq!(reader.contents().format, format, "{file}");
    let contents = reader.contents().clone();
    let found = samples(reader.as_mut());
    let names: Vec<&str> = contents.channels.iter().map(|c| c.name.as_str()).collect();
    let wanted: Vec<&str> = expected.iter().map(|e| e.0).collect();
    assert_eq!(names, wanted, "{file}");
    for ((channel, samples), (name, length, sum, time)) in
        contents.channels.iter().zip(&found).zip(expected)
    {
        assert_eq!(samples.len(), *length, "{file} {name}");
        let (found, sum) = (format!("{:016x}", checksum(samples)), format!("{sum:016x}"));
        assert_eq!(found, sum, "{file} {name}");
        if let Some((start, interval)) = *time {
            assert_eq!(
                channel.time,
                TimeBase::Uniform { start, interval },
                "{file} {name}"
            );
        }
    }
}
