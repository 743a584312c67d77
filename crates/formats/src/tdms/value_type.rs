//! Types of values in TDMS files, and their decoding to doubles.

/// A type of value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueType {
    /// 8-bit integer.
    I8,
    /// 16-bit integer.
    I16,
    /// 32-bit integer.
    I32,
    /// 64-bit integer.
    I64,
    /// 8-bit integer without sign.
    U8,
    /// 16-bit integer without sign.
    U16,
    /// 32-bit integer without sign.
    U32,
    /// 64-bit integer without sign.
    U64,
    /// 32-bit float.
    F32,
    /// 64-bit float.
    F64,
    /// 80-bit float in 16 bytes; its values are not read.
    Extended,
    /// True or false.
    Bool,
    /// Text; its values are not read.
    Text,
    /// Time in seconds since 1904 and 2⁻⁶⁴ s.
    Timestamp,
    /// Two 32-bit floats; its values are not read.
    Complex64,
    /// Two 64-bit floats; its values are not read.
    Complex128,
    /// Raw data of NI-DAQmx.
    Daqmx,
}

impl ValueType {
    /// The type of a code in an index or a property.
    #[must_use]
    pub fn of_code(code: u32) -> Option<Self> {
        Some(match code {
            1 => Self::I8,
            2 => Self::I16,
            3 => Self::I32,
            4 => Self::I64,
            5 => Self::U8,
            6 => Self::U16,
            7 => Self::U32,
            8 => Self::U64,
            9 | 0x19 => Self::F32,
            10 | 0x1a => Self::F64,
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

    /// The type of a code in a scaler of NI-DAQmx.
    #[must_use]
    pub fn of_scaler_code(code: u32) -> Option<Self> {
        const TYPES: [ValueType; 10] = [
            ValueType::U8,
            ValueType::I8,
            ValueType::U16,
            ValueType::I16,
            ValueType::U32,
            ValueType::I32,
            ValueType::U64,
            ValueType::I64,
            ValueType::F32,
            ValueType::F64,
        ];
        TYPES.get(code as usize).copied()
    }

    /// Bytes of a value; 0 where that is not fixed.
    #[must_use]
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 | Self::Bool => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 | Self::Complex64 => 8,
            Self::Extended | Self::Timestamp | Self::Complex128 => 16,
            Self::Text | Self::Daqmx => 0,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::I8 => "8-bit integer",
            Self::I16 => "16-bit integer",
            Self::I32 => "32-bit integer",
            Self::I64 => "64-bit integer",
            Self::U8 => "8-bit unsigned integer",
            Self::U16 => "16-bit unsigned integer",
            Self::U32 => "32-bit unsigned integer",
            Self::U64 => "64-bit unsigned integer",
            Self::F32 => "32-bit float",
            Self::F64 => "64-bit float",
            Self::Extended => "80-bit float",
            Self::Bool => "boolean",
            Self::Text => "text",
            Self::Timestamp => "timestamp",
            Self::Complex64 | Self::Complex128 => "complex number",
            Self::Daqmx => "DAQmx raw data",
        }
    }

    /// Whether its values become doubles.
    #[must_use]
    pub fn is_number(self) -> bool {
        !matches!(
            self,
            Self::Extended | Self::Text | Self::Complex64 | Self::Complex128 | Self::Daqmx
        )
    }
}

/// Where values lie among bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Their type.
    pub value: ValueType,
    /// Bytes before the first.
    pub offset: usize,
    /// Bytes from one to the next.
    pub stride: usize,
    /// The order of bytes.
    pub big_endian: bool,
    /// For a digital line: its bit.
    pub bit: Option<u8>,
}

/// Decodes as many values as `out` takes.
///
/// * `zero`: the second from which timestamps count
///
/// `bytes` must hold them all.
pub fn decode(bytes: &[u8], layout: Layout, zero: i64, out: &mut [f64]) {
    macro_rules! numbers {
        ($type:ty) => {{
            const SIZE: usize = size_of::<$type>();
            // The usual case apart: the compiler then copies whole registers.
            if layout.stride == SIZE && !layout.big_endian {
                let values = bytes[layout.offset..].chunks_exact(SIZE);
                for (out, value) in out.iter_mut().zip(values) {
                    let value: [u8; SIZE] = value.try_into().unwrap_or([0; SIZE]);
                    *out = <$type>::from_le_bytes(value) as f64;
                }
            } else if !layout.big_endian {
                let rows = bytes[layout.offset..].chunks(layout.stride);
                for (out, row) in out.iter_mut().zip(rows) {
                    let value: [u8; SIZE] = row[..SIZE].try_into().unwrap_or([0; SIZE]);
                    *out = <$type>::from_le_bytes(value) as f64;
                }
            } else {
                let rows = bytes[layout.offset..].chunks(layout.stride);
                for (out, row) in out.iter_mut().zip(rows) {
                    let value: [u8; SIZE] = row[..SIZE].try_into().unwrap_or([0; SIZE]);
                    *out = <$type>::from_be_bytes(value) as f64;
                }
            }
        }};
    }
    match layout.value {
        ValueType::I8 => numbers!(i8),
        ValueType::I16 => numbers!(i16),
        ValueType::I32 => numbers!(i32),
        ValueType::I64 => numbers!(i64),
        ValueType::U8 | ValueType::Bool => numbers!(u8),
        ValueType::U16 => numbers!(u16),
        ValueType::U32 => numbers!(u32),
        ValueType::U64 => numbers!(u64),
        ValueType::F32 => numbers!(f32),
        ValueType::F64 => numbers!(f64),
        ValueType::Timestamp => {
            for (out, row) in out
                .iter_mut()
                .zip(bytes[layout.offset..].chunks(layout.stride))
            {
                let (seconds, fraction) = timestamp(row, layout.big_endian);
                *out = seconds.wrapping_sub(zero) as f64 + fraction;
            }
        }
        ValueType::Extended
        | ValueType::Text
        | ValueType::Complex64
        | ValueType::Complex128
        | ValueType::Daqmx => out.fill(f64::NAN),
    }
    if let Some(bit) = layout.bit {
        for value in out {
            *value = f64::from(u8::from((*value as u64 >> bit) & 1 == 1));
        }
    }
}

/// Seconds since 1904 and the part of a second of a timestamp.
#[must_use]
pub fn timestamp(bytes: &[u8], big_endian: bool) -> (i64, f64) {
    let part = |from: usize| {
        let bytes: [u8; 8] = bytes[from..from + 8].try_into().unwrap_or([0; 8]);
        match big_endian {
            true => u64::from_be_bytes(bytes),
            false => u64::from_le_bytes(bytes),
        }
    };
    let (seconds, fraction) = match big_endian {
        true => (part(0), part(8)),
        false => (part(8), part(0)),
    };
    (seconds as i64, fraction as f64 / 2_f64.powi(64))
}
