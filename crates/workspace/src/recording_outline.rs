//! A channel of any length at the resolution of a screen: smallest and largest
//! sample of each stretch of the time that is shown.
//!
//! Extremes of stretches of doubling length are kept beside the samples, so that any
//! part of 10⁷ samples is outlined by reading a few thousand numbers.

use serde::Serialize;
use std::path::Path;
use windfall_campaign::recording::find_channel::find_channel;
use windfall_campaign::settings::model::{FilePlan, TimePlan};
use windfall_files::error::Error;
use windfall_files::text::column_role::{seconds_per_unit, unit_in};
use windfall_formats::contents::{Contents, TimeBase};
use windfall_formats::open::open;

/// Samples below the first level of stretches.
const FIRST: usize = 16;

/// Extremes of a stretch; NaN where it has no sample.
pub(crate) type Extremes = [f64; 2];

/// A channel with the extremes of its stretches.
#[derive(Clone, Debug)]
pub struct OutlinedChannel {
    name: String,
    unit: Option<String>,
    clock: Clock,
    samples: Vec<f64>,
    // Stretches of FIRST, 2 FIRST, 4 FIRST … samples.
    levels: Vec<Vec<Extremes>>,
}

#[derive(Clone, Debug)]
enum Clock {
    /// Numbers of samples.
    Unknown,
    Uniform {
        start: f64,
        interval: f64,
    },
    Times(Vec<f64>),
}

/// A part of a channel as it is shown.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Outline {
    /// Name of the channel.
    pub channel: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Whether times are in seconds; otherwise they are numbers of samples.
    pub timed: bool,
    /// First time of the whole channel.
    pub start: f64,
    /// Last time of the whole channel.
    pub end: f64,
    /// Samples of the whole channel.
    pub samples: usize,
    /// Samples in the part that is shown.
    pub shown: usize,
    /// Whether each point is one sample.
    pub exact: bool,
    /// Begin of each stretch.
    pub time: Vec<f64>,
    /// Smallest sample of each stretch.
    pub low: Vec<f64>,
    /// Largest sample of each stretch.
    pub high: Vec<f64>,
}

impl OutlinedChannel {
    /// Reads a channel of a recording, as the file has it.
    ///
    /// * `plan`: how the file is read, and its times where it does not tell them
    ///
    /// # Errors
    /// The file cannot be read, has no such channel, or times that go back.
    pub fn read(path: &Path, plan: &FilePlan, channel: &str) -> Result<Self, Error> {
        let mut reader = open(path, &plan.open).map_err(Error::Format)?;
        let mut contents = reader.contents().clone();
        let index = find_channel(&contents, channel, path, "")?;
        tell_times(&mut contents, index, plan);
        let times = match contents.channels[index].time {
            TimeBase::Channel(at) => Some(at),
            TimeBase::Unknown | TimeBase::Uniform { .. } => None,
        };
        let mut wanted = vec![index];
        wanted.extend(times.filter(|at| *at != index));
        let mut columns = reader.read_whole(&wanted).map_err(Error::Format)?;
        let scale = times.map_or(1.0, |at| seconds_per_unit(&contents.channels[at]));
        let times = match columns.len() {
            2 => columns.pop(),
            _ => None,
        };
        let samples = columns.pop().unwrap_or_default();
        Ok(Self::of(&contents, index, samples, times, scale))
    }

    fn of(
        contents: &Contents,
        index: usize,
        samples: Vec<f64>,
        times: Option<Vec<f64>>,
        scale: f64,
    ) -> Self {
        let described = &contents.channels[index];
        let clock = match (described.time, times) {
            (TimeBase::Uniform { start, interval }, _) => Clock::Uniform { start, interval },
            (_, Some(times)) => increasing(times, samples.len(), scale),
            _ => Clock::Unknown,
        };
        Self {
            name: described.name.clone(),
            unit: unit_in(described),
            clock,
            levels: levels(&samples),
            samples,
        }
    }

