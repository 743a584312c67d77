//! Segments of a TDMS file: lead-ins, incremental metadata, raw data.

use crate::contents::Note;
use crate::number::integer;
use crate::tdms::layout::{Active, Flags, Group, Region, chunk, cut};
use crate::tdms::metadata::{Cursor, Index, ObjectEntry, Property, read_objects};
use crate::tdms::value_type::ValueType;
use std::collections::BTreeMap;
use std::sync::Arc;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Bytes before the metadata of a segment.
const LEAD_IN: u64 = 28;

/// Longest metadata of a segment; bytes.
const LONGEST_METADATA: u64 = 1 << 28;

/// An object, accumulated over segments.
#[derive(Debug, Default)]
pub struct Object {
    pub path: String,
    /// Latest value of each property.
    pub properties: BTreeMap<String, Property>,
    index: Option<Index>,
    /// Number of samples.
    pub length: u64,
    pub types: Vec<ValueType>,
    /// Offset of the first value, and whether it is big-endian.
    pub first: Option<(u64, bool)>,
}

struct LeadIn {
    metadata: bool,
    new_list: bool,
    raw_data: bool,
    flags: Flags,
    metadata_length: u64,
    /// Start of the next segment; `None` if this one is unfinished.
    next: Option<u64>,
}

/// Result of reading the segments.
#[derive(Debug, Default)]
pub struct Found {
    /// Objects in order of appearance.
    pub objects: Vec<Object>,
    pub by_path: BTreeMap<String, usize>,
    active: Vec<Active>,
    /// Raw data in file order.
    pub groups: Vec<Group>,
    pub notes: Vec<Note>,
    pub segments: u64,
    /// Chunk layout of the previous segment, reused without new metadata.
    last_chunk: Option<(Flags, Arc<Vec<Region>>, u64)>,
}

pub fn read_segments(source: &Source) -> Result<Found, Error> {
    let mut found = Found::default();
    let mut at = 0;
    while at < source.length() {
        if source.length() - at < LEAD_IN {
            let left = source.length() - at;
            let missing = format!("{left} bytes after the last segment are not a whole segment");
            found.notes.push(Note::CutOff(missing));
            break;
        }
        let lead_in = read_lead_in(source, at)?;
        if !read_segment(source, at, &lead_in, &mut found)? {
            break;
        }
        found.segments += 1;
        match lead_in.next {
            Some(next) => at = next,
            None => break,
        }
    }
    Ok(found)
}

fn malformed(source: &Source, at: u64, problem: String) -> Error {
    source.malformed(
        Place::Byte(at),
        problem,
        "the file is damaged, or was written by a program that does not keep to the \
                 format; export the recording again",
    )
}

fn read_lead_in(source: &Source, at: u64) -> Result<LeadIn, Error> {
    let bytes = source.bytes_at(at, LEAD_IN)?;
    if &bytes[..4] != b"TDSm" {
        let problem = match bytes[..4] == *b"TDSh" {
            true => "this is an index file (.tdms_index); name the .tdms file beside it".to_owned(),
            false => "expected a segment, which begins with \"TDSm\"".to_owned(),
        };
        return Err(malformed(source, at, problem));
    }
    // The flags are always little-endian.
    let flag = |bit: u32| bytes[4] & (1 << bit) != 0;
    let big_endian = flag(6);
    let length = integer(&bytes[12..20], big_endian);
    let metadata_length = integer(&bytes[20..28], big_endian);
    let next = at + LEAD_IN;
    let next = next
        .checked_add(length)
        .filter(|next| *next <= source.length());
    if next.is_some() && metadata_length > length {
        let problem = format!(
            "the raw data begin at {metadata_length}, after the end of their segment at {length}"
        );
        return Err(malformed(source, at + 20, problem));
    }
    Ok(LeadIn {
        metadata: flag(1),
        new_list: flag(2),
        raw_data: flag(3),
        flags: Flags {
            interleaved: flag(5),
            big_endian,
        },
        metadata_length,
        next,
    })
}

/// Reads a segment; false if its metadata are truncated.
fn read_segment(
    source: &Source,
    at: u64,
    lead_in: &LeadIn,
    found: &mut Found,
) -> Result<bool, Error> {
    let begin = at + LEAD_IN;
    if lead_in.next.is_none() {
        let missing = "its last segment was not finished; the complete part of it is read";
        found.notes.push(Note::CutOff(missing.to_owned()));
    }
    if lead_in.metadata {
        let left = source.length() - begin;
        let length = lead_in.metadata_length.min(left);
        if length > LONGEST_METADATA {
            return Err(Error::TooLarge {
                path: source.path().to_path_buf(),
                place: Place::Byte(at),
                what: "the metadata of a segment (bytes)".to_owned(),
                declared: length,
                possible: LONGEST_METADATA,
            });
        }
        let bytes = source.bytes_at(begin, length)?;
        let mut cursor = Cursor::new(&bytes, lead_in.flags.big_endian);
        match read_objects(&mut cursor) {
            Ok(objects) => update(source, begin, lead_in, objects, found)?,
            Err(fault) if fault.ended && lead_in.metadata_length >= left => {
                let missing = "the metadata of its last segment".to_owned();
                found.notes.push(Note::CutOff(missing));
                return Ok(false);
            }
            Err(fault) => return Err(malformed(source, begin + fault.at as u64, fault.problem)),
        }
    }
    if lead_in.raw_data {
        let data = begin.checked_add(lead_in.metadata_length);
        let data = data.unwrap_or(source.length()).min(source.length());
        let end = lead_in.next.unwrap_or(source.length());
        add_data(source, data, end.saturating_sub(data), lead_in, found)?;
    }
    Ok(true)
}

