//! A long recording at a glance: what `inspect` says of it, and the extremes of each channel in
//! stretches, few enough to be kept beside the campaign and read at once.
//!
//! Wide parts of a recording are outlined from its stretches; narrow ones need its samples
//! ([`crate::recording_outline`]).

use crate::recording_outline::{Extremes, Outline, joined, tell_times};
use serde::{Deserialize, Serialize};
use std::path::Path;
use windfall_campaign::settings::model::FilePlan;
use windfall_files::cache::{keep, kept, stamp};
use windfall_files::error::Error;
use windfall_files::provenance::{REVISION, VERSION};
use windfall_files::text::column_role::{seconds_per_unit, unit_in};
use windfall_formats::contents::{Contents, TimeBase};
use windfall_inspect::run::inspect_taking;

/// Bytes from which a file is long: shorter ones are read at once. 10⁶ samples of 16 bits have
/// half of that.
pub const LONG: u64 = 4 << 20;

/// Most stretches of a channel; 10⁷ samples make stretches of 64.
const MOST: usize = 1 << 18;

/// Form of what is kept; raised with every change of it.
const FORM: u32 = 1;

/// A long recording at a glance.
#[derive(Clone, Debug, PartialEq)]
pub struct Glance {
    /// What `inspect` says of it, as JSON.
    pub inspection: String,
    channels: Vec<Stretched>,
}

/// A channel in stretches.
#[derive(Clone, Debug, PartialEq)]
struct Stretched {
    name: String,
    unit: Option<String>,
    clock: Clock,
    samples: usize,
    /// Samples of a stretch; the last one may have fewer.
    length: usize,
    extremes: Vec<Extremes>,
}

/// When stretches begin.
#[derive(Clone, Debug, PartialEq)]
enum Clock {
    /// Numbers of samples.
    Unknown,
    Uniform {
        start: f64,
        interval: f64,
    },
    /// The first time of each stretch, and the last of all; s.
    Times {
        begins: Vec<f64>,
        end: f64,
    },
}

impl Glance {
    /// Looks at a recording, or finds what is kept of it beside the campaign.
    ///
    /// * `directory`: of the campaign
    /// * `file`: name of the recording, by which the answer calls it
    /// * `path`: where it is
    ///
    /// # Errors
    /// The file cannot be read, or breaks the rules of its format.
    pub fn of(directory: &Path, file: &str, path: &Path, plan: &FilePlan) -> Result<Self, Error> {
        let before = stamp(path).map_err(|source| Error::access(path, "read", source))?;
        let (open, time) = (&plan.open, &plan.time);
        let key = format!("glance {FORM} {VERSION} {REVISION} {file:?} {before} {open:?} {time:?}");
        if let Some(found) = kept(directory, &key).and_then(|bytes| Self::from_bytes(&bytes)) {
            return Ok(found);
        }
        let glance = Self::read(file, path, plan)?;
        // What was written to meanwhile is not what the key says.
        if stamp(path).is_ok_and(|after| after == before) {
            keep(directory, &key, &glance.to_bytes());
        }
        Ok(glance)
    }

    fn read(file: &str, path: &Path, plan: &FilePlan) -> Result<Self, Error> {
        let mut taken: Vec<Taken> = Vec::new();
        let mut take = |place: usize, samples: &[f64]| {
            if taken.len() <= place {
                taken.resize_with(place + 1, Taken::default);
            }
            taken[place].take(samples);
        };
        let (mut inspection, mut contents) = inspect_taking(path, &plan.open, &[], &mut take)?;
        file.clone_into(&mut inspection.file);
        taken.resize_with(contents.channels.len(), Taken::default);
        for index in 0..taken.len() {
            tell_times(&mut contents, index, plan);
        }
        let channels = (0..taken.len()).filter_map(|index| stretched(&contents, &taken, index));
        let failed = |error: serde_json::Error| {
            Error::access(path, "read", std::io::Error::other(error.to_string()))
        };
        Ok(Self {
            channels: channels.collect(),
            inspection: serde_json::to_string(&inspection).map_err(failed)?,
        })
    }

    /// A part of a channel in at most about that many points; `None` where its samples are
    /// needed: the part is narrow, or the channel is none of these.
    ///
    /// * `from`, `to`: times; the ends of the channel if `None`
    pub fn outline(
        &self,
        channel: &str,
        from: Option<f64>,
        to: Option<f64>,
        points: usize,
    ) -> Option<Outline> {
        let mut named = self.channels.iter().filter(|own| own.name == channel);
        let own = named.next()?;
        // Which of two channels of one name is meant is for the file to say.
        named.next().is_none().then_some(())?;
        own.outline(from, to, points.max(2))
    }

