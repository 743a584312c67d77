//! Decodes elements of datasets to numbers.

use crate::hdf5::value_type::{Datatype, Kind, Member};
use crate::number::{self, Layout, integer};

/// Most numbers per element.
const MOST_PARTS: usize = 4096;

/// A number within an element.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    /// Path within the element; empty if the element is a number.
    pub path: Vec<String>,
    /// Suffix of the name, such as " (real)".
    pub suffix: &'static str,
    /// Description of the storage type.
    pub stored_as: String,
    /// Position and storage type.
    pub number: Number,
}

/// Position and storage type of a number within an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    /// Offset in bytes.
    pub offset: usize,
    /// Size in bytes.
    pub size: usize,
    form: Form,
    big_endian: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Signed,
    Unsigned,
    Float,
}

/// Non-numeric parts of an element: path and reason.
pub(crate) type LeftOut = Vec<(Vec<String>, &'static str)>;

/// The numbers in an element of a type, and its other parts.
pub(crate) fn parts(datatype: &Datatype) -> (Vec<Part>, LeftOut) {
    let (mut found, mut left_out) = (Vec::new(), Vec::new());
    add_parts(datatype, 0, &[], &mut found, &mut left_out);
    if found.len() + left_out.len() > MOST_PARTS {
        return (
            Vec::new(),
            vec![(Vec::new(), "its elements have more than 4096 members")],
        );
    }
    (found, left_out)
}

fn add_parts(
    datatype: &Datatype,
    offset: usize,
    path: &[String],
    found: &mut Vec<Part>,
    left_out: &mut LeftOut,
) {
    let below = |name: String| [path, &[name]].concat();
    if found.len() + left_out.len() > MOST_PARTS {
        return;
    }
    match &datatype.kind {
        Kind::Compound(members) => {
            let complex = complex_suffixes(members);
            for (i, member) in members.iter().enumerate() {
                let place = offset + member.offset;
                match complex {
                    Some(suffixes) => {
                        let before = found.len();
                        add_parts(&member.datatype, place, path, found, left_out);
                        for part in &mut found[before..] {
                            part.suffix = suffixes[i];
                        }
                    }
                    None => {
                        let path = below(member.name.clone());
                        add_parts(&member.datatype, place, &path, found, left_out);
                    }
                }
            }
        }
        Kind::Array { base, count } => {
            for i in 0..(*count).min(MOST_PARTS as u64 + 1) as usize {
                let path = below((i + 1).to_string());
                add_parts(base, offset + i * base.size, &path, found, left_out);
            }
        }
        kind => match number(datatype, offset) {
            Some(number) => found.push(Part {
                path: path.to_vec(),
                suffix: "",
                stored_as: describe(number, kind),
                number,
            }),
            None => left_out.push((path.to_vec(), reason(kind))),
        },
    }
}

/// Suffixes of the two members of a complex number.
fn complex_suffixes(members: &[Member]) -> Option<[&'static str; 2]> {
    let [real, imaginary] = members else {
        return None;
    };
    let named = [("real", "imag"), ("r", "i"), ("re", "im")]
        .contains(&(real.name.as_str(), imaginary.name.as_str()));
    let numbers = number(&real.datatype, 0).is_some() && number(&imaginary.datatype, 0).is_some();
    (named && numbers).then_some([" (real)", " (imaginary)"])
}

/// Why a type is not a number.
fn reason(kind: &Kind) -> &'static str {
    match kind {
        Kind::Text | Kind::HeapText => "it is text",
        Kind::Reference => "it holds references to other objects",
        Kind::Other(why) => why,
        _ => "it is not a number",
    }
}

/// The number of a scalar type at an offset.
fn number(datatype: &Datatype, offset: usize) -> Option<Number> {
    let of = |form, big_endian| {
        Some(Number {
            offset,
            size: datatype.size,
            form,
            big_endian,
        })
    };
    match &datatype.kind {
        Kind::Integer {
            signed: true,
            big_endian,
        } => of(Form::Signed, *big_endian),
        Kind::Integer { big_endian, .. } => of(Form::Unsigned, *big_endian),
        Kind::Float { big_endian } => of(Form::Float, *big_endian),
        Kind::Enumeration(base) => number(base, offset),
        _ => None,
    }
}

