//! Variables of MAT files, versions 5 to 7, and version 4.
//!
//! # Source
//! The MathWorks, "MAT-File Format", R2023b.

use crate::mat_stream::{Ended, Room, Stream};
use crate::tdms_type::ValueType;

/// Deepest nesting of cells and structures.
const DEEPEST: usize = 32;

/// Most elements of one file that are described.
const MOST_LEAVES: usize = 100_000;

/// Longest name or text; bytes.
const LONGEST_TEXT: u64 = 4096;

/// An array of numbers in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// Names of the variable and what is in it, joined by "/".
    pub name: String,
    /// Rows.
    pub rows: u64,
    /// Columns.
    pub columns: u64,
    /// Where it stands.
    pub room: Room,
    /// Bytes in the room before its numbers.
    pub offset: u64,
    /// How they are stored.
    pub value: ValueType,
    /// The order of bytes.
    pub big_endian: bool,
    /// What MATLAB calls it.
    pub class: &'static str,
}

/// What has been found in a file.
#[derive(Debug, Default)]
pub struct Found {
    /// Arrays of two numbers and more.
    pub leaves: Vec<Leaf>,
    /// Single numbers: name and value.
    pub scalars: Vec<(String, f64)>,
    /// Texts: name and text.
    pub texts: Vec<(String, String)>,
    /// What is no array of numbers: what and why.
    pub left_out: Vec<(String, String)>,
}

/// Why a variable cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Its bytes end too early or cannot be inflated.
    Ended,
    /// It breaks the rules.
    Broken(String),
}

impl From<Ended> for Fault {
    fn from(_: Ended) -> Self {
        Self::Ended
    }
}

/// The tag of an element.
#[derive(Clone, Copy, Debug)]
pub struct Tag {
    /// Its type.
    pub code: u32,
    /// Bytes of its data.
    pub bytes: u64,
    /// Bytes behind the data up to the next element.
    pub padding: u64,
}

/// Reads elements from a stream.
pub struct Elements<'a> {
    stream: Stream<'a>,
    room: Room,
    big_endian: bool,
}

impl<'a> Elements<'a> {
    /// From the beginning of a room.
    #[must_use]
    pub fn new(stream: Stream<'a>, room: Room, big_endian: bool) -> Self {
        Self {
            stream,
            room,
            big_endian,
        }
    }

    fn u32(&mut self) -> Result<u32, Fault> {
        let mut bytes = [0; 4];
        self.stream.fill(&mut bytes)?;
        Ok(match self.big_endian {
            true => u32::from_be_bytes(bytes),
            false => u32::from_le_bytes(bytes),
        })
    }

    /// The next tag.
    ///
    /// # Errors
    /// The bytes end.
    pub fn tag(&mut self) -> Result<Tag, Fault> {
        let first = self.u32()?;
        // A small element has its length in the same word and four bytes of data.
        if first >> 16 != 0 {
            let bytes = u64::from(first >> 16);
            return match bytes {
                1..=4 => Ok(Tag {
                    code: first & 0xffff,
                    bytes,
                    padding: 4 - bytes,
                }),
                _ => Err(Fault::Broken(format!(
                    "a small element of {bytes} bytes cannot be"
                ))),
            };
        }
        let bytes = u64::from(self.u32()?);
        Ok(Tag {
            code: first,
            bytes,
            padding: (8 - bytes % 8) % 8,
        })
    }

    fn numbers(&mut self, tag: Tag, most: u64) -> Result<Vec<u32>, Fault> {
        if tag.bytes > most || !tag.bytes.is_multiple_of(4) {
            return Err(Fault::Broken(format!(
                "{} bytes of dimensions cannot be",
                tag.bytes
            )));
        }
        let numbers = (0..tag.bytes / 4)
            .map(|_| self.u32())
            .collect::<Result<_, _>>()?;
        self.stream.skip(tag.padding)?;
        Ok(numbers)
    }

