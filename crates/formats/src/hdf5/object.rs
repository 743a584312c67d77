//! Headers of groups and datasets: rows of messages.

use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::file::Hdf5File;

/// Kinds of messages that are read.
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

/// Most blocks of a header.
const MOST_BLOCKS: usize = 4096;

/// Most bytes of a header.
const LARGEST: u64 = 16 << 20;

/// A message.
#[derive(Clone, Debug)]
pub(crate) struct Message {
    pub kind: u16,
    /// Whether it tells where the message is instead.
    pub shared: bool,
    pub bytes: Vec<u8>,
    /// Its address.
    pub address: u64,
}

/// The messages of a group or dataset.
#[derive(Clone, Debug, Default)]
pub(crate) struct Header {
    pub messages: Vec<Message>,
}

impl Header {
    /// The first message of a kind.
    pub fn message(&self, kind: u16) -> Option<&Message> {
        self.messages.iter().find(|m| m.kind == kind)
    }
}

/// Blocks of messages that are still to be read.
struct Blocks {
    waiting: Vec<(u64, u64)>,
    seen: Vec<u64>,
    bytes: u64,
}

impl Blocks {
    fn add(&mut self, cursor: &Cursor<'_>, address: u64, length: u64) -> Result<(), Problem> {
        self.bytes = self.bytes.saturating_add(length);
        if self.seen.contains(&address) || self.seen.len() > MOST_BLOCKS || self.bytes > LARGEST {
            return Err(cursor.damaged("a header goes round in circles, or is too long"));
        }
        self.seen.push(address);
        self.waiting.push((address, length));
        Ok(())
    }
}

/// Reads the header at an address.
pub(crate) fn read_header(file: &Hdf5File, address: u64) -> Result<Header, Problem> {
    let head = file.bytes_up_to(address, 64)?;
    let mut cursor = file.cursor(&head, address);
    match head.starts_with(b"OHDR") {
        true => read_version2(file, address, &mut cursor),
        false => read_version1(file, address, &mut cursor),
    }
}

fn read_version1(
    file: &Hdf5File,
    address: u64,
    cursor: &mut Cursor<'_>,
) -> Result<Header, Problem> {
    if cursor.u8()? != 1 {
        return Err(file
            .cursor(&[], address)
            .damaged("expected the header of a group or dataset"));
    }
    cursor.skip(7)?;
    let length = u64::from(cursor.u32()?);
    let mut blocks = Blocks {
        waiting: Vec::new(),
        seen: Vec::new(),
        bytes: 0,
    };
    blocks.add(cursor, address + 16, length)?;
    let mut header = Header::default();
    let mut next = 0;
    while let Some(&(address, length)) = blocks.waiting.get(next) {
        next += 1;
        let bytes = file.bytes(address, length)?;
        let mut cursor = file.cursor(&bytes, address);
        while cursor.left() >= 8 {
            let kind = cursor.u16()?;
            let size = usize::from(cursor.u16()?);
            let flags = cursor.u8()?;
            cursor.skip(3)?;
            add_message(
                &mut header,
                &mut blocks,
                &mut cursor,
                (kind, size, flags),
                address,
            )?;
        }
    }
    Ok(header)
}

fn read_version2(
    file: &Hdf5File,
    address: u64,
    cursor: &mut Cursor<'_>,
) -> Result<Header, Problem> {
    cursor.expect(b"OHDR")?;
    cursor.version("a header", &[2])?;
    let flags = cursor.u8()?;
    // Times, and limits of compact attributes.
    cursor.skip(if flags & 0x20 != 0 { 16 } else { 0 })?;
    cursor.skip(if flags & 0x10 != 0 { 4 } else { 0 })?;
    let length = cursor.uint(1 << (flags & 3))?;
    let before = cursor.place() as u64;
    let mut blocks = Blocks {
        waiting: Vec::new(),
        seen: Vec::new(),
        bytes: 0,
    };
    let whole = length.saturating_add(before + 4);
    blocks.add(cursor, address, whole)?;
    let mut header = Header::default();
    let mut next = 0;
    while let Some(&(address, length)) = blocks.waiting.get(next) {
        let bytes = file.bytes(address, length)?;
        file.check(&bytes, address)?;
        let mut cursor = file.cursor(&bytes[..bytes.len() - 4], address);
        match next {
            0 => cursor.skip(before as usize)?,
            _ => cursor.expect(b"OCHK")?,
        }
        next += 1;
        let tracked = if flags & 4 != 0 { 2 } else { 0 };
        while cursor.left() >= 4 + tracked {
            let kind = u16::from(cursor.u8()?);
            let size = usize::from(cursor.u16()?);
            let message_flags = cursor.u8()?;
            cursor.skip(tracked)?;
            let what = (kind, size, message_flags);
            add_message(&mut header, &mut blocks, &mut cursor, what, address)?;
        }
    }
    Ok(header)
}

fn add_message(
    header: &mut Header,
    blocks: &mut Blocks,
    cursor: &mut Cursor<'_>,
    (kind, size, flags): (u16, usize, u8),
    block: u64,
) -> Result<(), Problem> {
    let address = block + cursor.place() as u64;
    let start = cursor.at();
    let bytes = cursor.take(size)?;
    if kind == CONTINUATION {
        let mut body = Cursor::new(bytes, start, cursor.widths());
        let next = body.address()?;
        let length = body.length()?;
        let next = next.ok_or_else(|| cursor.damaged("a header goes on nowhere"))?;
        return blocks.add(cursor, next, length);
    }
    if kind != 0 {
        header.messages.push(Message {
            kind,
            shared: flags & 2 != 0,
            bytes: bytes.to_vec(),
            address,
        });
    }
    Ok(())
}

/// The message that a shared one stands for; another is given back as it is.
pub(crate) fn resolve(file: &Hdf5File, message: &Message) -> Result<Message, Problem> {
    if !message.shared {
        return Ok(message.clone());
    }
    let mut cursor = file.cursor(&message.bytes, message.address);
    let target = shared_address(&mut cursor)?;
    let header = read_header(file, target)?;
    match header.message(message.kind) {
        Some(found) if !found.shared => Ok(found.clone()),
        _ => Err(cursor.damaged("what a shared message refers to is not there")),
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
            "messages that are kept in a table of the file".to_owned(),
        ));
    }
    let address = cursor.address()?;
    address.ok_or_else(|| cursor.damaged("a shared message is nowhere"))
}
