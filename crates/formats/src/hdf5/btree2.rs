//! Version 2 B-trees: links, attributes and chunks.

use crate::hdf5::cursor::{Problem, bytes_for};
use crate::hdf5::file::Hdf5File;
use std::collections::BTreeSet;

/// Bytes of a node besides its records.
const AROUND: u64 = 10;

/// Deepest tree.
const DEEPEST: u64 = 16;

/// Node sizes at a depth.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Width of the record count of a node; bytes.
    count: usize,
    /// Most records in and below a node, and the width of that count.
    most_below: u64,
    below: usize,
}

struct Tree<'a> {
    file: &'a Hdf5File,
    record: usize,
    node: u64,
    levels: Vec<Level>,
    seen: BTreeSet<u64>,
    records: Vec<Vec<u8>>,
}

/// All records of a tree, in order, with its type.
pub(crate) fn read_records(
    file: &Hdf5File,
    address: u64,
    kinds: &[u8],
) -> Result<(u8, Vec<Vec<u8>>), Problem> {
    let size = 22 + file.widths.address + file.widths.length;
    let mut cursor = file.checked(address, size as u64, b"BTHD")?;
    cursor.version("a tree", &[0])?;
    let kind = cursor.u8()?;
    let node = u64::from(cursor.u32()?);
    let record = cursor.u16()?;
    let depth = u64::from(cursor.u16()?);
    cursor.skip(2)?;
    let root = cursor.address()?;
    let count = u64::from(cursor.u16()?);
    if !kinds.contains(&kind) || record == 0 || node <= AROUND || depth > DEEPEST {
        return Err(cursor.damaged("a B-tree has an unexpected type"));
    }
    let mut tree = Tree {
        file,
        record: usize::from(record),
        node,
        levels: levels(file, node, u64::from(record), depth),
        seen: BTreeSet::new(),
        records: Vec::new(),
    };
    if let Some(root) = root {
        tree.read_node(root, count, depth)?;
    }
    Ok((kind, tree.records))
}

fn levels(file: &Hdf5File, node: u64, record: u64, depth: u64) -> Vec<Level> {
    let most = (node - AROUND) / record;
    let count = bytes_for(most);
    let mut levels = vec![Level {
        count,
        most_below: most,
        below: 0,
    }];
    for d in 1..=depth as usize {
        let under = levels[d - 1];
        let pointer = (file.widths.address + count + under.below) as u64;
        let most = node.saturating_sub(AROUND + pointer) / (record + pointer);
        let most_below = (most + 1)
            .saturating_mul(under.most_below)
            .saturating_add(most);
        levels.push(Level {
            count,
            most_below,
            below: bytes_for(most_below),
        });
    }
    levels
}

impl Tree<'_> {
    fn read_node(&mut self, address: u64, count: u64, depth: u64) -> Result<(), Problem> {
        let file = self.file;
        let level = self.levels[depth as usize];
        let record = self.record as u64;
        let mut size = 6 + count * record + 4;
        let under = depth.checked_sub(1).map(|d| self.levels[d as usize]);
        if let Some(under) = under {
            let pointer = file.widths.address + level.count + under.below;
            size += (count + 1) * pointer as u64;
        }
        if size > self.node || !self.seen.insert(address) {
            let here = file.cursor(&[][..], address);
            return Err(here.damaged("a B-tree has a misplaced node"));
        }
        let signature = if depth == 0 { b"BTLF" } else { b"BTIN" };
        let mut cursor = file.checked(address, size, signature)?;
        cursor.skip(2)?;
        let own: Vec<Vec<u8>> = (0..count)
            .map(|_| cursor.take(self.record).map(<[u8]>::to_vec))
            .collect::<Result<_, _>>()?;
        let Some(under) = under else {
            self.records.extend(own);
            return Ok(());
        };
        let mut own = own.into_iter();
        for _ in 0..=count {
            let child = cursor.address()?;
            let child = child.ok_or_else(|| cursor.damaged("a B-tree has an undefined address"))?;
            let below = cursor.uint(level.count)?;
            cursor.skip(under.below)?;
            self.read_node(child, below, depth - 1)?;
            self.records.extend(own.next());
        }
        Ok(())
    }
}
