//! Datatypes.

use crate::hdf5::cursor::{Cursor, Problem};

/// Deepest nesting of datatypes.
const DEEPEST: usize = 16;

const MOST_MEMBERS: u16 = 4096;

/// Most dimensions of an array datatype.
const MOST_EXTENTS: u8 = 32;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Datatype {
    /// Bytes per element.
    pub size: usize,
    pub kind: Kind,
}

/// Class of a datatype.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Integer {
        signed: bool,
        big_endian: bool,
    },
    Float {
        big_endian: bool,
    },
    /// An enumeration, stored as an integer.
    Enumeration(Box<Datatype>),
    /// Text of fixed length.
    Text,
    /// Text of variable length, stored in the heap.
    HeapText,
    /// Reference to another object.
    Reference,
    Compound(Vec<Member>),
    Array {
        base: Box<Datatype>,
        count: u64,
    },
    /// Any other class, and why it is not read.
    Other(&'static str),
}

/// A member of a compound.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    pub name: String,
    /// Offset in bytes.
    pub offset: usize,
    pub datatype: Datatype,
}

const ODD: &str = "its numbers have padding bits, or are floats of an unusual form";

pub(crate) fn read_type(cursor: &mut Cursor<'_>) -> Result<Datatype, Problem> {
    read_nested(cursor, 0)
}

fn read_nested(cursor: &mut Cursor<'_>, depth: usize) -> Result<Datatype, Problem> {
    if depth > DEEPEST {
        return Err(Problem::Unsupported(
            "datatypes nested that deeply".to_owned(),
        ));
    }
    let head = cursor.u8()?;
    let (version, class) = (head >> 4, head & 0xf);
    let bits = cursor.uint(3)?;
    let size = cursor.u32()? as usize;
    let kind = match class {
        0 | 4 => read_integer(cursor, class, bits, size)?,
        1 => read_float(cursor, bits, size)?,
        2 => {
            cursor.skip(2)?;
            Kind::Other("it holds times in an old format")
        }
        3 => Kind::Text,
        5 => {
            cursor.skip(bits as usize & 0xff)?;
            Kind::Other("its type is known only to the program that wrote it")
        }
        6 => read_compound(cursor, version, bits, (size, depth))?,
        7 if bits & 0xf == 0 => Kind::Reference,
        7 => Kind::Other("it holds references to regions of datasets"),
        8 => read_enumeration(cursor, version, bits, depth)?,
        9 => {
            read_nested(cursor, depth + 1)?;
            match bits & 0xf {
                1 => Kind::HeapText,
                _ => Kind::Other("its elements vary in length"),
            }
        }
        10 => read_array(cursor, version, depth)?,
        _ => Kind::Other("its type is unknown"),
    };
    if let Kind::Array { base, count } = &kind
        && count.checked_mul(base.size as u64) != Some(size as u64)
    {
        return Err(cursor.damaged("the size of an array type does not match its elements"));
    }
    Ok(Datatype { size, kind })
}

fn read_integer(
    cursor: &mut Cursor<'_>,
    class: u8,
    bits: u64,
    size: usize,
) -> Result<Kind, Problem> {
    let (offset, precision) = (cursor.u16()?, cursor.u16()?);
    let fills = offset == 0 && usize::from(precision) == size.saturating_mul(8);
    Ok(match fills && (1..=8).contains(&size) {
        true => Kind::Integer {
            signed: class == 0 && bits & 8 != 0,
            big_endian: bits & 1 != 0,
        },
        false => Kind::Other(ODD),
    })
}

