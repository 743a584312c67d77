//! Reads arrays of NumPy.

use crate::arrays::channels::list_channels;
use crate::arrays::pass::Pass;
use crate::arrays::tree::{Array, BEGINNING, Series, Tree, count, first_fastest, last_fastest};
use crate::contents::{Contents, Format};
use crate::npy::data_type::{Field, fields};
use crate::npy::header::{Header, MAGIC, read_header};
use crate::number::{Layout, Number};
use crate::reader::{Reader, Sink};
use crate::zip::entries::{Entry, check_sizes, open_archive, read_entry};
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes read at a time, unless one element is larger.
const BLOCK: u64 = 1 << 20;

/// Largest element; bytes.
const LARGEST: u64 = 1 << 20;

/// Arrays of NumPy.
#[derive(Debug)]
pub struct NpyReader {
    sources: Vec<Source>,
    contents: Contents,
    series: Vec<Series>,
    stored: Vec<Stored>,
}

/// Where the numbers of an array are.
#[derive(Clone, Copy, Debug)]
struct Stored {
    source: usize,
    /// First byte of the first element.
    data: u64,
    /// Bytes of an element, and where the number stands in it.
    size: u64,
    offset: u64,
    number: Number,
    big_endian: bool,
}

/// Whether a file is a single array.
pub(crate) fn begins(head: &[u8]) -> bool {
    head.starts_with(MAGIC)
}

impl NpyReader {
    /// Opens a single array or an archive of arrays.
    pub fn open(source: Source) -> Result<Self, Error> {
        let mut tree = Tree::default();
        let mut stored = Vec::new();
        if begins(&source.head(16)?) {
            let header = read_header(&source)?;
            let variant = format!(
                "one array, version {}.{}",
                header.version.0, header.version.1
            );
            list(&source, 0, None, &header, &mut tree, &mut stored)?;
            return Ok(Self::of(vec![source], variant, tree, stored));
        }
        let (archive, entries) = open_archive(source)?;
        let arrays = entries.iter().filter(|entry| entry.name.ends_with(".npy"));
        let arrays: Vec<&Entry> = arrays.collect();
        check_sizes(&archive, &arrays)?;
        let mut sources = Vec::new();
        for entry in arrays {
            let name = entry.name.trim_end_matches(".npy");
            let path = format!("{}/{name}", archive.get_ref().path().display());
            let array = Source::from_bytes(&path, read_entry(&archive, entry)?);
            let header = read_header(&array)?;
            list(
                &array,
                sources.len(),
                Some(name),
                &header,
                &mut tree,
                &mut stored,
            )?;
            sources.push(array);
        }
        let variant = format!("archive of {} array(s)", sources.len());
        Ok(Self::of(sources, variant, tree, stored))
    }

    fn of(sources: Vec<Source>, variant: String, tree: Tree, stored: Vec<Stored>) -> Self {
        let listing = list_channels(tree);
        Self {
            sources,
            contents: Contents {
                format: Format::Npy,
                variant,
                channels: listing.channels,
                properties: listing.properties,
                notes: listing.notes,
            },
            series: listing.series,
            stored,
        }
    }
}

/// Adds the arrays in a file to those that were found before.
///
/// * `name`: of the file in its archive
fn list(
    source: &Source,
    at: usize,
    name: Option<&str>,
    header: &Header,
    tree: &mut Tree,
    stored: &mut Vec<Stored>,
) -> Result<(), Error> {
    let path = |field: &Field| {
        let mut path: Vec<String> = name.map(str::to_owned).into_iter().collect();
        path.extend(field.path.iter().cloned());
        if path.is_empty() {
            path.push("array".to_owned());
        }
        path
    };
    let known = fields(&header.descr).filter(|(_, size)| *size <= LARGEST);
    let Some((fields, size)) = known else {
        let whole = vec![name.unwrap_or("array").to_owned()];
        tree.leave_out(&whole, "it holds objects of Python or an unknown type");
        return Ok(());
    };
    let extents = match header.fortran {
        true => first_fastest(&header.shape),
        false => last_fastest(&header.shape),
    };
    let elements = count(&extents);
    let needed = elements.saturating_mul(size);
    if needed > source.length().saturating_sub(header.data) {
        return Err(source.truncated(header.data, "the array", needed));
    }
    for field in fields {
        let (number, big_endian) = match field.number {
            Ok(number) => number,
            Err(why) => {
                tree.leave_out(&path(&field), why);
                continue;
            }
        };
        let place = Stored {
            source: at,
            data: header.data,
            size,
            offset: field.offset,
            number,
            big_endian,
        };
        let step = extents.first().map_or(1, |extent| extent.step);
        let first: u64 = match extents.len() {
            2 => extents[0].length.min(BEGINNING),
            _ => 0,
        };
        let first = if elements == 0 { 0 } else { first };
        let beginning = (0..first).map(|row| one(source, place, row * step));
        tree.arrays.push(Array {
            path: path(&field),
            part: field.part,
            stored_as: field.written,
            value: match elements {
                1 => Some(one(source, place, 0)?),
                _ => None,
            },
            beginning: beginning.collect::<Result<_, Error>>()?,
            extents: extents.clone(),
            unit: None,
            properties: Vec::new(),
        });
        stored.push(place);
    }
    Ok(())
}

/// One number of an array.
fn one(source: &Source, place: Stored, element: u64) -> Result<f64, Error> {
    let at = place.data + element * place.size + place.offset;
    let bytes = source.bytes_at(at, place.number.size())?;
    Ok(place.number.decode_all(&bytes, place.big_endian)[0])
}

impl Reader for NpyReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let mut arrays: Vec<usize> = wanted.iter().map(|&c| self.series[c].array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        let (mut bytes, mut numbers) = (Vec::new(), Vec::new());
        for array in arrays {
            let place = self.stored[array];
            let source = &self.sources[place.source];
            let mut pass = Pass::new(array, wanted, &self.series);
            let (mut at, end) = pass.range();
            while at < end {
                let many = (end - at).min((BLOCK / place.size).max(1));
                bytes.resize((many * place.size) as usize, 0);
                source.read_at(place.data + at * place.size, &mut bytes)?;
                numbers.resize(many as usize, 0.0);
                let layout = Layout {
                    offset: place.offset as usize,
                    stride: place.size as usize,
                    big_endian: place.big_endian,
                };
                place.number.decode(&bytes, layout, &mut numbers);
                pass.take(at, &numbers, sink)?;
                at += many;
            }
        }
        Ok(())
    }
}
