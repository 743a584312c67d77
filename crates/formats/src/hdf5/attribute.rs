//! Attributes of groups and datasets.

use crate::hdf5::btree2::read_records;
use crate::hdf5::cursor::{Cursor, Problem};
use crate::hdf5::file::Hdf5File;
use crate::hdf5::heap::{FractalHeap, read_text};
use crate::hdf5::layout::read_space;
use crate::hdf5::number::number_of;
use crate::hdf5::object::{
    ATTRIBUTE, ATTRIBUTE_INFO, DATATYPE, Header, read_header, shared_address,
};
use crate::hdf5::value_type::{Datatype, Kind, read_type};

/// Most values of an attribute that are shown.
const MOST_VALUES: u64 = 16;

/// Longest attribute text kept; characters.
const LONGEST_TEXT: usize = 4096;

const MOST_ATTRIBUTES: usize = 65_536;

/// Attributes for internal use of other programs.
const INTERNAL: [&str; 8] = [
    "H5PATH",
    "CLASS",
    "NAME",
    "DIMENSION_LIST",
    "DIMENSION_LABELS",
    "REFERENCE_LIST",
    "_Netcdf4Dimid",
    "_Netcdf4Coordinates",
];

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Text(String),
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// The attributes of an object, by name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes(pub Vec<(String, Value)>);

impl Attributes {
    /// Reads the attributes of a header; unreadable ones say so in their value.
    pub fn read(file: &Hdf5File, header: &Header) -> Self {
        let mut values = Vec::new();
        for message in &header.messages {
            let mut cursor = file.cursor(&message.bytes, message.address);
            match message.kind {
                ATTRIBUTE if !message.shared => values.extend(read_attribute(file, &mut cursor)),
                ATTRIBUTE_INFO => {
                    // Damage in attributes alone is not reported.
                    let _ = read_dense(file, &mut cursor, &mut values);
                }
                _ => {}
            }
        }
        values.sort_by(|a: &(String, Value), b| a.0.cmp(&b.0));
        Self(values)
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.iter().find_map(|(n, value)| match value {
            Value::Text(text) if n == name => Some(text.as_str()),
            _ => None,
        })
    }

    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(n, _)| n == name)
    }

    pub fn unit(&self) -> Option<String> {
        const UNITS: [&str; 3] = ["unit", "units", "unit_string"];
        self.0.iter().find_map(|(name, value)| match value {
            Value::Text(text)
                if !text.is_empty() && UNITS.contains(&name.to_lowercase().as_str()) =>
            {
                Some(text.clone())
            }
            _ => None,
        })
    }

    /// Attributes worth showing to the user.
    pub fn shown(&self) -> impl Iterator<Item = &(String, Value)> {
        self.0
            .iter()
            .filter(|(name, _)| !INTERNAL.contains(&name.as_str()) && !name.starts_with("MATLAB_"))
    }
}

fn read_dense(
    file: &Hdf5File,
    cursor: &mut Cursor<'_>,
    values: &mut Vec<(String, Value)>,
) -> Result<(), Problem> {
    cursor.version("attributes", &[0])?;
    let flags = cursor.u8()?;
    cursor.skip(if flags & 1 != 0 { 2 } else { 0 })?;
    let (Some(heap), Some(names)) = (cursor.address()?, cursor.address()?) else {
        return Ok(());
    };
    let heap = FractalHeap::read(file, heap)?;
    let (_, records) = read_records(file, names, &[8])?;
    for record in records.iter().take(MOST_ATTRIBUTES) {
        let id = record.get(..heap.id_length()).unwrap_or_default();
        if let Ok((bytes, address)) = heap.object(id) {
            values.extend(read_attribute(file, &mut file.cursor(&bytes, address)));
        }
    }
    Ok(())
}

/// An attribute; `None` if not even its name can be read.
fn read_attribute(file: &Hdf5File, cursor: &mut Cursor<'_>) -> Option<(String, Value)> {
    let head = read_head(cursor).ok()?;
    let value = read_value(file, cursor, &head);
    let value = value.unwrap_or_else(|_| Value::Text("(cannot be read)".to_owned()));
    Some((head.name, value))
}

