//! MATLAB files of versions 4 to 7. For version 7.3 see `hdf5::read`.

use crate::arrays::channels::list_channels;
use crate::arrays::pass::Pass;
use crate::arrays::tree::Series;
use crate::contents::{Contents, Format};
use crate::mat::flow::{Flow, Region};
use crate::mat::stored::Stored;
use crate::mat::{version4, version5};
use crate::reader::{Reader, Sink};
use windfall_source::error::Error;
use windfall_source::source::Source;

/// Numbers read at a time.
const BLOCK: u64 = 1 << 16;

/// A MATLAB file of version 4 to 7.
#[derive(Debug)]
pub struct MatReader {
    source: Source,
    contents: Contents,
    series: Vec<Series>,
    stored: Vec<Stored>,
}

/// Whether a file starts like a MATLAB file of versions 4 to 7.
pub(crate) fn begins(head: &[u8]) -> bool {
    version5::begins(head) || version4::begins(head)
}

impl MatReader {
    pub fn open(source: Source) -> Result<Self, Error> {
        let mut properties = Vec::new();
        let head = source.head(128)?;
        let version_4 = !version5::begins(&head) && version4::begins(&head);
        let (found, variant) = match version_4 {
            true => (version4::list(&source)?, "v4".to_owned()),
            false => {
                let header = version5::read_header(&source)?;
                let (found, compressed) = version5::list(&source, &header)?;
                properties.push(("description".to_owned(), header.description));
                let version = if compressed { "v7" } else { "v5" };
                (found, version.to_owned())
            }
        };
        let big_endian = found.stored.first().is_some_and(|s| s.big_endian);
        let variant = variant + if big_endian { ", big-endian" } else { "" };
        let listing = list_channels(found.tree);
        properties.extend(listing.properties);
        Ok(Self {
            source,
            contents: Contents {
                format: Format::Mat,
                variant,
                channels: listing.channels,
                properties,
                notes: listing.notes,
            },
            series: listing.series,
            stored: found.stored,
        })
    }
}

impl Reader for MatReader {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(&mut self, wanted: &[usize], sink: &mut dyn Sink) -> Result<(), Error> {
        let mut arrays: Vec<usize> = wanted.iter().map(|&c| self.series[c].array).collect();
        arrays.sort_unstable();
        arrays.dedup();
        let mut open: Option<(Region, Flow<'_>)> = None;
        for array in arrays {
            let stored = self.stored[array];
            // Arrays of one variable share a flow, as they are in order.
            let flow = match open.take() {
                Some((region, flow)) if region == stored.region => flow,
                _ => Flow::new(&self.source, stored.region),
            };
            let (_, flow) = open.insert((stored.region, flow));
            let mut pass = Pass::new(array, wanted, &self.series);
            read_array(flow, stored, &mut pass, sink)?;
        }
        Ok(())
    }
}

fn read_array(
    flow: &mut Flow<'_>,
    stored: Stored,
    pass: &mut Pass,
    sink: &mut dyn Sink,
) -> Result<(), Error> {
    let size = stored.number.size();
    let (mut at, end) = pass.range();
    let mut numbers = Vec::new();
    let mut bytes = Vec::new();
    while at < end {
        let count = (end - at).min(BLOCK);
        bytes.resize((count * size) as usize, 0);
        flow.read_at(stored.at + at * size, &mut bytes)?;
        numbers.resize(count as usize, 0.0);
        let layout = stored.number.packed(stored.big_endian);
        stored.number.decode(&bytes, layout, &mut numbers);
        pass.take(at, &numbers, sink)?;
        at += count;
    }
    if end == stored.count && stored.closes {
        flow.finish()?;
    }
    Ok(())
}
