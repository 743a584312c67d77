//! Version 5 MAT files (MATLAB 5 to 7): a header and a sequence of variables, each a
//! tree of matrices, structs and cells.
//!
//! # Source
//! The MathWorks (2023), "MAT-File Format", chapter 1, "Level 5 MAT-Files".

use crate::contents::Note;
use crate::mat::element::{COMPRESSED, Elements, MATRIX};
use crate::mat::flow::{Flow, Region};
use crate::mat::matrix::{Walk, list_variable};
use crate::mat::stored::MatTree;
use crate::number::integer;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Bytes of the header of a file.
const HEADER: u64 = 128;

#[derive(Clone, Debug)]
pub(crate) struct Header {
    /// Text written by the program that made the file.
    pub description: String,
    pub big_endian: bool,
    /// Offset of MATLAB's data for objects.
    subsystem: u64,
}

/// Whether a file starts like version 5.
pub(crate) fn begins(head: &[u8]) -> bool {
    matches!(head.get(126..128), Some(b"IM" | b"MI")) && head[..4].iter().all(|c| *c != 0)
}

pub(crate) fn read_header(source: &Source) -> Result<Header, Error> {
    if source.length() < HEADER {
        return Err(source.truncated(0, "the header of a MAT file", HEADER));
    }
    let bytes = source.bytes_at(0, HEADER)?;
    let big_endian = &bytes[126..] == b"MI";
    let version = integer(&bytes[124..126], big_endian);
    if !begins(&bytes) || version != 0x0100 {
        let problem = match version {
            0x0200 => "this is version 7.3, which is an HDF5 file".to_owned(),
            _ => format!("expected version 256 and \"IM\" or \"MI\", found version {version}"),
        };
        return Err(source.malformed(
            Place::Byte(124),
            problem,
            "let windfall detect the format, or save the file again in MATLAB",
        ));
    }
    let text = String::from_utf8_lossy(&bytes[..116]);
    Ok(Header {
        description: text.trim_matches(['\0', ' ']).to_owned(),
        big_endian,
        subsystem: integer(&bytes[116..124], big_endian),
    })
}

/// Lists the arrays of a file, and whether any is compressed; notes a file cut off.
pub(crate) fn list(source: &Source, header: &Header) -> Result<(MatTree, bool), Error> {
    let mut walk = Walk::default();
    let mut any_compressed = false;
    let mut at = HEADER;
    while at < source.length() {
        let left = source.length() - at;
        if left < 8 {
            cut_off(source, &mut walk, at, "the tag of a variable", 8)?;
            break;
        }
        let (kind, length) = read_tag(source, header, at)?;
        if length > left - 8 {
            cut_off(source, &mut walk, at + 8, "a variable", length)?;
            break;
        }
        let compressed = kind == COMPRESSED;
        any_compressed |= compressed;
        // An uncompressed matrix is read including its tag.
        let tag = if compressed { 0 } else { 8 };
        let region = Region {
            start: at + 8 - tag,
            length: length + tag,
            compressed,
        };
        if at == header.subsystem {
            walk.found.tree.leave_out(
                &["MATLAB's store of objects".to_owned()],
                "it holds no recording",
            );
        } else if compressed || kind == MATRIX {
            let mut elements = Elements {
                source,
                flow: Flow::new(source, region),
                region,
                big_endian: header.big_endian,
                start: at,
            };
            list_variable(&mut elements, &mut walk)?;
        } else {
            walk.found.tree.notes.push(Note::Odd(format!(
                "the data element of type {kind} at byte {at} is skipped"
            )));
        }
        let end = at + 8 + length;
        at = match compressed {
            true => end,
            false => end.next_multiple_of(8),
        };
    }
    Ok((walk.found, any_compressed))
}

fn read_tag(source: &Source, header: &Header, at: u64) -> Result<(u32, u64), Error> {
    let bytes = source.bytes_at(at, 8)?;
    let [kind, length] = [&bytes[..4], &bytes[4..]].map(|b| integer(b, header.big_endian));
    Ok((kind as u32, length))
}

/// Notes a truncated file; an error if nothing was found before.
fn cut_off(
    source: &Source,
    walk: &mut Walk,
    at: u64,
    what: &str,
    needed: u64,
) -> Result<(), Error> {
    let error = source.truncated(at, what, needed);
    if walk.found.stored.is_empty() && walk.found.tree.texts.is_empty() {
        return Err(error);
    }
    walk.found.tree.notes.push(Note::CutOff(format!(
        "{what} at byte {at} needs {needed} bytes, {} are left",
        source.length().saturating_sub(at)
    )));
    Ok(())
}