struct Head {
    version: u8,
    flags: u8,
    name: String,
    type_size: usize,
    space_size: usize,
}

fn read_head(cursor: &mut Cursor<'_>) -> Result<Head, Problem> {
    let version = cursor.version("attributes", &[1, 2, 3])?;
    let flags = cursor.u8()?;
    let name_size = usize::from(cursor.u16()?);
    let type_size = usize::from(cursor.u16()?);
    let space_size = usize::from(cursor.u16()?);
    cursor.skip(if version == 3 { 1 } else { 0 })?;
    let padded = |size: usize| match version {
        1 => size.next_multiple_of(8),
        _ => size,
    };
    let name = cursor.take(padded(name_size))?;
    let name = name.split(|b| *b == 0).next().unwrap_or_default();
    Ok(Head {
        version,
        flags: if version == 1 { 0 } else { flags },
        name: String::from_utf8_lossy(name).into_owned(),
        type_size: padded(type_size),
        space_size: padded(space_size),
    })
}

fn read_value(file: &Hdf5File, cursor: &mut Cursor<'_>, head: &Head) -> Result<Value, Problem> {
    let at = cursor.at() - file.base.min(cursor.at());
    let mut inner = file.cursor(cursor.take(head.type_size)?, at);
    let datatype = match head.flags & 1 {
        0 => read_type(&mut inner)?,
        _ => read_shared_type(file, &mut inner)?,
    };
    if head.flags & 2 != 0 {
        return Err(Problem::Unsupported(format!(
            "shared extents, {}",
            head.version
        )));
    }
    let at = cursor.at() - file.base.min(cursor.at());
    let count = read_space(&mut file.cursor(cursor.take(head.space_size)?, at))?.count();
    let at = cursor.at();
    if datatype.size == 0 {
        return Err(cursor.damaged("an attribute has elements of zero size"));
    }
    let shown = usize::try_from(count.min(MOST_VALUES)).unwrap_or(0);
    let elements = cursor.rest().chunks_exact(datatype.size).take(shown);
    let texts: Vec<String> = elements
        .clone()
        .filter_map(|bytes| text_of(file, &datatype, bytes, at))
        .collect();
    let numbers: Vec<f64> = elements
        .filter_map(|bytes| number_of(bytes, &datatype))
        .collect();
    let more = if count > MOST_VALUES { " …" } else { "" };
    Ok(match (&numbers[..], &texts[..]) {
        ([number], _) if count == 1 => Value::Number(*number),
        ([], []) => Value::Text("(not shown)".to_owned()),
        ([], texts) => Value::Text(shorten(&format!("{}{more}", texts.join(", ")))),
        (numbers, _) => {
            let texts: Vec<String> = numbers.iter().map(f64::to_string).collect();
            Value::Text(format!("{}{more}", texts.join(", ")))
        }
    })
}

/// A committed datatype, which has a header of its own.
pub(crate) fn read_shared_type(
    file: &Hdf5File,
    cursor: &mut Cursor<'_>,
) -> Result<Datatype, Problem> {
    let address = shared_address(cursor)?;
    let header = read_header(file, address)?;
    match header.message(DATATYPE).filter(|m| !m.shared) {
        Some(found) => read_type(&mut file.cursor(&found.bytes, found.address)),
        None => Err(cursor.damaged("a datatype is not where it should be")),
    }
}

pub(crate) fn text_of(
    file: &Hdf5File,
    datatype: &Datatype,
    bytes: &[u8],
    at: u64,
) -> Option<String> {
    let bytes = match datatype.kind {
        Kind::Text => bytes.to_vec(),
        Kind::HeapText => read_text(file, bytes, at).ok()?,
        _ => return None,
    };
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    Some(shorten(String::from_utf8_lossy(&bytes[..end]).trim_end()))
}

fn shorten(text: &str) -> String {
    text.chars().take(LONGEST_TEXT).collect()
}
