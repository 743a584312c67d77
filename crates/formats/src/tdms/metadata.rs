//! Metadata of TDMS segments: objects, properties and raw data indexes.
//!
//! # Source
//! National Instruments, "TDMS file format internal structure".

use crate::number::{Number, integer};
use crate::tdms::value_type::{ValueType, timestamp};
use std::collections::BTreeMap;

/// Seconds from 1904 to 1970.
const TO_UNIX: i64 = 2_082_844_800;

/// Most scalers or raw buffers of an NI-DAQmx channel.
const MOST_SCALERS: u32 = 1 << 12;

#[derive(Clone, Debug, PartialEq)]
pub enum Property {
    Number(f64),
    Text(String),
}

impl Property {
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Text(_) => None,
        }
    }

    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Number(_) => None,
            Self::Text(text) => Some(text),
        }
    }
}

/// Raw data of an object in a segment.
#[derive(Clone, Debug, PartialEq)]
pub enum Index {
    /// No raw data.
    Nothing,
    /// Same as in the previous segment.
    Same,
    Values {
        value: ValueType,
        /// Values per chunk.
        count: u64,
        /// Bytes per chunk.
        bytes: u64,
    },
    /// NI-DAQmx raw data.
    Daqmx {
        /// Values per chunk.
        count: u64,
        /// Where they are.
        scalers: Vec<Scaler>,
        /// Widths of the raw buffers; bytes.
        widths: Vec<u32>,
    },
}

/// A source of values of an NI-DAQmx channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scaler {
    pub value: ValueType,
    /// Index of the raw buffer.
    pub buffer: u32,
    /// Offset in the rows of the buffer; bytes.
    pub offset: u32,
    /// Bit of a digital line.
    pub bit: Option<u8>,
    /// Number used by scales.
    pub id: u32,
}

/// An object in the metadata of a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectEntry {
    /// Path such as "/'group'/'channel'".
    pub path: String,
    pub index: Index,
    /// New or changed properties.
    pub properties: BTreeMap<String, Property>,
}

/// Reads numbers and texts in sequence.
pub struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Offset in the metadata.
    pub at: usize,
    pub problem: String,
    /// Whether the metadata are truncated.
    pub ended: bool,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8], big_endian: bool) -> Self {
        Self {
            bytes,
            at: 0,
            big_endian,
        }
    }

    fn fault(&self, problem: String) -> Fault {
        Fault {
            at: self.at,
            problem,
            ended: false,
        }
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let left = &self.bytes[self.at..];
        let taken = left.get(..count).ok_or_else(|| Fault {
            at: self.at,
            problem: format!(
                "{count} bytes are needed, {} are left of the metadata",
                left.len()
            ),
            ended: true,
        })?;
        self.at += count;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, Fault> {
        Ok(integer(self.take(4)?, self.big_endian) as u32)
    }

    fn u64(&mut self) -> Result<u64, Fault> {
        Ok(integer(self.take(8)?, self.big_endian))
    }

    fn text(&mut self) -> Result<String, Fault> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}

pub fn read_objects(cursor: &mut Cursor) -> Result<Vec<ObjectEntry>, Fault> {
    let count = cursor.u32()?;
    let mut objects = Vec::new();
    for _ in 0..count {
        let path = cursor.text()?;
        let index = read_index(cursor)?;
        let mut properties = BTreeMap::new();
        for _ in 0..cursor.u32()? {
            let name = cursor.text()?;
            let value = read_property(cursor)?;
            properties.extend(value.map(|value| (name, value)));
        }
        objects.push(ObjectEntry {
            path,
            index,
            properties,
        });
    }
    Ok(objects)
}

fn read_index(cursor: &mut Cursor) -> Result<Index, Fault> {
    let header = cursor.u32()?;
    match header {
        u32::MAX => return Ok(Index::Nothing),
        0 => return Ok(Index::Same),
        0x1269 => return read_daqmx(cursor, false),
        0x126a | 0x1369 => return read_daqmx(cursor, true),
        _ => {}
    }
    let code = cursor.u32()?;
    let value = ValueType::of_code(code)
        .ok_or_else(|| cursor.fault(format!("the data type {code:#x} is not known")))?;
    let dimensions = cursor.u32()?;
    if dimensions != 1 {
        return Err(cursor.fault(format!("arrays cannot have {dimensions} dimensions")));
    }
    let count = cursor.u64()?;
    let bytes = match value {
        ValueType::Text => Some(cursor.u64()?),
        value => count.checked_mul(value.size()),
    };
    let bytes = bytes.ok_or_else(|| cursor.fault(format!("{count} values are impossible")))?;
    Ok(Index::Values {
        value,
        count,
        bytes,
    })
}