    fn text(&mut self, tag: Tag) -> Result<String, Fault> {
        let kept = tag.bytes.min(LONGEST_TEXT);
        let mut bytes = vec![0; kept as usize];
        self.stream.fill(&mut bytes)?;
        self.stream.skip(tag.bytes - kept + tag.padding)?;
        Ok(match tag.code {
            4 | 17 => {
                let unit = |pair: &[u8]| match self.big_endian {
                    true => u16::from_be_bytes([pair[0], pair[1]]),
                    false => u16::from_le_bytes([pair[0], pair[1]]),
                };
                let units = bytes.chunks_exact(2).map(unit);
                char::decode_utf16(units)
                    .map(|c| c.unwrap_or('\u{fffd}'))
                    .collect()
            }
            _ => String::from_utf8_lossy(&bytes).into_owned(),
        })
    }

    /// Describes the matrix whose tag has been read.
    ///
    /// * `parent`: name of what it stands in, with "/" behind, or nothing
    /// * `given`: its name there; `None` for one that brings its own
    ///
    /// # Errors
    /// It ends too early or breaks the rules.
    pub fn matrix(
        &mut self,
        tag: Tag,
        given: Option<&str>,
        depth: usize,
        found: &mut Found,
    ) -> Result<(), Fault> {
        let end = self.stream.position() + tag.bytes;
        if tag.bytes > 0 {
            self.inside(end, given, depth, found)?;
        }
        let left = end.checked_sub(self.stream.position());
        let left = left.ok_or_else(|| {
            Fault::Broken("an element reaches beyond the one that it stands in".to_owned())
        })?;
        self.stream.skip(left + tag.padding)?;
        Ok(())
    }

    fn inside(
        &mut self,
        end: u64,
        given: Option<&str>,
        depth: usize,
        found: &mut Found,
    ) -> Result<(), Fault> {
        let flags = self.tag()?;
        let flags = self.numbers(flags, 8)?;
        let flags = flags.first().copied().unwrap_or(0);
        let (class, complex) = (flags & 0xff, flags & 0x800 != 0);
        if class == 17 {
            let name = given.unwrap_or("a variable").to_owned();
            found
                .left_out
                .push((name, "it is an object of a class".to_owned()));
            return Ok(());
        }
        let dimensions = self.tag()?;
        let dimensions = self.numbers(dimensions, 256)?;
        let name = self.tag()?;
        let name = self.text(name)?;
        if given.is_none() && name.is_empty() {
            // MATLAB keeps the workspace of functions in such a variable.
            let what = "a variable without a name".to_owned();
            found
                .left_out
                .push((what, "MATLAB keeps functions in it".to_owned()));
            return Ok(());
        }
        let name = given.map_or(name, str::to_owned);
        if found.leaves.len() + found.left_out.len() + found.scalars.len() + found.texts.len()
            > MOST_LEAVES
        {
            return Err(Fault::Broken(
                "it holds more than 100,000 arrays".to_owned(),
            ));
        }
        let shape: Vec<u64> = dimensions.iter().map(|d| u64::from(*d)).collect();
        let count = shape
            .iter()
            .try_fold(1_u64, |product, d| product.checked_mul(*d));
        let count = count
            .ok_or_else(|| Fault::Broken(format!("\"{name}\" of size {shape:?} cannot be")))?;
        match class {
            1 => self.cells(end, &name, count, depth, found),
            2 | 3 => self.structures(end, &name, class == 3, count, depth, found),
            4 => {
                let tag = self.tag()?;
                let text = self.text(tag)?;
                found.texts.push((name, text));
                Ok(())
            }
            5 => {
                found.left_out.push((name, "it is sparse".to_owned()));
                Ok(())
            }
            6..=15 => self.numeric(end, &name, class, &shape, count, complex, found),
            _ => {
                let why = format!("it is of class {class} (a function or an unknown one)");
                found.left_out.push((name, why));
                Ok(())
            }
        }
    }

