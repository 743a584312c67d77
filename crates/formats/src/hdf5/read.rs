//! HDF5 files, including MATLAB 7.3.

use crate::arrays::channels::list_channels;
use crate::arrays::pass::Pass;
use crate::arrays::tree::Series;
use crate::contents::{Contents, Format, Note};
use crate::hdf5::blocks::each_block;
use crate::hdf5::dataset::Dataset;
use crate::hdf5::file::{self, Hdf5File};
use crate::hdf5::number::{Number, decode};
use crate::hdf5::tree::{Stored, list};
use crate::reader::{Reader, Sink};
use windfall_source::error::Error;
use windfall_source::source::Source;

#[derive(Debug)]
pub struct Hdf5Reader {
    file: Hdf5File,
    contents: Contents,
    series: Vec<Series>,
    stored: Vec<Stored>,
    datasets: Vec<Dataset>,
}

/// Whether a file starts like an HDF5 file.
pub(crate) fn begins(head: &[u8]) -> bool {
    file::begins(head)
}

impl Hdf5Reader {
    /// Lists the contents of a file; unreadable objects are left out with a note.
    pub fn open(source: Source) -> Result<Self, Error> {
        let file = Hdf5File::open(source)?;
        let length = file.source.length();
        let found = list(&file);
        if found.is_err() && file.end > length {
            let what = "the complete file";
            return Err(file.source.truncated(0, what, file.end));
        }
        let mut found = found?;
        if file.end > length {
            found.tree.notes.push(Note::CutOff(format!(
                "{} bytes were written, {length} are there",
                file.end
            )));
        }
        let mut properties = Vec::new();
        let head = file.source.head(116)?;
        let by_matlab = found.by_matlab || head.starts_with(b"MATLAB");
        if head.starts_with(b"MATLAB") {
            let text = String::from_utf8_lossy(&head);
            let text = text.trim_matches(['\0', ' ']).to_owned();
            properties.push(("description".to_owned(), text));
        }
        let variant = match by_matlab {
            true => "MATLAB v7.3".to_owned(),
            false => format!("superblock {}", file.version),
        };
        let listing = list_channels(found.tree);
        properties.extend(found.properties);
        properties.extend(listing.properties);
        Ok(Self {
            file,
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

    /// Reads the channels within one dataset.
    fn read_dataset(
        &mut self,
        at: usize,
        wanted: &[usize],
        sink: &mut dyn Sink,
    ) -> Result<(), Error> {
        let mut arrays: Vec<usize> = wanted.iter().map(|&c| self.series[c].array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        arrays.retain(|&array| self.stored[array].dataset == at);
        let mut passes: Vec<(Number, Pass)> = arrays
            .iter()
            .map(|&array| {
                (
                    self.stored[array].number,
                    Pass::new(array, wanted, &self.series),
                )
            })
            .collect();
        let ranges = passes.iter().map(|(_, pass)| pass.range());
        let range = ranges
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((0, 0));
        let dataset = &mut self.datasets[at];
        let element = dataset.datatype.size;
        let mut numbers = Vec::new();
        let read = each_block(&self.file, dataset, range, &mut |first, bytes| {
            for (number, pass) in &mut passes {
                numbers.clear();
                decode(bytes, element, *number, &mut numbers);
                pass.take(first, &numbers, sink)?;
            }
            Ok(())
        });
        dataset.forget();
        read.map_err(|problem| {
            let here = |c: &&usize| self.stored[self.series[**c].array].dataset == at;
            let channel = wanted.iter().find(here).copied().unwrap_or(0);
            self.file
                .error(&self.contents.channels[channel].name, problem)
        })
    }
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