    /// Bytes that it takes in memory.
    pub fn bytes(&self) -> usize {
        let numbers = self.channels.iter().map(|own| match &own.clock {
            Clock::Times { begins, .. } => 2 * own.extremes.len() + begins.len(),
            Clock::Unknown | Clock::Uniform { .. } => 2 * own.extremes.len(),
        });
        self.inspection.len() + 8 * numbers.sum::<usize>()
    }
}

impl Stretched {
    fn outline(&self, from: Option<f64>, to: Option<f64>, points: usize) -> Option<Outline> {
        let all = self.extremes.len();
        let before = |early: &dyn Fn(f64) -> bool| {
            // Times increase.
            let (mut low, mut high) = (0, all);
            while low < high {
                let middle = low.midpoint(high);
                match early(self.begin(middle)) {
                    true => low = middle + 1,
                    false => high = middle,
                }
            }
            low
        };
        // The stretch in which each end lies belongs to the part.
        let first = from.map_or(0, |from| before(&|time| time <= from).saturating_sub(1));
        let last = to.map_or(all, |to| before(&|time| time <= to)).max(first);
        let shown = (last * self.length).min(self.samples) - (first * self.length);
        let stride = shown.div_ceil(points);
        if stride < self.length || shown <= 2 * points {
            return None;
        }
        let stride = stride.div_ceil(self.length);
        let mut outline = Outline {
            channel: self.name.clone(),
            unit: self.unit.clone(),
            timed: self.clock != Clock::Unknown,
            start: self.begin(0),
            end: self.end(),
            samples: self.samples,
            shown,
            exact: false,
            time: Vec::new(),
            low: Vec::new(),
            high: Vec::new(),
        };
        for begin in (first..last).step_by(stride) {
            let part = &self.extremes[begin..(begin + stride).min(last)];
            let [low, high] = part.iter().copied().fold([f64::NAN; 2], joined);
            if !low.is_nan() {
                outline.time.push(self.begin(begin));
                outline.low.push(low);
                outline.high.push(high);
            }
        }
        Some(outline)
    }

    /// When a stretch begins.
    fn begin(&self, stretch: usize) -> f64 {
        let sample = (stretch * self.length) as f64;
        match &self.clock {
            Clock::Unknown => sample,
            Clock::Uniform { start, interval } => start + sample * interval,
            Clock::Times { begins, .. } => begins.get(stretch).copied().unwrap_or(0.0),
        }
    }

    /// When the last sample was.
    fn end(&self) -> f64 {
        let last = self.samples.saturating_sub(1) as f64;
        match &self.clock {
            Clock::Unknown => last,
            Clock::Uniform { start, interval } => start + last * interval,
            Clock::Times { end, .. } => *end,
        }
    }
}

/// What has been seen of a channel while the file is read.
struct Taken {
    samples: usize,
    length: usize,
    extremes: Vec<Extremes>,
    begins: Vec<f64>,
    last: f64,
    increasing: bool,
}

impl Default for Taken {
    fn default() -> Self {
        Self {
            samples: 0,
            length: 1,
            extremes: Vec::new(),
            begins: Vec::new(),
            last: f64::NEG_INFINITY,
            increasing: true,
        }
    }
}

impl Taken {
    fn take(&mut self, mut samples: &[f64]) {
        while let Some(&begin) = samples.first() {
            let within = self.samples % self.length;
            if within == 0 {
                if self.extremes.len() == MOST {
                    self.halve();
                    continue;
                }
                self.extremes.push([f64::NAN; 2]);
                self.begins.push(begin);
            }
            let (part, rest) = samples.split_at((self.length - within).min(samples.len()));
            let found = self.extremes.last().copied().unwrap_or([f64::NAN; 2]);
            let found = part
                .iter()
                .fold(found, |all, own| joined(all, [*own, *own]));
            if let Some(last) = self.extremes.last_mut() {
                *last = found;
            }
            for &value in part {
                self.increasing &= value > self.last;
                self.last = value;
            }
            self.samples += part.len();
            samples = rest;
        }
    }

    fn halve(&mut self) {
        let pairs = self.extremes.chunks(2);
        self.extremes = pairs
            .map(|pair| pair.iter().copied().fold([f64::NAN; 2], joined))
            .collect();
        self.begins = self.begins.iter().copied().step_by(2).collect();
        self.length *= 2;
    }
}

