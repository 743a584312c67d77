//! Walks the groups and datasets of an HDF5 file, including MATLAB 7.3.
//!
//! # Source
//! The HDF Group (2023), "HDF5 File Format Specification 3.0". MATLAB's conventions
//! are not published; the attributes `MATLAB_class`, `MATLAB_empty`, `MATLAB_sparse`
//! and `MATLAB_object_decode`, and the group `#refs#` for the contents of cells, are
//! inferred from its files.

use crate::arrays::tree::{Array, BEGINNING, Scalar, Tree, count, first_fastest, last_fastest};
use crate::hdf5::attribute::{Attributes, Value, text_of};
use crate::hdf5::blocks::each_block;
use crate::hdf5::cursor::Problem;
use crate::hdf5::dataset::Dataset;
use crate::hdf5::file::{Hdf5File, reason};
use crate::hdf5::group::{Link, Member, is_group, read_members};
use crate::hdf5::layout::Layout;
use crate::hdf5::number::{Number, Part, decode, parts};
use crate::hdf5::object::{Header, read_header};
use crate::hdf5::value_type::Kind;
use std::collections::BTreeSet;
use windfall_source::error::Error;

/// Deepest nesting of groups and cells.
const DEEPEST: usize = 32;

/// Most objects in a file: groups, datasets, cells.
const MOST_THINGS: usize = 200_000;

/// Longest text kept; characters.
const LONGEST_TEXT: u64 = 8192;

/// Largest compression ratio: deflate stores 258 bytes in two bits.
const MOST_PACKED: u64 = 1032;

/// Bytes allowed for datasets that were never written.
const LARGEST_UNWRITTEN: u64 = 1 << 16;

/// Location of the numbers of an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored {
    pub dataset: usize,
    /// Which number within its elements.
    pub number: Number,
}

#[derive(Default, Debug)]
pub(crate) struct Hdf5Tree {
    pub tree: Tree,
    /// Location of the numbers of each array.
    pub stored: Vec<Stored>,
    pub datasets: Vec<Dataset>,
    /// Attributes of groups.
    pub properties: Vec<(String, String)>,
    pub by_matlab: bool,
}

struct Walk<'a> {
    file: &'a Hdf5File,
    found: Hdf5Tree,
    /// Addresses of listed objects.
    seen: BTreeSet<u64>,
    things: usize,
    /// Total size of the datasets so far; bytes.
    claimed: u64,
}

/// Lists the contents of a file; unreadable objects are left out with a note.
pub(crate) fn list(file: &Hdf5File) -> Result<Hdf5Tree, Error> {
    let mut walk = Walk {
        file,
        found: Hdf5Tree::default(),
        seen: BTreeSet::from([file.root]),
        things: 0,
        claimed: 0,
    };
    walk.list_root()
        .map_err(|problem| file.error("/", problem))?;
    Ok(walk.found)
}

