//! What is poor in a recording, without stopping the extraction.

use crate::error::{Rounded, Times};
use crate::filter::butterworth::Band;

/// Something about the signals that a reader of the results must know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Finding {
    /// More than 0.1 % of the encoder's transitions skip a state.
    #[error(
        "{channels}: {illegal} of {transitions} transitions skip a state ({:.2} %), the first at {} s; the displacement is wrong from there by 2 counts each. Raise the sampling rate (now {} Hz; it must exceed speed / count length) or check the wiring{}",
        100.0 * *illegal as f64 / *transitions as f64,
        Rounded(*first),
        Rounded(*sampling_rate),
        added_text(*added)
    )]
    IllegalTransitions {
        /// Names of the phases.
        channels: String,
        /// Transitions in which both phases change.
        illegal: usize,
        /// All transitions.
        transitions: usize,
        /// Time of the first; s.
        first: f64,
        /// Sampling rate; Hz.
        sampling_rate: f64,
        /// Counts added for skipped states, in the local direction.
        added: i64,
    },
    /// A channel with the opposite sign of the convention.
    #[error(
        "channel '{channel}' has the opposite sign of the convention (motion into the fruit and repulsive force are positive); {}. Set its sign in campaign.toml, or swap the phases of an encoder",
        if *corrected { "its sign has been changed" } else { "it is used as recorded" }
    )]
    Reversed {
        /// Name of the channel.
        channel: String,
        /// True if its sign has been changed.
        corrected: bool,
    },
    /// Successive force samples at the limit of the instrument.
    #[error(
        "channel '{channel}' is clipped: {samples} successive samples at {value} from {} s to {} s; peak, impulse and fitted parameters are biased. Enlarge the measuring range",
        Rounded(*from),
        Rounded(*to)
    )]
    Clipped {
        /// Name of the channel.
        channel: String,
        /// The limit, as recorded (before offset and sign are corrected).
        value: f64,
        /// Samples at the limit.
        samples: usize,
        /// Time of the first of them; s.
        from: f64,
        /// Time of the last of them; s.
        to: f64,
    },
    /// Sampling intervals that differ.
    #[error(
        "channel '{channel}' is sampled irregularly: the interval departs by up to {jitter:.3e} s from its median of {interval:.3e} s, most at {} s; the recorded times are used as they are",
        Rounded(*at)
    )]
    IrregularSampling {
        /// Name of the channel.
        channel: String,
        /// Median interval; s.
        interval: f64,
        /// Largest departure from it; s.
        jitter: f64,
        /// Where that is; s.
        at: f64,
    },
    /// More than one contact.
    #[error(
        "{} contacts, beginning at {onsets} s; the one at {} s is used. Give a time range to choose another",
        onsets.0.len(),
        Rounded(*used)
    )]
    SeveralContacts {
        /// Onset of each; s.
        onsets: Times,
        /// Onset of the one that is used; s.
        used: f64,
    },
    /// The recording begins in contact.
    #[error(
        "the recording begins in contact ({} s): onset and impact velocity are not seen. Record some samples before the trigger",
        Rounded(*time)
    )]
    ContactAtStart {
        /// Begin of the recording; s.
        time: f64,
    },
    /// The recording ends in contact.
    #[error(
        "the recording ends in contact ({} s): separation and rebound are not seen. Record longer",
        Rounded(*time)
    )]
    ContactAtEnd {
        /// End of the recording; s.
        time: f64,
    },
    /// Hardly any sample before contact from which to know zero and noise.
    #[error(
        "channel '{channel}' has only {samples} samples before contact: its zero and its noise are poorly known"
    )]
    ShortBaseline {
        /// Name of the channel.
        channel: String,
        /// Samples before contact.
        samples: usize,
    },
    /// An offset of the force that has been subtracted.
    #[error(
        "channel '{channel}' reads {offset:.4} ± {offset_sd:.4} N before contact; this offset has been subtracted"
    )]
    OffsetRemoved {
        /// Name of the channel.
        channel: String,
        /// The offset; N.
        offset: f64,
        /// Its standard uncertainty; N.
        offset_sd: f64,
    },
    /// No force channel: the contact window comes from the motion.
    #[error(
        "no force channel: the contact window comes from the deceleration in '{channel}' and is known to about {resolution:.2e} s"
    )]
    WindowFromMotion {
        /// Name of the channel.
        channel: String,
        /// How finely onset and end are known; s.
        resolution: f64,
    },
    /// The noise could not be measured and a floor stands in for it.
    #[error("the noise of '{channel}' cannot be measured; {floor:.3e} is assumed ({reason})")]
    NoiseAtFloor {
        /// Name of the channel.
        channel: String,
        /// The floor; unit of the channel.
        floor: f64,
        /// Where the floor comes from.
        reason: &'static str,
    },
    /// A sample next to the contact that does not belong to the motion.
    #[error(
        "channel '{channel}': the sample at {} s ({value:.4e}) does not fit the free motion around it and is left out",
        Rounded(*time)
    )]
    Glitch {
        /// Name of the channel.
        channel: String,
        /// Its time; s.
        time: f64,
        /// Its value; unit of the channel.
        value: f64,
    },
    /// A channel that has been filtered.
    #[error(
        "channel '{channel}' was {} (Butterworth of order {order}, forwards and backwards, no delay); {:.1} % of its range is left, and neighbouring samples share their noise",
        band_text(*band),
        100.0 * kept
    )]
    Filtered {
        /// Name of the channel.
        channel: String,
        /// What the filter lets through.
        band: Band,
        /// Its order.
        order: usize,
        /// Range of the values after it over that before; 1.
        kept: f64,
    },
    /// A drift of the force that has been taken off.
    #[error(
        "a drift of {slope:.4} ± {slope_sd:.4} N/s in channel '{channel}', from the quiet stretches before and after contact, has been subtracted"
    )]
    DriftRemoved {
        /// Name of the channel.
        channel: String,
        /// The drift; N/s.
        slope: f64,
        /// Its standard deviation; N/s.
        slope_sd: f64,
    },
    /// A drift that cannot be told.
    #[error(
        "no drift of channel '{channel}' can be told from {before} samples before and {after} after contact; only the mean before it has been subtracted. Record longer"
    )]
    DriftUnknown {
        /// Name of the channel.
        channel: String,
        /// Samples before the first contact.
        before: usize,
        /// Samples after the last.
        after: usize,
    },
    /// The force of the tip ahead of the sensor has been added.
    #[error(
        "a tip of {} kg ahead of '{channel}': its inertia, from {}, raises the largest force by {:.1} %",
        Rounded(*mass),
        if *measured { "the measured acceleration" } else { "the rig's own motion (a rigid impactor)" },
        100.0 * (raised - 1.0)
    )]
    TipMass {
        /// Name of the channel.
        channel: String,
        /// Mass of the tip; kg.
        mass: f64,
        /// Whether the acceleration was measured.
        measured: bool,
        /// Largest force after it over that before; 1.
        raised: f64,
    },
    /// Force and acceleration do not belong to one mass.
    #[error(
        "force and mass times acceleration disagree: impulses as {impulse_ratio:.3} ± {impulse_ratio_sd:.3} to 1, peaks as {peak_ratio:.3} ± {peak_ratio_sd:.3} to 1; check both calibrations, the mass, and that the accelerometer sits where the force acts"
    )]
    AccelerometerDisagrees {
        /// Ratio of the impulses; 1.
        impulse_ratio: f64,
        /// Its standard uncertainty, from noise and zeros; 1.
        impulse_ratio_sd: f64,
        /// Ratio of the largest values; 1.
        peak_ratio: f64,
        /// Its standard uncertainty, likewise; 1.
        peak_ratio_sd: f64,
    },
    /// The loop of force over displacement and the velocities tell other energies.
    #[error(
        "the loop of force over displacement holds {area:.4e} J and the velocities tell {absorbed:.4e} J absorbed; check the calibrations of force and displacement, the delay between them, and the mass"
    )]
    EnergyMismatch {
        /// Area of the loop; J.
        area: f64,
        /// Difference of the kinetic energies; J.
        absorbed: f64,
    },
    /// Few samples during contact.
    #[error(
        "channel '{channel}' has only {samples} samples during contact: it says little about the shape of the force law"
    )]
    FewSamples {
        /// Name of the channel.
        channel: String,
        /// Samples in contact.
        samples: usize,
    },
}

impl Finding {
    /// Stable short name, for tables and JSON.
    #[must_use]
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
            Self::OffsetRemoved { .. } => "offset-removed",
            Self::WindowFromMotion { .. } => "window-from-motion",
            Self::NoiseAtFloor { .. } => "noise-at-floor",
            Self::Glitch { .. } => "glitch",
            Self::Filtered { .. } => "filtered",
            Self::DriftRemoved { .. } => "drift-removed",
            Self::DriftUnknown { .. } => "drift-unknown",
            Self::TipMass { .. } => "tip-mass",
            Self::AccelerometerDisagrees { .. } => "accelerometer-disagrees",
            Self::EnergyMismatch { .. } => "energy-mismatch",
            Self::FewSamples { .. } => "few-samples",
        }
    }
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