/// A channel with its clock; `None` where its times are of another length than its samples.
fn stretched(contents: &Contents, taken: &[Taken], index: usize) -> Option<Stretched> {
    let (described, own) = (&contents.channels[index], &taken[index]);
    let clock = match described.time {
        TimeBase::Unknown => Clock::Unknown,
        TimeBase::Uniform { start, interval } => Clock::Uniform { start, interval },
        TimeBase::Channel(at) if at == index => Clock::Unknown,
        TimeBase::Channel(at) => {
            let (times, scale) = (&taken[at], seconds_per_unit(&contents.channels[at]));
            if times.samples != own.samples {
                return None;
            }
            match times.increasing {
                true => Clock::Times {
                    begins: times.begins.iter().map(|time| time * scale).collect(),
                    end: times.last * scale,
                },
                false => Clock::Unknown,
            }
        }
    };
    Some(Stretched {
        name: described.name.clone(),
        unit: unit_in(described),
        clock,
        samples: own.samples,
        length: own.length,
        extremes: own.extremes.clone(),
    })
}

/// What precedes the numbers of a kept [`Glance`].
#[derive(Deserialize, Serialize)]
struct Head {
    inspection: String,
    channels: Vec<ChannelHead>,
}

#[derive(Deserialize, Serialize)]
struct ChannelHead {
    name: String,
    unit: Option<String>,
    samples: usize,
    length: usize,
    stretches: usize,
    clock: ClockHead,
}

#[derive(Deserialize, Serialize)]
enum ClockHead {
    Unknown,
    Uniform,
    Times,
}

impl Glance {
    /// Length of the head, the head as JSON, then numbers of 8 bytes.
    fn to_bytes(&self) -> Vec<u8> {
        let mut numbers: Vec<f64> = Vec::new();
        let mut channels = Vec::new();
        for own in &self.channels {
            numbers.extend(own.extremes.iter().flatten());
            let clock = match &own.clock {
                Clock::Unknown => ClockHead::Unknown,
                Clock::Uniform { start, interval } => {
                    numbers.extend([start, interval]);
                    ClockHead::Uniform
                }
                Clock::Times { begins, end } => {
                    numbers.extend(begins.iter().chain([end]));
                    ClockHead::Times
                }
            };
            channels.push(ChannelHead {
                name: own.name.clone(),
                unit: own.unit.clone(),
                samples: own.samples,
                length: own.length,
                stretches: own.extremes.len(),
                clock,
            });
        }
        let head = Head {
            inspection: self.inspection.clone(),
            channels,
        };
        // Texts and whole numbers: there is nothing that could not be written.
        let head = serde_json::to_vec(&head).unwrap_or_default();
        let mut bytes = (head.len() as u64).to_le_bytes().to_vec();
        bytes.extend(head);
        bytes.extend(numbers.iter().flat_map(|own| own.to_le_bytes()));
        bytes
    }

