//! WAVE files: RIFF, RIFX and RF64, integers and floats of any depth.
//!
//! # Source
//! Microsoft and IBM (1991), "Multimedia Programming Interface and Data
//! Specifications 1.0"; EBU Tech 3306 (2009) for RF64; ITU-T G.711 for µ-law and
//! A-law.

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::number::integer;
use crate::reader::{Reader, Sink};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Samples read at a time, over all channels.
const BLOCK: u64 = 1 << 16;

const MOST_CHANNELS: u16 = 4096;

/// Unknown size: still being written, or given elsewhere (RF64).
const NO_SIZE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Coding {
    /// Two's complement; offset binary up to eight bits.
    Integer,
    Float,
    MuLaw,
    ALaw,
}

#[derive(Debug)]
pub struct WavReader {
    source: Source,
    contents: Contents,
    shape: Shape,
    start: u64,
    frames: u64,
}

/// Contents of the chunk `fmt `.
#[derive(Clone, Copy, Debug)]
struct Shape {
    coding: Coding,
    channels: u16,
    rate: u32,
    /// Bytes per sample.
    container: u16,
    /// Significant bits per sample.
    bits: u16,
    big_endian: bool,
}

impl WavReader {
    pub fn open(source: Source) -> Result<Self, Error> {
        let head = source.bytes_at(0, 12.min(source.length()))?;
        let big_endian = head.starts_with(b"RIFX");
        if head.get(8..12) != Some(b"WAVE") {
            return Err(malformed(
                &source,
                8,
                "expected \"WAVE\"; this is not a WAVE file",
            ));
        }
        let mut notes = Vec::new();
        let mut properties = Vec::new();
        let mut shape = None;
        let mut long_size = None;
        let mut data = None;
        let mut at = 12;
        while at + 8 <= source.length() {
            let header = source.bytes_at(at, 8)?;
            let (name, size) = (&header[..4], integer(&header[4..8], big_endian) as u32);
            let (begin, left) = (at + 8, source.length() - at - 8);
            match name {
                b"ds64" if size >= 16 && left >= 16 => {
                    let sizes = source.bytes_at(begin, 16)?;
                    long_size = Some(integer(&sizes[8..16], big_endian));
                }
                b"fmt " => shape = Some(read_shape(&source, begin, size, big_endian)?),
                b"LIST" => properties.extend(read_info(&source, begin, size, big_endian)?),
                b"data" => {
                    let declared = match size {
                        NO_SIZE => long_size.unwrap_or(left),
                        // Left by a recorder that was switched off.
                        0 => left,
                        size => u64::from(size),
                    };
                    data = Some((begin, declared, left));
                    if declared >= left {
                        break;
                    }
                }
                _ => {}
            }
            let length = match (name, data) {
                (b"data", Some((_, declared, _))) => declared,
                _ => u64::from(size),
            };
            // Chunks begin at even offsets.
            at = begin + length + length % 2;
        }
        let shape = shape.ok_or_else(|| malformed(&source, 12, "there is no chunk \"fmt \""))?;
        let (start, declared, left) = data.ok_or_else(|| {
            malformed(
                &source,
                at.min(source.length()),
                "there is no chunk \"data\"",
            )
        })?;
        let frame = u64::from(shape.container) * u64::from(shape.channels);
        if declared > left {
            notes.push(Note::CutOff(format!(
                "{declared} bytes of samples are declared, {left} are there"
            )));
        }
        let bytes = declared.min(left);
        if bytes % frame != 0 {
            notes.push(Note::Odd(format!(
                "{} bytes after the last whole frame are left out",
                bytes % frame
            )));
        }
        let frames = bytes / frame;
        let contents = contents(&head, shape, frames, properties, notes);
        Ok(Self {
            source,
            contents,
            shape,
            start,
            frames,
        })
    }
}

fn malformed(source: &Source, at: u64, problem: &str) -> Error {
    source.malformed(Place::Byte(at), problem, "record or export the sound again")
}

fn read_shape(source: &Source, at: u64, size: u32, big_endian: bool) -> Result<Shape, Error> {
    if size < 16 {
        return Err(malformed(
            source,
            at,
            "the chunk \"fmt \" is shorter than 16 bytes",
        ));
    }
    let bytes = source.bytes_at(at, u64::from(size.min(40)))?;
    let u16_at = |at: usize| integer(&bytes[at..at + 2], big_endian) as u16;
    let (mut code, channels) = (u16_at(0), u16_at(2));
    let rate = integer(&bytes[4..8], big_endian) as u32;
    let (align, mut bits) = (u16_at(12), u16_at(14));
    // WAVE_FORMAT_EXTENSIBLE has the code and the valid bits further on.
    if code == 0xfffe && bytes.len() >= 28 {
        let valid = u16_at(18);
        if valid > 0 && valid <= bits {
            bits = valid;
        }
        code = integer(&bytes[24..28], big_endian) as u16;
    }
    let coding = match code {
        1 => Coding::Integer,
        3 => Coding::Float,
        6 => Coding::ALaw,
        7 => Coding::MuLaw,
        other => {
            return Err(source.unsupported(
                Place::Byte(at),
                format!("WAVE format {other} ({})", codec(other)),
                "convert it to PCM",
            ));
        }
    };
    if channels == 0 || channels > MOST_CHANNELS || rate == 0 || align == 0 {
        return Err(malformed(
            source,
            at,
            &format!("{channels} channels at {rate} Hz in frames of {align} bytes are impossible"),
        ));
    }
    let container = align / channels;
    let fits = match coding {
        Coding::Integer => (1..=8).contains(&container) && (1..=8 * container).contains(&bits),
        Coding::Float => matches!((container, bits), (4, 32) | (8, 64)),
        Coding::MuLaw | Coding::ALaw => container == 1,
    };
    if align % channels != 0 || !fits {
        return Err(malformed(
            source,
            at,
            &format!(
                "{bits} bits in frames of {align} bytes for {channels} channels are impossible"
            ),
        ));
    }
    Ok(Shape {
        coding,
        channels,
        rate,
        container,
        bits,
        big_endian,
    })
}

