//! Variables of version 5 MAT files: numbers, texts, structs and cells.

use crate::arrays::tree::{Array, BEGINNING, first_fastest};
use crate::mat::element::{Element, Elements, MATRIX};
use crate::mat::number::{name_of, of_class, of_element};
use crate::mat::stored::{MatTree, Stored};
use crate::number::{Number, integer};
use windfall_source::error::Error;

/// Deepest nesting of structs and cells.
const DEEPEST: usize = 32;

/// Most objects in a file: arrays, texts, fields and cells.
const MOST_THINGS: usize = 200_000;

/// Most dimensions of an array.
const MOST_EXTENTS: u64 = 32;

/// Longest text kept; bytes.
const LONGEST_TEXT: u64 = 8192;

/// Most bytes of the field names of a struct.
const LONGEST_NAMES: u64 = 1 << 20;

/// Contents found so far.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    pub found: MatTree,
    things: usize,
    /// End of the current variable.
    end: u64,
}

/// Common part of all matrices.
struct Matrix {
    complex: bool,
    logical: bool,
    extents: Vec<u64>,
    /// Number of elements.
    count: u64,
    /// Offset after the name.
    at: u64,
    end: u64,
}

pub(crate) fn list_variable(elements: &mut Elements<'_>, walk: &mut Walk) -> Result<(), Error> {
    // The decompressed length is only known from the first tag.
    let end = match elements.region.compressed {
        true => u64::MAX,
        false => elements.region.length,
    };
    let element = elements.element(0, end)?;
    if element.kind != MATRIX {
        return Err(elements.malformed("expected a matrix"));
    }
    walk.end = element.at + element.length;
    list_matrix(elements, element, &[], walk)
}

/// Lists a matrix; `above` is empty for variables, which are named.
fn list_matrix(
    elements: &mut Elements<'_>,
    element: Element,
    above: &[String],
    walk: &mut Walk,
) -> Result<(), Error> {
    walk.things += 1;
    if element.length == 0 {
        walk.found.tree.leave_out(above, "it is empty");
        return Ok(());
    }
    if above.len() > DEEPEST || walk.things > MOST_THINGS {
        walk.found.tree.leave_out(
            above,
            "it is nested too deep, or the file holds too many objects",
        );
        return Ok(());
    }
    let end = element.at + element.length;
    let flags = elements.element(element.at, end)?;
    let flag_words = elements.integers(flags, 2)?;
    let Some(&word) = flag_words.first() else {
        return Err(elements.malformed("expected the flags of a matrix"));
    };
    let class = (word & 0xff) as u8;
    let named = |elements: &mut Elements<'_>, at: u64| -> Result<(Vec<String>, u64), Error> {
        let name = elements.element(at, end)?;
        let text = elements.data(name, LONGEST_TEXT)?;
        let mut path = above.to_vec();
        if path.is_empty() {
            path.push(String::from_utf8_lossy(&text).into_owned());
        }
        Ok((path, name.next))
    };
    if class == OPAQUE {
        let (path, _) = named(elements, flags.next)?;
        walk.found.tree.leave_out(&path, reason(class));
        return Ok(());
    }
    let extents = elements.element(flags.next, end)?;
    let lengths = elements.integers(extents, MOST_EXTENTS)?;
    let lengths: Vec<u64> = lengths.into_iter().map(u64::from).collect();
    if lengths.len() < 2 || extents.length / 4 > MOST_EXTENTS {
        return Err(elements.malformed("expected a matrix of 2 to 32 dimensions"));
    }
    let (path, at) = named(elements, extents.next)?;
    let matrix = Matrix {
        complex: word & 0x800 != 0,
        logical: word & 0x200 != 0,
        count: lengths.iter().fold(1, |n, l| n.saturating_mul(*l)),
        extents: lengths,
        at,
        end,
    };
    if path[0].is_empty() {
        let name = ["MATLAB's store of objects".to_owned()];
        walk.found.tree.leave_out(&name, "it holds no recording");
        return Ok(());
    }
    match class {
        CELL => list_cells(elements, &matrix, &path, walk),
        STRUCT => list_struct(elements, &matrix, &path, walk),
        TEXT => list_text(elements, &matrix, path, walk),
        _ => match of_class(class) {
            Some(number) => list_numbers(elements, &matrix, (path, number), walk),
            None => {
                walk.found.tree.leave_out(&path, reason(class));
                Ok(())
            }
        },
    }
}

