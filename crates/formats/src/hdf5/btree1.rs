//! Version 1 B-trees: group members and chunks.

use crate::hdf5::cursor::Problem;
use crate::hdf5::file::Hdf5File;
use std::collections::BTreeSet;

/// What a tree indexes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keys {
    /// Members of a group.
    Names,
    /// Chunks of a dataset with this many dimensions.
    Chunks(usize),
}

/// A leaf: a key and the address it points to.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    /// The key; for chunks the size, filter mask and position.
    pub key: Vec<u8>,
    pub address: u64,
}

/// All leaves of a tree, in order.
pub(crate) fn read_leaves(file: &Hdf5File, root: u64, keys: Keys) -> Result<Vec<Leaf>, Problem> {
    let mut leaves = Vec::new();
    let mut seen = BTreeSet::new();
    read_node(file, root, keys, None, &mut seen, &mut leaves)?;
    Ok(leaves)
}

fn read_node(
    file: &Hdf5File,
    address: u64,
    keys: Keys,
    expected: Option<u8>,
    seen: &mut BTreeSet<u64>,
    leaves: &mut Vec<Leaf>,
) -> Result<(), Problem> {
    let widths = file.widths;
    let head_size = 8 + 2 * widths.address as u64;
    let mut cursor = file.cursor(file.bytes(address, head_size)?, address);
    cursor.signature(b"TREE")?;
    let kind = cursor.u8()?;
    let level = cursor.u8()?;
    let used = u64::from(cursor.u16()?);
    let fits = kind == u8::from(keys != Keys::Names) && expected.is_none_or(|e| e == level);
    if !fits || !seen.insert(address) {
        return Err(cursor.damaged("a B-tree has a misplaced node"));
    }
    let key_size = match keys {
        Keys::Names => widths.length,
        Keys::Chunks(rank) => 8 + 8 * (rank + 1),
    };
    let size = used * (key_size + widths.address) as u64;
    let body = address + head_size;
    let mut cursor = file.cursor(file.bytes(body, size)?, body);
    for _ in 0..used {
        let key = cursor.take(key_size)?.to_vec();
        let child = cursor.address()?;
        let child = child.ok_or_else(|| cursor.damaged("a B-tree has an undefined address"))?;
        match level {
            0 => leaves.push(Leaf {
                key,
                address: child,
            }),
            _ => read_node(file, child, keys, Some(level - 1), seen, leaves)?,
        }
    }
    Ok(())
}