impl Walk<'_> {
    fn leave_out(&mut self, path: &[String], why: &str) {
        self.found.tree.leave_out(path, why);
    }

    fn list_root(&mut self) -> Result<(), Problem> {
        let header = read_header(self.file, self.file.root)?;
        let members = read_members(self.file, &header)?;
        let has = |name: &str| members.iter().any(|m| m.name == name);
        self.found.by_matlab = has("#refs#") || has("#subsystem#");
        self.add_attributes(&Attributes::read(self.file, &header), &[]);
        for member in members {
            match (member.name.as_str(), self.found.by_matlab) {
                // Holds the contents of cells, without names.
                ("#refs#", true) => {}
                ("#subsystem#", true) => {
                    let name = ["MATLAB's store of objects".to_owned()];
                    self.found.tree.leave_out(&name, "it holds no recording");
                }
                _ => self.list_member(&member, &[], false),
            }
        }
        Ok(())
    }

    /// Lists a member of a group; `in_struct` if it is a MATLAB struct.
    fn list_member(&mut self, member: &Member, above: &[String], in_struct: bool) {
        let path = [above, std::slice::from_ref(&member.name)].concat();
        match &member.link {
            Link::Hard(address) => self.list_object(*address, path, in_struct),
            Link::Soft(target) => {
                let why = format!("it is another name of \"{target}\"");
                self.leave_out(&path, &why);
            }
            Link::External => self.leave_out(&path, "it is in another file"),
        }
    }

    /// Lists a group or dataset.
    fn list_object(&mut self, address: u64, path: Vec<String>, in_struct: bool) {
        self.things += 1;
        if path.len() > DEEPEST || self.things > MOST_THINGS {
            return self.leave_out(
                &path,
                "it is nested too deep, or the file holds too many objects",
            );
        }
        if let Err(problem) = self.list_header(address, &path, in_struct) {
            self.leave_out(&path, &reason(&problem));
        }
    }

    fn list_header(
        &mut self,
        address: u64,
        path: &[String],
        in_struct: bool,
    ) -> Result<(), Problem> {
        let header = read_header(self.file, address)?;
        let attributes = Attributes::read(self.file, &header);
        let class = attributes.text("MATLAB_class");
        self.found.by_matlab |= class.is_some();
        // In MATLAB files, all empty cells refer to one dataset.
        if attributes.has("MATLAB_empty") {
            self.leave_out(path, "it is empty");
            return Ok(());
        }
        if !self.seen.insert(address) {
            self.leave_out(path, "it is another name of what is listed already");
            return Ok(());
        }
        if is_group(&header) {
            return self.list_group(&header, &attributes, path);
        }
        match Dataset::read(self.file, &header)? {
            Some(dataset) => self.list_dataset(dataset, &attributes, path, in_struct),
            None => {
                self.leave_out(path, "it is a type, not data");
                Ok(())
            }
        }
    }

    fn list_group(
        &mut self,
        header: &Header,
        attributes: &Attributes,
        path: &[String],
    ) -> Result<(), Problem> {
        if attributes.has("MATLAB_sparse") {
            self.leave_out(path, "it is a sparse matrix; save full(…) of it");
            return Ok(());
        }
        let class = attributes.text("MATLAB_class");
        let is_struct = class == Some("struct");
        if class.is_some() && !is_struct {
            self.leave_out(path, OBJECT);
            return Ok(());
        }
        self.add_attributes(attributes, path);
        for member in read_members(self.file, header)? {
            self.list_member(&member, path, is_struct);
        }
        Ok(())
    }

    /// Attributes of a group become properties; numbers may be sampling rates.
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
        mut dataset: Dataset,
        attributes: &Attributes,
        path: &[String],
        in_struct: bool,
    ) -> Result<(), Problem> {
        let class = attributes.text("MATLAB_class");
        let elements = dataset.space.count();
        match (&dataset.datatype.kind, class) {
            (Kind::Reference, class) if class == Some("cell") || (class.is_none() && in_struct) => {
                self.list_references(dataset, path, class.is_none())
            }
            (_, Some("char")) => self.list_characters(dataset, path),
            (_, Some(class)) if !NUMERIC.contains(&class) => {
                self.leave_out(path, OBJECT);
                Ok(())
            }
            (Kind::Text | Kind::HeapText, _) if elements == 1 => {
                let bytes = self.some_bytes(&mut dataset, 1)?;
                let text = text_of(self.file, &dataset.datatype, &bytes, 0);
                let text = text.unwrap_or_else(|| "(cannot be read)".to_owned());
                self.found.tree.texts.push((path.to_vec(), text));
                Ok(())
            }
            (_, class) => self.list_numbers(dataset, attributes, path, class.is_some()),
        }
    }

    /// Bytes of the first elements of a dataset.
    fn some_bytes(&self, dataset: &mut Dataset, most: u64) -> Result<Vec<u8>, Problem> {
        let count = dataset.space.count().min(most);
        let mut found = Vec::new();
        if self.claims_too_much(dataset) {
            return Err(too_much(dataset));
        }
        each_block(self.file, dataset, (0, count), &mut |_, bytes| {
            found.extend_from_slice(bytes);
            Ok(())
        })?;
        dataset.forget();
        found.truncate((count as usize).saturating_mul(dataset.datatype.size));
        Ok(found)
    }

    /// Whether a dataset declares more bytes than the file can hold.
    fn claims_too_much(&self, dataset: &Dataset) -> bool {
        let packed = match (&dataset.layout, dataset.filters.is_empty()) {
            (Layout::Chunked(_), false) => MOST_PACKED,
            _ => 1,
        };
        let length = self.file.source.length();
        let possible = length
            .saturating_mul(packed)
            .saturating_add(LARGEST_UNWRITTEN);
        let possible_all = length.saturating_mul(MOST_PACKED);
        let size = dataset.size();
        size > possible
            || self.claimed.saturating_add(size) > possible_all.saturating_add(LARGEST_UNWRITTEN)
    }

    /// Cells, and fields of struct arrays, are references to other datasets.
    fn list_references(
        &mut self,
        mut dataset: Dataset,
        path: &[String],
        of_structs: bool,
    ) -> Result<(), Problem> {
        let size = dataset.datatype.size;
        let bytes = self.some_bytes(&mut dataset, MOST_THINGS as u64)?;
        for (k, address) in bytes.chunks_exact(size).enumerate() {
            let mut path = path.to_vec();
            // A field of the third struct is "s/3/field".
            let place = if of_structs {
                path.len() - 1
            } else {
                path.len()
            };
            path.insert(place, (k + 1).to_string());
            match self.file.cursor(address, 0).address()? {
                Some(address) if address != 0 => self.list_object(address, path, false),
                _ => self.leave_out(&path, "it refers to nothing in the file"),
            }
        }
        Ok(())
    }

    /// MATLAB text, stored as numbers.
    fn list_characters(&mut self, mut dataset: Dataset, path: &[String]) -> Result<(), Problem> {
        let bytes = self.some_bytes(&mut dataset, LONGEST_TEXT)?;
        let (parts, _) = parts(&dataset.datatype);
        let mut codes = Vec::new();
        if let [part] = &parts[..] {
            decode(&bytes, dataset.datatype.size, part.number, &mut codes);
        }
        let units = codes.iter().map(|code| *code as u16);
        let characters: Vec<char> = char::decode_utf16(units)
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect();
        let rows = dataset.space.extents.last().map_or(1, |n| *n as usize);
        let text = match rows {
            0 | 1 => characters.iter().collect(),
            rows => (0..rows.min(characters.len()))
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
        mut dataset: Dataset,
        attributes: &Attributes,
        path: &[String],
        by_matlab: bool,
    ) -> Result<(), Problem> {
        let (parts, left_out) = parts(&dataset.datatype);
        for (below, why) in left_out {
            self.leave_out(&[path, &below].concat(), why);
        }
        if self.claims_too_much(&dataset) {
            return Err(too_much(&dataset));
        }
        self.claimed = self.claimed.saturating_add(dataset.size());
        let extents = match by_matlab {
            // MATLAB's first dimension varies fastest and is written last.
            true => {
                let reversed: Vec<u64> = dataset.space.extents.iter().rev().copied().collect();
                first_fastest(&reversed)
            }
            false => last_fastest(&dataset.space.extents),
        };
        // Read the start of the first column, or a scalar.
        let step = extents.first().map_or(1, |e| e.step);
        let wanted = match (count(&extents), &extents[..]) {
            (1, _) => 1,
            (_, [rows, columns]) if columns.length > 1 && columns.length <= BEGINNING => {
                rows.length.min(BEGINNING) * step
            }
            _ => 0,
        };
        let bytes = self.some_bytes(&mut dataset, wanted)?;
        let element = dataset.datatype.size;
        self.add_scalars(attributes, path);
        for part in parts {
            let mut first = Vec::new();
            decode(&bytes, element, part.number, &mut first);
            let first: Vec<f64> = first.into_iter().step_by(step as usize).collect();
            self.found.stored.push(Stored {
                dataset: self.found.datasets.len(),
                number: part.number,
            });
            self.found.tree.arrays.push(Array {
                path: [path, &part.path].concat(),
                part: part.suffix,
                extents: extents.clone(),
                stored_as: stored_as(&dataset, &part),
                value: first.first().copied().filter(|_| wanted == 1),
                beginning: first,
                unit: attributes.unit(),
                properties: attributes
                    .shown()
                    .map(|(name, value)| (name.clone(), value.to_string()))
                    .collect(),
            });
        }
        self.found.datasets.push(dataset);
        Ok(())
    }
}

fn too_much(dataset: &Dataset) -> Problem {
    Problem::Damaged(
        0,
        format!(
            "it declares {} elements, more than the file can hold",
            dataset.space.count()
        ),
    )
}

/// Numeric MATLAB classes.
const NUMERIC: [&str; 11] = [
    "double", "single", "logical", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
    "uint64",
];

/// Why other MATLAB classes are left out.
const OBJECT: &str = "it is an object of MATLAB (a table, a string, a date …); save plain arrays";

fn stored_as(dataset: &Dataset, part: &Part) -> String {
    match &dataset.layout {
        Layout::Chunked(_) if dataset.filters.is_empty() => {
            format!("{}, in chunks", part.stored_as)
        }
        Layout::Chunked(_) => format!("{}, in packed chunks", part.stored_as),
        _ => part.stored_as.clone(),
    }
}