fn read_daqmx(cursor: &mut Cursor, digital: bool) -> Result<Index, Fault> {
    cursor.u32()?;
    let dimensions = cursor.u32()?;
    if dimensions != 1 {
        return Err(cursor.fault(format!("arrays cannot have {dimensions} dimensions")));
    }
    let count = cursor.u64()?;
    let number = cursor.u32()?;
    if number == 0 || number > MOST_SCALERS {
        return Err(cursor.fault(format!("{number} scalers are impossible")));
    }
    let mut scalers = Vec::new();
    for _ in 0..number {
        let code = cursor.u32()?;
        let value = ValueType::of_scaler_code(code)
            .ok_or_else(|| cursor.fault(format!("the scaler's type {code} is not known")))?;
        let (buffer, place) = (cursor.u32()?, cursor.u32()?);
        match digital {
            true => cursor.take(1)?,
            false => cursor.take(4)?,
        };
        let id = cursor.u32()?;
        scalers.push(Scaler {
            value,
            buffer,
            offset: if digital { place / 8 } else { place },
            bit: digital.then_some((place % 8) as u8),
            id,
        });
    }
    let number = cursor.u32()?;
    if number == 0 || number > MOST_SCALERS {
        return Err(cursor.fault(format!("{number} raw buffers are impossible")));
    }
    let widths = (0..number)
        .map(|_| cursor.u32())
        .collect::<Result<Vec<u32>, Fault>>()?;
    for scaler in &scalers {
        let width = widths.get(scaler.buffer as usize).copied().map(u64::from);
        let end = u64::from(scaler.offset) + scaler.value.size();
        if width.is_none_or(|width| end > width) {
            return Err(cursor.fault("a scaler lies outside of its raw buffer".to_owned()));
        }
    }
    Ok(Index::Daqmx {
        count,
        scalers,
        widths,
    })
}

/// The value of a property; `None` if neither a number nor a text.
fn read_property(cursor: &mut Cursor) -> Result<Option<Property>, Fault> {
    let code = cursor.u32()?;
    let value = ValueType::of_code(code)
        .ok_or_else(|| cursor.fault(format!("the type {code:#x} of a property is not known")))?;
    if value == ValueType::Text {
        return cursor.text().map(|text| Some(Property::Text(text)));
    }
    let big_endian = cursor.big_endian;
    let bytes = cursor.take(value.size() as usize)?;
    if value == ValueType::Timestamp {
        let (seconds, fraction) = timestamp(bytes, big_endian);
        return Ok(Some(Property::Text(date(
            seconds.saturating_sub(TO_UNIX),
            fraction,
        ))));
    }
    let number = match value {
        ValueType::Number(number) => number,
        ValueType::Bool => Number::U8,
        _ => return Ok(None),
    };
    let mut out = [0.0];
    number.decode(bytes, number.packed(big_endian), &mut out);
    Ok(Some(Property::Number(out[0])))
}

/// "2024-11-19T20:39:53.123456Z".
///
/// # Source
/// H. Hinnant, "chrono-compatible low-level date algorithms" (2013),
/// `civil_from_days`.
fn date(seconds: i64, fraction: f64) -> String {
    let (days, rest) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let shifted = days.saturating_add(719_468);
    let (era, day_of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!(
        "{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:09.6}Z",
        rest / 3_600,
        rest / 60 % 60,
        (rest % 60) as f64 + fraction
    )
}

/// Group and channel names of a path; empty for the file, one name for a group.
pub fn names_of(path: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut rest = path;
    while let Some(quoted) = rest.strip_prefix("/'") {
        // Quotes in names are doubled.
        let mut name = String::new();
        let mut chars = quoted.char_indices().peekable();
        let mut end = quoted.len();
        while let Some((at, c)) = chars.next() {
            if c == '\'' {
                if chars.peek().is_some_and(|(_, next)| *next == '\'') {
                    chars.next();
                } else {
                    end = at + 1;
                    break;
                }
            }
            name.push(c);
        }
        names.push(name);
        rest = &quoted[end..];
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_names() {
        assert_eq!(names_of("/'it''s'/'a/b'"), ["it's", "a/b"]);
        assert_eq!(names_of("/"), Vec::<String>::new());
        assert_eq!(date(1_732_048_793, 0.25), "2024-11-19T20:39:53.250000Z");
    }
}
