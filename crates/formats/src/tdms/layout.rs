//! Layout of raw data in TDMS segments.

use crate::number;
use crate::tdms::metadata::{Index, Scaler};
use crate::tdms::scale::RAW;
use crate::tdms::value_type::{Layout, ValueType};
use std::sync::Arc;

/// A source of values within the rows of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Index of the object in the file.
    pub object: usize,
    /// Number used by scales; [`RAW`] except for NI-DAQmx.
    pub id: u32,
    pub layout: Layout,
}

/// Rows of equal width in a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Offset in the chunk; bytes.
    pub offset: u64,
    pub rows: u64,
    /// Bytes per row.
    pub width: u64,
    pub members: Vec<Member>,
}

/// Consecutive chunks of one layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Offset of the first chunk.
    pub offset: u64,
    pub chunks: u64,
    /// Bytes per chunk.
    pub size: u64,
    pub regions: Arc<Vec<Region>>,
}

/// An object with raw data in a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Active {
    /// Index of the object in the file.
    pub object: usize,
    pub index: Index,
}

/// Segment flags that affect the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flags {
    pub interleaved: bool,
    pub big_endian: bool,
}

/// The layout and size in bytes of a chunk; `None` if the objects cannot be combined.
pub fn chunk(active: &[Active], flags: Flags) -> Option<(Vec<Region>, u64)> {
    let daqmx = active
        .iter()
        .any(|a| matches!(a.index, Index::Daqmx { .. }));
    match (daqmx, flags.interleaved) {
        (true, _) => daqmx_chunk(active, flags),
        (false, true) => interleaved_chunk(active, flags),
        (false, false) => contiguous_chunk(active, flags),
    }
}

fn contiguous_chunk(active: &[Active], flags: Flags) -> Option<(Vec<Region>, u64)> {
    let mut at = 0_u64;
    let mut regions = Vec::new();
    for object in active {
        let Index::Values {
            value,
            count,
            bytes,
        } = object.index
        else {
            continue;
        };
        if value.size() > 0 {
            regions.push(Region {
                offset: at,
                rows: count,
                width: value.size(),
                members: vec![member(object.object, value, 0, value.size(), flags)],
            });
        }
        at = at.checked_add(bytes)?;
    }
    Some((regions, at))
}

fn interleaved_chunk(active: &[Active], flags: Flags) -> Option<(Vec<Region>, u64)> {
    let mut width = 0_u64;
    let mut rows = None;
    for object in active {
        let Index::Values { value, count, .. } = object.index else {
            continue;
        };
        // Interleaving needs values of fixed size and equal count.
        if value.size() == 0 || rows.is_some_and(|rows| rows != count) {
            return None;
        }
        rows = Some(count);
        width += value.size();
    }
    let rows = rows.unwrap_or(0);
    let mut offset = 0;
    let mut members = Vec::new();
    for object in active {
        if let Index::Values { value, .. } = object.index {
            members.push(member(object.object, value, offset, width, flags));
            offset += value.size();
        }
    }
    let size = rows.checked_mul(width)?;
    let region = Region {
        offset: 0,
        rows,
        width,
        members,
    };
    Some((vec![region], size))
}

fn daqmx_chunk(active: &[Active], flags: Flags) -> Option<(Vec<Region>, u64)> {
    let mut shared: Option<&Vec<u32>> = None;
    for object in active {
        match &object.index {
            Index::Daqmx { widths, .. } if shared.is_none_or(|known| known == widths) => {
                shared = Some(widths);
            }
            _ => return None,
        }
    }
    let widths = shared?;
    let mut regions: Vec<Region> = widths
        .iter()
        .map(|width| Region {
            offset: 0,
            rows: 0,
            width: u64::from(*width),
            members: Vec::new(),
        })
        .collect();
    for object in active {
        let Index::Daqmx { count, scalers, .. } = &object.index else {
            continue;
        };
        for scaler in scalers {
            let region = regions.get_mut(scaler.buffer as usize)?;
            region.rows = region.rows.max(*count);
            region
                .members
                .push(scaler_member(object.object, scaler, region.width, flags));
        }
    }
    let mut at = 0_u64;
    for region in &mut regions {
        region.offset = at;
        at = at.checked_add(region.rows.checked_mul(region.width)?)?;
    }
    regions.retain(|region| region.width > 0);
    Some((regions, at))
}

fn member(object: usize, value: ValueType, offset: u64, width: u64, flags: Flags) -> Member {
    Member {
        object,
        id: RAW,
        layout: Layout {
            value,
            place: number::Layout {
                offset: offset as usize,
                stride: width as usize,
                big_endian: flags.big_endian,
            },
            bit: None,
        },
    }
}

fn scaler_member(object: usize, scaler: &Scaler, width: u64, flags: Flags) -> Member {
    let offset = u64::from(scaler.offset);
    let mut member = member(object, scaler.value, offset, width, flags);
    member.id = scaler.id;
    member.layout.bit = scaler.bit;
    member
}

/// The complete rows in the first `bytes` bytes of a truncated chunk.
pub fn cut(regions: &[Region], bytes: u64) -> Vec<Region> {
    let kept = regions.iter().map(|region| {
        let left = bytes.saturating_sub(region.offset);
        Region {
            rows: (left / region.width).min(region.rows),
            ..region.clone()
        }
    });
    kept.filter(|region| region.rows > 0).collect()
}