fn read_float(cursor: &mut Cursor<'_>, bits: u64, size: usize) -> Result<Kind, Problem> {
    let (offset, precision) = (cursor.u16()?, cursor.u16()?);
    // Position and size of exponent and fraction.
    let form = cursor.take(4)?.to_vec();
    let bias = cursor.u32()?;
    let sign = bits >> 8 & 0xff;
    let usual = match size {
        2 => form == [10, 5, 0, 10] && sign == 15 && bias == 15,
        4 => form == [23, 8, 0, 23] && sign == 31 && bias == 127,
        8 => form == [52, 11, 0, 52] && sign == 63 && bias == 1023,
        _ => false,
    };
    // Bits 6 and 0 give the byte order; VAX sets both.
    let order = bits & 0x41;
    let fills = offset == 0 && usize::from(precision) == size.saturating_mul(8);
    Ok(match usual && fills && order <= 1 {
        true => Kind::Float {
            big_endian: order == 1,
        },
        false => Kind::Other(ODD),
    })
}

fn read_compound(
    cursor: &mut Cursor<'_>,
    version: u8,
    bits: u64,
    (size, depth): (usize, usize),
) -> Result<Kind, Problem> {
    let count = (bits & 0xffff) as u16;
    if count > MOST_MEMBERS {
        return Err(Problem::Unsupported(format!(
            "compound types with {count} members"
        )));
    }
    let mut members = Vec::new();
    for _ in 0..count {
        let from = cursor.place();
        let name = cursor.text()?;
        if version < 3 {
            cursor.align(from)?;
        }
        let offset = match version {
            1 | 2 => u64::from(cursor.u32()?),
            _ => cursor.uint(crate::hdf5::cursor::bytes_for(size as u64))?,
        };
        let mut extents = Vec::new();
        if version == 1 {
            let rank = cursor.u8()?;
            cursor.skip(3 + 4 + 4)?;
            for i in 0..4 {
                let extent = u64::from(cursor.u32()?);
                if i < rank {
                    extents.push(extent);
                }
            }
        }
        let mut datatype = read_nested(cursor, depth + 1)?;
        if !extents.is_empty() {
            datatype = array_of(cursor, datatype, &extents)?;
        }
        let fits = (offset as usize).checked_add(datatype.size);
        if fits.is_none_or(|end| end > size) {
            return Err(cursor.damaged("a member lies outside of its compound type"));
        }
        members.push(Member {
            name,
            offset: offset as usize,
            datatype,
        });
    }
    Ok(Kind::Compound(members))
}

fn read_enumeration(
    cursor: &mut Cursor<'_>,
    version: u8,
    bits: u64,
    depth: usize,
) -> Result<Kind, Problem> {
    let base = read_nested(cursor, depth + 1)?;
    let count = bits & 0xffff;
    for _ in 0..count {
        let from = cursor.place();
        cursor.text()?;
        if version < 3 {
            cursor.align(from)?;
        }
    }
    cursor.skip(base.size.saturating_mul(count as usize))?;
    Ok(match base.kind {
        Kind::Integer { .. } => Kind::Enumeration(Box::new(base)),
        _ => Kind::Other("its type is unknown"),
    })
}

fn read_array(cursor: &mut Cursor<'_>, version: u8, depth: usize) -> Result<Kind, Problem> {
    let rank = cursor.u8()?;
    if rank > MOST_EXTENTS {
        return Err(cursor.damaged("an array type has too many dimensions"));
    }
    if version < 3 {
        cursor.skip(3)?;
    }
    let mut extents = Vec::new();
    for _ in 0..rank {
        extents.push(u64::from(cursor.u32()?));
    }
    if version < 3 {
        cursor.skip(4 * usize::from(rank))?;
    }
    let base = read_nested(cursor, depth + 1)?;
    Ok(array_of(cursor, base, &extents)?.kind)
}

fn array_of(cursor: &Cursor<'_>, base: Datatype, extents: &[u64]) -> Result<Datatype, Problem> {
    let count = extents.iter().try_fold(1_u64, |n, e| n.checked_mul(*e));
    let size = count
        .and_then(|n| n.checked_mul(base.size as u64))
        .filter(|size| *size <= u64::from(u32::MAX));
    match (count, size) {
        (Some(count), Some(size)) => Ok(Datatype {
            size: size as usize,
            kind: Kind::Array {
                base: Box::new(base),
                count,
            },
        }),
        _ => Err(cursor.damaged("an array type is too large")),
    }
}
