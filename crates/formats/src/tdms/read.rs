//! LabVIEW TDMS files: segments, incremental metadata, scales, and contiguous,
//! interleaved and DAQmx raw data.
//!
//! # Source
//! National Instruments, "TDMS file format internal structure".

use crate::contents::{ChannelContents, Contents, Format, Note, TimeBase};
use crate::number::Number;
use crate::reader::{Reader, Sink};
use crate::tdms::layout::{Group, Member, Region};
use crate::tdms::metadata::{Property, names_of};
use crate::tdms::scale::{Scales, scales_of};
use crate::tdms::segments::{Found, read_segments};
use crate::tdms::value_type::{Layout, ValueType, decode, timestamp};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use windfall_source::error::Error;
use windfall_source::room::zeros;
use windfall_source::source::Source;

/// Bytes read and decoded at a time, small enough for the processor's cache.
const WINDOW: u64 = 1 << 18;

#[derive(Debug)]
pub struct TdmsReader {
    source: Source,
    contents: Contents,
    channels: Vec<Channel>,
    groups: Vec<Group>,
}

#[derive(Debug)]
struct Channel {
    /// Index of the object in the file.
    object: usize,
    scales: Scales,
    /// Raw inputs of the scales.
    inputs: Vec<u32>,
    length: u64,
    /// Second subtracted from timestamps.
    zero: i64,
}

impl TdmsReader {
    pub fn open(source: Source) -> Result<Self, Error> {
        let found = read_segments(&source)?;
        let version = source.bytes_at(4, 8)?;
        let version = match version[4..8] {
            [a, 0, 0, b] => u32::from(a.max(b)),
            [a, b, _, _] => u32::from_le_bytes([a, b, 0, 0]),
            _ => 0,
        };
        let (contents, channels) = contents(&source, &found, version)?;
        Ok(Self {
            source,
            contents,
            channels,
            groups: found.groups,
        })
    }
}

fn contents(
    source: &Source,
    found: &Found,
    version: u32,
) -> Result<(Contents, Vec<Channel>), Error> {
    let mut contents = Contents {
        format: Format::Tdms,
        variant: format!("version {version}, {} segments", found.segments),
        channels: Vec::new(),
        properties: Vec::new(),
        notes: found.notes.clone(),
    };
    let mut channels = Vec::new();
    for (position, object) in found.objects.iter().enumerate() {
        let names = names_of(&object.path);
        let prefix = if names.is_empty() {
            String::new()
        } else {
            format!("{}: ", names.join("/"))
        };
        let texts = object.properties.iter().map(|(name, value)| {
            let text = match value {
                Property::Number(value) => value.to_string(),
                Property::Text(text) => text.clone(),
            };
            (name.clone(), text)
        });
        if names.len() < 2 {
            contents
                .properties
                .extend(texts.map(|(name, text)| (format!("{prefix}{name}"), text)));
            continue;
        }
        let name = names.join("/");
        match channel(source, found, position)? {
            Ok((channel, stored_as)) => {
                contents.channels.push(ChannelContents {
                    unit: object
                        .properties
                        .get("unit_string")
                        .and_then(Property::text)
                        .map(str::to_owned)
                        .filter(|u| !u.is_empty()),
                    length: Some(channel.length),
                    time: time_base(&object.properties),
                    stored_as,
                    properties: texts.collect(),
                    name,
                });
                channels.push(channel);
            }
            Err(why) => contents.notes.push(Note::LeftOut {
                what: format!("channel \"{name}\""),
                why,
            }),
        }
    }
    Ok((contents, channels))
}

fn time_base(properties: &BTreeMap<String, Property>) -> TimeBase {
    let number = |name: &str| properties.get(name).and_then(Property::number);
    match number("wf_increment").filter(|interval| *interval > 0.0 && interval.is_finite()) {
        Some(interval) => TimeBase::Uniform {
            start: number("wf_start_offset").unwrap_or(0.0),
            interval,
        },
        None => TimeBase::Unknown,
    }
}

/// A channel and how it is stored, or why it is left out.
type Described = Result<(Channel, String), String>;

