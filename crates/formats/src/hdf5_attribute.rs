//! Attributes of groups and datasets.

use crate::hdf5_number::{Number, number_of};
use hdf5_reader::{Attribute, H5Type};

/// Most numbers of an attribute that are shown.
const MOST_NUMBERS: usize = 16;

/// Longest text of an attribute that is kept; characters.
const LONGEST_TEXT: usize = 4096;

/// Attributes by which programs keep their own order.
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

/// What an attribute holds.
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

/// The attributes of a thing, by name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes(pub Vec<(String, Value)>);

impl Attributes {
    /// The values of attributes.
    pub fn read(attributes: Vec<Attribute>) -> Self {
        let mut values: Vec<(String, Value)> = attributes
            .iter()
            .map(|a| (a.name.clone(), value(a)))
            .collect();
        values.sort_by(|a, b| a.0.cmp(&b.0));
        Self(values)
    }

    /// A text.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.iter().find_map(|(n, value)| match value {
            Value::Text(text) if n == name => Some(text.as_str()),
            _ => None,
        })
    }

    /// Whether there is one of this name.
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(n, _)| n == name)
    }

    /// The unit.
    pub fn unit(&self) -> Option<String> {
        self.0.iter().find_map(|(name, value)| match value {
            Value::Text(text)
                if !text.is_empty()
                    && ["unit", "units", "unit_string"].contains(&name.to_lowercase().as_str()) =>
            {
                Some(text.clone())
            }
            _ => None,
        })
    }

    /// What a user may want to see.
    pub fn shown(&self) -> impl Iterator<Item = &(String, Value)> {
        self.0
            .iter()
            .filter(|(name, _)| !INTERNAL.contains(&name.as_str()) && !name.starts_with("MATLAB_"))
    }
}

fn value(attribute: &Attribute) -> Value {
    if let Ok(strings) = attribute.read_strings() {
        return Value::Text(shorten(&strings.join(", ")));
    }
    if let Ok(text) = attribute.read_string() {
        return Value::Text(shorten(&text));
    }
    let size = Number::element_size(&attribute.datatype);
    let count = attribute.num_elements().unwrap_or(0);
    let numbers: Vec<f64> = match size {
        0 => Vec::new(),
        size => attribute
            .raw_data
            .chunks_exact(size)
            .take(MOST_NUMBERS)
            .filter_map(|bytes| number_of(bytes, &attribute.datatype))
            .collect(),
    };
    match numbers[..] {
        [] => Value::Text("(not shown)".to_owned()),
        [number] if count == 1 => Value::Number(number),
        _ => {
            let texts: Vec<String> = numbers.iter().map(f64::to_string).collect();
            let more = if count > MOST_NUMBERS as u64 {
                " …"
            } else {
                ""
            };
            Value::Text(format!("{}{more}", texts.join(", ")))
        }
    }
}

fn shorten(text: &str) -> String {
    text.trim_end_matches('\0')
        .chars()
        .take(LONGEST_TEXT)
        .collect()
}
