//! Number types of MAT files.

use crate::number::Number;

/// MATLAB's name of a number type.
pub(crate) fn name_of(number: Number) -> &'static str {
    match number {
        Number::I8 => "int8",
        Number::U8 => "uint8",
        Number::I16 => "int16",
        Number::U16 => "uint16",
        Number::I32 => "int32",
        Number::U32 => "uint32",
        Number::I64 => "int64",
        Number::U64 => "uint64",
        Number::F32 => "single",
        Number::F64 => "double",
    }
}

/// Number type of a version 5 data element.
pub(crate) fn of_element(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

/// Number type of a version 5 array class.
pub(crate) fn of_class(class: u8) -> Option<Number> {
    use Number::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    let classes = [F64, F32, I8, U8, I16, U16, I32, U32, I64, U64];
    classes.get(usize::from(class.checked_sub(6)?)).copied()
}

/// Number type by the digit P of version 4.
pub(crate) fn of_version_4(digit: u32) -> Option<Number> {
    use Number::{F32, F64, I16, I32, U8, U16};
    let digits = [F64, F32, I32, I16, U16, U8];
    digits.get(digit as usize).copied()
}