    fn cells(
        &mut self,
        end: u64,
        name: &str,
        count: u64,
        depth: usize,
        found: &mut Found,
    ) -> Result<(), Fault> {
        self.nested(end, depth, count, found, |index| {
            format!("{name}/{}", index + 1)
        })
    }

    fn structures(
        &mut self,
        end: u64,
        name: &str,
        object: bool,
        count: u64,
        depth: usize,
        found: &mut Found,
    ) -> Result<(), Fault> {
        if object {
            let class = self.tag()?;
            self.text(class)?;
        }
        let length = self.tag()?;
        let length = self.numbers(length, 4)?.first().copied().unwrap_or(0) as usize;
        let names = self.tag()?;
        if length == 0 || names.bytes > 1 << 20 {
            return Err(Fault::Broken(format!(
                "the names of the fields of \"{name}\" cannot be"
            )));
        }
        let mut bytes = vec![0; names.bytes as usize];
        self.stream.fill(&mut bytes)?;
        self.stream.skip(names.padding)?;
        let fields: Vec<String> = bytes
            .chunks_exact(length)
            .map(|field| {
                let end = field.iter().position(|byte| *byte == 0).unwrap_or(length);
                String::from_utf8_lossy(&field[..end]).into_owned()
            })
            .collect();
        if fields.is_empty() {
            return Ok(());
        }
        let all = count.checked_mul(fields.len() as u64);
        let all = all.ok_or_else(|| Fault::Broken(format!("\"{name}\" has too many elements")))?;
        self.nested(end, depth, all, found, |index| {
            let field = &fields[(index % fields.len() as u64) as usize];
            match count {
                1 => format!("{name}/{field}"),
                _ => format!("{name}/{}/{field}", index / fields.len() as u64 + 1),
            }
        })
    }

    /// Matrices one after the other, as many as there are before `end`.
    fn nested(
        &mut self,
        end: u64,
        depth: usize,
        count: u64,
        found: &mut Found,
        name: impl Fn(u64) -> String,
    ) -> Result<(), Fault> {
        if depth >= DEEPEST {
            return Err(Fault::Broken(
                "cells and structures are nested more than 32 deep".to_owned(),
            ));
        }
        for index in 0..count {
            if self.stream.position() >= end {
                return Ok(());
            }
            let tag = self.tag()?;
            if tag.code != MATRIX {
                return Err(Fault::Broken(format!(
                    "expected an array, found an element of type {}",
                    tag.code
                )));
            }
            self.matrix(tag, Some(&name(index)), depth + 1, found)?;
        }
        Ok(())
    }

    #[allow(clippy::too_many_arguments)]
    fn numeric(
        &mut self,
        end: u64,
        name: &str,
        class: u32,
        shape: &[u64],
        count: u64,
        complex: bool,
        found: &mut Found,
    ) -> Result<(), Fault> {
        let parts: &[&str] = if complex {
            &[" (real)", " (imaginary)"]
        } else {
            &[""]
        };
        for part in parts {
            if self.stream.position() >= end || count == 0 {
                return Ok(());
            }
            let tag = self.tag()?;
            let name = format!("{name}{part}");
            let value = value_type(tag.code).ok_or_else(|| {
                Fault::Broken(format!("\"{name}\" holds elements of type {}", tag.code))
            })?;
            if count.checked_mul(value.size()) != Some(tag.bytes) {
                let problem = format!(
                    "\"{name}\" of size {shape:?} needs {count} values of {} bytes and has {} bytes",
                    value.size(),
                    tag.bytes
                );
                return Err(Fault::Broken(problem));
            }
            let leaf = Leaf {
                name,
                rows: shape.first().copied().unwrap_or(1),
                columns: shape.get(1).copied().unwrap_or(1),
                room: self.room,
                offset: self.stream.position(),
                value,
                big_endian: self.big_endian,
                class: class_name(class),
            };
            self.add(leaf, shape, count, tag, found)?;
        }
        Ok(())
    }

