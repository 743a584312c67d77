//! The groups and datasets of an HDF5 file, of MATLAB 7.3 among them.
//!
//! # Source
//! The HDF Group (2023), "HDF5 File Format Specification 3.0". How MATLAB uses
//! it is not published; the attributes `MATLAB_class`, `MATLAB_empty`,
//! `MATLAB_sparse` and `MATLAB_object_decode`, and the group `#refs#` for what is
//! in cells, are taken from files that it wrote.

use crate::array_tree::{Array, Scalar, Tree, count, first_fastest, last_fastest};
use crate::error::{Error, Place};
use crate::hdf5_attribute::{Attributes, Value};
use crate::hdf5_blocks::{Stop, each_block};
use crate::hdf5_number::{Number, Numbers, Part, parts, size_of};
use crate::hdf5_storage::{error_of, reason};
use crate::source::Source;
use hdf5_reader::error::Error as Fault;
use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Datatype, ReferenceType};
use std::collections::{BTreeMap, BTreeSet};

/// Deepest nesting of groups and cells.
const DEEPEST: usize = 32;

/// Most things in a file: groups, datasets, cells.
const MOST_THINGS: usize = 200_000;

/// Longest text that is kept; characters.
const LONGEST_TEXT: u64 = 8192;

/// Most that data can be compressed: deflate holds 258 bytes in two bits.
const MOST_PACKED: u64 = 1032;

/// Bytes that a dataset without any stored may have.
const LARGEST_UNSTORED: u64 = 1 << 20;

/// Where the numbers of an array are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored {
    /// Position of the dataset.
    pub dataset: usize,
    /// Which of the numbers in its elements.
    pub part: usize,
    /// How many numbers an element has.
    pub parts: usize,
}

/// What an HDF5 file holds.
#[derive(Default)]
pub(crate) struct Hdf5Tree {
    /// Arrays and texts.
    pub tree: Tree,
    /// Where the numbers of each array are.
    pub stored: Vec<Stored>,
    /// Datasets.
    pub datasets: Vec<Dataset>,
    /// Attributes of groups.
    pub properties: Vec<(String, String)>,
    /// Whether MATLAB wrote the file.
    pub by_matlab: bool,
}

enum Target {
    Group(Group),
    Dataset(Dataset),
}

struct Walk<'a> {
    source: &'a Source,
    found: Hdf5Tree,
    /// Addresses of what has been listed.
    seen: BTreeSet<u64>,
    /// What cells refer to.
    targets: BTreeMap<u64, Target>,
    things: usize,
}

/// Lists what a file holds.
///
/// # Errors
/// Its root cannot be read. What cannot be read below is left out with a note.
pub(crate) fn list(source: &Source, root: &Group) -> Result<Hdf5Tree, Error> {
    let fail = |fault| error_of(source.path(), Place::Object("/".to_owned()), fault);
    let mut walk = Walk {
        source,
        found: Hdf5Tree::default(),
        seen: BTreeSet::new(),
        targets: BTreeMap::new(),
        things: 0,
    };
    let members = members(root).map_err(fail)?;
    for (name, member) in &members {
        if let (Target::Group(group), "#refs#") = (member, name.as_str()) {
            walk.found.by_matlab = true;
            for (_, target) in self::members(group).map_err(fail)? {
                let address = match &target {
                    Target::Group(group) => group.address(),
                    Target::Dataset(dataset) => dataset.address(),
                };
                walk.targets.insert(address, target);
            }
        }
    }
    walk.seen.insert(root.address());
    let attributes = Attributes::read(root.attributes().map_err(fail)?);
    walk.add_attributes(&attributes, &[]);
    for (name, member) in members {
        match name.as_str() {
            "#refs#" if walk.found.by_matlab => {}
            "#subsystem#" => {
                walk.found.by_matlab = true;
                let name = ["MATLAB's store of objects".to_owned()];
                walk.found.tree.leave_out(&name, "it holds no recording");
            }
            _ => walk.list_target(&member, vec![name], false),
        }
    }
    Ok(walk.found)
}

/// The groups and datasets in a group, by name.
fn members(group: &Group) -> Result<Vec<(String, Target)>, Fault> {
    let (groups, datasets) = group.members()?;
    let groups = groups
        .into_iter()
        .map(|g| (g.name().to_owned(), Target::Group(g)));
    let datasets = datasets
        .into_iter()
        .map(|d| (d.name().to_owned(), Target::Dataset(d)));
    let mut members: Vec<(String, Target)> = groups.chain(datasets).collect();
    members.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(members)
}