const CELL: u8 = 1;
const STRUCT: u8 = 2;
const TEXT: u8 = 4;
const OPAQUE: u8 = 17;

/// Why a class of matrices is not read.
fn reason(class: u8) -> &'static str {
    match class {
        3 | OPAQUE => "it is an object of MATLAB (a table, a string, a date …); save plain arrays",
        5 => "it is a sparse matrix; save full(…) of it",
        16 => "it is a function",
        _ => "windfall does not know its class",
    }
}

fn list_cells(
    elements: &mut Elements<'_>,
    matrix: &Matrix,
    path: &[String],
    walk: &mut Walk,
) -> Result<(), Error> {
    let mut at = matrix.at;
    check_room(elements, matrix, matrix.count)?;
    for cell in 0..matrix.count {
        let element = elements.element(at, matrix.end)?;
        list_part(elements, element, path, &[cell + 1], None, walk)?;
        at = element.next;
    }
    Ok(())
}

fn list_struct(
    elements: &mut Elements<'_>,
    matrix: &Matrix,
    path: &[String],
    walk: &mut Walk,
) -> Result<(), Error> {
    let width = elements.element(matrix.at, matrix.end)?;
    let width_words = elements.integers(width, 1)?;
    let names_element = elements.element(width.next, matrix.end)?;
    let text = elements.data(names_element, LONGEST_NAMES)?;
    let width = match width_words.first() {
        Some(&width) if width > 0 => width as usize,
        _ => return Err(elements.malformed("expected the length of field names")),
    };
    let names: Vec<String> = text
        .chunks_exact(width)
        .map(|name| name.split(|c| *c == 0).next().unwrap_or_default())
        .map(|name| String::from_utf8_lossy(name).into_owned())
        .collect();
    let next = names_element.next;
    if names.is_empty() && matrix.count > 0 {
        walk.found
            .tree
            .leave_out(path, "it is a struct without fields");
        return Ok(());
    }
    let mut at = next;
    check_room(
        elements,
        matrix,
        matrix.count.saturating_mul(names.len() as u64),
    )?;
    for k in 0..matrix.count {
        // A single struct is not numbered.
        let number = [k + 1];
        let number = if matrix.count == 1 {
            &number[..0]
        } else {
            &number[..]
        };
        for name in &names {
            let element = elements.element(at, matrix.end)?;
            list_part(elements, element, path, number, Some(name), walk)?;
            at = element.next;
        }
    }
    Ok(())
}

/// Lists a cell, or a field of a struct.
fn list_part(
    elements: &mut Elements<'_>,
    element: Element,
    path: &[String],
    number: &[u64],
    name: Option<&String>,
    walk: &mut Walk,
) -> Result<(), Error> {
    if element.kind != MATRIX {
        return Err(elements.malformed("expected a matrix in a struct or cell"));
    }
    let mut path = path.to_vec();
    path.extend(number.iter().map(u64::to_string));
    path.extend(name.cloned());
    list_matrix(elements, element, &path, walk)
}

/// Each part of a struct or cell takes at least a tag of eight bytes.
fn check_room(elements: &Elements<'_>, matrix: &Matrix, parts: u64) -> Result<(), Error> {
    match parts > matrix.end.saturating_sub(matrix.at) / 8 {
        true => {
            Err(elements.malformed("a struct or cell declares more parts than it has room for"))
        }
        false => Ok(()),
    }
}

