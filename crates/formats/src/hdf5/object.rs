//! Object headers: lists of messages.

use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::file::Hdf5File;

/// Message types that are read.
pub(crate) const DATASPACE: u16 = 0x01;
pub(crate) const LINK_INFO: u16 = 0x02;
pub(crate) const DATATYPE: u16 = 0x03;
pub(crate) const OLD_FILL: u16 = 0x04;
pub(crate) const FILL: u16 = 0x05;
pub(crate) const LINK: u16 = 0x06;
pub(crate) const EXTERNAL_FILES: u16 = 0x07;
pub(crate) const LAYOUT: u16 = 0x08;
pub(crate) const FILTERS: u16 = 0x0b;
pub(crate) const ATTRIBUTE: u16 = 0x0c;
pub(crate) const SYMBOL_TABLE: u16 = 0x11;
pub(crate) const ATTRIBUTE_INFO: u16 = 0x15;
const CONTINUATION: u16 = 0x10;

const MOST_BLOCKS: usize = 4096;

/// Most bytes of a header.
const LARGEST: u64 = 16 << 20;

#[derive(Clone, Debug)]
pub(crate) struct Message {
    pub kind: u16,
    /// Whether it only refers to the message.
    pub shared: bool,
    pub bytes: Vec<u8>,
    pub address: u64,
}

/// The messages of an object.
#[derive(Clone, Debug, Default)]
pub(crate) struct Header {
    pub messages: Vec<Message>,
}

impl Header {
    pub fn message(&self, kind: u16) -> Option<&Message> {
        self.messages.iter().find(|m| m.kind == kind)
    }
}

/// Blocks of messages found so far.
#[derive(Default)]
struct Blocks {
    waiting: Vec<(u64, u64)>,
    bytes: u64,
}

impl Blocks {
    fn add(&mut self, cursor: &Cursor<'_>, address: u64, length: u64) -> Result<(), Problem> {
        self.bytes = self.bytes.saturating_add(length);
        let seen = self.waiting.iter().any(|(known, _)| *known == address);
        if seen || self.waiting.len() > MOST_BLOCKS || self.bytes > LARGEST {
            return Err(cursor.damaged("an object header is cyclic or too long"));
        }
        self.waiting.push((address, length));
        Ok(())
    }
}

/// Version of a header.
enum Form {
    Version1,
    /// Bytes before the first message, and of the creation order of each.
    Version2 {
        before: usize,
        tracked: usize,
    },
}

pub(crate) fn read_header(file: &Hdf5File, address: u64) -> Result<Header, Problem> {
    let mut cursor = file.cursor(file.bytes_up_to(address, 64)?, address);
    let mut blocks = Blocks::default();
    let form = match cursor.rest().starts_with(b"OHDR") {
        true => {
            let (length, form) = begin_version2(&mut cursor)?;
            blocks.add(&cursor, address, length)?;
            form
        }
        false => {
            if cursor.u8()? != 1 {
                return Err(file
                    .cursor(&[][..], address)
                    .damaged("expected the header of a group or dataset"));
            }
            cursor.skip(7)?;
            let length = u64::from(cursor.u32()?);
            blocks.add(&cursor, address + 16, length)?;
            Form::Version1
        }
    };
    let mut header = Header::default();
    let mut next = 0;
    while let Some(&(address, length)) = blocks.waiting.get(next) {
        let mut bytes = file.bytes(address, length)?;
        if let Form::Version2 { .. } = form {
            file.check(&bytes, address)?;
            bytes.truncate(bytes.len() - 4);
        }
        let mut cursor = file.cursor(bytes, address);
        let head = match form {
            Form::Version1 => 8,
            Form::Version2 { before, tracked } => {
                match next {
                    0 => cursor.skip(before)?,
                    _ => cursor.signature(b"OCHK")?,
                }
                4 + tracked
            }
        };
        next += 1;
        while cursor.left() >= head {
            add_message(&mut header, &mut blocks, &mut cursor, &form, address)?;
        }
    }
    Ok(header)
}

/// Length and form of the first block of a version 2 header.
fn begin_version2(cursor: &mut Cursor<'_>) -> Result<(u64, Form), Problem> {
    cursor.signature(b"OHDR")?;
    cursor.version("a header", &[2])?;
    let flags = cursor.u8()?;
    // Times, and limits of compact attributes.
    cursor.skip(if flags & 0x20 != 0 { 16 } else { 0 })?;
    cursor.skip(if flags & 0x10 != 0 { 4 } else { 0 })?;
    let length = cursor.uint(1 << (flags & 3))?;
    let form = Form::Version2 {
        before: cursor.place(),
        tracked: if flags & 4 != 0 { 2 } else { 0 },
    };
    Ok((length.saturating_add(cursor.place() as u64 + 4), form))
}

fn add_message(
    header: &mut Header,
    blocks: &mut Blocks,
    cursor: &mut Cursor<'_>,
    form: &Form,
    block: u64,
) -> Result<(), Problem> {
    let kind = match form {
        Form::Version1 => cursor.u16()?,
        Form::Version2 { .. } => u16::from(cursor.u8()?),
    };
    let size = usize::from(cursor.u16()?);
    let shared = cursor.u8()? & 2 != 0;
    cursor.skip(match form {
        Form::Version1 => 3,
        Form::Version2 { tracked, .. } => *tracked,
    })?;
    let address = block + cursor.place() as u64;
    let start = cursor.at();
    let bytes = cursor.take(size)?.to_vec();
    if kind == CONTINUATION {
        let mut body = Cursor::new(bytes, start, cursor.widths());
        let next = body.address()?;
        let length = body.length()?;
        let next = next
            .ok_or_else(|| cursor.damaged("an object header continues at an undefined address"))?;
        return blocks.add(cursor, next, length);
    }
    if kind != 0 {
        header.messages.push(Message {
            kind,
            shared,
            bytes,
            address,
        });
    }
    Ok(())
}

/// Resolves a shared message; others are returned unchanged.
pub(crate) fn resolve(file: &Hdf5File, message: &Message) -> Result<Message, Problem> {
    if !message.shared {
        return Ok(message.clone());
    }
    let mut cursor = file.cursor(&message.bytes, message.address);
    let target = shared_address(&mut cursor)?;
    let header = read_header(file, target)?;
    match header.message(message.kind) {
        Some(found) if !found.shared => Ok(found.clone()),
        _ => Err(cursor.damaged("a shared message refers to nothing")),
    }
}

/// The address of the header that holds a shared message.
pub(crate) fn shared_address(cursor: &mut Cursor<'_>) -> Result<u64, Problem> {
    let version = cursor.version("shared messages", &[1, 2, 3])?;
    let kind = cursor.u8()?;
    if version == 1 {
        cursor.skip(6)?;
    }
    if version == 3 && kind != 2 {
        return Err(Problem::Unsupported(
            "messages kept in a table of the file".to_owned(),
        ));
    }
    let address = cursor.address()?;
    address.ok_or_else(|| cursor.damaged("a shared message has an undefined address"))
}
