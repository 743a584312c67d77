//! Streams of a PDF.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// Bytes as a stream holds them.
pub fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // A vector takes everything.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}
