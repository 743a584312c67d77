//! Version 4 MAT files: a sequence of matrices with headers.
//!
//! # Source
//! The MathWorks (2023), "MAT-File Format", chapter 2, "Level 4 MAT-Files".

use crate::arrays::tree::{Array, BEGINNING, first_fastest};
use crate::contents::Note;
use crate::mat::flow::{ADVICE, Flow, Region};
use crate::mat::number::{name_of, of_version_4};
use crate::mat::stored::{MatTree, Stored};
use crate::number::integer;
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Bytes of a header.
const HEADER: u64 = 20;

/// Longest name; MATLAB has 63.
const LONGEST_NAME: u32 = 256;

/// Longest text kept.
const LONGEST_TEXT: u64 = 4096;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Header {
    machine: u32,
    digit: u32,
    kind: u32,
    rows: u32,
    columns: u32,
    complex: bool,
    name: u32,
    big_endian: bool,
}

/// Whether a file starts like version 4.
pub(crate) fn begins(head: &[u8]) -> bool {
    let Some(header) = read_header(head) else {
        return false;
    };
    let name = head.get(HEADER as usize..HEADER as usize + header.name as usize);
    name.and_then(<[u8]>::split_last)
        .is_some_and(|(end, name)| {
            *end == 0
                && name.first().is_some_and(u8::is_ascii_alphabetic)
                && name.iter().all(|c| c.is_ascii_alphanumeric() || *c == b'_')
        })
}

/// Parses a header, if the bytes are plausible.
fn read_header(bytes: &[u8]) -> Option<Header> {
    let words = bytes.get(..HEADER as usize)?.as_chunks::<4>().0;
    [false, true].into_iter().find_map(|big_endian| {
        let word = |i: usize| integer(&words[i], big_endian) as u32;
        let kind = word(0);
        let header = Header {
            machine: kind / 1000,
            digit: kind / 10 % 10,
            kind: kind % 10,
            rows: word(1),
            columns: word(2),
            complex: word(3) == 1,
            name: word(4),
            big_endian,
        };
        let fits = header.machine <= 4
            && kind / 100 % 10 == 0
            && header.digit <= 5
            && header.kind <= 2
            && word(3) <= 1
            && (1..=LONGEST_NAME).contains(&header.name)
            && header.rows <= i32::MAX as u32
            && header.columns <= i32::MAX as u32;
        fits.then_some(header)
    })
}

pub(crate) fn list(source: &Source) -> Result<MatTree, Error> {
    let mut found = MatTree::default();
    let mut at = 0;
    while at < source.length() {
        match list_matrix(source, at, &mut found) {
            Ok(next) => at = next,
            Err(Error::Truncated { what, .. }) if !found.stored.is_empty() => {
                found.tree.notes.push(Note::CutOff(what));
                break;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(found)
}

/// Lists the matrix at `at`; returns its end.
fn list_matrix(source: &Source, at: u64, found: &mut MatTree) -> Result<u64, Error> {
    let left = source.length() - at;
    if left < HEADER {
        return Err(source.truncated(at, "the header of a variable", HEADER));
    }
    let header = read_header(&source.bytes_at(at, HEADER)?)
        .ok_or_else(|| malformed(source, at, "expected the header of a version 4 matrix"))?;
    let name_at = at + HEADER;
    let needed = u64::from(header.name);
    if source.length() - name_at < needed {
        return Err(source.truncated(name_at, "the name of a variable", needed));
    }
    let name = source.bytes_at(name_at, needed)?;
    let name = name.split(|c| *c == 0).next().unwrap_or_default();
    let name = String::from_utf8_lossy(name).into_owned();
    if header.machine > 1 {
        return Err(refused_machine(source, at, &header));
    }
    let number = of_version_4(header.digit)
        .ok_or_else(|| malformed(source, at, "expected a number type from 0 to 5"))?;
    let count = u64::from(header.rows) * u64::from(header.columns);
    let parts = 1 + u64::from(header.complex);
    let start = name_at + needed;
    let bytes = count.checked_mul(number.size() * parts);
    let length = bytes
        .filter(|b| *b <= source.length() - start)
        .ok_or_else(|| {
            let what = format!("the variable \"{name}\"");
            source.truncated(start, &what, bytes.unwrap_or(u64::MAX))
        })?;
    let region = Region {
        start,
        length,
        compressed: false,
    };
    let stored = Stored {
        region,
        at: 0,
        number,
        count,
        big_endian: header.big_endian,
        closes: false,
    };
    let path = vec![name];
    match header.kind {
        0 => add(source, path, &header, stored, found)?,
        1 => found
            .tree
            .texts
            .push((path, read_text(source, &header, stored)?)),
        _ => found.tree.leave_out(&path, "it is a sparse matrix"),
    }
    Ok(start + length)
}

fn add(
    source: &Source,
    path: Vec<String>,
    header: &Header,
    stored: Stored,
    found: &mut MatTree,
) -> Result<(), Error> {
    let parts: &[&'static str] = match header.complex {
        true => &[" (real)", " (imaginary)"],
        false => &[""],
    };
    for (i, &part) in parts.iter().enumerate() {
        let stored = Stored {
            at: i as u64 * stored.count * stored.number.size(),
            ..stored
        };
        let first = match header.columns {
            0 => Vec::new(),
            _ => read_some(source, stored, BEGINNING.min(u64::from(header.rows)))?,
        };
        let value = first.first().copied().filter(|_| stored.count == 1);
        found.stored.push(stored);
        found.tree.arrays.push(Array {
            path: path.clone(),
            part,
            extents: first_fastest(&[u64::from(header.rows), u64::from(header.columns)]),
            stored_as: name_of(stored.number).to_owned(),
            value,
            beginning: if header.columns > 1 {
                first
            } else {
                Vec::new()
            },
            unit: None,
            properties: Vec::new(),
        });
    }
    Ok(())
}

/// Text of a character matrix; rows are lines.
fn read_text(source: &Source, header: &Header, stored: Stored) -> Result<String, Error> {
    let codes = read_some(source, stored, LONGEST_TEXT)?;
    let character =
        |code: &f64| char::from_u32(*code as u32).unwrap_or(char::REPLACEMENT_CHARACTER);
    let rows = header.rows.max(1) as usize;
    let lines: Vec<String> = (0..rows.min(codes.len()))
        .map(|row| codes[row..].iter().step_by(rows).map(character).collect())
        .collect();
    Ok(lines.join("\n"))
}

/// The first numbers, at most `most`.
fn read_some(source: &Source, stored: Stored, most: u64) -> Result<Vec<f64>, Error> {
    let count = stored.count.min(most);
    let mut bytes = vec![0; (count * stored.number.size()) as usize];
    Flow::new(source, stored.region).read_at(stored.at, &mut bytes)?;
    Ok(stored.number.decode_all(&bytes, stored.big_endian))
}

fn refused_machine(source: &Source, at: u64, header: &Header) -> Error {
    let machine = match header.machine {
        2 => "VAX D-float",
        3 => "VAX G-float",
        _ => "Cray",
    };
    source.unsupported(
        Place::Byte(at),
        format!("{machine} numbers"),
        "load the file in MATLAB and save it again",
    )
}

fn malformed(source: &Source, at: u64, problem: &str) -> Error {
    source.malformed(Place::Byte(at), problem, ADVICE)
}
