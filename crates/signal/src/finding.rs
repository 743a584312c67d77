//! What is poor in a recording, without stopping the extraction.

use crate::error::{Rounded, Times};
use crate::filter::butterworth::Band;
use windfall_numerics::written::{percent, plain, value_and_sd, with_digits};

/// Something about the signals that a reader of the results must know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum Finding {
    #[error(
        "{channels}: {illegal} of {transitions} transitions skip a state ({:.2} %), the first at {} s; the displacement is wrong from there by 2 counts each. Raise the sampling rate (now {} Hz; it must exceed speed / count length) or check the wiring{}",
        100.0 * *illegal as f64 / *transitions as f64,
        Rounded(*first),
        Rounded(*sampling_rate),
        added_text(*added)
    )]
    IllegalTransitions {
        channels: String,
        illegal: usize,
        transitions: usize,
        first: f64,
        sampling_rate: f64,
        added: i64,
    },
    #[error(
        "channel '{channel}' has the opposite sign of the convention (motion into the fruit and repulsive force are positive); {}. Set its sign in campaign.toml, or swap the phases of an encoder",
        if *corrected { "its sign has been changed" } else { "it is used as recorded" }
    )]
    Reversed { channel: String, corrected: bool },
    #[error(
        "channel '{channel}' is clipped: {samples} successive samples at {value} from {} s to {} s; peak, impulse and fitted parameters are biased. Enlarge the measuring range",
        Rounded(*from),
        Rounded(*to)
    )]
    Clipped {
        channel: String,
        /// As recorded, before offset and sign are corrected.
        value: f64,
        samples: usize,
        from: f64,
        to: f64,
    },
    #[error(
        "channel '{channel}' is sampled irregularly: the interval departs by up to {} s from its median of {} s, most at {} s; the recorded times are used as they are",
        plain(*jitter), plain(*interval), Rounded(*at)
    )]
    IrregularSampling {
        channel: String,
        interval: f64,
        jitter: f64,
        at: f64,
    },
    #[error(
        "{} contacts, beginning at {onsets} s; the one at {} s is used. Give each a row of its own in impacts.csv, with from_s and to_s around it",
        onsets.0.len(),
        Rounded(*used)
    )]
    SeveralContacts { onsets: Times, used: f64 },
    #[error(
        "the recording begins in contact ({} s): onset and impact velocity are not seen. Record some samples before the trigger",
        Rounded(*time)
    )]
    ContactAtStart { time: f64 },
    #[error(
        "the recording ends in contact ({} s): separation and rebound are not seen. Record longer",
        Rounded(*time)
    )]
    ContactAtEnd { time: f64 },
    #[error(
        "{}",
        short_baseline_text(channel, *samples, *before)
    )]
    ShortBaseline {
        channel: String,
        samples: usize,
        before: usize,
    },
    #[error(
        "channel '{channel}' does not rest before contact: its zero is the mean of the last {samples} of {before} samples, from {} s on, and wanders by {sd:.4} N in as long. `baseline = \"drift\"` in [contact] subtracts a line through what is before and after contact",
        Rounded(*from)
    )]
    LocalBaseline {
        channel: String,
        samples: usize,
        before: usize,
        from: f64,
        sd: f64,
    },
    #[error(
        "channel '{channel}' rings after the contact at {} s: {swings} further swing(s) with others in the opposite direction between them, until {} s and up to {:.0} % of its peak, are not taken for contacts. Mount sensor and specimen more rigidly, or look for the frequency of the bench",
        Rounded(*time), Rounded(*until), 100.0 * share
    )]
    Ringing {
        channel: String,
        time: f64,
        swings: usize,
        until: f64,
        share: f64,
    },
    #[error(
        "channel '{channel}' swings to both sides {swings} times, at {times} s: the sensor is moved to and fro, and nothing tells a contact from such a movement. If one of them is an impact, cut it out with from_s and to_s in impacts.csv"
    )]
    Shaking {
        channel: String,
        swings: usize,
        times: Times,
    },
    #[error(
        "channel '{channel}' stands at {level:.2} m/s² from {} s to {} s: rest or free fall under gravity, not taken for a contact",
        Rounded(*from), Rounded(*until)
    )]
    Gravity {
        channel: String,
        level: f64,
        from: f64,
        until: f64,
    },
    #[error(
        "channel '{channel}' reads {} N before contact; this offset has been subtracted",
        value_and_sd(*offset, Some(*offset_sd))
    )]
    OffsetRemoved {
        channel: String,
        offset: f64,
        offset_sd: f64,
    },
    #[error(
        "no force channel: the contact window comes from the deceleration in '{channel}' and is known to about {} s",
        plain(*resolution)
    )]
    WindowFromMotion { channel: String, resolution: f64 },
    #[error(
        "the threshold of {threshold:.2} N is {:.0} % of the largest force in '{channel}': the contact begins before and ends after what is shown, its duration is too short, and velocities, restitution and energies are less certain. {cure}",
        100.0 * share
    )]
    HighThreshold {
        channel: String,
        threshold: f64,
        share: f64,
        cure: &'static str,
    },
    #[error("the noise of '{channel}' cannot be measured; {} is assumed ({reason})", plain(*floor))]
    NoiseAtFloor {
        channel: String,
        floor: f64,
        reason: &'static str,
    },
    #[error(
        "channel '{channel}': the sample at {} s ({}) does not fit the free motion around it and is left out",
        Rounded(*time), plain(*value)
    )]
    Glitch {
        channel: String,
        time: f64,
        value: f64,
    },
    #[error(
        "channel '{channel}': {samples} single sample(s) far from those beside them, the first at {} s ({}); the median of their neighbours is used instead. Look at plugs, cables and the converter",
        Rounded(*time), plain(*value)
    )]
    Spikes {
        channel: String,
        samples: usize,
        time: f64,
        value: f64,
    },
    #[error(
        "channel '{channel}': {samples} single sample(s) far from those beside them, the first at {} s ({}); they are used as they are, since pulses have few samples here and one may be a peak. If it is a wrong value, blank it, or give a range of time without it (from_s and to_s in impacts.csv)",
        Rounded(*time), plain(*value)
    )]
    SpikesKept {
        channel: String,
        samples: usize,
        time: f64,
        value: f64,
    },
    #[error(
        "at {times} s '{channel}' shows a force without a change of velocity: a knock on the bench or the cable, not taken for a contact"
    )]
    Bump { channel: String, times: Times },
    #[error(
        "channel '{channel}' was {} (Butterworth of order {order}, forwards and backwards, no delay); {:.1} % of its range is left, and neighbouring samples share their noise",
        band_text(*band),
        100.0 * kept
    )]
    Filtered {
        channel: String,
        band: Band,
        order: usize,
        kept: f64,
    },
    #[error(
        "a drift of {} N/s in channel '{channel}', from the quiet stretches before and after contact, has been subtracted",
        value_and_sd(*slope, Some(*slope_sd))
    )]
    DriftRemoved {
        channel: String,
        slope: f64,
        slope_sd: f64,
    },
    #[error(
        "only {used} contact durations of free motion {} the contact are used of '{channel}', not {wanted}: {why}",
        if *after { "after" } else { "before" }
    )]
    FlightHeldBack {
        channel: String,
        after: bool,
        used: f64,
        wanted: f64,
        why: &'static str,
    },
    #[error(
        "a hum of {frequency:.0} Hz and {} N in channel '{channel}' has been subtracted, as seen before and after contact. Look at the earth and the shield of its cable",
        value_and_sd(*amplitude, Some(*sd))
    )]
    HumRemoved {
        channel: String,
        frequency: f64,
        amplitude: f64,
        sd: f64,
    },
    #[error(
        "channel '{channel}' reads {} N more after contact than before ({} of the peak): something rests on the sensor, or its zero sags as that of a piezoelectric sensor does. The zero before contact is used",
        value_and_sd(*change, Some(*sd)),
        percent(*share)
    )]
    ZeroShift {
        channel: String,
        change: f64,
        sd: f64,
        share: f64,
    },
    #[error(
        "no drift of channel '{channel}' can be told from {before} samples before and {after} after contact; only the mean before it has been subtracted. Record longer"
    )]
    DriftUnknown {
        channel: String,
        before: usize,
        after: usize,
    },
    #[error(
        "a tip of {} kg ahead of '{channel}': its inertia, from {}, raises the largest force by {:.1} %",
        Rounded(*mass),
        if *measured { "the measured acceleration" } else { "the rig's own motion (a rigid impactor)" },
        100.0 * (raised - 1.0)
    )]
    TipMass {
        channel: String,
        mass: f64,
        measured: bool,
        raised: f64,
    },
    #[error(
        "force and mass times acceleration disagree: impulses as {} to 1, peaks as {} to 1; check both calibrations, the mass, and that the accelerometer sits where the force acts",
        value_and_sd(*impulse_ratio, Some(*impulse_ratio_sd)),
        value_and_sd(*peak_ratio, Some(*peak_ratio_sd))
    )]
    AccelerometerDisagrees {
        impulse_ratio: f64,
        impulse_ratio_sd: f64,
        peak_ratio: f64,
        peak_ratio_sd: f64,
    },
    #[error(
        "the loop of force over displacement holds {} J and the velocities tell {} J absorbed; check the calibrations of force and displacement, the delay between them, and the mass",
        plain(*area),
        plain(*absorbed)
    )]
    EnergyMismatch { area: f64, absorbed: f64 },
    #[error(
        "channel '{channel}' jumps by {:.1} µm between two samples at {} s, much farther than before and after: rows are missing, or counts were lost. Record the time beside each row, and look at the buffer of the recorder",
        1e6 * size,
        Rounded(*time)
    )]
    GapInContact {
        channel: String,
        time: f64,
        size: f64,
    },
    #[error(
        "'{force}' comes {} µs {} than '{displacement}', by Newton's law: a delay between the channels shifts stiffness and damping. Sample both at once, and look for missing rows",
        value_and_sd(1e6 * delay.abs(), Some(1e6 * sd)),
        if *delay > 0.0 { "later" } else { "earlier" }
    )]
    LateChannel {
        force: String,
        displacement: String,
        delay: f64,
        sd: f64,
    },
    #[error(
        "'{force}' is {} times mass times the acceleration of '{displacement}': look at the sensitivity of the force, at the mass or inertia, at the length of a count, and for missing rows",
        value_and_sd(*gain, Some(*sd))
    )]
    ImpulseMismatch {
        force: String,
        displacement: String,
        gain: f64,
        sd: f64,
    },
    #[error(
        "'{force}' and '{displacement}' are not of one motion: the force, integrated twice, departs from the displacement by {} µm ({} of the largest). Samples may be missing, the arm may ring, or the sensor may not see the whole force",
        with_digits(1e6 * misfit, 2),
        percent(*share)
    )]
    MotionMismatch {
        force: String,
        displacement: String,
        misfit: f64,
        share: f64,
    },
    #[error(
        "channel '{channel}' has only {samples} samples during contact: it says little about the shape of the force law"
    )]
    FewSamples { channel: String, samples: usize },
    #[error(
        "channel '{channel}': {samples} sample(s) outside of the contact are missing and left out, the first at {} s ({first})",
        Rounded(*at)
    )]
    MissingSamples {
        channel: String,
        samples: usize,
        at: f64,
        /// What stands in place of the first, and where.
        first: String,
    },
    #[error("{doubt}")]
    DecimalOrThousands { doubt: String },
}

