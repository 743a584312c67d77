//! What is poor in recordings of bounces.

use crate::error::Rounded;

/// Something about a recording of bounces that a reader must know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum BounceFinding {
    #[error(
        "no bounce: the force departs by {largest:.4} N at most from its static level, and a contact begins above {threshold:.4} N; check channel and volts per newton, lower [bounces] threshold, or leave the recording out"
    )]
    NoBounce { largest: f64, threshold: f64 },
    #[error(
        "not valid: one impact on the plate, and two are needed; the rebound missed the plate, or the recording ends too early. Without a second impact there is no restitution from time; impulse and waveform remain"
    )]
    NotValid,
    #[error(
        "the force is negative in contact; its sign was changed. Give volts per newton with the sign of the wiring to be rid of this message"
    )]
    Reversed,
    #[error(
        "{samples} samples before the first contact: the static level is taken from quiet stretches elsewhere, and the first onset and impulse are not to be trusted; record with a pre-trigger of a tenth of a second"
    )]
    BeginsInContact { samples: usize },
    #[error(
        "the recording ends in the contact that begins at {} s: its impulse and end are not known; record longer",
        Rounded(*onset)
    )]
    EndsInContact { onset: f64 },
    #[error(
        "the recording ends while the plate rings from the impact at {} s, with {amplitude:.1} times the noise: the impulse of this impact is corrected for what is left; record until the force is quiet",
        Rounded(*onset)
    )]
    EndsInRinging { onset: f64, amplitude: f64 },
    #[error(
        "the static level moves by {change:.4} N from {} s to {} s: forces and impulses are off by that much; let the transmitter warm up, or set [bounces] static_level = \"follow\"",
        Rounded(*from),
        Rounded(*to)
    )]
    StaticLevelDrifts { change: f64, from: f64, to: f64 },
    #[error(
        "bounce {bounce} is clipped: {samples} successive samples at {limit:.4} N where both flanks point higher; its peak and impulse are too small. Choose a larger range, or a lower height"
    )]
    Clipped {
        bounce: usize,
        limit: f64,
        samples: usize,
    },
    #[error(
        "the plate still rings with {amplitude:.4} N when bounce {bounce} begins at {} s (peak {peak:.4} N): the ringing is taken out for onset, first peak and impulse, but the largest support force contains it; do not compare that with other peaks",
        Rounded(*onset)
    )]
    StillRinging {
        bounce: usize,
        onset: f64,
        amplitude: f64,
        peak: f64,
    },
    #[error(
        "bounce {bounce} has {samples} samples in contact: its peak falls between them, and impulse and onset are rough; sample at {needed:.0} Hz or faster"
    )]
    SlowSampling {
        bounce: usize,
        samples: usize,
        needed: f64,
    },
    #[error(
        "after {} s the plate does not ring as one damped mode does: {misfit:.1} times the noise is left; damping ratio and stiffness describe it roughly. Look for a loose plate, a second mode or a cable that touches",
        Rounded(*from)
    )]
    RingingNotOneMode { misfit: f64, from: f64 },
}

impl BounceFinding {
    /// Stable short name, for tables and JSON.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoBounce { .. } => "no_bounce",
            Self::NotValid => "not_valid",
            Self::Reversed => "force_reversed",
            Self::BeginsInContact { .. } => "begins_in_contact",
            Self::EndsInContact { .. } => "ends_in_contact",
            Self::EndsInRinging { .. } => "ends_in_ringing",
            Self::StaticLevelDrifts { .. } => "static_level_drifts",
            Self::Clipped { .. } => "bounce_clipped",
            Self::StillRinging { .. } => "still_ringing",
            Self::SlowSampling { .. } => "slow_sampling",
            Self::RingingNotOneMode { .. } => "ringing_not_one_mode",
        }
    }
}
