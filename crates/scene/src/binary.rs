//! Values as bytes and back, to the last bit: little-endian, one after the other, lists
//! behind their length.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Read, Result, Write};

/// A value that goes into bytes and comes back with the same bits.
pub trait Binary: Sized {
    /// Writes the value.
    fn write(&self, to: &mut dyn Write) -> Result<()>;

    /// Reads a value that [`Binary::write`] wrote.
    ///
    /// # Errors
    /// Those of the reader; bytes that are no such value.
    fn read(from: &mut dyn Read) -> Result<Self>;
}

/// Bytes that are no such value.
pub fn no_value(what: &str) -> Error {
    Error::new(ErrorKind::InvalidData, format!("no {what}"))
}

macro_rules! numbers {
    ($($number:ty)*) => {
        $(impl Binary for $number {
            fn write(&self, to: &mut dyn Write) -> Result<()> {
                to.write_all(&self.to_le_bytes())
            }

            fn read(from: &mut dyn Read) -> Result<Self> {
                let mut bytes = [0; size_of::<$number>()];
                from.read_exact(&mut bytes)?;
                Ok(Self::from_le_bytes(bytes))
            }
        })*
    };
}

numbers! { u8 u32 u64 f32 f64 }

impl Binary for usize {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        (*self as u64).write(to)
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        Self::try_from(u64::read(from)?).map_err(|_| no_value("number of this machine"))
    }
}

impl Binary for bool {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        u8::from(*self).write(to)
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        match u8::read(from)? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(no_value("truth value")),
        }
    }
}

impl<T: Binary + Copy + Default, const N: usize> Binary for [T; N] {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.iter().try_for_each(|own| own.write(to))
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        let mut all = [T::default(); N];
        for own in &mut all {
            *own = T::read(from)?;
        }
        Ok(all)
    }
}

impl<T: Binary> Binary for Vec<T> {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.len().write(to)?;
        self.iter().try_for_each(|own| own.write(to))
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        // A corrupt length hits the end of the bytes before it allocates much.
        (0..usize::read(from)?).map(|_| T::read(from)).collect()
    }
}

impl<K: Binary + Ord, V: Binary> Binary for BTreeMap<K, V> {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.len().write(to)?;
        self.iter().try_for_each(|(key, value)| {
            key.write(to)?;
            value.write(to)
        })
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        Vec::<(K, V)>::read(from).map(|all| all.into_iter().collect())
    }
}

impl<A: Binary, B: Binary> Binary for (A, B) {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.0.write(to)?;
        self.1.write(to)
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        Ok((A::read(from)?, B::read(from)?))
    }
}

impl<T: Binary> Binary for Option<T> {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.is_some().write(to)?;
        self.iter().try_for_each(|own| own.write(to))
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        bool::read(from)?.then(|| T::read(from)).transpose()
    }
}

impl Binary for String {
    fn write(&self, to: &mut dyn Write) -> Result<()> {
        self.len().write(to)?;
        to.write_all(self.as_bytes())
    }

    fn read(from: &mut dyn Read) -> Result<Self> {
        Self::from_utf8(Vec::read(from)?).map_err(|_| no_value("text"))
    }
}

/// [`Binary`] of a struct: its fields one after the other. All of them must be named.
#[macro_export]
macro_rules! binary {
    ($type:ty { $($field:ident),* $(,)? }) => {
        impl $crate::binary::Binary for $type {
            fn write(&self, to: &mut dyn std::io::Write) -> std::io::Result<()> {
                $($crate::binary::Binary::write(&self.$field, to)?;)*
                Ok(())
            }

            fn read(from: &mut dyn std::io::Read) -> std::io::Result<Self> {
                Ok(Self { $($field: $crate::binary::Binary::read(from)?),* })
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn there_and_back<T: Binary>(value: &T) -> (Vec<u8>, T) {
        let mut bytes = Vec::new();
        value.write(&mut bytes).unwrap();
        let back = T::read(&mut &bytes[..]).unwrap();
        (bytes, back)
    }

    #[test]
    fn every_bit_comes_back() {
        let numbers = [0.1, -0.0, f64::MIN_POSITIVE / 3.0, f64::INFINITY, f64::NAN];
        let (bytes, back) = there_and_back(&numbers);
        assert_eq!(bytes.len(), 40);
        assert_eq!(back.map(f64::to_bits), numbers.map(f64::to_bits));
        let map = BTreeMap::from([(3_u32, Some("apple".to_owned())), (9, None)]);
        assert_eq!(there_and_back(&map).1, map);
        assert_eq!(there_and_back(&vec![(true, 1.5_f32)]).1, [(true, 1.5)]);
    }

    #[test]
    fn rejects_bytes_that_are_no_value() {
        // A length beyond every memory.
        let bytes = [255; 12];
        assert!(Vec::<f64>::read(&mut &bytes[..]).is_err());
        assert!(String::read(&mut &bytes[..]).is_err());
        assert!(bool::read(&mut &bytes[..]).is_err());
        assert!(u64::read(&mut &bytes[..7]).is_err());
    }
}
