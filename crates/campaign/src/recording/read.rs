//! One impact's recording: channels of a file → channels in SI units.

use crate::error::CampaignError;
use crate::recording::find_channel::find_channel;
use crate::settings::files::fill_placeholders;
use crate::settings::model::{ChannelPlan, FilePlan, ImpactEntry, TimePlan};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use windfall_files::confined::named_file;
use windfall_files::error::{Error, Place};
use windfall_files::inputs::protect;
use windfall_files::text::column_role::seconds_per_unit;
use windfall_formats::contents::{Contents, Note, TimeBase};
use windfall_formats::open::{open, open_source};
use windfall_formats::reader::is_missing;
use windfall_signal::recording::{Channel, Missing, Quantity, Recording, Times};
use windfall_source::source::Source as Bytes;

/// Where the recording of an impact is.
pub fn recording_path(files: &FilePlan, impact: &ImpactEntry) -> PathBuf {
    files.directory.join(&impact.file)
}

/// [`recording_path`] of a recording that may be read.
///
/// # Errors
/// It lies outside of the campaign and of the directories that the user named, or is a pipe
/// or a device.
pub fn recording_file(files: &FilePlan, impact: &ImpactEntry) -> Result<PathBuf, Error> {
    let Some(within) = &files.within else {
        return Ok(recording_path(files, impact));
    };
    named_file(&files.directory, &impact.file, within).map_err(|problem| {
        Error::from(CampaignError::RecordingRefused {
            place: Place::at(Path::new("impacts.csv"), impact.line),
            file: impact.file.clone(),
            problem,
        })
    })
}

/// Reads the campaign's channels of an impact, out of a file of any format.
///
/// A blank cell means that its channel has no sample in that row; so do NaN at
/// the end of a channel of another format, which programs write to fill up
/// channels of different lengths.
///
/// # Errors
/// As [`read_with_gaps`]; a sample in the range of the entry is missing; nothing shows
/// whether a mark stands before decimals.
pub fn read_recording(files: &FilePlan, impact: &ImpactEntry) -> Result<Recording, Error> {
    let recording = read_with_gaps(files, impact)?;
    let path = || recording_path(files, impact);
    if let Some(doubt) = recording.doubts.first() {
        return Err(Error::from(CampaignError::DecimalOrThousands {
            path: path(),
            doubt: doubt.clone(),
        }));
    }
    let from = impact.from.unwrap_or(f64::NEG_INFINITY);
    let to = impact.to.unwrap_or(f64::INFINITY);
    for missing in &recording.missing {
        let mut inside = missing
            .times
            .iter()
            .filter(|time| (from..=to).contains(*time));
        if let Some(&at) = inside.next() {
            return Err(Error::from(CampaignError::SampleMissing {
                path: path(),
                column: missing.channel.clone(),
                samples: 1 + inside.count(),
                at,
                first: missing.first.clone(),
            }));
        }
    }
    Ok(recording)
}