impl Finding {
    /// The channel that is meant, where it is one.
    pub fn channel(&self) -> Option<&str> {
        match self {
            Self::Reversed { channel, .. }
            | Self::Clipped { channel, .. }
            | Self::IrregularSampling { channel, .. }
            | Self::ShortBaseline { channel, .. }
            | Self::LocalBaseline { channel, .. }
            | Self::Ringing { channel, .. }
            | Self::Shaking { channel, .. }
            | Self::Gravity { channel, .. }
            | Self::OffsetRemoved { channel, .. }
            | Self::WindowFromMotion { channel, .. }
            | Self::HighThreshold { channel, .. }
            | Self::NoiseAtFloor { channel, .. }
            | Self::Glitch { channel, .. }
            | Self::Spikes { channel, .. }
            | Self::SpikesKept { channel, .. }
            | Self::Bump { channel, .. }
            | Self::Filtered { channel, .. }
            | Self::DriftRemoved { channel, .. }
            | Self::FlightHeldBack { channel, .. }
            | Self::HumRemoved { channel, .. }
            | Self::ZeroShift { channel, .. }
            | Self::DriftUnknown { channel, .. }
            | Self::TipMass { channel, .. }
            | Self::GapInContact { channel, .. }
            | Self::FewSamples { channel, .. }
            | Self::MissingSamples { channel, .. } => Some(channel),
            _ => None,
        }
    }