fn channel(source: &Source, found: &Found, position: usize) -> Result<Described, Error> {
    let object = &found.objects[position];
    if object.length == 0 && object.types.is_empty() {
        return Ok(Err("it has no samples".to_owned()));
    }
    if let Some(other) = object.types.iter().find(|value| !value.is_number()) {
        return Ok(Err(format!("it holds values of type {}", other.name())));
    }
    // Scales may be set on the group or the file instead.
    let group = format!(
        "/{}",
        object
            .path
            .trim_start_matches('/')
            .split("'/'")
            .next()
            .map_or(String::new(), |g| format!("{}'", g.trim_end_matches('\'')))
    );
    let paths = [object.path.as_str(), group.as_str(), "/"];
    let scaled = paths.into_iter().find_map(|path| {
        let object = &found.objects[*found.by_path.get(path)?];
        object
            .properties
            .contains_key("NI_Number_Of_Scales")
            .then_some(&object.properties)
    });
    let scales = match scaled.map_or(Ok(Scales::default()), scales_of) {
        Ok(scales) => scales,
        Err(why) => return Ok(Err(why)),
    };
    let zero = match (object.types.first(), object.first) {
        (Some(ValueType::Timestamp), Some((at, big_endian))) => {
            timestamp(&source.bytes_at(at, 16)?, big_endian).0
        }
        _ => 0,
    };
    let types: Vec<&str> = object.types.iter().map(|value| value.name()).collect();
    let remark = if types.contains(&"timestamp") {
        ", in seconds since the first whole one"
    } else {
        ""
    };
    let stored_as = format!("{}{remark}{}", types.join(" and "), scales.describe());
    let channel = Channel {
        object: position,
        inputs: scales.raw_inputs(),
        scales,
        length: object.length,
        zero,
    };
    check_buffers(found, &channel).map_or(Ok(Ok((channel, stored_as))), |why| Ok(Err(why)))
}

/// Why the raw values of a channel cannot be combined, if so.
fn check_buffers(found: &Found, channel: &Channel) -> Option<String> {
    if channel.inputs.len() < 2 {
        return None;
    }
    let mut last: Option<&Arc<Vec<Region>>> = None;
    for group in &found.groups {
        if last.is_some_and(|known| Arc::ptr_eq(known, &group.regions)) {
            continue;
        }
        last = Some(&group.regions);
        let holds = |region: &&Region| region.members.iter().any(|m| m.object == channel.object);
        if group.regions.iter().filter(holds).count() > 1 {
            return Some("its raw values are spread over several raw buffers".to_owned());
        }
    }
    None
}

/// Some rows of a region.
struct Window<'a> {
    offset: u64,
    rows: u64,
    region: &'a Region,
}

impl TdmsReader {
    /// Calls `take` with the windows of all requested regions, in file order.
    fn windows<'a>(
        &'a self,
        places: &[Option<usize>],
        mut take: impl FnMut(Window<'a>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let wanted = |member: &Member| places.get(member.object).copied().flatten().is_some();
        for group in &self.groups {
            let regions: Vec<&Region> = group
                .regions
                .iter()
                .filter(|r| r.members.iter().any(wanted))
                .collect();
            for chunk in 0..if regions.is_empty() { 0 } else { group.chunks } {
                for region in &regions {
                    let begin = group.offset + chunk * group.size + region.offset;
                    let at_once = (WINDOW / region.width).max(1);
                    let mut row = 0;
                    while row < region.rows {
                        let rows = at_once.min(region.rows - row);
                        let offset = begin + row * region.width;
                        take(Window {
                            offset,
                            rows,
                            region,
                        })?;
                        row += rows;
                    }
                }
            }
        }
        Ok(())
    }

    /// Position of each object of the file among the requested channels.
    fn places(&self, wanted: &[usize]) -> Vec<Option<usize>> {
        let last = self.channels.iter().map(|channel| channel.object).max();
        let mut places = vec![None; last.map_or(0, |last| last + 1)];
        for (position, channel) in wanted.iter().enumerate() {
            places[self.channels[*channel].object] = Some(position);
        }
        places
    }
}

