//! What stops the extraction of an impact.

use crate::filter::butterworth::FilterError;
use crate::recording::Quantity;

/// A recording, or an option, from which no impact can be extracted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// No channel of the kind that is needed.
    #[error(
        "the recording has no channel for {needed}; found {found}. Map a column to it under [channels]"
    )]
    MissingChannel {
        /// What would do.
        needed: &'static str,
        /// What there is.
        found: String,
    },
    /// Two channels of the same quantity.
    #[error("channels '{first}' and '{second}' both hold {quantity}; keep one of them")]
    RepeatedChannel {
        /// The quantity.
        quantity: Quantity,
        /// Name of one channel.
        first: String,
        /// Name of the other.
        second: String,
    },
    /// A channel with no or hardly any samples.
    #[error("channel '{channel}' has {samples} samples; at least {least} are needed")]
    TooFewSamples {
        /// Name of the channel.
        channel: String,
        /// Samples it has.
        samples: usize,
        /// Samples needed.
        least: usize,
    },
    /// As many times as samples are needed.
    #[error(
        "channel '{channel}' has {samples} samples but {times} sampling times; one time per sample is needed"
    )]
    UnequalLengths {
        /// Name of the channel.
        channel: String,
        /// Samples.
        samples: usize,
        /// Sampling times.
        times: usize,
    },
    /// A sample that is not a finite number.
    #[error(
        "channel '{channel}': sample {sample} at {time} s is {value}, not a finite number; leave the cell blank if there was no sample, or cut the recording"
    )]
    NotFinite {
        /// Name of the channel.
        channel: String,
        /// Index of the sample, from 0.
        sample: usize,
        /// Its time; s.
        time: f64,
        /// Its value.
        value: f64,
    },
    /// A sampling time that is not a finite number.
    #[error("channel '{channel}': the time of sample {sample} is {time}, not a finite number")]
    TimeNotFinite {
        /// Name of the channel.
        channel: String,
        /// Index of the sample, from 0.
        sample: usize,
        /// The time.
        time: f64,
    },
    /// Time repeats or runs backwards.
    #[error(
        "channel '{channel}': time does not increase at sample {sample}: {time} s after {before} s; split the recording there, or give a sampling rate in place of the time column"
    )]
    TimeNotIncreasing {
        /// Name of the channel.
        channel: String,
        /// Index of the later sample, from 0.
        sample: usize,
        /// Time of the sample before; s.
        before: f64,
        /// Time of the sample; s.
        time: f64,
    },
    /// A sampling interval that is no positive number.
    #[error(
        "channel '{channel}': the sampling interval is {interval} s; a positive interval is needed"
    )]
    BadInterval {
        /// Name of the channel.
        channel: String,
        /// The interval; s.
        interval: f64,
    },
    /// The two phases were not sampled together.
    #[error(
        "phases '{a}' and '{b}' are not sampled at the same times; ×4 decoding needs both at every instant"
    )]
    PhasesNotTogether {
        /// Name of phase A.
        a: String,
        /// Name of phase B.
        b: String,
    },
    /// A phase without two distinct levels.
    #[error(
        "phase '{channel}' shows no two distinct levels (samples from {low} to {high}); check the wiring and the column"
    )]
    PhaseLevels {
        /// Name of the channel.
        channel: String,
        /// Smallest sample.
        low: f64,
        /// Largest sample.
        high: f64,
    },
    /// An encoder or angle channel, but not the geometry that turns it into a displacement.
    #[error(
        "channel '{channel}' gives {quantity}, and to make a displacement of it {needed} is needed"
    )]
    MissingGeometry {
        /// Name of the channel.
        channel: String,
        /// What it holds.
        quantity: Quantity,
        /// What is missing, with an example.
        needed: &'static str,
    },
    /// Nothing rises above the threshold.
    #[error(
        "no contact in channel '{channel}': the largest value is {largest:.4} {unit} and the threshold {threshold:.4} {unit}; lower the threshold, or leave this recording out"
    )]
    NoContact {
        /// Name of the channel.
        channel: String,
        /// Largest value seen above the baseline; `unit`.
        largest: f64,
        /// Threshold it was held against; `unit`.
        threshold: f64,
        /// N, or m/s² where there is no force channel.
        unit: &'static str,
    },
    /// Contacts, but none in the range of time asked for.
    #[error("no contact begins between {from} s and {to} s; the contacts found begin at {found} s")]
    NoContactInRange {
        /// Begin of the range; s.
        from: f64,
        /// End of the range; s.
        to: f64,
        /// Onsets found; s.
        found: Times,
    },
    /// An option with a value that makes no sense.
    #[error("{option} = {value}: expected {expected}")]
    BadOption {
        /// Name of the option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// A channel that cannot be filtered as asked.
    #[error("channel '{channel}' cannot be filtered: {source}")]
    Filter {
        /// Name of the channel.
        channel: String,
        /// Why not.
        source: FilterError,
    },
    /// Samples that are not evenly spaced, where they must be.
    #[error(
        "channel '{channel}': sample {sample} was taken at {time} s, where even spacing has {expected} s; spectra need evenly spaced samples without gaps: cut the recording (from_s and to_s in impacts.csv), or give the sampling rate in place of the times"
    )]
    UnevenSampling {
        /// Name of the channel.
        channel: String,
        /// Index of the sample, from 0.
        sample: usize,
        /// Its time; s.
        time: f64,
        /// The time at even spacing; s.
        expected: f64,
    },
    /// Nothing in a recording rises like a tap.
    #[error(
        "no tap in channel '{channel}': nowhere does the sound in the band rise {rise}-fold in energy within milliseconds (the largest value is {largest:.4}); look at it with `windfall inspect`, and check channel, band and gain"
    )]
    NoTap {
        /// Name of the channel.
        channel: String,
        /// Largest value in the band.
        largest: f64,
        /// Rise of energy asked for; 1.
        rise: f64,
    },
    /// A repeated impact that does not begin or end below the level at which
    /// impacts are aligned.
    #[error(
        "no crossing of {level:.4} N in the {side} of the force (largest {largest:.4} N); record from before to after the contact, or align at another level"
    )]
    CrossingUnseen {
        /// "rise" or "fall".
        side: &'static str,
        /// The level; N.
        level: f64,
        /// Largest force; N.
        largest: f64,
    },
    /// A comparison over fruit with hardly any.
    #[error("{fruit} fruit cannot be compared; at least {least} are needed")]
    TooFewFruit {
        /// Fruit there are.
        fruit: usize,
        /// Fruit needed.
        least: usize,
    },
    /// Curves of one comparison that are not on the same instants.
    #[error("a difference curve has {other} instants and another {first}; all need the same")]
    CurvesUnequal {
        /// Instants of the first curve.
        first: usize,
        /// Instants of the other.
        other: usize,
    },
    /// Interval of a critical energy that is none.
    #[error(
        "critical energy of fruit {fruit}: between {low} J and {high} J; expected 0 ≤ low < high, energies in J"
    )]
    BadEnergyInterval {
        /// Position of the fruit, from 0.
        fruit: usize,
        /// Largest energy without a change; J.
        low: f64,
        /// Least energy with a change; J.
        high: f64,
    },
    /// No distribution of critical energies can be fitted.
    #[error("critical impact energy: {problem}")]
    EnergyUndetermined {
        /// Why, and what to do.
        problem: &'static str,
    },
    /// The mass cannot be found from this impact.
    #[error(
        "the mass cannot be found from impulse and change of velocity: {missing} is not known; give the mass instead"
    )]
    NoMass {
        /// The first quantity that is missing.
        missing: &'static str,
    },
    /// The change of velocity has the wrong sign or is zero.
    #[error(
        "the mass cannot be found: an impulse of {impulse:.4} N s against a change of velocity of {change:.4} m/s; both must be positive. Check signs and units of force and displacement"
    )]
    MassNotPositive {
        /// Impulse of the contact force; N s.
        impulse: f64,
        /// Change of velocity it caused; m/s.
        change: f64,
    },
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
