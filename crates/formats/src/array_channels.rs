//! Arrays of numbers with names → channels, with the times that go with them.

use crate::contents::{ChannelContents, Contents, Note, TimeBase};
use crate::error::Error;
use crate::read_text::is_time_name;
use crate::reader::Sink;

/// Numbers from which a column of times is told.
pub const BEGINNING: u64 = 64;

/// A matrix with more columns than this and fewer rows has its samples in rows.
const MANY: u64 = 64;

/// Most channels of one matrix.
const MOST_CHANNELS: u64 = 4096;

/// Names of sampling rates; in lower case.
const RATES: [&str; 8] = [
    "fs",
    "f_s",
    "rate",
    "samplerate",
    "sample_rate",
    "samplingrate",
    "sampling_rate",
    "samplefrequency",
];

/// Names of sampling intervals; in lower case.
const INTERVALS: [&str; 6] = ["dt", "ts", "delta_t", "timestep", "interval", "increment"];

/// A matrix of a file, stored column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its name; parts are joined by "/".
    pub name: String,
    /// Rows.
    pub rows: u64,
    /// Columns.
    pub columns: u64,
    /// How it is stored.
    pub stored_as: String,
    /// Its unit, where the file says it.
    pub unit: Option<String>,
    /// Its first numbers.
    pub beginning: Vec<f64>,
}

/// Which part of which array each channel is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArrayChannels {
    parts: Vec<(usize, Cut)>,
}

/// Every `step`-th number from `first` on, `count` of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cut {
    first: u64,
    step: u64,
    count: u64,
}

/// A channel that is wanted, as a part of an array.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    position: usize,
    cut: Cut,
}

impl ArrayChannels {
    /// The wanted channels that are parts of an array.
    #[must_use]
    pub fn of_array(&self, array: usize, wanted: &[usize]) -> Vec<Part> {
        let mut parts = Vec::new();
        for (position, channel) in wanted.iter().enumerate() {
            let (from, cut) = self.parts[*channel];
            if from == array {
                parts.push(Part { position, cut });
            }
        }
        parts
    }
}

impl Part {
    /// Hands over what a block of an array's numbers holds of the channel.
    ///
    /// * `at`: position of the block's first number in the array
    ///
    /// # Errors
    /// Those of the sink.
    pub fn hand_over(&self, samples: &[f64], at: u64, sink: &mut dyn Sink) -> Result<(), Error> {
        let Cut { first, step, count } = self.cut;
        let end = at + samples.len() as u64;
        // The first of the channel's numbers at or behind `at`.
        let from = match at > first {
            true => first + (at - first).div_ceil(step) * step,
            false => first,
        };
        let last = first + (count - 1) * step;
        let to = end.min(last + 1);
        if from >= to {
            return Ok(());
        }
        let slice = &samples[(from - at) as usize..(to - at) as usize];
        match step {
            1 => sink.take(self.position, slice),
            step => {
                let picked: Vec<f64> = slice.iter().step_by(step as usize).copied().collect();
                sink.take(self.position, &picked)
            }
        }
    }
}

/// Adds the channels of arrays to the contents.
///
/// A vector is one channel; each column of a matrix is one, or each row where the
/// matrix is wide. A vector named as a time, or a first column that rises evenly,
/// times what stands beside it; so does a single number named as a rate.
pub fn describe_arrays(
    arrays: &[Array],
    scalars: &[(String, f64)],
    contents: &mut Contents,
) -> ArrayChannels {
    let mut channels = ArrayChannels::default();
    for (index, array) in arrays.iter().enumerate() {
        let (rows, columns) = (array.rows, array.columns);
        if rows == 1 || columns == 1 {
            let cut = Cut {
                first: 0,
                step: 1,
                count: rows * columns,
            };
            add(
                array,
                array.name.clone(),
                index,
                cut,
                contents,
                &mut channels,
            );
            continue;
        }
        let wide = columns > MANY && rows < columns;
        let (count, length) = if wide {
            (rows, columns)
        } else {
            (columns, rows)
        };
        if count > MOST_CHANNELS {
            contents.notes.push(Note::LeftOut {
                what: format!("\"{}\"", array.name),
                why: format!("it is a matrix of {rows} × {columns}, not channels"),
            });
            continue;
        }
        if wide {
            contents.notes.push(Note::Assumed {
                what: format!("the {rows} rows of \"{}\" are taken as channels, since it has {columns} columns", array.name),
            });
        }
        let begin = contents.channels.len();
        for place in 0..count {
            let cut = match wide {
                true => Cut {
                    first: place,
                    step: rows,
                    count: length,
                },
                false => Cut {
                    first: place * rows,
                    step: 1,
                    count: length,
                },
            };
            add(
                array,
                format!("{}/{}", array.name, place + 1),
                index,
                cut,
                contents,
                &mut channels,
            );
        }
        if !wide && rises_evenly(&array.beginning) {
            contents.notes.push(Note::Assumed {
                what: format!(
                    "the first column of \"{}\" rises evenly and is taken as the time in seconds",
                    array.name
                ),
            });
            for channel in &mut contents.channels[begin + 1..] {
                channel.time = TimeBase::Channel(begin);
            }
        }
    }
    add_times(scalars, contents);
    channels
}