/// [`read_recording`] of which samples may be missing: it says when.
///
/// # Errors
/// The file may not or cannot be read, one of the channels is not in it, a sample has no time,
/// or nothing says when samples were taken.
pub fn read_with_gaps(files: &FilePlan, impact: &ImpactEntry) -> Result<Recording, Error> {
    let path = recording_file(files, impact)?;
    let reader = match &files.held {
        Some(held) => open_source(Bytes::of_bytes(&path, Arc::clone(held)), &files.open),
        None => {
            protect(&path);
            open(&path, &files.open)
        }
    };
    let mut reader = reader.map_err(Error::Format)?;
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
    // What reading itself has found out is in the notes by now.
    let contents = reader.contents();
    let channels = sources
        .iter()
        .map(|source| {
            let other = other_phase(source.plan.quantity);
            let other = sources.iter().find(|s| Some(s.plan.quantity) == other);
            let other = other.map_or(&[][..], |other| column(other.index));
            channel_of((source, other), column, contents, &path)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let (channels, missing): (Vec<_>, Vec<_>) = channels.into_iter().unzip();
    let doubts = contents.notes.iter().filter_map(|note| match note {
        Note::DecimalOrThousands(doubt) => Some(doubt.clone()),
        _ => None,
    });
    Ok(Recording {
        name: impact.file.clone(),
        channels,
        missing: missing.into_iter().flatten().collect(),
        doubts: doubts.collect(),
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

/// The phase of an encoder without which a sample of this one says nothing.
fn other_phase(quantity: Quantity) -> Option<Quantity> {
    match quantity {
        Quantity::PhaseA => Some(Quantity::PhaseB),
        Quantity::PhaseB => Some(Quantity::PhaseA),
        _ => None,
    }
}

/// * `other`: samples of the other phase of an encoder
fn channel_of<'a>(
    (source, other): (&Source, &[f64]),
    column: impl Fn(usize) -> &'a [f64],
    contents: &Contents,
    path: &Path,
) -> Result<(Channel, Option<Missing>), Error> {
    let plan = source.plan;
    let name = &contents.channels[source.index].name;
    let cells = without_filling(column(source.index));
    // In a text file any other NaN is a blank cell.
    let blanks = contents.format.has_blank_cells();
    let dirty = |cell: f64| cell.is_infinite() || is_missing(cell) || (cell.is_nan() && !blanks);
    let times = match source.clock {
        Clock::Channel { index, .. } => column(index),
        Clock::Uniform { .. } => &[],
    };
    let time_at = |row: usize| match source.clock {
        Clock::Channel { scale, .. } => {
            times.get(row).copied().unwrap_or(f64::NAN) * scale - plan.delay
        }
        Clock::Uniform { start, interval } => start - plan.delay + row as f64 * interval,
    };
    let scaled = |cell: f64| plan.scale * (cell - plan.offset);
    let all = |cells: &[f64]| cells.iter().all(|cell| cell.is_finite());
    if let Clock::Uniform { start, interval } = source.clock
        && !cells.is_empty()
        && all(cells)
        && all(other)
    {
        let channel = Channel {
            name: name.clone(),
            quantity: plan.quantity,
            times: Times::Uniform {
                start: start - plan.delay,
                interval,
            },
            samples: cells.iter().map(|cell| scaled(*cell)).collect(),
        };
        return Ok((channel, None));
    }
    let (mut samples, mut listed, mut lost) = (Vec::new(), Vec::new(), Vec::new());
    for (row, &cell) in cells.iter().enumerate() {
        let time_lost = times.get(row).is_some_and(|time| dirty(*time));
        let other_lost = other.get(row).is_some_and(|other| dirty(*other));
        if dirty(cell) || ((time_lost || other_lost) && !cell.is_nan()) {
            lost.push(row);
            continue;
        }
        if cell.is_nan() {
            continue;
        }
        let time = time_at(row);
        if let Clock::Channel { index, .. } = source.clock
            && time.is_nan()
        {
            return Err(Error::from(CampaignError::SampleWithoutTime {
                place: Place::at(path, 0),
                sample: row,
                column: name.clone(),
                time: contents.channels[index].name.clone(),
            }));
        }
        listed.push(time);
        samples.push(scaled(cell));
    }
    if samples.is_empty() {
        return Err(Error::from(CampaignError::ColumnBlank {
            path: path.to_path_buf(),
            column: name.clone(),
        }));
    }
    let times = match source.clock {
        Clock::Uniform { start, interval } if samples.len() == cells.len() => Times::Uniform {
            start: start - plan.delay,
            interval,
        },
        // Rows without a sample leave a gap.
        _ => Times::Listed(listed),
    };
    let missing = (!lost.is_empty()).then(|| Missing {
        channel: name.clone(),
        times: lost.iter().map(|row| near_time(*row, time_at)).collect(),
        first: first_missing(source, contents, lost[0], cells[lost[0]]),
    });
    let channel = Channel {
        name: name.clone(),
        quantity: plan.quantity,
        times,
        samples,
    };
    Ok((channel, missing))
}

/// Time of a row; of one whose own time is missing, that of the row before.
fn near_time(row: usize, time_at: impl Fn(usize) -> f64) -> f64 {
    let mut times = (0..=row).rev().map(time_at);
    times
        .find(|time| time.is_finite())
        .unwrap_or(f64::NEG_INFINITY)
}

/// What stands in place of the first missing sample of a channel, and where.
fn first_missing(source: &Source, contents: &Contents, row: usize, cell: f64) -> String {
    let mut columns = vec![source.index];
    if let Clock::Channel { index, .. } = source.clock {
        columns.push(index);
    }
    let names = columns.iter().map(|index| &contents.channels[*index].name);
    let mut told = names.filter_map(|name| {
        contents.notes.iter().find_map(|note| match note {
            Note::Missing {
                column, line, word, ..
            } if column == name => Some(format!("\"{word}\" in line {line}")),
            _ => None,
        })
    });
    told.next().unwrap_or_else(|| match cell.is_finite() {
        true => format!("its time or the other phase is missing at sample {row}"),
        false => format!("{cell} as sample {row}"),
    })
}

/// The samples up to the last that is a number, or should be one.
fn without_filling(cells: &[f64]) -> &[f64] {
    let last = cells
        .iter()
        .rposition(|cell| !cell.is_nan() || is_missing(*cell));
    &cells[..last.map_or(0, |last| last + 1)]
}