impl Walk<'_> {
    fn leave_out(&mut self, path: &[String], why: &str) {
        self.found.tree.leave_out(path, why);
    }

    /// Lists a group or dataset; `in_struct` for those in a struct of MATLAB.
    fn list_target(&mut self, target: &Target, path: Vec<String>, in_struct: bool) {
        self.things += 1;
        if path.len() > DEEPEST || self.things > MOST_THINGS {
            return self.leave_out(&path, "it is nested too deep, or the file holds too much");
        }
        let listed = match target {
            Target::Group(group) => self.list_group(group, &path),
            Target::Dataset(dataset) => self.list_dataset(dataset, &path, in_struct),
        };
        if let Err(fault) = listed {
            let why = format!("it cannot be read ({})", reason(&fault));
            self.leave_out(&path, &why);
        }
    }

    fn list_group(&mut self, group: &Group, path: &[String]) -> Result<(), Fault> {
        if !self.seen.insert(group.address()) {
            self.leave_out(path, "it is another name of a group that is listed");
            return Ok(());
        }
        let attributes = Attributes::read(group.attributes()?);
        let class = attributes.text("MATLAB_class");
        self.found.by_matlab |= class.is_some();
        if attributes.has("MATLAB_sparse") {
            self.leave_out(path, "it is a sparse matrix; save full(…) of it");
            return Ok(());
        }
        let is_struct = class == Some("struct");
        if class.is_some() && !is_struct {
            self.leave_out(path, OBJECT);
            return Ok(());
        }
        self.add_attributes(&attributes, path);
        for (name, member) in members(group)? {
            let mut path = path.to_vec();
            path.push(name);
            self.list_target(&member, path, is_struct);
        }
        Ok(())
    }

    /// Attributes of a group: texts are shown, numbers may be sampling rates.
    fn add_attributes(&mut self, attributes: &Attributes, path: &[String]) {
        for (name, value) in attributes.shown() {
            let mut full = path.to_vec();
            full.push(name.clone());
            let shown = (full.join("/"), value.to_string());
            self.found.properties.push(shown);
        }
        self.add_scalars(attributes, path);
    }

    fn add_scalars(&mut self, attributes: &Attributes, path: &[String]) {
        for (name, value) in attributes.shown() {
            if let Value::Number(value) = value {
                self.found.tree.scalars.push(Scalar {
                    level: path.to_vec(),
                    name: name.clone(),
                    value: *value,
                });
            }
        }
    }

    fn list_dataset(
        &mut self,
        dataset: &Dataset,
        path: &[String],
        in_struct: bool,
    ) -> Result<(), Fault> {
        let attributes = Attributes::read(dataset.attributes());
        let class = attributes.text("MATLAB_class").map(str::to_owned);
        self.found.by_matlab |= class.is_some();
        if attributes.has("MATLAB_empty") {
            self.leave_out(path, "it is empty");
            return Ok(());
        }
        if !self.seen.insert(dataset.address()) {
            self.leave_out(path, "it is another name of a dataset that is listed");
            return Ok(());
        }
        let elements = dataset.num_elements()?;
        match (dataset.dtype(), class.as_deref()) {
            (Datatype::Reference { ref_type, .. }, class)
                if *ref_type == ReferenceType::Object
                    && (class == Some("cell") || (class.is_none() && in_struct)) =>
            {
                self.list_references(dataset, path, class.is_none())
            }
            (_, Some("char")) => self.list_characters(dataset, elements, path),
            (_, Some(class)) if !NUMERIC.contains(&class) => {
                self.leave_out(path, OBJECT);
                Ok(())
            }
            (Datatype::String { .. } | Datatype::VarLen { .. }, _) if elements == 1 => {
                let text = dataset.read_string()?;
                let text = text.chars().take(LONGEST_TEXT as usize).collect();
                self.found.tree.texts.push((path.to_vec(), text));
                Ok(())
            }
            (_, class) => self.list_numbers(dataset, &attributes, path, class.is_some()),
        }
    }

    /// Cells, and the fields of an array of structs, refer to other datasets.
    fn list_references(
        &mut self,
        dataset: &Dataset,
        path: &[String],
        of_structs: bool,
    ) -> Result<(), Fault> {
        let (elements, size) = (dataset.num_elements()?, size_of(dataset.dtype()));
        if elements > MOST_THINGS as u64 || !(1..=8).contains(&size) {
            self.leave_out(path, "it claims more cells than a file can hold");
            return Ok(());
        }
        let bytes = dataset.read_raw_bytes()?;
        for (k, address) in bytes.chunks_exact(size).enumerate() {
            let mut word = [0; 8];
            word[..size].copy_from_slice(address);
            let address = u64::from_le_bytes(word);
            let mut path = path.to_vec();
            // The field of the third struct is "s/3/field".
            let place = if of_structs {
                path.len() - 1
            } else {
                path.len()
            };
            path.insert(place, (k + 1).to_string());
            match self.targets.remove(&address) {
                Some(target) => {
                    self.list_target(&target, path, false);
                    self.targets.insert(address, target);
                }
                None => self.leave_out(&path, "it refers to nothing in the file"),
            }
        }
        Ok(())
    }

    /// Text of MATLAB, stored as numbers.
    fn list_characters(
        &mut self,
        dataset: &Dataset,
        elements: u64,
        path: &[String],
    ) -> Result<(), Fault> {
        if elements > LONGEST_TEXT {
            self.leave_out(path, "it is a long text");
            return Ok(());
        }
        let codes = dataset.read_array::<Number>()?;
        let units = codes.iter().map(|code| code.0 as u16);
        let characters: Vec<char> = char::decode_utf16(units)
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect();
        let rows = dataset.shape().last().map_or(1, |n| *n as usize);
        let text = match rows {
            0 | 1 => characters.iter().collect(),
            rows => (0..rows)
                .map(|row| {
                    characters
                        .iter()
                        .skip(row)
                        .step_by(rows)
                        .collect::<String>()
                })
                .map(|line| line.trim_end().to_owned())
                .collect::<Vec<_>>()
                .join("\n"),
        };
        self.found.tree.texts.push((path.to_vec(), text));
        Ok(())
    }

    fn list_numbers(
        &mut self,
        dataset: &Dataset,
        attributes: &Attributes,
        path: &[String],
        by_matlab: bool,
    ) -> Result<(), Fault> {
        let mut left_out = Vec::new();
        let mut parts = parts(dataset.dtype(), &mut left_out);
        if let Some(why) = odd_number(dataset)? {
            parts.clear();
            left_out.push((Vec::new(), why));
        }
        for (below, why) in left_out {
            self.leave_out(&[path, &below].concat(), why);
        }
        let extents = match by_matlab {
            // MATLAB's first extent runs fastest and is written last.
            true => first_fastest(&dataset.shape().iter().rev().copied().collect::<Vec<_>>()),
            false => last_fastest(dataset.shape()),
        };
        let elements = count(&extents);
        let bytes = elements.saturating_mul(size_of(dataset.dtype()) as u64);
        let possible = self.source.length().saturating_mul(MOST_PACKED);
        if bytes > possible.saturating_add(LARGEST_UNSTORED) {
            let why = format!("it claims {elements} elements, more than the file can hold");
            self.leave_out(path, &why);
            return Ok(());
        }
        let values = match elements {
            1 => first_element(dataset, parts.len())?,
            _ => Vec::new(),
        };
        self.add_scalars(attributes, path);
        self.found.datasets.push(dataset.clone());
        for (at, part) in parts.iter().enumerate() {
            self.found.stored.push(Stored {
                dataset: self.found.datasets.len() - 1,
                part: at,
                parts: parts.len(),
            });
            self.found.tree.arrays.push(Array {
                path: [path, &part.path].concat(),
                part: part.suffix,
                extents: extents.clone(),
                stored_as: stored_as(dataset, part),
                value: values.get(at).copied(),
                beginning: Vec::new(),
                unit: attributes.unit(),
                properties: attributes
                    .shown()
                    .map(|(name, value)| (name.clone(), value.to_string()))
                    .collect(),
            });
        }
        Ok(())
    }
}