    /// Bytes that it takes in memory.
    pub fn bytes(&self) -> usize {
        let times = match &self.clock {
            Clock::Times(times) => times.len(),
            Clock::Unknown | Clock::Uniform { .. } => 0,
        };
        let extremes: usize = self.levels.iter().map(Vec::len).sum();
        8 * (self.samples.len() + times + 2 * extremes)
    }

    /// A part of the channel in at most about that many points: the samples
    /// themselves where they are few, else extremes of stretches of equal length.
    ///
    /// * `from`, `to`: times; the ends of the channel if `None`
    pub fn outline(&self, from: Option<f64>, to: Option<f64>, points: usize) -> Outline {
        let count = self.samples.len();
        let first = from.map_or(0, |from| self.before(|time| time < from));
        let last = to
            .map_or(count, |to| self.before(|time| time <= to))
            .max(first);
        // One sample beyond each end, so that lines reach the edges.
        let (first, last) = (first.saturating_sub(1), (last + 1).min(count));
        let shown = last - first;
        let exact = shown <= 2 * points.max(2);
        let mut outline = Outline {
            channel: self.name.clone(),
            unit: self.unit.clone(),
            timed: !matches!(self.clock, Clock::Unknown),
            start: self.time(0),
            end: self.time(count.saturating_sub(1)),
            samples: count,
            shown,
            exact,
            time: Vec::new(),
            low: Vec::new(),
            high: Vec::new(),
        };
        let stride = match exact {
            true => 1,
            false => shown.div_ceil(points.max(2)),
        };
        for begin in (first..last).step_by(stride) {
            let [low, high] = self.extremes(begin, (begin + stride).min(last));
            if low.is_nan() {
                continue;
            }
            outline.time.push(self.time(begin));
            outline.low.push(low);
            outline.high.push(high);
        }
        outline
    }

    fn time(&self, sample: usize) -> f64 {
        match &self.clock {
            Clock::Unknown => sample as f64,
            Clock::Uniform { start, interval } => start + sample as f64 * interval,
            Clock::Times(times) => times.get(sample).copied().unwrap_or(0.0),
        }
    }

