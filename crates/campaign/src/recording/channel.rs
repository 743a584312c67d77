//! The samples of one channel of a recording, within the range of an entry.

use crate::error::CampaignError;
use crate::settings::model::ImpactEntry;
use windfall_files::error::Error;
use windfall_signal::recording::{Quantity, Recording};

/// Times and samples of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Sampling times; s.
    pub times: Vec<f64>,
    /// Samples; SI.
    pub values: Vec<f64>,
}

/// The samples of a quantity between `from_s` and `to_s` of the entry.
///
/// # Errors
/// The recording has no such channel, or no sample in the range.
pub fn channel_samples(
    recording: &Recording,
    quantity: Quantity,
    entry: &ImpactEntry,
) -> Result<Samples, Error> {
    let channel = recording.channels.iter().find(|c| c.quantity == quantity);
    let Some(channel) = channel else {
        return Err(Error::from(CampaignError::ChannelNotMapped {
            item: entry.id.clone(),
            quantity: quantity.to_string(),
        }));
    };
    let from = entry.from.unwrap_or(f64::NEG_INFINITY);
    let to = entry.to.unwrap_or(f64::INFINITY);
    let all = channel.samples.iter().enumerate();
    let kept = all.map(|(i, value)| (channel.times.at(i), *value));
    let (times, values): (Vec<f64>, Vec<f64>) =
        kept.filter(|(time, _)| (from..=to).contains(time)).unzip();
    match times.is_empty() {
        false => Ok(Samples { times, values }),
        true => Err(Error::from(CampaignError::RangeEmpty {
            item: entry.id.clone(),
            channel: channel.name.clone(),
            from,
            to,
        })),
    }
}
