//! sigrok logic-analyser captures (.sr).
//!
//! # Source
//! The sigrok project, "File format: sigrok/v2".

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::reader::{Reader, Sink};
use crate::zip::entries::{Archive, Entry, open_archive, open_entry};
use std::io::Read;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Longest metadata of a capture; bytes.
const LONGEST_METADATA: u64 = 1 << 20;

const MOST_PROBES: usize = 512;

/// Samples decoded at a time.
const BLOCK: usize = 1 << 15;

/// A capture of a logic analyser.
#[derive(Debug)]
pub struct SigrokReader {
    archive: Archive,
    contents: Contents,
    /// Parts of the capture, in order.
    parts: Vec<Entry>,
    /// Bytes per sample of all probes.
    unit: usize,
    /// Bit of each channel.
    bits: Vec<usize>,
}

/// Contents of the entry "metadata" for the first device.
#[derive(Default)]
struct Metadata {
    file: String,
    rate: Option<f64>,
    unit: usize,
    probes: Vec<(usize, String)>,
    analog: usize,
    properties: Vec<(String, String)>,
}

impl SigrokReader {
    pub fn open(source: Source) -> Result<Self, Error> {
        let (archive, entries) = open_archive(source)?;
        let Some(description) = entries.iter().find(|entry| entry.name == "metadata") else {
            return Err(archive.get_ref().unknown(
                "this zip archive is not a sigrok capture: it has no entry \"metadata\"",
                "unpack it and name the recording; save a workbook's sheet as CSV",
            ));
        };
        let metadata = read_metadata(&archive, description)?;
        let mut parts: Vec<(u64, Entry)> = entries
            .iter()
            .filter_map(|entry| {
                let rest = entry.name.strip_prefix(&metadata.file)?;
                let number = match rest.strip_prefix('-') {
                    Some(number) => number.parse().ok()?,
                    None if rest.is_empty() => 0,
                    None => return None,
                };
                Some((number, entry.clone()))
            })
            .collect();
        parts.sort_by_key(|(number, _)| *number);
        let parts: Vec<Entry> = parts.into_iter().map(|(_, entry)| entry).collect();
        let unit = metadata.unit;
        let samples = parts.iter().map(|part| part.size / unit as u64).sum();
        let mut notes = Vec::new();
        if metadata.analog > 0 {
            notes.push(Note::LeftOut {
                what: format!("{} analog channel(s)", metadata.analog),
                why: "only the logic levels of a capture are read".to_owned(),
            });
        }
        let time = match metadata.rate {
            Some(rate) => TimeBase::Uniform {
                start: 0.0,
                interval: rate.recip(),
            },
            None => TimeBase::Unknown,
        };
        let channel = |(_, name): &(usize, String)| ChannelContents {
            name: name.clone(),
            unit: None,
            length: Some(samples),
            time,
            stored_as: "logic level".to_owned(),
            properties: Vec::new(),
        };
        let contents = Contents {
            format: Format::Sigrok,
            variant: format!("{} part(s)", parts.len()),
            channels: metadata.probes.iter().map(channel).collect(),
            properties: metadata.properties,
            notes,
        };
        Ok(Self {
            contents,
            parts,
            unit,
            bits: metadata.probes.iter().map(|(bit, _)| *bit).collect(),
            archive,
        })
    }
}

fn read_metadata(archive: &Archive, entry: &Entry) -> Result<Metadata, Error> {
    let broken = |problem: String| {
        archive.get_ref().malformed(
            Place::Object("metadata".to_owned()),
            problem,
            "save the capture again",
        )
    };
    let mut text = String::new();
    let read = open_entry(archive, entry)?
        .take(LONGEST_METADATA)
        .read_to_string(&mut text);
    read.map_err(|error| broken(format!("it cannot be unpacked: {error}")))?;
    let mut metadata = Metadata::default();
    for line in text.lines() {
        let Some((key, value)) = line.split_once('=').map(|(k, v)| (k.trim(), v.trim())) else {
            continue;
        };
        match key {
            "capturefile" if metadata.file.is_empty() => metadata.file = value.to_owned(),
            "samplerate" => metadata.rate = rate(value),
            "unitsize" => metadata.unit = value.parse().unwrap_or(0),
            "total analog" => metadata.analog = value.parse().unwrap_or(0),
            _ => match key.strip_prefix("probe").map(str::parse::<usize>) {
                Some(Ok(number)) if number > 0 && metadata.probes.len() < MOST_PROBES => {
                    metadata.probes.push((number - 1, value.to_owned()));
                }
                _ => metadata.properties.push((key.to_owned(), value.to_owned())),
            },
        }
    }
    if metadata.file.is_empty() || metadata.unit == 0 || metadata.unit > MOST_PROBES / 8 {
        return Err(broken(
            "it gives no capture file or no sample size".to_owned(),
        ));
    }
    let unit = metadata.unit;
    metadata.probes.retain(|(bit, _)| *bit < 8 * unit);
    // Names may repeat; add the probe number then.
    for place in 1..metadata.probes.len() {
        let (before, after) = metadata.probes.split_at_mut(place);
        let (bit, name) = &mut after[0];
        if before.iter().any(|(_, known)| known == name) {
            *name = format!("{name} (probe {})", *bit + 1);
        }
    }
    match metadata.probes.is_empty() {
        true => Err(broken("it lists no probes".to_owned())),
        false => Ok(metadata),
    }
}

/// "1 MHz" → 1e6.
fn rate(text: &str) -> Option<f64> {
    let (number, unit) = text.split_once(' ').unwrap_or((text, "Hz"));
    let factor = match unit.trim() {
        "Hz" => 1.0,
        "kHz" => 1e3,
        "MHz" => 1e6,
        "GHz" => 1e9,
        _ => return None,
    };
    let rate = factor * number.trim().parse::<f64>().ok()?;
    (rate > 0.0 && rate.is_finite()).then_some(rate)
}

impl Reader for SigrokReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let mut bytes = vec![0; BLOCK * self.unit];
        let mut samples = Vec::new();
        for part in &self.parts {
            let mut stream = open_entry(&self.archive, part)?;
            loop {
                let filled = fill(&mut stream, &mut bytes).map_err(|error| {
                    self.archive.get_ref().malformed(
                        Place::Object(part.name.clone()),
                        format!("the capture cannot be unpacked: {error}"),
                        "save the capture again",
                    )
                })?;
                let rows = filled / self.unit;
                for (position, channel) in wanted.iter().enumerate() {
                    let bit = self.bits[*channel];
                    let level = |row: &[u8]| f64::from((row[bit / 8] >> (bit % 8)) & 1);
                    samples.clear();
                    samples.extend(bytes[..rows * self.unit].chunks_exact(self.unit).map(level));
                    sink.take(position, &samples)?;
                }
                if filled < bytes.len() {
                    break;
                }
            }
        }
        Ok(())
    }
}

/// Fills a buffer as far as possible.
fn fill(stream: &mut dyn Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match stream.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}