fn describe(number: Number, kind: &Kind) -> String {
    let form = match (number.form, kind) {
        (_, Kind::Enumeration(_)) => "integer with names",
        (Form::Signed, _) => "integer",
        (Form::Unsigned, _) => "integer without sign",
        (Form::Float, _) => "float",
    };
    let order = if number.big_endian && number.size > 1 {
        ", big-endian"
    } else {
        ""
    };
    format!("{}-bit {form}{order}", 8 * number.size)
}

/// The number in an element of scalar type.
pub(crate) fn number_of(bytes: &[u8], datatype: &Datatype) -> Option<f64> {
    decode_one(bytes, number(datatype, 0)?)
}

/// Appends the number from each element of `bytes`.
pub(crate) fn decode(bytes: &[u8], element: usize, number: Number, numbers: &mut Vec<f64>) {
    let elements = bytes.chunks_exact(element);
    let Some(kind) = number.usual().filter(|_| elements.len() > 0) else {
        numbers
            .extend(elements.filter_map(|bytes| decode_one(bytes.get(number.offset..)?, number)));
        return;
    };
    let layout = Layout {
        offset: number.offset,
        stride: element,
        big_endian: number.big_endian,
    };
    let from = numbers.len();
    numbers.resize(from + elements.len(), 0.0);
    kind.decode(bytes, layout, &mut numbers[from..]);
}

impl Number {
    /// The corresponding native type, if any.
    fn usual(self) -> Option<number::Number> {
        use number::Number::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
        let [signed, unsigned] = match self.size {
            1 => [I8, U8],
            2 => [I16, U16],
            4 => [I32, U32],
            8 => [I64, U64],
            _ => return None,
        };
        match (self.form, self.size) {
            (Form::Signed, _) => Some(signed),
            (Form::Unsigned, _) => Some(unsigned),
            (Form::Float, 4) => Some(F32),
            (Form::Float, 8) => Some(F64),
            (Form::Float, _) => None,
        }
    }
}

fn decode_one(bytes: &[u8], number: Number) -> Option<f64> {
    let word = integer(bytes.get(..number.size)?, number.big_endian);
    Some(match (number.form, number.size) {
        (Form::Unsigned, _) => word as f64,
        (Form::Signed, size) => {
            let unused = 64 - 8 * size as u32;
            ((word << unused) as i64 >> unused) as f64
        }
        (Form::Float, 2) => half(word as u16),
        (Form::Float, 4) => f64::from(f32::from_bits(word as u32)),
        (Form::Float, _) => f64::from_bits(word),
    })
}

/// IEEE 754-2008 binary16.
fn half(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let fraction = f64::from(bits & 0x3ff);
    sign * match bits >> 10 & 0x1f {
        0 => fraction * 2_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * 2_f64.powi(i32::from(exponent) - 25),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_half_floats() {
        // IEEE 754-2008, binary16: one, the largest, the smallest, minus two.
        let cases = [
            (0x3c00, 1.0),
            (0x7bff, 65504.0),
            (1, 2_f64.powi(-24)),
            (0xc000, -2.0),
        ];
        for (bits, value) in cases {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan());
        assert_eq!(half(0xfc00), f64::NEG_INFINITY);
    }

    #[test]
    fn closed_form_integers_of_three_bytes() {
        let number = |big_endian| Number {
            offset: 1,
            size: 3,
            form: Form::Signed,
            big_endian,
        };
        let mut found = Vec::new();
        decode(
            &[9, 0xfe, 0xff, 0xff, 9, 0, 1, 0],
            4,
            number(false),
            &mut found,
        );
        decode(
            &[9, 0xfe, 0xff, 0xff, 9, 0, 1, 0, 9],
            4,
            number(true),
            &mut found,
        );
        assert_eq!(found, [-2.0, 256.0, -65537.0, 256.0]);
    }
}