/// Decodes and scales the values of a channel in a window.
fn decode_channel(channel: &Channel, bytes: &[u8], region: &Region, out: &mut [f64]) {
    let own = region
        .members
        .iter()
        .filter(|member| member.object == channel.object);
    let members: Vec<&Member> = own.collect();
    if let [member] = members[..] {
        decode(bytes, member.layout, channel.zero, out);
        channel.scales.apply_in_place(out);
        return;
    }
    let raw: Vec<(u32, Vec<f64>)> = members
        .iter()
        .map(|member| {
            let mut values = vec![0.0; out.len()];
            decode(bytes, member.layout, channel.zero, &mut values);
            (member.id, values)
        })
        .collect();
    let raw: Vec<(u32, &[f64])> = raw
        .iter()
        .map(|(id, values)| (*id, values.as_slice()))
        .collect();
    channel.scales.apply(&raw, out);
}

/// Whether a region is a single channel of native doubles.
fn holds_doubles(region: &Region) -> bool {
    let doubles = Layout {
        value: ValueType::Number(Number::F64),
        place: Number::F64.packed(cfg!(target_endian = "big")),
        bit: None,
    };
    matches!(region.members[..], [Member { layout, .. }] if layout == doubles)
        && region.width == Number::F64.size()
}

/// Positions of the requested channels in a region, without repetition.
fn objects_of<'a>(
    region: &'a Region,
    places: &'a [Option<usize>],
) -> impl Iterator<Item = usize> + 'a {
    let mut seen: Vec<usize> = Vec::new();
    region.members.iter().filter_map(move |member| {
        let place = places.get(member.object).copied().flatten()?;
        if seen.contains(&place) {
            return None;
        }
        seen.push(place);
        Some(place)
    })
}

impl Reader for TdmsReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let places = self.places(wanted);
        let mut samples = Vec::new();
        self.windows(&places, |window| {
            let bytes = self
                .source
                .bytes_at(window.offset, window.rows * window.region.width)?;
            for place in objects_of(window.region, &places) {
                samples.clear();
                samples.resize(window.rows as usize, 0.0);
                let channel = &self.channels[wanted[place]];
                decode_channel(channel, &bytes, window.region, &mut samples);
                sink.take(place, &samples)?;
            }
            Ok(())
        })
    }

    fn read_whole(&mut self, wanted: &[usize]) -> Result<Vec<Vec<f64>>, Error> {
        let places = self.places(wanted);
        let lengths = wanted
            .iter()
            .map(|channel| self.channels[*channel].length as usize);
        let mut columns: Vec<Vec<f64>> = lengths.map(zeros).collect();

        // Pair each window with the parts of the columns it fills.
        let mut rest: Vec<&mut [f64]> = columns.iter_mut().map(Vec::as_mut_slice).collect();
        let mut tasks = Vec::new();
        self.windows(&places, |window| {
            let parts: Vec<(usize, &mut [f64])> = objects_of(window.region, &places)
                .map(|place| {
                    let whole = std::mem::take(&mut rest[place]);
                    let (part, after) = whole.split_at_mut((window.rows as usize).min(whole.len()));
                    rest[place] = after;
                    (place, part)
                })
                .collect();
            tasks.push((window, parts));
            Ok(())
        })?;
        tasks
            .into_par_iter()
            .try_for_each_init(Vec::new, |bytes, (window, mut parts)| {
                if let [(place, part)] = &mut parts[..]
                    && holds_doubles(window.region)
                {
                    let room = bytemuck::cast_slice_mut(part);
                    self.source.read_at(window.offset, room)?;
                    self.channels[wanted[*place]].scales.apply_in_place(part);
                    return Ok(());
                }
                bytes.resize((window.rows * window.region.width) as usize, 0);
                self.source.read_at(window.offset, bytes)?;
                for (place, part) in parts {
                    decode_channel(&self.channels[wanted[place]], bytes, window.region, part);
                }
                Ok(())
            })?;
        Ok(columns)
    }
}