fn add(
    array: &Array,
    name: String,
    index: usize,
    cut: Cut,
    contents: &mut Contents,
    channels: &mut ArrayChannels,
) {
    contents.channels.push(ChannelContents {
        name,
        unit: array.unit.clone(),
        length: Some(cut.count),
        time: TimeBase::Unknown,
        stored_as: array.stored_as.clone(),
        properties: Vec::new(),
    });
    channels.parts.push((index, cut));
}

fn rises_evenly(values: &[f64]) -> bool {
    if values.len() < 3 {
        return false;
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    let even = |pair: &[f64]| ((pair[1] - pair[0]) - step).abs() < 0.2 * step;
    step > 0.0 && step != 1.0 && values.windows(2).all(even)
}

/// The part of a name before the last "/", and the part behind it.
fn parent(name: &str) -> (&str, &str) {
    name.rsplit_once('/').unwrap_or(("", name))
}

/// Times from vectors and single numbers beside the channels.
fn add_times(scalars: &[(String, f64)], contents: &mut Contents) {
    let times: Vec<(usize, String, Option<u64>)> = contents
        .channels
        .iter()
        .enumerate()
        .filter(|(_, channel)| is_time_name(parent(&channel.name).1))
        .map(|(at, channel)| (at, parent(&channel.name).0.to_owned(), channel.length))
        .collect();
    let mut assumed = Vec::new();
    for (at, channel) in contents.channels.iter_mut().enumerate() {
        if channel.time != TimeBase::Unknown {
            continue;
        }
        // Columns of a matrix stand one level deeper than what times it.
        let above = parent(&channel.name).0;
        let levels = [above, parent(above).0];
        let found = times.iter().find(|(time, level, length)| {
            *time != at && *length == channel.length && levels.contains(&level.as_str())
        });
        if let Some((time, ..)) = found {
            channel.time = TimeBase::Channel(*time);
            continue;
        }
        if times.iter().any(|(time, ..)| *time == at) {
            continue;
        }
        let named = |names: &[&str]| {
            scalars.iter().find(|(name, value)| {
                let (level, last) = parent(name);
                let fits = names.contains(&last.to_lowercase().as_str());
                fits && *value > 0.0 && value.is_finite() && levels.contains(&level)
            })
        };
        let interval = named(&RATES).map(|(name, rate)| (name, rate.recip()));
        let interval = interval.or_else(|| named(&INTERVALS).map(|(name, dt)| (name, *dt)));
        if let Some((name, interval)) = interval {
            channel.time = TimeBase::Uniform {
                start: 0.0,
                interval,
            };
            let what = format!(
                "\"{name}\" is taken as the sampling rate or interval (Hz, s) of what stands beside it"
            );
            if !assumed.contains(&what) {
                assumed.push(what);
            }
        }
    }
    contents
        .notes
        .extend(assumed.into_iter().map(|what| Note::Assumed { what }));
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Kept(Vec<Vec<f64>>);
    impl Sink for Kept {
        fn take(&mut self, at: usize, samples: &[f64]) -> Result<(), Error> {
            self.0[at].extend(samples);
            Ok(())
        }
    }

    #[test]
    fn closed_form_columns_and_rows_in_blocks_of_any_size() {
        let numbers: Vec<f64> = (0..12).map(f64::from).collect();
        let parts = [
            Part {
                position: 0,
                cut: Cut {
                    first: 4,
                    step: 1,
                    count: 4,
                },
            },
            Part {
                position: 1,
                cut: Cut {
                    first: 1,
                    step: 3,
                    count: 4,
                },
            },
        ];
        for block in 1..=12 {
            let mut kept = Kept(vec![Vec::new(); 2]);
            for (index, samples) in numbers.chunks(block).enumerate() {
                for part in &parts {
                    part.hand_over(samples, (index * block) as u64, &mut kept)
                        .unwrap();
                }
            }
            assert_eq!(
                kept.0,
                [[4.0, 5.0, 6.0, 7.0], [1.0, 4.0, 7.0, 10.0]],
                "{block}"
            );
        }
    }
}