    /// Number of samples at the beginning for whose time `early` holds.
    fn before(&self, early: impl Fn(f64) -> bool) -> usize {
        let (mut low, mut high) = (0, self.samples.len());
        while low < high {
            let middle = low.midpoint(high);
            match early(self.time(middle)) {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        low
    }

    /// Extremes of the samples `first..last`.
    fn extremes(&self, mut first: usize, last: usize) -> Extremes {
        let mut found = [f64::NAN; 2];
        while first < last {
            // The longest stretch that begins here and ends in time.
            let fitting = |level: &usize| {
                let length = FIRST << level;
                first.is_multiple_of(length) && first + length <= last
            };
            match (0..self.levels.len()).take_while(fitting).last() {
                Some(level) => {
                    let length = FIRST << level;
                    found = joined(found, self.levels[level][first / length]);
                    first += length;
                }
                None => {
                    let value = self.samples[first];
                    found = joined(found, [value, value]);
                    first += 1;
                }
            }
        }
        found
    }
}

/// Where the file does not say when samples were taken, the campaign may.
pub(crate) fn tell_times(contents: &mut Contents, index: usize, plan: &FilePlan) {
    if contents.channels[index].time != TimeBase::Unknown {
        return;
    }
    let named = |name: &String| contents.channels.iter().position(|c| c.name == *name);
    let told = match &plan.time {
        TimePlan::Rate(rate) => Some(TimeBase::Uniform {
            start: 0.0,
            interval: 1.0 / rate,
        }),
        TimePlan::Column(name) => named(name).map(TimeBase::Channel),
        TimePlan::OfChannels | TimePlan::OfFile => None,
    };
    contents.channels[index].time = told.unwrap_or(TimeBase::Unknown);
}

/// Times in seconds if they increase, otherwise numbers of samples, as in `inspect`.
fn increasing(mut times: Vec<f64>, samples: usize, scale: f64) -> Clock {
    times.truncate(samples);
    let usable = times.len() == samples && times.windows(2).all(|pair| pair[0] < pair[1]);
    match usable {
        true => {
            times.iter_mut().for_each(|time| *time *= scale);
            Clock::Times(times)
        }
        false => Clock::Unknown,
    }
}

fn levels(samples: &[f64]) -> Vec<Vec<Extremes>> {
    let single = |samples: &[f64]| {
        let extremes = samples.iter().map(|value| [*value, *value]);
        extremes.fold([f64::NAN; 2], joined)
    };
    let whole = samples.chunks_exact(FIRST);
    let mut levels: Vec<Vec<Extremes>> = vec![whole.map(single).collect()];
    while let Some(below) = levels.last().filter(|level| level.len() >= 2) {
        let pairs = below.chunks_exact(2).map(|pair| joined(pair[0], pair[1]));
        let level = pairs.collect();
        levels.push(level);
    }
    levels
}

/// `f64::min` and `f64::max` skip NaN, a blank cell; infinities count as blank too.
pub(crate) fn joined(a: Extremes, b: Extremes) -> Extremes {
    let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
    [finite(b[0]).min(a[0]), finite(b[1]).max(a[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(samples: Vec<f64>) -> OutlinedChannel {
        OutlinedChannel {
            name: "f".to_owned(),
            unit: None,
            clock: Clock::Uniform {
                start: 1.0,
                interval: 0.5,
            },
            levels: levels(&samples),
            samples,
        }
    }

    /// A rough signal that no stretch hides.
    fn signal(count: usize) -> Vec<f64> {
        (0..count)
            .map(|i| ((i * 7919) % 10_007) as f64 - 5_000.0)
            .collect()
    }

    #[test]
    fn closed_form_extremes_of_any_part_are_those_of_its_samples() {
        let channel = channel(signal(5_000));
        for (first, last) in [
            (0, 5_000),
            (1, 4_999),
            (15, 33),
            (16, 32),
            (4_990, 5_000),
            (7, 8),
        ] {
            let part = &channel.samples[first..last];
            let low = part.iter().copied().fold(f64::INFINITY, f64::min);
            let high = part.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(channel.extremes(first, last), [low, high]);
        }
    }

    #[test]
    fn an_outline_keeps_every_extreme_and_few_points() {
        let mut samples = vec![0.0; 100_000];
        samples[71_234] = 9.0;
        samples[71_235] = -3.0;
        let channel = channel(samples);
        let outline = channel.outline(None, None, 800);
        assert!(outline.time.len() <= 801 && !outline.exact);
        assert_eq!(outline.high.iter().copied().fold(0.0, f64::max), 9.0);
        assert_eq!(outline.low.iter().copied().fold(0.0, f64::min), -3.0);
        assert_eq!((outline.start, outline.end), (1.0, 1.0 + 99_999.0 * 0.5));
    }

    #[test]
    fn few_samples_are_shown_as_they_are_with_one_beyond_each_end() {
        let channel = channel(signal(1_000));
        let outline = channel.outline(Some(11.0), Some(13.0), 100);
        assert!(outline.exact);
        assert_eq!(outline.time, [10.5, 11.0, 11.5, 12.0, 12.5, 13.0, 13.5]);
        assert_eq!(outline.low, channel.samples[19..26]);
        assert_eq!(outline.low, outline.high);
    }

    #[test]
    fn blank_cells_are_no_points() {
        let mut samples = signal(40);
        samples[3] = f64::NAN;
        samples[5] = f64::INFINITY;
        let outline = channel(samples).outline(None, None, 100);
        assert_eq!(outline.time.len(), 38);
        let nothing = channel(Vec::new()).outline(Some(0.0), Some(1.0), 10);
        assert_eq!((nothing.shown, nothing.time.len()), (0, 0));
    }
}
