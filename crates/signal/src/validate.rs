//! Checks of a channel before anything is made of it.

use crate::error::Error;
use crate::finding::Finding;
use crate::noise::estimate::median;
use crate::recording::{Channel, Times};

/// Intervals that depart from their median by more than this part of it are
/// irregular; 1. Rounding in a file stays below.
const IRREGULAR: f64 = 0.01;

/// Times of a channel, one per sample, after checking them and the samples.
///
/// # Errors
/// [`Error::NotFinite`], [`Error::TimeNotFinite`], [`Error::TimeNotIncreasing`],
/// [`Error::UnequalLengths`], [`Error::BadInterval`], [`Error::TooFewSamples`].
pub fn checked_times(channel: &Channel) -> Result<(Vec<f64>, Option<Finding>), Error> {
    let name = || channel.name.clone();
    let n = channel.samples.len();
    if n == 0 {
        return Err(Error::too_few_samples(name(), 0, 1));
    }
    let times = match &channel.times {
        Times::Uniform { start, interval } => {
            if !(*interval > 0.0 && interval.is_finite() && start.is_finite()) {
                return Err(Error::BadInterval {
                    channel: name(),
                    interval: *interval,
                });
            }
            (0..n).map(|i| channel.times.at(i)).collect()
        }
        Times::Listed(times) => {
            if times.len() != n {
                return Err(Error::UnequalLengths {
                    channel: name(),
                    samples: n,
                    times: times.len(),
                });
            }
            check_times(channel, times)?;
            times.clone()
        }
    };
    if let Some(sample) = channel.samples.iter().position(|v| !v.is_finite()) {
        return Err(Error::NotFinite {
            channel: name(),
            sample,
            time: times[sample],
            value: channel.samples[sample],
        });
    }
    let finding = match &channel.times {
        Times::Uniform { .. } => None,
        Times::Listed(_) => irregularity(&channel.name, &times),
    };
    Ok((times, finding))
}

fn check_times(channel: &Channel, times: &[f64]) -> Result<(), Error> {
    if let Some(sample) = times.iter().position(|t| !t.is_finite()) {
        return Err(Error::TimeNotFinite {
            channel: channel.name.clone(),
            sample,
            time: times[sample],
        });
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(Error::TimeNotIncreasing {
            channel: channel.name.clone(),
            sample: before + 1,
            before: times[before],
            time: times[before + 1],
        }),
        None => Ok(()),
    }
}

/// The largest departure of an interval from the median one, if it matters.
fn irregularity(name: &str, times: &[f64]) -> Option<Finding> {
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let interval = median(&intervals)?;
    let (at, jitter) = intervals
        .iter()
        .map(|i| (i - interval).abs())
        .enumerate()
        .fold(
            (0, 0.0),
            |worst, (i, jitter)| {
                if jitter > worst.1 { (i, jitter) } else { worst }
            },
        );
    (jitter > IRREGULAR * interval).then(|| Finding::IrregularSampling {
        channel: name.to_owned(),
        interval,
        jitter,
        at: times[at],
    })
}