fn list_text(
    elements: &mut Elements<'_>,
    matrix: &Matrix,
    path: Vec<String>,
    walk: &mut Walk,
) -> Result<(), Error> {
    if matrix.at >= matrix.end {
        walk.found.tree.texts.push((path, String::new()));
        return Ok(());
    }
    let element = elements.element(matrix.at, matrix.end)?;
    let bytes = elements.data(element, LONGEST_TEXT)?;
    let big_endian = elements.big_endian;
    let text: String = match element.kind {
        1 | 2 | 16 => String::from_utf8_lossy(&bytes).into_owned(),
        4 | 17 => {
            let pairs = bytes.as_chunks::<2>().0.iter();
            let units = pairs.map(|pair| integer(pair, big_endian) as u16);
            char::decode_utf16(units)
                .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
                .collect()
        }
        _ => return Err(elements.malformed("expected the characters of a text")),
    };
    walk.found.tree.texts.push((path, by_rows(&text, matrix)));
    Ok(())
}

/// Text is stored by columns; rows are lines.
fn by_rows(text: &str, matrix: &Matrix) -> String {
    let rows = matrix.extents[0];
    let characters: Vec<char> = text.chars().collect();
    // A text with rows but no columns is empty.
    if rows <= 1 || characters.is_empty() || characters.len() as u64 != matrix.count {
        return text.to_owned();
    }
    let rows = rows as usize;
    let line = |row: usize| characters[row..].iter().step_by(rows).collect::<String>();
    let lines: Vec<String> = (0..rows)
        .map(|row| line(row).trim_end().to_owned())
        .collect();
    lines.join("\n")
}

fn list_numbers(
    elements: &mut Elements<'_>,
    matrix: &Matrix,
    (path, class): (Vec<String>, Number),
    walk: &mut Walk,
) -> Result<(), Error> {
    let parts: &[&'static str] = match matrix.complex {
        true => &[" (real)", " (imaginary)"],
        false => &[""],
    };
    let mut at = matrix.at;
    for &part in parts {
        let element = elements.element(at, matrix.end)?;
        at = element.next;
        let Some(number) = of_element(element.kind) else {
            return Err(elements.malformed("expected the numbers of a matrix"));
        };
        if element.length != matrix.count.saturating_mul(number.size()) {
            let problem = format!(
                "\"{}\" has {} elements and {} bytes of {}",
                path.join("/"),
                matrix.count,
                element.length,
                name_of(number)
            );
            return Err(elements.malformed(&problem));
        }
        let first = first_column(elements, matrix, element, number)?;
        let value = first.first().copied().filter(|_| matrix.count == 1);
        walk.found.stored.push(Stored {
            region: elements.region,
            at: element.at,
            number,
            count: matrix.count,
            big_endian: elements.big_endian,
            closes: element.next >= walk.end,
        });
        walk.found.tree.arrays.push(Array {
            path: path.clone(),
            part,
            extents: first_fastest(&matrix.extents),
            stored_as: stored_as(matrix, class, number, elements.region.compressed),
            value,
            beginning: first,
            unit: None,
            properties: Vec::new(),
        });
    }
    Ok(())
}

/// The start of the first column of a matrix, or a scalar.
fn first_column(
    elements: &mut Elements<'_>,
    matrix: &Matrix,
    element: Element,
    number: Number,
) -> Result<Vec<f64>, Error> {
    if matrix.count == 1 || (matrix.extents.len() == 2 && matrix.extents[1] > 1) {
        let most = matrix.extents[0].min(BEGINNING) * number.size();
        let bytes = elements.data(element, most)?;
        return Ok(number.decode_all(&bytes, elements.big_endian));
    }
    Ok(Vec::new())
}

fn stored_as(matrix: &Matrix, class: Number, number: Number, compressed: bool) -> String {
    let mut text = match matrix.logical {
        true => "logical".to_owned(),
        false => name_of(class).to_owned(),
    };
    if number != class {
        text.push_str(", stored as ");
        text.push_str(name_of(number));
    }
    if compressed {
        text.push_str(", compressed");
    }
    text
}
