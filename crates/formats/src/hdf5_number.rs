//! Elements of HDF5 datasets → numbers.

use hdf5_reader::error::{ByteOrder, Error as Fault};
use hdf5_reader::{Datatype, H5Type};

/// Most numbers in one element.
const MOST_PARTS: usize = 4096;

/// Deepest nesting of compounds.
const DEEPEST: usize = 8;

/// Why a type is left out as a whole.
const TOO_MANY: &str = "its elements have more than 4096 members, or are nested too deep";

/// One number in an element.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    /// Names from the element to it; empty for an element that is a number.
    pub path: Vec<String>,
    /// What is appended to the name: " (real)".
    pub suffix: &'static str,
    /// How it is stored, in a few words.
    pub stored_as: String,
}

/// The numbers in an element of a type, in order; those parts that are none go
/// to `left_out` with the reason.
pub(crate) fn parts(kind: &Datatype, left_out: &mut Vec<(Vec<String>, &'static str)>) -> Vec<Part> {
    let mut found = Vec::new();
    add_parts(kind, &[], &mut found, left_out);
    if left_out.iter().any(|(_, why)| *why == TOO_MANY) {
        left_out.clear();
        left_out.push((Vec::new(), TOO_MANY));
        found.clear();
    }
    found
}

fn add_parts(
    kind: &Datatype,
    path: &[String],
    found: &mut Vec<Part>,
    left_out: &mut Vec<(Vec<String>, &'static str)>,
) {
    let below = |name: &str| {
        let mut path = path.to_vec();
        path.push(name.to_owned());
        path
    };
    if found.len() > MOST_PARTS || path.len() > DEEPEST {
        return left_out.push((path.to_vec(), TOO_MANY));
    }
    match kind {
        Datatype::Compound { fields, .. } => match complex_suffixes(kind) {
            Some(suffixes) => {
                for (field, suffix) in fields.iter().zip(suffixes) {
                    found.push(Part {
                        path: path.to_vec(),
                        suffix,
                        stored_as: format!("complex of {}", describe(&field.datatype)),
                    });
                }
            }
            None => {
                for field in fields {
                    add_parts(&field.datatype, &below(&field.name), found, left_out);
                }
            }
        },
        Datatype::Array { base, dims } => {
            let count = dims.iter().try_fold(1_u64, |n, d| n.checked_mul(*d));
            match count {
                Some(count) if count <= MOST_PARTS as u64 => {
                    for i in 0..count {
                        add_parts(base, &below(&(i + 1).to_string()), found, left_out);
                    }
                }
                _ => left_out.push((path.to_vec(), "it is a member of more than 4096 numbers")),
            }
        }
        kind => match number_kind(kind) {
            Some(_) => found.push(Part {
                path: path.to_vec(),
                suffix: "",
                stored_as: describe(kind),
            }),
            None => left_out.push((path.to_vec(), reason(kind))),
        },
    }
}

/// The suffixes of the two members of a complex number.
fn complex_suffixes(kind: &Datatype) -> Option<[&'static str; 2]> {
    let Datatype::Compound { fields, .. } = kind else {
        return None;
    };
    let [real, imaginary] = &fields[..] else {
        return None;
    };
    let named = [("real", "imag"), ("r", "i"), ("re", "im")]
        .contains(&(real.name.as_str(), imaginary.name.as_str()));
    let numbers =
        number_kind(&real.datatype).is_some() && number_kind(&imaginary.datatype).is_some();
    (named && numbers).then_some([" (real)", " (imaginary)"])
}

/// Why a type is no number.
fn reason(kind: &Datatype) -> &'static str {
    match kind {
        Datatype::String { .. } | Datatype::VarLen { .. } => {
            "it is text or of varying length, not numbers"
        }
        Datatype::Reference { .. } => "it holds references to other things",
        Datatype::Opaque { .. } => "its type is known only to the program that wrote it",
        Datatype::FloatingPoint { .. } => "windfall reads floats of 16, 32 and 64 bits only",
        _ => "its type is not one of numbers",
    }
}

/// How one number is stored.
#[derive(Clone, Copy, Debug)]
enum NumberKind {
    Integer { size: usize, signed: bool },
    Float { size: usize },
}

fn number_kind(kind: &Datatype) -> Option<(NumberKind, bool)> {
    let big = |order: &ByteOrder| *order == ByteOrder::BigEndian;
    match kind {
        Datatype::FixedPoint {
            size,
            signed,
            byte_order,
        } if (1..=8).contains(size) => {
            let kind = NumberKind::Integer {
                size: usize::from(*size),
                signed: *signed,
            };
            Some((kind, big(byte_order)))
        }
        Datatype::Bitfield { size, byte_order } if (1..=8).contains(size) => {
            let kind = NumberKind::Integer {
                size: usize::from(*size),
                signed: false,
            };
            Some((kind, big(byte_order)))
        }
        Datatype::FloatingPoint { size, byte_order } if [2, 4, 8].contains(size) => {
            let size = usize::from(*size);
            Some((NumberKind::Float { size }, big(byte_order)))
        }
        Datatype::Enum { base, .. } if !matches!(**base, Datatype::Enum { .. }) => {
            number_kind(base)
        }
        _ => None,
    }
}

fn describe(kind: &Datatype) -> String {
    let Some((number, big_endian)) = number_kind(kind) else {
        return String::new();
    };
    let order = if big_endian { ", big-endian" } else { "" };
    let named = match kind {
        Datatype::Enum { .. } => " with names",
        _ => "",
    };
    match number {
        NumberKind::Integer { size, signed } => {
            let sign = if signed { "" } else { " without sign" };
            format!("{}-bit integer{sign}{named}{order}", 8 * size)
        }
        NumberKind::Float { size } => format!("{}-bit float{order}", 8 * size),
    }
}

/// Bytes of an element of a type, as they stand in a dataset.
pub(crate) fn size_of(kind: &Datatype) -> usize {
    match kind {
        Datatype::FixedPoint { size, .. }
        | Datatype::FloatingPoint { size, .. }
        | Datatype::Reference { size, .. }
        | Datatype::Bitfield { size, .. } => usize::from(*size),
        Datatype::Compound { size, .. } | Datatype::Opaque { size, .. } => *size as usize,
        Datatype::Array { base, dims } => dims.iter().fold(size_of(base), |n, d| {
            n.saturating_mul(usize::try_from(*d).unwrap_or(usize::MAX))
        }),
        Datatype::Enum { base, .. } => size_of(base),
        Datatype::String { size, .. } => match size {
            hdf5_reader::StringSize::Fixed(size) => *size as usize,
            // Of a reference into the heap.
            hdf5_reader::StringSize::Variable => 16,
        },
        Datatype::VarLen { .. } => 16,
    }
}

/// One number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Number(pub f64);

/// The numbers of one element, in the order of [`parts`].
#[derive(Clone, Debug)]
pub(crate) struct Numbers(pub Vec<f64>);

impl H5Type for Number {
    fn hdf5_type() -> Datatype {
        f64::hdf5_type()
    }

    fn from_bytes(bytes: &[u8], kind: &Datatype) -> Result<Self, Fault> {
        let mut numbers = Vec::with_capacity(1);
        decode_element(bytes, kind, &mut numbers)?;
        numbers.first().copied().map(Self).ok_or_else(too_short)
    }

    fn element_size(kind: &Datatype) -> usize {
        size_of(kind)
    }

    fn decode_vec(raw: &[u8], kind: &Datatype, count: usize) -> Option<Result<Vec<Self>, Fault>> {
        let size = size_of(kind);
        let raw = raw.get(..count.checked_mul(size)?)?;
        macro_rules! each {
            ($kind:ty, $size:literal, $from:ident) => {{
                let numbers = raw.as_chunks::<$size>().0.iter();
                Some(Ok(numbers
                    .map(|b| Self(<$kind>::$from(*b) as f64))
                    .collect()))
            }};
        }
        use NumberKind::{Float, Integer};
        match number_kind(kind)? {
            (Float { size: 8 }, false) => each!(f64, 8, from_le_bytes),
            (Float { size: 8 }, true) => each!(f64, 8, from_be_bytes),
            (Float { size: 4 }, false) => each!(f32, 4, from_le_bytes),
            (Float { size: 4 }, true) => each!(f32, 4, from_be_bytes),
            (Integer { size: 2, signed }, false) if signed => each!(i16, 2, from_le_bytes),
            (Integer { size: 4, signed }, false) if signed => each!(i32, 4, from_le_bytes),
            _ => None,
        }
    }
}

impl H5Type for Numbers {
    fn hdf5_type() -> Datatype {
        f64::hdf5_type()
    }

    fn from_bytes(bytes: &[u8], kind: &Datatype) -> Result<Self, Fault> {
        let mut numbers = Vec::new();
        decode_element(bytes, kind, &mut numbers)?;
        Ok(Self(numbers))
    }

    fn element_size(kind: &Datatype) -> usize {
        size_of(kind)
    }
}

fn too_short() -> Fault {
    Fault::InvalidData("an element is shorter than its type".to_owned())
}

/// Appends the numbers of an element.
fn decode_element(bytes: &[u8], kind: &Datatype, numbers: &mut Vec<f64>) -> Result<(), Fault> {
    match kind {
        Datatype::Compound { fields, .. } => {
            for field in fields {
                let part = bytes
                    .get(field.byte_offset as usize..)
                    .ok_or_else(too_short)?;
                decode_element(part, &field.datatype, numbers)?;
            }
            Ok(())
        }
        Datatype::Array { base, dims } => {
            let size = size_of(base);
            let count = dims.iter().product::<u64>();
            if count > MOST_PARTS as u64 {
                return Ok(());
            }
            for i in 0..count as usize {
                let part = bytes.get(i * size..).ok_or_else(too_short)?;
                decode_element(part, base, numbers)?;
            }
            Ok(())
        }
        kind => {
            if let Some((number, big_endian)) = number_kind(kind) {
                numbers.push(decode_number(bytes, number, big_endian).ok_or_else(too_short)?);
            }
            Ok(())
        }
    }
}

/// The number in an element whose type is one.
pub(crate) fn number_of(bytes: &[u8], kind: &Datatype) -> Option<f64> {
    let (number, big_endian) = number_kind(kind)?;
    decode_number(bytes, number, big_endian)
}

fn decode_number(bytes: &[u8], kind: NumberKind, big_endian: bool) -> Option<f64> {
    let (NumberKind::Integer { size, .. } | NumberKind::Float { size }) = kind;
    // The bytes in the order of significance, the least first.
    let mut word = [0; 8];
    word[..size].copy_from_slice(bytes.get(..size)?);
    if big_endian {
        word[..size].reverse();
    }
    let word = u64::from_le_bytes(word);
    Some(match kind {
        NumberKind::Integer { signed: false, .. } => word as f64,
        NumberKind::Integer { signed: true, size } => {
            let unused = 64 - 8 * size as u32;
            ((word << unused) as i64 >> unused) as f64
        }
        NumberKind::Float { size: 2 } => half(word as u16),
        NumberKind::Float { size: 4 } => f64::from(f32::from_bits(word as u32)),
        NumberKind::Float { .. } => f64::from_bits(word),
    })
}

/// A float of 16 bits, IEEE 754-2008 binary16.
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
        let kind = NumberKind::Integer {
            size: 3,
            signed: true,
        };
        assert_eq!(decode_number(&[0xfe, 0xff, 0xff], kind, false), Some(-2.0));
        assert_eq!(decode_number(&[0, 1, 0], kind, true), Some(256.0));
        assert_eq!(decode_number(&[0, 1], kind, true), None);
    }
}
