//! Members of groups.

use crate::hdf5::btree1::{Keys, read_leaves};
use crate::hdf5::btree2::read_records;
use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::file::Hdf5File;
use crate::hdf5::heap::{FractalHeap, LocalHeap};
use crate::hdf5::object::{Header, LINK, LINK_INFO, SYMBOL_TABLE};

const MOST_MEMBERS: usize = 200_000;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Member {
    pub name: String,
    pub link: Link,
}

/// Target of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Link {
    /// The object with a header at this address.
    Hard(u64),
    /// Another path in the file.
    Soft(String),
    /// An object in another file.
    External,
}

/// The members of a group, sorted by name.
pub(crate) fn read_members(file: &Hdf5File, header: &Header) -> Result<Vec<Member>, Problem> {
    let mut members = Vec::new();
    for message in &header.messages {
        let mut cursor = file.cursor(&message.bytes, message.address);
        match message.kind {
            SYMBOL_TABLE => read_symbols(file, &mut cursor, &mut members)?,
            LINK => members.push(read_link(&mut cursor)?),
            LINK_INFO => read_dense(file, &mut cursor, &mut members)?,
            _ => {}
        }
    }
    if members.len() > MOST_MEMBERS {
        return Err(Problem::Unsupported(format!(
            "groups of {} members",
            members.len()
        )));
    }
    members.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(members)
}

/// Whether a header belongs to a group.
pub(crate) fn is_group(header: &Header) -> bool {
    [SYMBOL_TABLE, LINK, LINK_INFO]
        .iter()
        .any(|kind| header.message(*kind).is_some())
}

/// Members of an old-style group.
fn read_symbols(
    file: &Hdf5File,
    cursor: &mut Cursor<'_>,
    members: &mut Vec<Member>,
) -> Result<(), Problem> {
    let (Some(tree), Some(heap)) = (cursor.address()?, cursor.address()?) else {
        return Ok(());
    };
    let heap = LocalHeap::read(file, heap)?;
    let entry = 2 * file.widths.address + 24;
    for leaf in read_leaves(file, tree, Keys::Names)? {
        let mut cursor = file.cursor(file.bytes(leaf.address, 8)?, leaf.address);
        cursor.signature(b"SNOD")?;
        cursor.skip(2)?;
        let count = usize::from(cursor.u16()?);
        let entries = leaf.address + 8;
        let mut cursor = file.cursor(file.bytes(entries, (count * entry) as u64)?, entries);
        for _ in 0..count {
            let name = cursor.uint(file.widths.address)?;
            let address = cursor.address()?;
            let kind = cursor.u32()?;
            cursor.skip(4)?;
            let soft = u64::from(cursor.u32()?);
            cursor.skip(12)?;
            let link = match (kind, address) {
                (2, _) => Link::Soft(heap.name(file, soft)?),
                (_, Some(address)) => Link::Hard(address),
                _ => continue,
            };
            let name = heap.name(file, name)?;
            members.push(Member { name, link });
        }
        if members.len() > MOST_MEMBERS {
            return Ok(());
        }
    }
    Ok(())
}

/// A member of a new-style group.
fn read_link(cursor: &mut Cursor<'_>) -> Result<Member, Problem> {
    cursor.version("links", &[1])?;
    let flags = cursor.u8()?;
    let kind = if flags & 8 != 0 { cursor.u8()? } else { 0 };
    cursor.skip(if flags & 4 != 0 { 8 } else { 0 })?;
    cursor.skip(if flags & 0x10 != 0 { 1 } else { 0 })?;
    let length = cursor.uint(1 << (flags & 3))?;
    let name = cursor.take(usize::try_from(length).unwrap_or(usize::MAX))?;
    let name = String::from_utf8_lossy(name).into_owned();
    let link = match kind {
        0 => {
            let address = cursor.address()?;
            Link::Hard(address.ok_or_else(|| cursor.damaged("a link has an undefined address"))?)
        }
        1 => {
            let length = usize::from(cursor.u16()?);
            Link::Soft(String::from_utf8_lossy(cursor.take(length)?).into_owned())
        }
        _ => Link::External,
    };
    Ok(Member { name, link })
}

/// Members of a new-style group in dense storage.
fn read_dense(
    file: &Hdf5File,
    cursor: &mut Cursor<'_>,
    members: &mut Vec<Member>,
) -> Result<(), Problem> {
    cursor.version("links", &[0])?;
    let flags = cursor.u8()?;
    cursor.skip(if flags & 1 != 0 { 8 } else { 0 })?;
    let (Some(heap), Some(names)) = (cursor.address()?, cursor.address()?) else {
        return Ok(());
    };
    let heap = FractalHeap::read(file, heap)?;
    let (_, records) = read_records(file, names, &[5])?;
    for record in records {
        // After the hash of the name.
        let id = record.get(4..4 + heap.id_length());
        let id = id.ok_or_else(|| cursor.damaged("a link record is too short"))?;
        let (bytes, address) = heap.object(id)?;
        members.push(read_link(&mut file.cursor(&bytes, address))?);
        if members.len() > MOST_MEMBERS {
            return Ok(());
        }
    }
    Ok(())
}
