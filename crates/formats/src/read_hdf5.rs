//! HDF5 files, and those of MATLAB 7.3, which are HDF5 too.

use crate::array_channels::list_channels;
use crate::array_pass::Pass;
use crate::array_tree::Series;
use crate::contents::{Contents, Format};
use crate::error::{Error, Place};
use crate::hdf5_blocks::{Stop, each_block};
use crate::hdf5_number::{Number, Numbers};
use crate::hdf5_storage::{error_of, open_file};
use crate::hdf5_tree::{Stored, list};
use crate::reader::{Reader, Sink};
use crate::source::Source;
use hdf5_reader::Dataset;
use std::sync::Arc;

/// What an HDF5 file begins with, at byte 0 or behind what another program put
/// before it: at 512, 1024, 2048 and so on.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// An HDF5 file.
pub struct Hdf5Reader {
    source: Arc<Source>,
    contents: Contents,
    series: Vec<Series>,
    stored: Vec<Stored>,
    datasets: Vec<Dataset>,
}

/// Whether a file begins like an HDF5 file.
pub(crate) fn begins(head: &[u8]) -> bool {
    [0, 512, 1024, 2048].iter().any(|at| {
        head.get(*at..)
            .is_some_and(|rest| rest.starts_with(SIGNATURE))
    })
}

impl Hdf5Reader {
    /// Lists what a file holds.
    ///
    /// # Errors
    /// The file cannot be read, is no HDF5 file, or its root is damaged.
    pub fn open(source: Source) -> Result<Self, Error> {
        if source.length() == 0 {
            return Err(Error::Empty {
                path: source.path().to_path_buf(),
                expected: "a recording",
            });
        }
        let source = Arc::new(source);
        let file = open_file(source.clone())?;
        let root = file
            .root_group()
            .map_err(|fault| error_of(source.path(), Place::File, fault))?;
        let found = list(&source, &root)?;
        let mut properties = Vec::new();
        let head = source.head(116)?;
        if head.starts_with(b"MATLAB") {
            let text = String::from_utf8_lossy(&head);
            let text = text.trim_matches(['\0', ' ']).to_owned();
            properties.push(("description".to_owned(), text));
        }
        let variant = match found.by_matlab || head.starts_with(b"MATLAB") {
            true => "MATLAB v7.3".to_owned(),
            false => format!("superblock {}", file.superblock().version),
        };
        let listing = list_channels(found.tree);
        properties.extend(found.properties);
        properties.extend(listing.properties);
        Ok(Self {
            source,
            contents: Contents {
                format: Format::Hdf5,
                variant,
                channels: listing.channels,
                properties,
                notes: listing.notes,
            },
            series: listing.series,
            stored: found.stored,
            datasets: found.datasets,
        })
    }

    /// Reads those channels that are in one dataset.
    fn read_dataset(&self, at: usize, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let mut arrays: Vec<usize> = wanted.iter().map(|&c| self.series[c].array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        arrays.retain(|&array| self.stored[array].dataset == at);
        let mut passes: Vec<(usize, Pass)> = arrays
            .iter()
            .map(|&array| (array, Pass::new(array, wanted, &self.series)))
            .collect();
        let ranges = passes.iter().map(|(_, pass)| pass.range());
        let range = ranges
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((0, 0));
        let dataset = &self.datasets[at];
        let simple = arrays.first().is_some_and(|&a| self.stored[a].parts == 1);
        let mut numbers = Vec::new();
        let read = if simple && is_number(dataset) {
            each_block(dataset, range, &mut |first, block: Vec<Number>| {
                let numbers: Vec<f64> = block.into_iter().map(|n| n.0).collect();
                let mut taken = passes.iter_mut();
                taken.try_for_each(|(_, pass)| pass.take(first, &numbers, sink))
            })
        } else {
            each_block(dataset, range, &mut |first, block: Vec<Numbers>| {
                for (array, pass) in &mut passes {
                    let part = self.stored[*array].part;
                    numbers.clear();
                    // All elements have as many numbers as their type.
                    numbers.extend(block.iter().filter_map(|n| n.0.get(part)));
                    pass.take(first, &numbers, sink)?;
                }
                Ok(())
            })
        };
        read.map_err(|stop| match stop {
            Stop::Asked(error) => error,
            Stop::Fault(fault) => {
                let name = |c: &&usize| self.stored[self.series[**c].array].dataset == at;
                let channel = wanted.iter().find(name).copied().unwrap_or(0);
                let name = self.contents.channels[channel].name.clone();
                error_of(self.source.path(), Place::Object(name), fault)
            }
        })
    }
}

/// Whether the elements of a dataset are numbers, not compounds or arrays of them.
fn is_number(dataset: &Dataset) -> bool {
    !matches!(
        dataset.dtype(),
        hdf5_reader::Datatype::Compound { .. } | hdf5_reader::Datatype::Array { .. }
    )
}

impl Reader for Hdf5Reader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let mut datasets: Vec<usize> = wanted
            .iter()
            .map(|&channel| self.stored[self.series[channel].array].dataset)
            .collect();
        datasets.sort_unstable();
        datasets.dedup();
        for dataset in datasets {
            self.read_dataset(dataset, wanted, sink)?;
        }
        Ok(())
    }
}
