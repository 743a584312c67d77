//! What stops the extraction of an impact.

use crate::filter::butterworth::FilterError;
use crate::recording::Quantity;

/// A recording, or an option, from which no impact can be extracted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum Error {
    #[error(
        "the recording has no channel for {needed}; found {found}. Map a column to it under [channels]"
    )]
    MissingChannel { needed: &'static str, found: String },
    #[error("channels '{first}' and '{second}' both hold {quantity}; keep one of them")]
    RepeatedChannel {
        quantity: Quantity,
        first: String,
        second: String,
    },
    #[error("channel '{channel}' has {samples} samples; at least {least} are needed")]
    TooFewSamples {
        channel: String,
        samples: usize,
        least: usize,
    },
    #[error(
        "channel '{channel}' has {samples} samples but {times} sampling times; one time per sample is needed"
    )]
    UnequalLengths {
        channel: String,
        samples: usize,
        times: usize,
    },
    #[error(
        "channel '{channel}': sample {sample} at {time} s is {value}, not a finite number; leave the cell blank if there was no sample, or cut the recording"
    )]
    NotFinite {
        channel: String,
        sample: usize,
        time: f64,
        value: f64,
    },
    #[error(
        "channel '{channel}': {samples} sample(s) are missing within the contact from {} s to {} s, the first at {} s ({first}); without them the contact cannot be fitted. If the channel was overloaded, enlarge its range; else leave this impact out",
        Rounded(*onset), Rounded(*end), Rounded(*at)
    )]
    MissingInContact {
        channel: String,
        samples: usize,
        onset: f64,
        end: f64,
        at: f64,
        /// What stands in place of the first, and where.
        first: String,
    },
    #[error("channel '{channel}': the time of sample {sample} is {time}, not a finite number")]
    TimeNotFinite {
        channel: String,
        sample: usize,
        time: f64,
    },
    #[error(
        "channel '{channel}': time does not increase at sample {sample}: {time} s after {before} s; split the recording there, or give a sampling rate in place of the time column"
    )]
    TimeNotIncreasing {
        channel: String,
        sample: usize,
        before: f64,
        time: f64,
    },
    #[error(
        "channel '{channel}': the sampling interval is {interval} s; a positive interval is needed"
    )]
    BadInterval { channel: String, interval: f64 },
    #[error(
        "phases '{a}' and '{b}' are not sampled at the same times; ×4 decoding needs both at every instant"
    )]
    PhasesNotTogether { a: String, b: String },
    #[error(
        "phase '{channel}' shows no two distinct levels (samples from {low} to {high}); check the wiring and the column"
    )]
    PhaseLevels {
        channel: String,
        low: f64,
        high: f64,
    },
    #[error(
        "channel '{channel}' gives {quantity}, and to make a displacement of it {needed} is needed"
    )]
    MissingGeometry {
        channel: String,
        quantity: Quantity,
        needed: &'static str,
    },
    #[error(
        "no contact in channel '{channel}': the largest value is {largest:.4} {unit} and the threshold {threshold:.4} {unit}; {}",
        no_contact_advice(*largest, *threshold)
    )]
    NoContact {
        channel: String,
        largest: f64,
        threshold: f64,
        unit: &'static str,
    },
    #[error(
        "no contact in channel '{channel}': from {} s to {} s it stands at {level:.2} m/s², which is rest or free fall under gravity, and nothing else stands out; leave this recording out",
        Rounded(*from), Rounded(*until)
    )]
    OnlyGravity {
        channel: String,
        level: f64,
        from: f64,
        until: f64,
    },
    #[error("no contact begins between {from} s and {to} s; the contacts found begin at {found} s")]
    NoContactInRange { from: f64, to: f64, found: Times },
    #[error("{option} = {value}: expected {expected}")]
    BadOption {
        option: &'static str,
        value: f64,
        expected: &'static str,
    },
    #[error("channel '{channel}' cannot be filtered: {source}")]
    Filter {
        channel: String,
        source: FilterError,
    },
    #[error(
        "channel '{channel}': sample {sample} was taken at {time} s, where even spacing has {expected} s; spectra need evenly spaced samples without gaps: cut the recording (from_s and to_s in impacts.csv), or give the sampling rate in place of the times"
    )]
    UnevenSampling {
        channel: String,
        sample: usize,
        time: f64,
        expected: f64,
    },
    #[error(
        "no tap in channel '{channel}': nowhere does the sound in the band rise {rise}-fold in energy within milliseconds (the largest value is {largest:.4}); look at it with `windfall inspect`, and check channel, band and gain"
    )]
    NoTap {
        channel: String,
        largest: f64,
        rise: f64,
    },
    #[error(
        "no crossing of {level:.4} N in the {side} of the force (largest {largest:.4} N); record from before to after the contact, or align at another level"
    )]
    CrossingUnseen {
        side: &'static str,
        level: f64,
        largest: f64,
    },
    #[error("{fruit} fruit cannot be compared; at least {least} are needed")]
    TooFewFruit { fruit: usize, least: usize },
    #[error("a difference curve has {other} instants and another {first}; all need the same")]
    CurvesUnequal { first: usize, other: usize },
    #[error(
        "critical energy of fruit {fruit}: between {low} J and {high} J; expected 0 ≤ low < high, energies in J"
    )]
    BadEnergyInterval { fruit: usize, low: f64, high: f64 },
    #[error("critical impact energy: {problem}")]
    EnergyUndetermined { problem: &'static str },
    #[error(
        "the mass cannot be found from impulse and change of velocity: {missing} is not known; give the mass instead"
    )]
    NoMass { missing: &'static str },
    #[error(
        "the mass cannot be found: an impulse of {impulse:.4} N s against a change of velocity of {change:.4} m/s; both must be positive. Check signs and units of force and displacement"
    )]
    MassNotPositive { impulse: f64, change: f64 },
}

impl Error {
    /// An option that has no usable value, with what was expected of it.
    pub fn bad_option(option: &'static str, value: f64, expected: &'static str) -> Self {
        Self::BadOption {
            option,
            value,
            expected,
        }
    }

    pub(crate) fn too_few_samples(channel: String, samples: usize, least: usize) -> Self {
        Self::TooFewSamples {
            channel,
            samples,
            least,
        }
    }
}

/// What may help where no contact was found.
fn no_contact_advice(largest: f64, threshold: f64) -> &'static str {
    if largest >= threshold {
        "no sample stands above it for long enough: a contact needs three successive samples above the threshold. Sample faster"
    } else if largest > 0.0 {
        "lower the threshold (`threshold` in [contact]), or leave this recording out"
    } else {
        "nothing rises out of the level at the begin; leave this recording out"
    }
}

/// A number that must be positive and finite.
pub(crate) fn positive(option: &'static str, value: f64) -> Result<f64, Error> {
    match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(Error::bad_option(option, value, "a positive number")),
    }
}

/// Times in a message, at most [`SHOWN_TIMES`] of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Times(pub Vec<f64>);

/// Times shown in a message before "and n more".
pub const SHOWN_TIMES: usize = 6;

impl std::fmt::Display for Times {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (index, time) in self.0.iter().take(SHOWN_TIMES).enumerate() {
            if index > 0 {
                write!(f, ", ")?;
            }
            write!(f, "{}", Rounded(*time))?;
        }
        match self.0.len().saturating_sub(SHOWN_TIMES) {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}

/// A number with at most six decimals and no trailing zeros.
pub(crate) struct Rounded(pub f64);

impl std::fmt::Display for Rounded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = format!("{:.6}", self.0);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if text == "-0" { "0" } else { text })
    }
}