fn codec(code: u16) -> &'static str {
    match code {
        2 => "Microsoft ADPCM",
        17 => "IMA ADPCM",
        49 => "GSM 6.10",
        80 | 85 => "MPEG",
        _ => "compressed",
    }
}

/// Texts of a chunk LIST of type INFO.
fn read_info(
    source: &Source,
    at: u64,
    size: u32,
    big_endian: bool,
) -> Result<Vec<(String, String)>, Error> {
    const LONGEST: u64 = 1 << 16;
    let count = u64::from(size)
        .min(LONGEST)
        .min(source.length().saturating_sub(at));
    let bytes = source.bytes_at(at, count)?;
    let mut found = Vec::new();
    let Some(mut rest) = bytes.strip_prefix(b"INFO") else {
        return Ok(found);
    };
    while rest.len() >= 8 {
        let (name, length) = (&rest[..4], integer(&rest[4..8], big_endian) as usize);
        let text = &rest[8..(8_usize.saturating_add(length)).min(rest.len())];
        let text = String::from_utf8_lossy(text)
            .trim_end_matches('\0')
            .trim()
            .to_owned();
        if !text.is_empty() {
            found.push((String::from_utf8_lossy(name).into_owned(), text));
        }
        let next = 8_usize.saturating_add(length).saturating_add(length % 2);
        rest = rest.get(next..).unwrap_or_default();
    }
    Ok(found)
}

fn contents(
    head: &[u8],
    shape: Shape,
    frames: u64,
    properties: Vec<(String, String)>,
    notes: Vec<Note>,
) -> Contents {
    let stored_as = match shape.coding {
        Coding::Integer => format!("{}-bit integer, 1 is full scale", shape.bits),
        Coding::Float => format!("{}-bit float", shape.bits),
        Coding::MuLaw => "8-bit µ-law, 1 is full scale".to_owned(),
        Coding::ALaw => "8-bit A-law, 1 is full scale".to_owned(),
    };
    let channel = |index: u16| ChannelContents {
        name: format!("channel {}", index + 1),
        unit: None,
        length: Some(frames),
        time: TimeBase::Uniform {
            start: 0.0,
            interval: 1.0 / f64::from(shape.rate),
        },
        stored_as: stored_as.clone(),
        properties: Vec::new(),
    };
    Contents {
        format: Format::Wav,
        variant: String::from_utf8_lossy(&head[..4]).into_owned(),
        channels: (0..shape.channels).map(channel).collect(),
        properties,
        notes,
    }
}

impl Reader for WavReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let (container, channels) = (
            usize::from(self.shape.container),
            usize::from(self.shape.channels),
        );
        let frame = (container * channels) as u64;
        let at_once = (BLOCK / u64::from(self.shape.channels)).max(1);
        let decode = decoder(self.shape);
        let mut samples = Vec::new();
        let mut at = 0;
        while at < self.frames {
            let count = at_once.min(self.frames - at);
            let bytes = self
                .source
                .bytes_at(self.start + at * frame, count * frame)?;
            for (position, &channel) in wanted.iter().enumerate() {
                let place = channel * container;
                let frames = bytes.chunks_exact(container * channels);
                samples.clear();
                samples.extend(frames.map(|frame| decode(&frame[place..place + container])));
                sink.take(position, &samples)?;
            }
            at += count;
        }
        Ok(())
    }
}

/// Decodes a sample; full scale is 1.
fn decoder(shape: Shape) -> impl Fn(&[u8]) -> f64 {
    move |bytes| match shape.coding {
        Coding::Integer if shape.container == 1 => (f64::from(bytes[0]) - 128.0) / 128.0,
        Coding::Integer => {
            // Samples are left-aligned, so the sign is in place.
            let shift = 64 - 8 * u32::from(shape.container);
            let value = (integer(bytes, shape.big_endian) << shift) as i64;
            value as f64 / 2_f64.powi(63)
        }
        Coding::Float if shape.container == 4 => {
            f64::from(f32::from_bits(integer(bytes, shape.big_endian) as u32))
        }
        Coding::Float => f64::from_bits(integer(bytes, shape.big_endian)),
        Coding::MuLaw => f64::from(mu_law(bytes[0])) / 32768.0,
        Coding::ALaw => f64::from(a_law(bytes[0])) / 32768.0,
    }
}

/// 16-bit value of a µ-law byte (G.711).
fn mu_law(byte: u8) -> i32 {
    let code = !byte;
    let exponent = (code >> 4) & 7;
    let size = ((i32::from(code & 15) << 3) + 0x84) << exponent;
    if code & 0x80 == 0 {
        size - 0x84
    } else {
        0x84 - size
    }
}

/// 16-bit value of an A-law byte (G.711).
fn a_law(byte: u8) -> i32 {
    let code = byte ^ 0x55;
    let exponent = (code >> 4) & 7;
    let fraction = i32::from(code & 15) << 4;
    let size = match exponent {
        0 => fraction + 8,
        e => (fraction + 0x108) << (e - 1),
    };
    if code & 0x80 == 0 { -size } else { size }
}
