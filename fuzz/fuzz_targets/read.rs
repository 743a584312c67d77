//! Reads bytes as one format: the one named in WINDFALL_FUZZ_FORMAT.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;
use windfall_formats::Error;
use windfall_formats::contents::Format;
use windfall_formats::open::{OpenOptions, open_source};
use windfall_formats::reader::Sink;
use windfall_source::source::Source;

const FORMATS: [(&str, Format); 12] = [
    ("text", Format::Text),
    ("lvm", Format::Lvm),
    ("tdms", Format::Tdms),
    ("mat", Format::Mat),
    ("hdf5", Format::Hdf5),
    ("wav", Format::Wav),
    ("uff58", Format::Uff58),
    ("sigrok", Format::Sigrok),
    ("xlsx", Format::Xlsx),
    ("ods", Format::Ods),
    ("npy", Format::Npy),
    ("zip", Format::Zip),
];

static FORMAT: OnceLock<Format> = OnceLock::new();

struct Counter(usize);

impl Sink for Counter {
    fn take(&mut self, _: usize, samples: &[f64]) -> Result<(), Error> {
        self.0 += samples.len();
        Ok(())
    }

    fn fault(&mut self, _: Error) -> Result<(), Error> {
        Ok(())
    }
}

fuzz_target!(|bytes: &[u8]| {
    let format = *FORMAT.get_or_init(|| {
        let name = std::env::var("WINDFALL_FUZZ_FORMAT").expect("set WINDFALL_FUZZ_FORMAT");
        let found = FORMATS.iter().find(|(known, _)| *known == name);
        found.expect("WINDFALL_FUZZ_FORMAT is no format").1
    });
    let options = OpenOptions {
        format: Some(format),
        ..OpenOptions::default()
    };
    let Ok(mut reader) = open_source(Source::from_bytes("fuzz", bytes.to_vec()), &options) else {
        return;
    };
    let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let _ = reader.read(&all, &mut Counter(0));
});
