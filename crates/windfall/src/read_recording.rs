//! One impact's recording: columns of a CSV file → channels in SI units.

use crate::campaign::{ChannelPlan, FilePlan, ImpactEntry, TimePlan};
use crate::error::{Error, Place};
use crate::read_csv::read_numbers;
use crate::read_files::fill_placeholders;
use std::path::{Path, PathBuf};
use windfall_signal::recording::{Channel, Recording, Times};

/// Where the recording of an impact is.
#[must_use]
pub fn recording_path(files: &FilePlan, impact: &ImpactEntry) -> PathBuf {
    files.directory.join(&impact.file)
}

/// Reads the recording of an impact in one pass over its file.
///
/// A blank cell means that its channel has no sample in that row.
///
/// # Errors
/// The file or one of the columns is not there, a cell is no finite number, a
/// sample has no time.
pub fn read_recording(files: &FilePlan, impact: &ImpactEntry) -> Result<Recording, Error> {
    let path = recording_path(files, impact);
    let sources = files
        .channels
        .iter()
        .map(|plan| source_of(files, plan, impact, &path))
        .collect::<Result<Vec<_>, _>>()?;
    let (columns, asked_by) = columns_of(&sources);
    let numbers = read_numbers(&path, &columns, &asked_by)?.columns;
    let column = |name: &str| {
        let index = columns
            .iter()
            .position(|known| known == name)
            .unwrap_or_default();
        numbers[index].as_slice()
    };
    let channels = sources
        .iter()
        .map(|source| {
            let samples = column(&source.column);
            let times = source
                .time
                .as_ref()
                .map(|name| (name.as_str(), column(name)));
            channel_of(files, source, samples, times, &path)
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Recording {
        name: impact.file.clone(),
        channels,
    })
}

/// A channel with the names of its columns in this file.
struct Source<'a> {
    plan: &'a ChannelPlan,
    column: String,
    time: Option<String>,
}

fn source_of<'a>(
    files: &FilePlan,
    plan: &'a ChannelPlan,
    impact: &ImpactEntry,
    path: &Path,
) -> Result<Source<'a>, Error> {
    let fill = |text: &str| {
        fill_placeholders(text, &impact.cells).map_err(|name| Error::PlaceholderUnknown {
            place: Place {
                file: path.to_path_buf(),
                line: 0,
            },
            text: text.to_owned(),
            name,
        })
    };
    let time = match (&plan.time, &files.time) {
        (Some(own), _) => Some(fill(own)?),
        (None, TimePlan::Column(shared)) => Some(fill(shared)?),
        (None, TimePlan::Rate(_) | TimePlan::OfChannels) => None,
    };
    Ok(Source {
        plan,
        column: fill(&plan.column)?,
        time,
    })
}

/// Each column once, with who asks for it.
fn columns_of(sources: &[Source]) -> (Vec<String>, Vec<String>) {
    let mut columns: Vec<String> = Vec::new();
    let mut asked_by = Vec::new();
    for source in sources {
        for name in [Some(&source.column), source.time.as_ref()]
            .into_iter()
            .flatten()
        {
            if !columns.contains(name) {
                columns.push(name.clone());
                asked_by.push(match source.plan.line {
                    0 => format!(" (asked for as {})", source.plan.table),
                    line => format!(" (campaign.toml, line {line}, {})", source.plan.table),
                });
            }
        }
    }
    (columns, asked_by)
}

fn channel_of(
    files: &FilePlan,
    source: &Source,
    cells: &[Option<f64>],
    times: Option<(&str, &[Option<f64>])>,
    path: &Path,
) -> Result<Channel, Error> {
    let plan = source.plan;
    let calibrated = |cell: f64| plan.scale * (cell - plan.offset);
    let samples: Vec<f64> = cells
        .iter()
        .flatten()
        .map(|cell| calibrated(*cell))
        .collect();
    if samples.is_empty() {
        let column = source.column.clone();
        return Err(Error::ColumnBlank {
            path: path.to_path_buf(),
            column,
        });
    }
    let times = match (times, &files.time) {
        (Some((name, times)), _) => listed_times(files, source, cells, name, times, path)?,
        (None, TimePlan::Rate(rate)) => counted_times(cells, *rate, plan.delay),
        // A plan without a rate has a column of times.
        (None, TimePlan::Column(_) | TimePlan::OfChannels) => Times::Listed(Vec::new()),
    };
    Ok(Channel {
        name: source.column.clone(),
        quantity: plan.quantity,
        times,
        samples,
    })
}

fn listed_times(
    files: &FilePlan,
    source: &Source,
    cells: &[Option<f64>],
    name: &str,
    times: &[Option<f64>],
    path: &Path,
) -> Result<Times, Error> {
    let mut listed = Vec::with_capacity(cells.len());
    for (row, (cell, time)) in cells.iter().zip(times).enumerate() {
        match (cell, time) {
            (None, _) => {}
            (Some(_), Some(time)) => listed.push(time * files.time_scale - source.plan.delay),
            (Some(_), None) => {
                return Err(Error::SampleWithoutTime {
                    place: Place {
                        file: path.to_path_buf(),
                        line: 0,
                    },
                    sample: row,
                    column: source.column.clone(),
                    time: name.to_owned(),
                });
            }
        }
    }
    Ok(Times::Listed(listed))
}

/// Times of rows at a fixed rate; rows without a sample leave a gap.
fn counted_times(cells: &[Option<f64>], rate: f64, delay: f64) -> Times {
    if cells.iter().all(Option::is_some) {
        return Times::Uniform {
            start: -delay,
            interval: 1.0 / rate,
        };
    }
    let rows = cells.iter().enumerate().filter(|(_, cell)| cell.is_some());
    Times::Listed(rows.map(|(row, _)| row as f64 / rate - delay).collect())
}
