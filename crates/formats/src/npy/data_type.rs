//! Types of elements.

use crate::npy::header::Literal;
use crate::number::Number;

/// Numbers within each element.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Names of the fields of a structured type, outermost first.
    pub path: Vec<String>,
    /// " (real)", " (imaginary)", or nothing.
    pub part: &'static str,
    /// Its type, as NumPy writes it.
    pub written: String,
    /// Bytes from the beginning of an element.
    pub offset: u64,
    /// `None`, with the reason, where it holds no numbers that are read.
    pub number: Result<(Number, bool), &'static str>,
}

/// Most fields of an element.
const MOST_FIELDS: usize = 4096;

/// The fields of an element and its size in bytes; `None` if this is no type.
pub fn fields(descr: &Literal) -> Option<(Vec<Field>, u64)> {
    let mut found = Vec::new();
    let size = add(descr, &[], 0, &mut found)?;
    (size > 0).then_some((found, size))
}

fn add(descr: &Literal, path: &[String], offset: u64, found: &mut Vec<Field>) -> Option<u64> {
    match descr {
        Literal::Text(text) => add_plain(text, path, offset, found),
        Literal::Items(items) => {
            let mut size = 0_u64;
            for item in items {
                let Literal::Items(field) = item else {
                    return None;
                };
                let name = match field.first()? {
                    Literal::Text(name) => name,
                    // A title and a name.
                    Literal::Items(both) => match both.last()? {
                        Literal::Text(name) => name,
                        _ => return None,
                    },
                    _ => return None,
                };
                let mut path = path.to_vec();
                path.push(name.clone());
                let times = match field.get(2) {
                    None => None,
                    Some(shape) => Some(product(shape)?),
                };
                for time in 0..times.unwrap_or(1) {
                    let mut path = path.clone();
                    path.extend(times.map(|_| (time + 1).to_string()));
                    size = size.checked_add(add(
                        field.get(1)?,
                        &path,
                        offset.checked_add(size)?,
                        found,
                    )?)?;
                    if found.len() > MOST_FIELDS {
                        return None;
                    }
                }
            }
            Some(size)
        }
        _ => None,
    }
}

/// Number of elements of an array within an element.
fn product(shape: &Literal) -> Option<u64> {
    match shape {
        Literal::Whole(count) => Some(*count),
        Literal::Items(items) => items.iter().try_fold(1_u64, |all, item| match item {
            Literal::Whole(count) => all.checked_mul(*count),
            _ => None,
        }),
        _ => None,
    }
    .filter(|count| *count <= MOST_FIELDS as u64)
}

fn add_plain(text: &str, path: &[String], offset: u64, found: &mut Vec<Field>) -> Option<u64> {
    let order = text.chars().next()?;
    let rest = text.strip_prefix(['<', '>', '|', '='])?;
    let kind = rest.chars().next().filter(char::is_ascii)?;
    let digits = rest[1..].split('[').next()?;
    let count: u64 = digits.parse().ok()?;
    use Number::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    let (number, size, complex) = match (kind, count) {
        ('b' | 'u', 1) => (Ok(U8), 1, false),
        ('i', 1) => (Ok(I8), 1, false),
        ('i', 2) => (Ok(I16), 2, false),
        ('i', 4) => (Ok(I32), 4, false),
        ('i', 8) => (Ok(I64), 8, false),
        ('u', 2) => (Ok(U16), 2, false),
        ('u', 4) => (Ok(U32), 4, false),
        ('u', 8) => (Ok(U64), 8, false),
        ('f', 4) => (Ok(F32), 4, false),
        ('f', 8) => (Ok(F64), 8, false),
        ('c', 8) => (Ok(F32), 8, true),
        ('c', 16) => (Ok(F64), 16, true),
        ('f' | 'c', size) => (
            Err("its numbers are of an unusual size; save them as float64"),
            size,
            false,
        ),
        ('U', length) => (Err("it holds text"), length.checked_mul(4)?, false),
        ('S' | 'a', length) => (Err("it holds text"), length, false),
        ('M' | 'm', size) => (
            Err("it holds dates or times; save them as seconds"),
            size,
            false,
        ),
        // Fill bytes have no name.
        ('V', size) if path.last().is_none_or(String::is_empty) => return Some(size),
        ('V', size) => (Err("it holds raw bytes"), size, false),
        _ => return None,
    };
    let parts: &[&'static str] = if complex {
        &[" (real)", " (imaginary)"]
    } else {
        &[""]
    };
    for (place, part) in (0..).zip(parts) {
        found.push(Field {
            path: path.to_vec(),
            part,
            written: text.to_owned(),
            offset: offset.checked_add(place * size / 2)?,
            number: number.map(|number| (number, order == '>')),
        });
    }
    Some(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Literal {
        Literal::Text(text.to_owned())
    }

    #[test]
    fn closed_form_fields_and_sizes() {
        let (found, size) = fields(&text(">c16")).unwrap();
        assert_eq!((found.len(), size, found[1].offset), (2, 16, 8));
        assert_eq!(found[1].number, Ok((Number::F64, true)));
        let field = |parts: Vec<Literal>| Literal::Items(parts);
        let shape = Literal::Items(vec![Literal::Whole(2)]);
        let record = Literal::Items(vec![
            field(vec![text("t"), text("<f8")]),
            field(vec![text(""), text("|V4")]),
            field(vec![text("F"), text("<i2"), shape]),
            field(vec![text("name"), text("<U3")]),
        ]);
        let (found, size) = fields(&record).unwrap();
        let seen: Vec<(String, u64, bool)> = found
            .iter()
            .map(|field| (field.path.join("/"), field.offset, field.number.is_ok()))
            .collect();
        let expected = [
            ("t", 0, true),
            ("F/1", 12, true),
            ("F/2", 14, true),
            ("name", 16, false),
        ];
        let expected = expected.map(|(name, offset, read)| (name.to_owned(), offset, read));
        assert_eq!((seen, size), (expected.to_vec(), 28));
        for broken in ["", "f8", "<x8", "<f", "|O", "<ü8"] {
            assert_eq!(fields(&text(broken)), None, "{broken}");
        }
    }
}
