//! Sampling times of arrays: a vector "time" of the same length, or a scalar "fs" or "dt".

use crate::arrays::tree::{Listing, Scalar, Tree, count};
use crate::contents::{Note, TimeBase};
use crate::text::read::is_time_name;
use std::collections::BTreeMap;

const TIMES: [&str; 10] = [
    "t",
    "ts",
    "time",
    "times",
    "timesec",
    "timeseconds",
    "timevector",
    "timeaxis",
    "timestamp",
    "timestamps",
];
const RATES: [&str; 14] = [
    "fs",
    "fsamp",
    "fsample",
    "rate",
    "srate",
    "sfreq",
    "samplerate",
    "samplingrate",
    "samplefreq",
    "samplefrequency",
    "samplingfreq",
    "samplingfrequency",
    "sampleratehz",
    "samplingratehz",
];
const INTERVALS: [&str; 12] = [
    "dt",
    "ts",
    "deltat",
    "tinterval",
    "tsample",
    "sampletime",
    "sampleinterval",
    "sampleperiod",
    "samplinginterval",
    "samplingperiod",
    "xincrement",
    "wfincrement",
];
const STARTS: [&str; 3] = ["t0", "tstart", "wfstartoffset"];

/// Whether a name suggests times.
pub(crate) fn names_time(name: &str) -> bool {
    is_time_name(name) || TIMES.contains(&plain(name).as_str())
}

