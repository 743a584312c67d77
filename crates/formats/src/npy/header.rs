//! The header of an array: a literal of Python.
//!
//! # Source
//! NumPy enhancement proposal 1, "A simple file format for NumPy arrays", and `numpy.lib.format`.

use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// First bytes of an array.
pub const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header; bytes.
const LONGEST: u64 = 1 << 20;

/// Deepest nesting of a literal.
const DEEPEST: usize = 16;

/// What a header says.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub version: (u8, u8),
    /// Type of an element, as written.
    pub descr: Literal,
    pub fortran: bool,
    pub shape: Vec<u64>,
    /// First byte of the data.
    pub data: u64,
}

/// A literal of Python.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    Text(String),
    Whole(u64),
    Truth(bool),
    /// A list or a tuple.
    Items(Vec<Literal>),
    Pairs(Vec<(String, Literal)>),
}

/// Reads the header at the beginning of a source.
///
/// # Errors
/// It is none, or the file ends in it.
pub fn read_header(source: &Source) -> Result<Header, Error> {
    let broken = |problem: &str| {
        let advice = "the file is damaged: save the array again with numpy.save";
        source.malformed(Place::Byte(0), problem, advice)
    };
    let head = source.bytes_at(0, 10)?;
    if !head.starts_with(MAGIC) {
        return Err(broken("this is not the beginning of a NumPy array"));
    }
    let (length, begin) = match head[6] {
        1 => (u64::from(u16::from_le_bytes([head[8], head[9]])), 10),
        2 | 3 => {
            let bytes = source.bytes_at(8, 4)?;
            (
                u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
                12,
            )
        }
        other => {
            let what = format!("version {other} of NumPy's format");
            return Err(source.unsupported(Place::Byte(6), what, "save it with numpy.save"));
        }
    };
    if length > LONGEST {
        return Err(broken("the header is longer than a mebibyte"));
    }
    let bytes = source.bytes_at(begin, length)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut rest = text.trim();
    let literal = literal(&mut rest, 0).filter(|_| rest.is_empty());
    let Some(Literal::Pairs(pairs)) = literal else {
        return Err(broken("the header is not a dictionary of Python"));
    };
    let get = |key: &str| {
        pairs
            .iter()
            .find(|(name, _)| name == key)
            .map(|(_, value)| value)
    };
    let whole = |literal: &Literal| match literal {
        Literal::Whole(value) => Some(*value),
        _ => None,
    };
    let (Some(descr), Some(Literal::Truth(fortran)), Some(Literal::Items(shape))) =
        (get("descr"), get("fortran_order"), get("shape"))
    else {
        return Err(broken("the header lacks descr, fortran_order or shape"));
    };
    let shape: Option<Vec<u64>> = shape.iter().map(whole).collect();
    Ok(Header {
        version: (head[6], head[7]),
        descr: descr.clone(),
        fortran: *fortran,
        shape: shape.ok_or_else(|| broken("the shape is not made of whole numbers"))?,
        data: begin + length,
    })
}

/// Takes a literal from the beginning of a text.
fn literal(rest: &mut &str, depth: usize) -> Option<Literal> {
    if depth > DEEPEST {
        return None;
    }
    match rest.chars().next()? {
        '{' => {
            let mut pairs = Vec::new();
            let mut item = |rest: &mut &str| {
                let Literal::Text(key) = literal(rest, depth + 1)? else {
                    return None;
                };
                take(rest, ":").then_some(())?;
                pairs.push((key, literal(rest, depth + 1)?));
                Some(())
            };
            items(rest, "}", &mut item)?;
            Some(Literal::Pairs(pairs))
        }
        open @ ('[' | '(') => {
            let mut found = Vec::new();
            let mut item = |rest: &mut &str| {
                found.push(literal(rest, depth + 1)?);
                Some(())
            };
            items(rest, if open == '[' { "]" } else { ")" }, &mut item)?;
            Some(Literal::Items(found))
        }
        quote @ ('\'' | '"') => {
            let (text, after) = rest[1..].split_once(quote)?;
            *rest = after.trim_start();
            // Names with escapes are not read.
            (!text.contains('\\')).then(|| Literal::Text(text.to_owned()))
        }
        c if c.is_ascii_digit() => {
            let end = rest
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(rest.len());
            let (digits, after) = rest.split_at(end);
            // Python 2 wrote an L behind long numbers.
            *rest = after.strip_prefix('L').unwrap_or(after).trim_start();
            digits.parse().ok().map(Literal::Whole)
        }
        _ if take(rest, "True") => Some(Literal::Truth(true)),
        _ if take(rest, "False") => Some(Literal::Truth(false)),
        _ => None,
    }
}

/// Takes what stands between brackets, with commas.
fn items(
    rest: &mut &str,
    close: &str,
    item: &mut dyn FnMut(&mut &str) -> Option<()>,
) -> Option<()> {
    *rest = rest[1..].trim_start();
    while !take(rest, close) {
        item(rest)?;
        if !take(rest, ",") && !rest.starts_with(close) {
            return None;
        }
    }
    Some(())
}

fn take(rest: &mut &str, word: &str) -> bool {
    match rest.strip_prefix(word) {
        Some(after) => {
            *rest = after.trim_start();
            true
        }
        None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Literal> {
        let mut rest = text;
        literal(&mut rest, 0).filter(|_| rest.is_empty())
    }

    #[test]
    fn closed_form_literals() {
        let text = |text: &str| Literal::Text(text.to_owned());
        let (whole, items) = (Literal::Whole, Literal::Items);
        assert_eq!(read("(3, 4L,)"), Some(items(vec![whole(3), whole(4)])));
        assert_eq!(read("()"), Some(items(Vec::new())));
        let fields = items(vec![items(vec![
            text("t"),
            text("<f8"),
            items(vec![whole(2)]),
        ])]);
        let pairs = vec![
            ("a".to_owned(), Literal::Truth(false)),
            ("b".to_owned(), fields),
        ];
        let found = read("{'a': False, \"b\": [('t', '<f8', (2,))], }");
        assert_eq!(found, Some(Literal::Pairs(pairs)));
        for broken in ["", "{", "{1: 2}", "(1 2)", "'a", "-1", "None", "1x"] {
            assert_eq!(read(broken), None, "{broken}");
        }
        assert_eq!(read(&"(".repeat(100)), None);
    }
}
