//! MATLAB files of versions 4 to 7 (7.3 is HDF5).

use crate::array_channels::{Array, ArrayChannels, describe_arrays};
use crate::contents::{Contents, Format, Note};
use crate::error::{Error, Place};
use crate::mat_element::{COMPRESSED, Elements, Fault, Found, Leaf, MATRIX, Tag, header4};
use crate::mat_stream::{Room, Stream};
use crate::reader::{Reader, Sink};
use crate::source::Source;
use crate::tdms_type::{Layout, decode};

/// Bytes before the first element of versions 5 to 7.
const HEADER: u64 = 128;

/// Numbers read at once.
const BLOCK: u64 = 1 << 15;

/// A MATLAB file of version 4 to 7.
#[derive(Debug)]
pub struct MatReader {
    source: Source,
    contents: Contents,
    leaves: Vec<Leaf>,
    channels: ArrayChannels,
}

impl MatReader {
    /// Finds the variables of a file.
    ///
    /// # Errors
    /// The file cannot be read or is damaged before its last variable.
    pub fn open(source: Source) -> Result<Self, Error> {
        let head = source.head(HEADER)?;
        let mut found = Found::default();
        let mut notes = Vec::new();
        let version = match head.starts_with(b"MATLAB") {
            true => read_elements(&source, &head, &mut found, &mut notes)?,
            false => read_version4(&source, &mut found, &mut notes)?,
        };
        let arrays: Vec<Array> = found
            .leaves
            .iter()
            .map(|leaf| Array {
                name: leaf.name.clone(),
                rows: leaf.rows,
                columns: leaf.columns,
                stored_as: match leaf.class {
                    class if leaf.value.name() == stored_name(class) => class.to_owned(),
                    class => format!("{class}, stored as {}", leaf.value.name()),
                },
                unit: None,
                beginning: beginning(&source, leaf),
            })
            .collect();
        let mut contents = Contents {
            format: Format::Mat,
            variant: version.to_owned(),
            channels: Vec::new(),
            properties: found.texts.clone(),
            notes,
        };
        let scalars = found
            .scalars
            .iter()
            .map(|(name, value)| (name.clone(), value.to_string()));
        contents.properties.extend(scalars);
        contents
            .notes
            .extend(found.left_out.into_iter().map(|(name, why)| Note::LeftOut {
                what: format!("\"{name}\""),
                why,
            }));
        let channels = describe_arrays(&arrays, &found.scalars, &mut contents);
        Ok(Self {
            leaves: found.leaves,
            channels,
            contents,
            source,
        })
    }
}

fn stored_name(class: &str) -> &'static str {
    match class {
        "double" => "64-bit float",
        "single" => "32-bit float",
        _ => "",
    }
}

fn malformed(source: &Source, at: u64, problem: String) -> Error {
    Error::Malformed {
        path: source.path().to_path_buf(),
        place: Place::Byte(at),
        problem,
        advice: "save the file again from MATLAB (save name -v7), or export CSV".to_owned(),
    }
}

fn read_elements(
    source: &Source,
    head: &[u8],
    found: &mut Found,
    notes: &mut Vec<Note>,
) -> Result<&'static str, Error> {
    let big_endian = match head.get(126..128) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => {
            return Err(malformed(
                source,
                126,
                "expected \"IM\" or \"MI\" at the end of the header".to_owned(),
            ));
        }
    };
    let mut compressed = false;
    let mut at = HEADER;
    while at + 8 <= source.length() {
        let room = Room::Plain(at, source.length());
        let mut elements = Elements::new(Stream::new(source, room), room, big_endian);
        let fault = |fault| match fault {
            Fault::Ended => source.truncated(at, "a variable", 8),
            Fault::Broken(problem) => malformed(source, at, problem),
        };
        let tag = elements.tag().map_err(fault)?;
        let left = source.length() - at - 8;
        if tag.bytes > left {
            notes.push(Note::CutOff {
                missing: format!(
                    "the variable at byte {at} needs {} bytes, {left} are left; it is left out",
                    tag.bytes
                ),
            });
            break;
        }
        let whole = match tag.code {
            COMPRESSED => 8 + tag.bytes,
            _ => 8 + tag.bytes + tag.padding,
        };
        match tag.code {
            MATRIX => elements.matrix(tag, None, 0, found).map_err(fault)?,
            COMPRESSED => {
                compressed = true;
                inflate(source, at, tag, big_endian, found)?;
            }
            code => notes.push(Note::LeftOut {
                what: format!("the element at byte {at}"),
                why: format!("it is of type {code}, no variable"),
            }),
        }
        at += whole;
    }
    Ok(if compressed { "version 7" } else { "version 5" })
}

