//! Numbers in binary files.

/// Decodes an integer of up to eight bytes.
pub(crate) fn integer(bytes: &[u8], big_endian: bool) -> u64 {
    let join = |value: u64, byte: &u8| (value << 8) | u64::from(*byte);
    match big_endian {
        true => bytes.iter().fold(0, join),
        false => bytes.iter().rev().fold(0, join),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

/// Position of numbers in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Bytes before the first.
    pub offset: usize,
    /// Bytes from one number to the next.
    pub stride: usize,
    pub big_endian: bool,
}

impl Number {
    /// Size in bytes.
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    pub fn packed(self, big_endian: bool) -> Layout {
        Layout {
            offset: 0,
            stride: self.size() as usize,
            big_endian,
        }
    }

    pub fn decode_all(self, bytes: &[u8], big_endian: bool) -> Vec<f64> {
        let mut numbers = vec![0.0; bytes.len() / self.size() as usize];
        self.decode(bytes, self.packed(big_endian), &mut numbers);
        numbers
    }

    /// Fills `out`; `bytes` must hold enough numbers.
    pub fn decode(self, bytes: &[u8], layout: Layout, out: &mut [f64]) {
        let bytes = &bytes[layout.offset..];
        macro_rules! numbers {
            ($type:ty) => {{
                const SIZE: usize = size_of::<$type>();
                let packed = bytes.as_chunks::<SIZE>().0.iter().copied();
                let rows = bytes.chunks(layout.stride);
                let rows = rows.map(|row| *row.first_chunk::<SIZE>().unwrap_or(&[0; SIZE]));
                let (little, big) = (<$type>::from_le_bytes, <$type>::from_be_bytes);
                // Separate loops, so that each one is vectorised.
                match (layout.stride == SIZE, layout.big_endian) {
                    (true, false) => fill(out, packed.map(|value| little(value) as f64)),
                    (true, true) => fill(out, packed.map(|value| big(value) as f64)),
                    (false, false) => fill(out, rows.map(|value| little(value) as f64)),
                    (false, true) => fill(out, rows.map(|value| big(value) as f64)),
                }
            }};
        }
        match self {
            Self::I8 => numbers!(i8),
            Self::I16 => numbers!(i16),
            Self::I32 => numbers!(i32),
            Self::I64 => numbers!(i64),
            Self::U8 => numbers!(u8),
            Self::U16 => numbers!(u16),
            Self::U32 => numbers!(u32),
            Self::U64 => numbers!(u64),
            Self::F32 => numbers!(f32),
            Self::F64 => numbers!(f64),
        }
    }
}

fn fill(out: &mut [f64], values: impl Iterator<Item = f64>) {
    out.iter_mut()
        .zip(values)
        .for_each(|(out, value)| *out = value);
}
