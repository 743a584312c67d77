//! Header of a function in a universal file.

use crate::text::number::{Marks, number};
use windfall_source::error::{Error, Place};
use windfall_source::source::Source;

/// Contents of the eleven header lines.
pub struct Header {
    pub name: String,
    /// Whether numbers are double precision.
    pub double: bool,
    pub complex: bool,
    /// Whether the abscissa is evenly spaced.
    pub even: bool,
    pub points: u64,
    /// First value of the abscissa.
    pub start: f64,
    /// Step of the abscissa.
    pub interval: f64,
    pub abscissa: Axis,
    pub ordinate: Axis,
    pub properties: Vec<(String, String)>,
}

/// A quantity on an axis.
pub struct Axis {
    /// Code of the quantity.
    pub kind: u32,
    pub unit: Option<String>,
}

/// Code of time; s.
pub const TIME: u32 = 17;

pub fn malformed(source: &Source, line: u64, problem: &str) -> Error {
    source.malformed(
        Place::Line(line),
        problem,
        "export the functions again as data set 58",
    )
}

/// Parses the eleven header lines of a function.
///
/// * `line`: number of the preceding line
pub fn parse_header(source: &Source, lines: &[String], line: u64) -> Result<Header, Error> {
    let marks = Marks::decimal(b'.');
    let bad =
        |offset: u64, what: &str| malformed(source, line + offset, &format!("expected {what}"));
    let text = |index: usize, from: usize, to: usize| {
        let line: Vec<char> = lines[index].chars().collect();
        let end = to.min(line.len());
        line.get(from..end).map_or_else(String::new, |part| {
            part.iter().collect::<String>().trim().to_owned()
        })
    };
    let integer = |index: usize, from: usize, to: usize| text(index, from, to).parse::<u64>().ok();
    let number = |index: usize, from: usize, to: usize| number(&text(index, from, to), marks);
    let data_type = integer(6, 0, 10).ok_or_else(|| bad(7, "the data type in ten characters"))?;
    let points =
        integer(6, 10, 20).ok_or_else(|| bad(7, "the number of points in ten characters"))?;
    let even = integer(6, 20, 30) != Some(0);
    let (double, complex) = match data_type {
        2 => (false, false),
        4 => (true, false),
        5 => (false, true),
        6 => (true, true),
        other => return Err(bad(7, &format!("data of type 2, 4, 5 or 6, found {other}"))),
    };
    let axis = |index: usize| Axis {
        kind: integer(index, 0, 10).unwrap_or(0) as u32,
        unit: Some(text(index, 46, 66)).filter(|unit| !unit.is_empty() && unit != "NONE"),
    };
    let mut properties = Vec::new();
    for index in 0..5 {
        let line = lines[index].trim();
        if !line.is_empty() && line != "NONE" {
            properties.push((format!("ID line {}", index + 1), line.to_owned()));
        }
    }
    let place = |entity: String, node: Option<u64>, direction: String| {
        format!(
            "{entity} {} {direction}",
            node.map_or_else(String::new, |n| n.to_string())
        )
        .trim()
        .to_owned()
    };
    properties.push((
        "response".to_owned(),
        place(text(5, 31, 41), integer(5, 41, 51), text(5, 51, 55)),
    ));
    properties.push((
        "reference".to_owned(),
        place(text(5, 56, 66), integer(5, 66, 76), text(5, 76, 80)),
    ));
    let first = lines[0].trim();
    let name = match first.is_empty() || first == "NONE" {
        true => text(8, 25, 46),
        false => first.to_owned(),
    };
    Ok(Header {
        name: if name.is_empty() {
            "function".to_owned()
        } else {
            name
        },
        double,
        complex,
        even,
        points,
        start: number(6, 30, 43).unwrap_or(0.0),
        interval: number(6, 43, 56).unwrap_or(0.0),
        abscissa: axis(7),
        ordinate: axis(8),
        properties,
    })
}