    /// `None` where the bytes are not those of a glance.
    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (length, rest) = bytes.split_first_chunk()?;
        let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
        let (head, numbers) = rest.split_at_checked(length)?;
        let head: Head = serde_json::from_slice(head).ok()?;
        let (numbers, []) = numbers.as_chunks::<8>() else {
            return None;
        };
        let mut numbers = numbers.iter().map(|own| f64::from_le_bytes(*own));
        let mut channels = Vec::new();
        for own in head.channels {
            let whole = own.length > 0 && own.samples.div_ceil(own.length) == own.stretches;
            if !whole || own.stretches > MOST {
                return None;
            }
            let mut next = |count: usize| {
                let taken: Vec<f64> = numbers.by_ref().take(count).collect();
                (taken.len() == count).then_some(taken)
            };
            let extremes = next(2 * own.stretches)?.as_chunks::<2>().0.to_vec();
            let clock = match own.clock {
                ClockHead::Unknown => Clock::Unknown,
                ClockHead::Uniform => {
                    let [start, interval] = next(2)?.try_into().ok()?;
                    Clock::Uniform { start, interval }
                }
                ClockHead::Times => Clock::Times {
                    begins: next(own.stretches)?,
                    end: next(1)?[0],
                },
            };
            channels.push(Stretched {
                name: own.name,
                unit: own.unit,
                clock,
                samples: own.samples,
                length: own.length,
                extremes,
            });
        }
        let inspection = head.inspection;
        numbers.next().is_none().then_some(Self {
            inspection,
            channels,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording_outline::OutlinedChannel;
    use windfall_campaign::settings::model::TimePlan;
    use windfall_files::cache::CACHE_FOLDER;
    use windfall_formats::open::OpenOptions;

    fn plan(directory: &Path, time: TimePlan) -> FilePlan {
        FilePlan {
            directory: directory.to_path_buf(),
            within: None,
            held: None,
            open: OpenOptions::default(),
            time,
            time_scale: 1.0,
            channels: Vec::new(),
        }
    }

    /// A rough signal with a blank cell, that no stretch hides.
    fn recording(rows: usize) -> String {
        let row = |i: usize| {
            let force = match i == 777 {
                true => String::new(),
                false => ((i * 7919) % 10_007).to_string(),
            };
            format!("{},{force}\n", i as f64 * 0.25)
        };
        let rows: String = (0..rows).map(row).collect();
        format!("time_ms,force_N\n{rows}")
    }

    #[test]
    fn stretches_say_what_samples_say_and_come_back_from_the_disk() {
        let place = tempfile::tempdir().unwrap();
        let own = place.path();
        let path = own.join("long.csv");
        // More than twice as many rows as there are stretches.
        let rows = 2 * MOST + 12_345;
        std::fs::write(&path, recording(rows)).unwrap();
        let plan = plan(own, TimePlan::OfFile);
        let made = Glance::of(own, "long.csv", &path, &plan).unwrap();
        assert_eq!(
            std::fs::read_dir(own.join(CACHE_FOLDER)).unwrap().count(),
            1
        );
        assert_eq!(Glance::from_bytes(&made.to_bytes()).as_ref(), Some(&made));
        assert_eq!(Glance::of(own, "long.csv", &path, &plan).unwrap(), made);
        assert!(made.inspection.contains("\"file\":\"long.csv\""));

        let samples = OutlinedChannel::read(&path, &plan, "force_N").unwrap();
        for (from, to) in [(None, None), (Some(20.0), Some(90.3)), (None, Some(77.0))] {
            let glance = made.outline("force_N", from, to, 300).unwrap();
            let exact = samples.outline(from, to, 300);
            assert_eq!(
                (glance.start, glance.end, glance.samples),
                (exact.start, exact.end, rows)
            );
            assert!(glance.timed && !glance.exact && glance.time.len() <= 301);
            assert!(glance.time.len() >= 150, "{}", glance.time.len());
            // Both ends are reached, and each stretch has the extremes of its samples.
            assert!(glance.time[0] <= from.unwrap_or(0.0));
            let mut next = glance.time.iter().skip(1).copied().chain([f64::INFINITY]);
            for (place, begin) in glance.time.iter().enumerate().take(glance.time.len() - 1) {
                let end = next.next().unwrap();
                let part = samples.outline(Some(*begin), Some(end), 100_000);
                assert!(part.exact);
                let inside = part.time.iter().zip(&part.low);
                let inside = inside.filter(|(time, _)| *time >= begin && **time < end);
                let values: Vec<f64> = inside.map(|(_, value)| *value).collect();
                let low = values.iter().copied().fold(f64::INFINITY, f64::min);
                let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                assert_eq!((glance.low[place], glance.high[place]), (low, high));
            }
        }
        // A narrow part needs the samples.
        assert_eq!(made.outline("force_N", Some(20.0), Some(20.1), 300), None);
        assert_eq!(made.outline("absent", None, None, 300), None);
    }

    #[test]
    fn a_changed_file_and_a_changed_plan_are_looked_at_anew() {
        let place = tempfile::tempdir().unwrap();
        let own = place.path();
        let path = own.join("a.csv");
        std::fs::write(&path, recording(20_000)).unwrap();
        let glance = |time| Glance::of(own, "a.csv", &path, &plan(own, time)).unwrap();
        let first = glance(TimePlan::OfFile);
        std::thread::sleep(std::time::Duration::from_millis(20));
        let changed = recording(20_000).replace("\n0.25,7919\n", "\n0.25,9999\n");
        std::fs::write(&path, changed).unwrap();
        let second = glance(TimePlan::OfFile);
        assert_ne!(first, second);
        let entries = || std::fs::read_dir(own.join(CACHE_FOLDER)).unwrap();
        assert_eq!(entries().count(), 2);
        // Another rate, where the file does not tell its times.
        std::fs::write(&path, "force_N\n1\n2\n3\n").unwrap();
        let ends = |glance: Glance| glance.channels[0].end();
        assert_eq!(ends(glance(TimePlan::Rate(2.0))), 1.0);
        assert_eq!(ends(glance(TimePlan::Rate(4.0))), 0.5);
        // Entries that hold something else are made again.
        for entry in entries() {
            let path = entry.unwrap().path();
            std::fs::write(&path, "windfall cache 1\nnothing").unwrap();
        }
        assert_eq!(ends(glance(TimePlan::Rate(4.0))), 0.5);
    }

    #[test]
    fn bytes_that_are_no_glance_are_none() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.csv");
        std::fs::write(&path, recording(100)).unwrap();
        let made = Glance::read("a.csv", &path, &plan(place.path(), TimePlan::OfFile)).unwrap();
        let bytes = made.to_bytes();
        for length in 0..bytes.len() {
            assert_eq!(Glance::from_bytes(&bytes[..length]), None);
        }
        let more = [bytes.as_slice(), &[0; 8]].concat();
        assert_eq!(Glance::from_bytes(&more), None);
    }
}