/// Merges the metadata of a segment.
fn update(
    source: &Source,
    at: u64,
    lead_in: &LeadIn,
    entries: Vec<ObjectEntry>,
    found: &mut Found,
) -> Result<(), Error> {
    found.last_chunk = None;
    if lead_in.new_list {
        found.active.clear();
    }
    for entry in entries {
        let known = found.by_path.get(&entry.path).copied();
        let object = known.unwrap_or_else(|| {
            found
                .by_path
                .insert(entry.path.clone(), found.objects.len());
            found.objects.push(Object {
                path: entry.path.clone(),
                ..Object::default()
            });
            found.objects.len() - 1
        });
        found.objects[object].properties.extend(entry.properties);
        let index = match entry.index {
            Index::Same => match found.objects[object].index.clone() {
                Some(index) => index,
                None => {
                    let problem =
                        format!("{} refers to an index that was never defined", entry.path);
                    return Err(malformed(source, at, problem));
                }
            },
            index => index,
        };
        match &index {
            Index::Values { value, .. } => add_type(&mut found.objects[object], *value),
            Index::Daqmx { scalers, .. } => {
                scalers
                    .iter()
                    .for_each(|s| add_type(&mut found.objects[object], s.value));
            }
            Index::Nothing | Index::Same => {}
        }
        if index != Index::Nothing {
            found.objects[object].index = Some(index.clone());
        }
        match found
            .active
            .iter_mut()
            .find(|active| active.object == object)
        {
            Some(active) => active.index = index,
            None => found.active.push(Active { object, index }),
        }
    }
    Ok(())
}

fn add_type(object: &mut Object, value: ValueType) {
    if !object.types.contains(&value) {
        object.types.push(value);
    }
}

/// Adds the chunks of a segment's raw data.
fn add_data(
    source: &Source,
    at: u64,
    length: u64,
    lead_in: &LeadIn,
    found: &mut Found,
) -> Result<(), Error> {
    let same = found
        .last_chunk
        .clone()
        .filter(|(flags, ..)| *flags == lead_in.flags);
    let (regions, size) = match same {
        Some((_, regions, size)) => (regions, size),
        None => {
            let with_data: Vec<Active> = found
                .active
                .iter()
                .filter(|active| active.index != Index::Nothing)
                .cloned()
                .collect();
            let (regions, size) = chunk(&with_data, lead_in.flags).ok_or_else(|| {
                let problem = "the channels of this segment cannot stand together: they differ \
                               in length or in their raw buffers";
                malformed(source, at, problem.to_owned())
            })?;
            let regions = Arc::new(regions);
            found.last_chunk = Some((lead_in.flags, Arc::clone(&regions), size));
            (regions, size)
        }
    };
    if size == 0 || length == 0 {
        return Ok(());
    }
    let chunks = length / size;
    if chunks > 0 {
        add_group(found, at, chunks, size, &regions);
    }
    let rest = length % size;
    if rest > 0 {
        let kept = Arc::new(cut(&regions, rest));
        add_group(found, at + chunks * size, 1, rest, &kept);
        if lead_in.next.is_some() && !lead_in.flags.interleaved {
            found.notes.push(Note::Odd(format!("the raw data at byte {at} are no whole number of chunks; what is complete in the last is read")));
        }
    }
    Ok(())
}

fn add_group(found: &mut Found, offset: u64, chunks: u64, size: u64, regions: &Arc<Vec<Region>>) {
    for region in regions.iter() {
        let big_endian = region
            .members
            .first()
            .is_some_and(|m| m.layout.place.big_endian);
        let mut counted = None;
        for member in &region.members {
            let object = &mut found.objects[member.object];
            let value_at = offset + region.offset + member.layout.place.offset as u64;
            object.first.get_or_insert((value_at, big_endian));
            // Several scalers of a channel make one sample.
            if counted != Some(member.object) {
                object.length = object
                    .length
                    .saturating_add(region.rows.saturating_mul(chunks));
                counted = Some(member.object);
            }
        }
    }
    found.groups.push(Group {
        offset,
        chunks,
        size,
        regions: Arc::clone(regions),
    });
}