/// Describes the variable in a deflated element.
fn inflate(
    source: &Source,
    at: u64,
    outer: Tag,
    big_endian: bool,
    found: &mut Found,
) -> Result<(), Error> {
    let room = Room::Deflated(at + 8, at + 8 + outer.bytes);
    let mut elements = Elements::new(Stream::new(source, room), room, big_endian);
    let result = elements.tag().and_then(|tag| match tag.code {
        MATRIX => elements.matrix(tag, None, 0, found),
        code => Err(Fault::Broken(format!(
            "expected an array, found an element of type {code}"
        ))),
    });
    result.map_err(|fault| match fault {
        Fault::Ended => malformed(
            source,
            at,
            "the compressed variable ends too early or cannot be inflated".to_owned(),
        ),
        Fault::Broken(problem) => malformed(source, at, problem),
    })
}

fn read_version4(
    source: &Source,
    found: &mut Found,
    notes: &mut Vec<Note>,
) -> Result<&'static str, Error> {
    const VARIABLE: u64 = 20;
    let mut at = 0;
    while at < source.length() {
        let left = source.length() - at;
        let bytes = source.bytes_at(at, VARIABLE.min(left))?;
        let header = header4(&bytes).ok_or_else(|| {
            malformed(
                source,
                at,
                "expected the header of a variable of MATLAB version 4".to_owned(),
            )
        })?;
        let part = (header.rows.checked_mul(header.columns))
            .and_then(|n| n.checked_mul(header.value.size()));
        let parts = if header.complex { 2 } else { 1 };
        let whole = part
            .and_then(|part| part.checked_mul(parts))
            .and_then(|all| all.checked_add(VARIABLE + header.name));
        let Some((whole, part)) = whole.zip(part).filter(|(whole, _)| *whole <= left) else {
            notes.push(Note::CutOff {
                missing: format!(
                    "the variable at byte {at} is longer than the file; it is left out"
                ),
            });
            break;
        };
        let name = source.bytes_at(at + VARIABLE, header.name)?;
        let name = String::from_utf8_lossy(&name)
            .trim_end_matches('\0')
            .to_owned();
        let data = at + VARIABLE + header.name;
        match header.kind {
            1 => found.left_out.push((name, "it is text".to_owned())),
            2 => found.left_out.push((name, "it is sparse".to_owned())),
            _ => {
                let names = if header.complex {
                    vec![" (real)", " (imaginary)"]
                } else {
                    vec![""]
                };
                for (index, suffix) in names.iter().enumerate() {
                    let from = data + index as u64 * part;
                    let leaf = Leaf {
                        name: format!("{name}{suffix}"),
                        rows: header.rows,
                        columns: header.columns,
                        room: Room::Plain(from, from + part),
                        offset: 0,
                        value: header.value,
                        big_endian: header.big_endian,
                        class: "double",
                    };
                    match header.rows * header.columns {
                        0 => {}
                        1 => found.scalars.push((
                            leaf.name.clone(),
                            beginning(source, &leaf)
                                .first()
                                .copied()
                                .unwrap_or(f64::NAN),
                        )),
                        _ => found.leaves.push(leaf),
                    }
                }
            }
        }
        at += whole;
    }
    Ok("version 4")
}

/// The first numbers of an array, from which a column of times is told.
fn beginning(source: &Source, leaf: &Leaf) -> Vec<f64> {
    let mut first = Vec::new();
    let most = leaf.rows.min(crate::array_channels::BEGINNING);
    let read = each_block(source, leaf, most, |samples, _| {
        first.extend_from_slice(samples);
        Ok(())
    });
    match read {
        Ok(()) => first,
        Err(_) => Vec::new(),
    }
}

/// Calls `take` with blocks of the first `count` numbers of an array, in the order
/// of the file, and the position of the block's first.
fn each_block(
    source: &Source,
    leaf: &Leaf,
    count: u64,
    mut take: impl FnMut(&[f64], u64) -> Result<(), Error>,
) -> Result<(), Error> {
    let ended = |_| Error::Malformed {
        path: source.path().to_path_buf(),
        place: Place::Object(leaf.name.clone()),
        problem: "its numbers end too early or cannot be inflated".to_owned(),
        advice: "save the file again from MATLAB (save name -v7), or export CSV".to_owned(),
    };
    let mut stream = Stream::new(source, leaf.room);
    stream.skip(leaf.offset).map_err(ended)?;
    let layout = Layout {
        value: leaf.value,
        offset: 0,
        stride: leaf.value.size() as usize,
        big_endian: leaf.big_endian,
        bit: None,
    };
    let mut samples = Vec::new();
    let mut bytes = Vec::new();
    let mut at = 0;
    while at < count {
        let now = BLOCK.min(count - at);
        bytes.resize((now * leaf.value.size()) as usize, 0);
        stream.fill(&mut bytes).map_err(ended)?;
        samples.resize(now as usize, 0.0);
        decode(&bytes, layout, 0, &mut samples);
        take(&samples, at)?;
        at += now;
    }
    Ok(())
}

impl Reader for MatReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        for (index, leaf) in self.leaves.iter().enumerate() {
            let parts = self.channels.of_array(index, wanted);
            if parts.is_empty() {
                continue;
            }
            each_block(
                &self.source,
                leaf,
                leaf.rows * leaf.columns,
                |samples, at| {
                    for part in &parts {
                        part.hand_over(samples, at, sink)?;
                    }
                    Ok(())
                },
            )?;
        }
        Ok(())
    }
}