    /// Stable short name, for tables and JSON.
    pub fn code(&self) -> &'static str {
        match self {
            Self::IllegalTransitions { .. } => "illegal-transitions",
            Self::Reversed { .. } => "reversed",
            Self::Clipped { .. } => "clipped",
            Self::IrregularSampling { .. } => "irregular-sampling",
            Self::SeveralContacts { .. } => "several-contacts",
            Self::ContactAtStart { .. } => "contact-at-start",
            Self::ContactAtEnd { .. } => "contact-at-end",
            Self::ShortBaseline { .. } => "short-baseline",
            Self::LocalBaseline { .. } => "local-baseline",
            Self::Ringing { .. } => "ringing",
            Self::Shaking { .. } => "shaking",
            Self::Gravity { .. } => "gravity",
            Self::OffsetRemoved { .. } => "offset-removed",
            Self::WindowFromMotion { .. } => "window-from-motion",
            Self::HighThreshold { .. } => "high-threshold",
            Self::NoiseAtFloor { .. } => "noise-at-floor",
            Self::Glitch { .. } | Self::Spikes { .. } => "glitch",
            Self::SpikesKept { .. } => "spike",
            Self::Bump { .. } => "bump",
            Self::Filtered { .. } => "filtered",
            Self::DriftRemoved { .. } => "drift-removed",
            Self::FlightHeldBack { .. } => "flight-held-back",
            Self::HumRemoved { .. } => "hum-removed",
            Self::ZeroShift { .. } => "zero-shift",
            Self::DriftUnknown { .. } => "drift-unknown",
            Self::TipMass { .. } => "tip-mass",
            Self::AccelerometerDisagrees { .. } => "accelerometer-disagrees",
            Self::EnergyMismatch { .. } => "energy-mismatch",
            Self::GapInContact { .. } => "gap-in-contact",
            Self::LateChannel { .. } => "late-channel",
            Self::ImpulseMismatch { .. } => "impulse-mismatch",
            Self::MotionMismatch { .. } => "motion-mismatch",
            Self::FewSamples { .. } => "few-samples",
            Self::MissingSamples { .. } => "missing-samples",
            Self::DecimalOrThousands { .. } => "decimal-or-thousands",
        }
    }
}

fn short_baseline_text(channel: &str, samples: usize, before: usize) -> String {
    if samples == before {
        return format!(
            "channel '{channel}' has only {samples} samples before contact: its zero and its noise are poorly known"
        );
    }
    format!(
        "channel '{channel}' rises or falls over all of the {before} samples before contact: its zero and its noise are poorly known. Set `baseline = \"drift\"` in [contact], or cut the recording with from_s and to_s in impacts.csv"
    )
}

fn added_text(added: i64) -> String {
    match added {
        1.. => format!("; {added} counts were added in the local direction, as asked"),
        _ => String::new(),
    }
}

fn band_text(band: Band) -> String {
    match band {
        Band::LowPass(cutoff) => format!("low-pass filtered at {} Hz", Rounded(cutoff)),
        Band::HighPass(cutoff) => format!("high-pass filtered at {} Hz", Rounded(cutoff)),
        Band::BandPass(low, high) => format!(
            "band-pass filtered from {} Hz to {} Hz",
            Rounded(low),
            Rounded(high)
        ),
    }
}
