//! Numbers as MAT files store them.

/// How one number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MatNumber {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Single,
    Double,
}

impl MatNumber {
    /// Bytes of one.
    pub fn size(self) -> u64 {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Single => 4,
            Self::Int64 | Self::Uint64 | Self::Double => 8,
        }
    }

    /// The name that MATLAB has for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Int8 => "int8",
            Self::Uint8 => "uint8",
            Self::Int16 => "int16",
            Self::Uint16 => "uint16",
            Self::Int32 => "int32",
            Self::Uint32 => "uint32",
            Self::Int64 => "int64",
            Self::Uint64 => "uint64",
            Self::Single => "single",
            Self::Double => "double",
        }
    }

    /// By the type of a data element of version 5.
    pub fn of_element(kind: u32) -> Option<Self> {
        Some(match kind {
            1 => Self::Int8,
            2 => Self::Uint8,
            3 => Self::Int16,
            4 => Self::Uint16,
            5 => Self::Int32,
            6 => Self::Uint32,
            7 => Self::Single,
            9 => Self::Double,
            12 => Self::Int64,
            13 => Self::Uint64,
            _ => return None,
        })
    }

    /// By the class of an array of version 5.
    pub fn of_class(class: u8) -> Option<Self> {
        Some(match class {
            6 => Self::Double,
            7 => Self::Single,
            8 => Self::Int8,
            9 => Self::Uint8,
            10 => Self::Int16,
            11 => Self::Uint16,
            12 => Self::Int32,
            13 => Self::Uint32,
            14 => Self::Int64,
            15 => Self::Uint64,
            _ => return None,
        })
    }

    /// By the digit P of the type of version 4.
    pub fn of_version_4(digit: u32) -> Option<Self> {
        Some(match digit {
            0 => Self::Double,
            1 => Self::Single,
            2 => Self::Int32,
            3 => Self::Int16,
            4 => Self::Uint16,
            5 => Self::Uint8,
            _ => return None,
        })
    }

    /// Appends the numbers in `bytes`.
    pub fn decode(self, bytes: &[u8], big_endian: bool, numbers: &mut Vec<f64>) {
        macro_rules! each {
            ($kind:ty, $size:literal) => {
                numbers.extend(bytes.as_chunks::<$size>().0.iter().map(|b| {
                    if big_endian {
                        <$kind>::from_be_bytes(*b) as f64
                    } else {
                        <$kind>::from_le_bytes(*b) as f64
                    }
                }))
            };
        }
        match self {
            Self::Int8 => each!(i8, 1),
            Self::Uint8 => each!(u8, 1),
            Self::Int16 => each!(i16, 2),
            Self::Uint16 => each!(u16, 2),
            Self::Int32 => each!(i32, 4),
            Self::Uint32 => each!(u32, 4),
            Self::Int64 => each!(i64, 8),
            Self::Uint64 => each!(u64, 8),
            Self::Single => each!(f32, 4),
            Self::Double => each!(f64, 8),
        }
    }
}