    fn add(
        &mut self,
        leaf: Leaf,
        shape: &[u64],
        count: u64,
        tag: Tag,
        found: &mut Found,
    ) -> Result<(), Fault> {
        if count == 1 {
            let mut bytes = vec![0; tag.bytes as usize];
            self.stream.fill(&mut bytes)?;
            self.stream.skip(tag.padding)?;
            found
                .scalars
                .push((leaf.name.clone(), first_value(&bytes, &leaf)));
            return Ok(());
        }
        self.stream.skip(tag.bytes + tag.padding)?;
        match shape.len() > 2 {
            true => found
                .left_out
                .push((leaf.name, format!("it has {} dimensions", shape.len()))),
            false => found.leaves.push(leaf),
        }
        Ok(())
    }
}

fn first_value(bytes: &[u8], leaf: &Leaf) -> f64 {
    let layout = crate::tdms_type::Layout {
        value: leaf.value,
        offset: 0,
        stride: leaf.value.size() as usize,
        big_endian: leaf.big_endian,
        bit: None,
    };
    let mut out = [0.0];
    crate::tdms_type::decode(bytes, layout, 0, &mut out);
    out[0]
}

/// Type of the element that is an array.
pub const MATRIX: u32 = 14;

/// Type of the element that holds a deflated one.
pub const COMPRESSED: u32 = 15;

fn value_type(code: u32) -> Option<ValueType> {
    Some(match code {
        1 => ValueType::I8,
        2 => ValueType::U8,
        3 => ValueType::I16,
        4 => ValueType::U16,
        5 => ValueType::I32,
        6 => ValueType::U32,
        7 => ValueType::F32,
        9 => ValueType::F64,
        12 => ValueType::I64,
        13 => ValueType::U64,
        _ => return None,
    })
}

fn class_name(class: u32) -> &'static str {
    const NAMES: [&str; 10] = [
        "double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
        "uint64",
    ];
    NAMES.get(class as usize - 6).copied().unwrap_or("number")
}

/// The header of a variable of version 4: 20 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header4 {
    /// The order of bytes.
    pub big_endian: bool,
    /// How numbers are stored.
    pub value: ValueType,
    /// 0: numbers, 1: text, 2: sparse.
    pub kind: u32,
    /// Rows.
    pub rows: u64,
    /// Columns.
    pub columns: u64,
    /// Whether imaginary parts follow.
    pub complex: bool,
    /// Bytes of the name, with a zero at its end.
    pub name: u64,
}

/// Reads the header of a variable of version 4; `None` if it is none.
#[must_use]
pub fn header4(bytes: &[u8]) -> Option<Header4> {
    let word = |at: usize, big: bool| {
        let bytes: [u8; 4] = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(if big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        })
    };
    let machine = |code: u32| code / 1000;
    let big_endian = match (word(0, false)?, word(0, true)?) {
        (little, _) if little < 1000 => false,
        (_, big) if machine(big) == 1 => true,
        _ => return None,
    };
    let code = word(0, big_endian)? % 1000;
    let value = match code / 10 {
        0 => ValueType::F64,
        1 => ValueType::F32,
        2 => ValueType::I32,
        3 => ValueType::I16,
        4 => ValueType::U16,
        5 => ValueType::U8,
        _ => return None,
    };
    let (rows, columns) = (word(4, big_endian)?, word(8, big_endian)?);
    let (imaginary, name) = (word(12, big_endian)?, word(16, big_endian)?);
    let sane = code % 10 <= 2 && imaginary <= 1 && (1..=1024).contains(&name);
    let sane = sane && rows <= i32::MAX as u32 && columns <= i32::MAX as u32;
    sane.then_some(Header4 {
        big_endian,
        value,
        kind: code % 10,
        rows: u64::from(rows),
        columns: u64::from(columns),
        complex: imaginary == 1,
        name: u64::from(name),
    })
}
