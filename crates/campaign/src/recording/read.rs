//! One impact's recording: channels of a file → channels in SI units.

use crate::error::CampaignError;
use crate::recording::find_channel::find_channel;
use crate::settings::files::fill_placeholders;
use crate::settings::model::{ChannelPlan, FilePlan, ImpactEntry, TimePlan};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use windfall_files::error::{Error, Place};
use windfall_files::inputs::protect;
use windfall_files::text::column_role::seconds_per_unit;
use windfall_formats::contents::{Contents, TimeBase};
use windfall_formats::open::open;
use windfall_signal::recording::{Channel, Recording, Times};

/// Where the recording of an impact is.
pub fn recording_path(files: &FilePlan, impact: &ImpactEntry) -> PathBuf {
    files.directory.join(&impact.file)
}

/// Reads the campaign's channels of an impact, out of a file of any format.
///
/// A blank cell means that its channel has no sample in that row; so do NaN at
/// the end of a channel of another format, which programs write to fill up
/// channels of different lengths.
///
/// # Errors
/// The file cannot be read, one of the channels is not in it, a sample is not
/// finite or has no time, or nothing says when samples were taken.
pub fn read_recording(files: &FilePlan, impact: &ImpactEntry) -> Result<Recording, Error> {
    let path = recording_path(files, impact);
    protect(&path);
    let mut reader = open(&path, &files.open).map_err(Error::Format)?;
    let contents = reader.contents().clone();
    let sources = files
        .channels
        .iter()
        .map(|plan| source_of(files, plan, impact, &path, &contents))
        .collect::<Result<Vec<_>, _>>()?;

    // Every channel once, also where two sources share their times.
    let used = sources.iter().flat_map(|source| {
        let time = match source.clock {
            Clock::Channel { index, .. } => Some(index),
            Clock::Uniform { .. } => None,
        };
        [Some(source.index), time].into_iter().flatten()
    });
    let wanted: Vec<usize> = used.collect::<BTreeSet<_>>().into_iter().collect();
    let columns = reader.read_whole(&wanted).map_err(Error::Format)?;
    let column = |index: usize| match wanted.binary_search(&index) {
        Ok(place) => columns[place].as_slice(),
        Err(_) => &[],
    };
    let channels = sources
        .iter()
        .map(|source| channel_of(source, column, &contents, &path))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Recording {
        name: impact.file.clone(),
        channels,
    })
}

/// A channel of the campaign and where it is in this file.
struct Source<'a> {
    plan: &'a ChannelPlan,
    index: usize,
    clock: Clock,
}

/// When the rows of a channel were.
#[derive(Clone, Copy)]
enum Clock {
    Uniform { start: f64, interval: f64 },
    Channel { index: usize, scale: f64 },
}

fn source_of<'a>(
    files: &FilePlan,
    plan: &'a ChannelPlan,
    impact: &ImpactEntry,
    path: &Path,
    contents: &Contents,
) -> Result<Source<'a>, Error> {
    let fill = |text: &str| {
        fill_placeholders(text, &impact.cells).map_err(|name| {
            Error::from(CampaignError::PlaceholderUnknown {
                place: Place::at(path, 0),
                text: text.to_owned(),
                name,
            })
        })
    };
    let asked_by = match plan.line {
        0 => format!(" (asked for as {})", plan.table),
        line => format!(" (campaign.toml, line {line}, {})", plan.table),
    };
    let find = |text: &str| find_channel(contents, &fill(text)?, path, &asked_by);
    let index = find(&plan.column)?;
    let named = match (&plan.time, &files.time) {
        (Some(own), _) => Some(own),
        (None, TimePlan::Column(shared)) => Some(shared),
        (None, _) => None,
    };
    let clock = match (named, &files.time) {
        (Some(name), _) => Clock::Channel {
            index: find(name)?,
            scale: files.time_scale,
        },
        (None, TimePlan::Rate(rate)) => Clock::Uniform {
            start: 0.0,
            interval: 1.0 / rate,
        },
        (None, _) => clock_in_file(contents, index, path)?,
    };
    Ok(Source { plan, index, clock })
}

/// The times that the file itself gives for a channel.
fn clock_in_file(contents: &Contents, index: usize, path: &Path) -> Result<Clock, Error> {
    match contents.channels[index].time {
        TimeBase::Uniform { start, interval } => Ok(Clock::Uniform { start, interval }),
        TimeBase::Channel(at) => Ok(Clock::Channel {
            index: at,
            scale: seconds_per_unit(&contents.channels[at]),
        }),
        TimeBase::Unknown => Err(Error::from(CampaignError::TimesUnknown {
            path: path.to_path_buf(),
            column: contents.channels[index].name.clone(),
        })),
    }
}

fn channel_of<'a>(
    source: &Source,
    column: impl Fn(usize) -> &'a [f64],
    contents: &Contents,
    path: &Path,
) -> Result<Channel, Error> {
    let plan = source.plan;
    let name = &contents.channels[source.index].name;
    let cells = without_filling(column(source.index));
    if cells.iter().all(|cell| cell.is_nan()) {
        return Err(Error::from(CampaignError::ColumnBlank {
            path: path.to_path_buf(),
            column: name.clone(),
        }));
    }
    check_finite(cells, contents, source.index, path)?;
    let present = || cells.iter().enumerate().filter(|(_, cell)| !cell.is_nan());
    let times = match source.clock {
        Clock::Channel { index, scale } => {
            let times = column(index);
            let listed = present().map(|(row, _)| match times.get(row) {
                Some(time) if !time.is_nan() => Ok(time * scale - plan.delay),
                _ => Err(Error::from(CampaignError::SampleWithoutTime {
                    place: Place::at(path, 0),
                    sample: row,
                    column: name.clone(),
                    time: contents.channels[index].name.clone(),
                })),
            });
            Times::Listed(listed.collect::<Result<_, _>>()?)
        }
        Clock::Uniform { start, interval } => {
            let start = start - plan.delay;
            match cells.iter().any(|cell| cell.is_nan()) {
                // Rows without a sample leave a gap.
                true => {
                    let times = present().map(|(row, _)| start + row as f64 * interval);
                    Times::Listed(times.collect())
                }
                false => Times::Uniform { start, interval },
            }
        }
    };
    Ok(Channel {
        name: name.clone(),
        quantity: plan.quantity,
        times,
        samples: present()
            .map(|(_, cell)| plan.scale * (cell - plan.offset))
            .collect(),
    })
}

/// The samples up to the last that is a number.
fn without_filling(cells: &[f64]) -> &[f64] {
    let last = cells.iter().rposition(|cell| !cell.is_nan());
    &cells[..last.map_or(0, |last| last + 1)]
}

/// Refuses NaN and infinity; in a text file NaN is a blank cell.
fn check_finite(
    cells: &[f64],
    contents: &Contents,
    index: usize,
    path: &Path,
) -> Result<(), Error> {
    let blank = contents.format.has_blank_cells();
    let bad = |cell: &f64| cell.is_infinite() || (cell.is_nan() && !blank);
    match cells.iter().position(bad) {
        None => Ok(()),
        Some(sample) => Err(Error::from(CampaignError::SampleNotFinite {
            path: path.to_path_buf(),
            column: contents.channels[index].name.clone(),
            sample,
            value: cells[sample],
        })),
    }
}