/// Lower case, without punctuation and remarks in brackets.
fn plain(name: &str) -> String {
    let kept = name.split(['(', '[']).next().unwrap_or(name);
    kept.chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// Sampling times that apply to a level and below.
#[derive(Clone, Debug, Default)]
struct Clock {
    /// Time channels.
    times: Vec<usize>,
    interval: Option<(f64, String)>,
    start: f64,
}

/// Assigns the nearest time base, on its own level or above, and returns assumptions.
pub(crate) fn time_bases(tree: &Tree, listing: &mut Listing) -> Vec<Note> {
    let clocks = find_clocks(tree, listing);
    let mut assumed: Vec<(String, usize)> = Vec::new();
    for channel in 0..listing.channels.len() {
        let path = &tree.arrays[listing.series[channel].array].path;
        let known = listing.channels[channel].time != TimeBase::Unknown;
        if known || is_time(&clocks, path, channel) {
            continue;
        }
        let nearest = (0..=path.len())
            .rev()
            .filter_map(|depth| clocks.get(&path[..depth]))
            .find_map(|clock| base_by(clock, channel, listing));
        let Some((time, by)) = nearest else { continue };
        listing.channels[channel].time = time;
        match assumed.iter_mut().find(|(known, _)| *known == by) {
            Some((_, channels)) => *channels += 1,
            None => assumed.push((by, 1)),
        }
    }
    let note = |(by, channels): (String, usize)| {
        Note::Assumed(format!(
            "{by} of {channels} {}, because of its name",
            if channels == 1 { "channel" } else { "channels" }
        ))
    };
    assumed.into_iter().map(note).collect()
}

fn find_clocks(tree: &Tree, listing: &Listing) -> BTreeMap<Vec<String>, Clock> {
    let mut clocks: BTreeMap<Vec<String>, Clock> = BTreeMap::new();
    for (channel, series) in listing.series.iter().enumerate() {
        let array = &tree.arrays[series.array];
        let whole = count(&array.extents) == series.length && series.length > 1;
        if let Some((name, level)) = array.path.split_last()
            && whole
            && array.part.is_empty()
            && names_time(name)
        {
            clocks
                .entry(level.to_vec())
                .or_default()
                .times
                .push(channel);
        }
    }
    for array in &tree.arrays {
        if let (Some(value), Some((name, level))) = (array.value, array.path.split_last()) {
            let scalar = Scalar {
                level: level.to_vec(),
                name: name.clone(),
                value,
            };
            add_scalar(&mut clocks, &scalar);
        }
    }
    for scalar in &tree.scalars {
        add_scalar(&mut clocks, scalar);
    }
    clocks
}

fn add_scalar(clocks: &mut BTreeMap<Vec<String>, Clock>, scalar: &Scalar) {
    let name = plain(&scalar.name);
    let is = |names: &[&str]| names.contains(&name.as_str());
    let by = || {
        let mut path = scalar.level.clone();
        path.push(scalar.name.clone());
        path.join("/")
    };
    let positive = scalar.value.is_finite() && scalar.value > 0.0;
    let entry = |clocks: &mut BTreeMap<Vec<String>, Clock>, interval: f64, by: String| {
        let clock = clocks.entry(scalar.level.clone()).or_default();
        clock.interval.get_or_insert((interval, by));
    };
    if is(&RATES) && positive && (1.0 / scalar.value).is_finite() {
        let by = format!("\"{}\" is taken as the sampling rate in Hz", by());
        entry(clocks, 1.0 / scalar.value, by);
    } else if is(&INTERVALS) && positive {
        let by = format!("\"{}\" is taken as the time between samples in s", by());
        entry(clocks, scalar.value, by);
    } else if is(&STARTS) && scalar.value.is_finite() {
        clocks.entry(scalar.level.clone()).or_default().start = scalar.value;
    }
}

fn is_time(clocks: &BTreeMap<Vec<String>, Clock>, path: &[String], channel: usize) -> bool {
    path.split_last()
        .and_then(|(_, level)| clocks.get(level))
        .is_some_and(|clock| clock.times.contains(&channel))
}

/// The time base that a clock gives a channel, and how to describe it.
fn base_by(clock: &Clock, channel: usize, listing: &Listing) -> Option<(TimeBase, String)> {
    let length = listing.series[channel].length;
    let fits = |&&t: &&usize| listing.series[t].length == length;
    if let Some(&time) = clock.times.iter().find(fits) {
        let by = format!("\"{}\" is taken as the time", listing.channels[time].name);
        return Some((TimeBase::Channel(time), by));
    }
    let (interval, by) = clock.interval.clone()?;
    let start = clock.start;
    Some((TimeBase::Uniform { start, interval }, by))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::tree::{Array, Series, first_fastest};
    use crate::contents::ChannelContents;

    fn listing(arrays: &[(&str, u64, Option<f64>)]) -> (Tree, Listing) {
        let mut tree = Tree::default();
        let mut listing = Listing::default();
        for (at, &(name, length, value)) in arrays.iter().enumerate() {
            tree.arrays.push(Array {
                path: name.split('/').map(str::to_owned).collect(),
                part: "",
                extents: first_fastest(&[length]),
                stored_as: String::new(),
                value,
                beginning: Vec::new(),
                unit: None,
                properties: Vec::new(),
            });
            if length > 1 {
                listing.series.push(Series {
                    array: at,
                    start: 0,
                    step: 1,
                    length,
                });
                listing.channels.push(ChannelContents {
                    name: name.to_owned(),
                    unit: None,
                    length: Some(length),
                    time: TimeBase::Unknown,
                    stored_as: String::new(),
                    properties: Vec::new(),
                });
            }
        }
        (tree, listing)
    }

    #[test]
    fn closed_form_the_nearest_clock_of_the_right_length() {
        let (tree, mut listing) = listing(&[
            ("Fs", 1, Some(200.0)),
            ("t0", 1, Some(-0.5)),
            ("force", 50, None),
            ("run/Time (s)", 40, None),
            ("run/x", 40, None),
            ("run/y", 41, None),
            ("other/dt", 1, Some(0.25)),
            ("other/z", 40, None),
            ("bad/fs", 1, Some(0.0)),
            ("bad/z", 40, None),
        ]);
        let notes = time_bases(&tree, &mut listing);
        let times: Vec<TimeBase> = listing.channels.iter().map(|c| c.time).collect();
        let uniform = |start, interval| TimeBase::Uniform { start, interval };
        let expected = [
            uniform(-0.5, 0.005),
            TimeBase::Unknown,
            TimeBase::Channel(1),
            uniform(-0.5, 0.005),
            uniform(0.0, 0.25),
            uniform(-0.5, 0.005),
        ];
        assert_eq!(times, expected);
        assert_eq!(
            notes[0].to_string(),
            "\"Fs\" is taken as the sampling rate in Hz of 3 channels, because of its name"
        );
    }
}
