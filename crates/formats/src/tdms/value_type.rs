//! TDMS value types and their conversion to doubles.

use crate::number::{self, Number, integer};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueType {
    Number(Number),
    Bool,
    /// Seconds since 1904, and a fraction in 2⁻⁶⁴ s.
    Timestamp,
    // Values of the remaining types are not read.
    /// 80-bit float in 16 bytes.
    Extended,
    Text,
    /// Two 32-bit floats.
    Complex64,
    /// Two 64-bit floats.
    Complex128,
    /// NI-DAQmx raw data.
    Daqmx,
}

impl ValueType {
    /// Type for a code in an index or property.
    pub fn of_code(code: u32) -> Option<Self> {
        Some(match code {
            1 => Self::Number(Number::I8),
            2 => Self::Number(Number::I16),
            3 => Self::Number(Number::I32),
            4 => Self::Number(Number::I64),
            5 => Self::Number(Number::U8),
            6 => Self::Number(Number::U16),
            7 => Self::Number(Number::U32),
            8 => Self::Number(Number::U64),
            9 | 0x19 => Self::Number(Number::F32),
            10 | 0x1a => Self::Number(Number::F64),
            11 | 0x1b => Self::Extended,
            0x20 => Self::Text,
            0x21 => Self::Bool,
            0x44 => Self::Timestamp,
            0x0008_000c => Self::Complex64,
            0x0010_000d => Self::Complex128,
            0xffff_ffff => Self::Daqmx,
            _ => return None,
        })
    }

    /// Type for a code in an NI-DAQmx scaler.
    pub fn of_scaler_code(code: u32) -> Option<Self> {
        use Number::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
        let types = [U8, I8, U16, I16, U32, I32, U64, I64, F32, F64];
        types.get(code as usize).copied().map(Self::Number)
    }

    /// Bytes per value; 0 if variable.
    pub fn size(self) -> u64 {
        match self {
            Self::Number(number) => number.size(),
            Self::Bool => 1,
            Self::Complex64 => 8,
            Self::Extended | Self::Timestamp | Self::Complex128 => 16,
            Self::Text | Self::Daqmx => 0,
        }
    }

    /// Name for display.
    pub fn name(self) -> &'static str {
        match self {
            Self::Number(number) => match number {
                Number::I8 => "8-bit integer",
                Number::I16 => "16-bit integer",
                Number::I32 => "32-bit integer",
                Number::I64 => "64-bit integer",
                Number::U8 => "8-bit unsigned integer",
                Number::U16 => "16-bit unsigned integer",
                Number::U32 => "32-bit unsigned integer",
                Number::U64 => "64-bit unsigned integer",
                Number::F32 => "32-bit float",
                Number::F64 => "64-bit float",
            },
            Self::Extended => "80-bit float",
            Self::Bool => "boolean",
            Self::Text => "text",
            Self::Timestamp => "timestamp",
            Self::Complex64 | Self::Complex128 => "complex number",
            Self::Daqmx => "DAQmx raw data",
        }
    }

    /// Whether values convert to doubles.
    pub fn is_number(self) -> bool {
        matches!(self, Self::Number(_) | Self::Bool | Self::Timestamp)
    }
}

/// Position and type of values in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    pub value: ValueType,
    pub place: number::Layout,
    /// Bit of a digital line.
    pub bit: Option<u8>,
}

/// Fills `out`; `bytes` must hold enough values.
///
/// * `zero`: second subtracted from timestamps
pub fn decode(bytes: &[u8], layout: Layout, zero: i64, out: &mut [f64]) {
    let place = layout.place;
    match layout.value {
        ValueType::Number(number) => number.decode(bytes, place, out),
        ValueType::Bool => Number::U8.decode(bytes, place, out),
        ValueType::Timestamp => {
            let rows = bytes[place.offset..].chunks(place.stride);
            for (out, row) in out.iter_mut().zip(rows) {
                let (seconds, fraction) = timestamp(row, place.big_endian);
                *out = seconds.wrapping_sub(zero) as f64 + fraction;
            }
        }
        _ => out.fill(f64::NAN),
    }
    if let Some(bit) = layout.bit {
        for value in out {
            *value = f64::from(u8::from((*value as u64 >> bit) & 1 == 1));
        }
    }
}

/// Seconds since 1904, and the fraction of a second.
pub fn timestamp(bytes: &[u8], big_endian: bool) -> (i64, f64) {
    let (first, second) = (&bytes[..8], &bytes[8..16]);
    let (seconds, fraction) = match big_endian {
        true => (first, second),
        false => (second, first),
    };
    let fraction = integer(fraction, big_endian) as f64 / 2_f64.powi(64);
    (integer(seconds, big_endian) as i64, fraction)
}