/// Classes of MATLAB that are numbers.
const NUMERIC: [&str; 11] = [
    "double", "single", "logical", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
    "uint64",
];

/// Why classes of MATLAB are left out.
const OBJECT: &str = "it is an object of MATLAB (a table, a string, a date …); save plain arrays";

fn first_element(dataset: &Dataset, parts: usize) -> Result<Vec<f64>, Fault> {
    let mut values = Vec::new();
    let stopped = match parts {
        1 => each_block(dataset, (0, 1), &mut |_, block: Vec<Number>| {
            values.extend(block.iter().map(|n| n.0));
            Ok::<(), Fault>(())
        }),
        _ => each_block(dataset, (0, 1), &mut |_, block: Vec<Numbers>| {
            values.extend(block.into_iter().flat_map(|n| n.0));
            Ok(())
        }),
    };
    match stopped {
        Ok(()) => Ok(values),
        Err(Stop::Fault(fault) | Stop::Asked(fault)) => Err(fault),
    }
}

/// Why the bits of a number are not where they usually are, if so: the decoder
/// takes integers to fill their bytes and floats to be those of IEEE 754.
fn odd_number(dataset: &Dataset) -> Result<Option<&'static str>, Fault> {
    const ODD: &str = "its numbers do not fill their bytes, or are floats of an unusual form";
    let raw = dataset.raw_datatype()?;
    let [class, _, _, _, s0, s1, s2, s3, rest @ ..] = &raw[..] else {
        return Ok(None);
    };
    let bits = u32::from_le_bytes([*s0, *s1, *s2, *s3]).saturating_mul(8);
    let [o0, o1, p0, p1, rest @ ..] = rest else {
        return Ok(None);
    };
    let (offset, precision) = (
        u16::from_le_bytes([*o0, *o1]),
        u16::from_le_bytes([*p0, *p1]),
    );
    let fills = offset == 0 && u32::from(precision) == bits;
    let usual = match (class & 0xf, bits) {
        (0 | 4, _) => fills,
        // Place and size of the exponent, and of the fraction.
        (1, 16) => fills && rest.get(..4) == Some(&[10, 5, 0, 10]),
        (1, 32) => fills && rest.get(..4) == Some(&[23, 8, 0, 23]),
        (1, 64) => fills && rest.get(..4) == Some(&[52, 11, 0, 52]),
        _ => true,
    };
    Ok((!usual).then_some(ODD))
}

fn stored_as(dataset: &Dataset, part: &Part) -> String {
    match dataset.chunks() {
        Some(_) => format!("{}, in chunks", part.stored_as),
        None => part.stored_as.clone(),
    }
}
