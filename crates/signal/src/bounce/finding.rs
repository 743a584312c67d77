//! What is poor in recordings of bounces.

use crate::error::Rounded;
use std::fmt;

/// Something about a recording of bounces that a reader must know.
#[derive(Clone, Debug, PartialEq)]
pub enum BounceFinding {
    /// Nothing in the force is a bounce.
    NoBounce {
        /// Largest departure from the static level; N.
        largest: f64,
        /// Threshold; N.
        threshold: f64,
    },
    /// Fewer than two impacts on the plate.
    NotValid,
    /// The force was negative in contact and was turned round.
    Reversed,
    /// The recording begins in contact.
    BeginsInContact {
        /// Samples before the first contact.
        samples: usize,
    },
    /// The recording ends in contact.
    EndsInContact {
        /// Onset of the last bounce; s.
        onset: f64,
    },
    /// The recording ends while the plate rings.
    EndsInRinging {
        /// Onset of the last bounce; s.
        onset: f64,
        /// Amplitude at the end over the noise; 1.
        amplitude: f64,
    },
    /// The static level moves.
    StaticLevelDrifts {
        /// Difference of the levels; N.
        change: f64,
        /// Time of the first; s.
        from: f64,
        /// Time of the second; s.
        to: f64,
    },
    /// The force stands at the limit of the instrument.
    Clipped {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// The limit; N.
        limit: f64,
        /// Successive samples at it.
        samples: usize,
    },
    /// The plate still rings when the next impact begins.
    StillRinging {
        /// Number of the bounce that begins, from 1.
        bounce: usize,
        /// Its onset; s.
        onset: f64,
        /// Amplitude of the ringing; N.
        amplitude: f64,
        /// Peak of the bounce; N.
        peak: f64,
    },
    /// Too few samples in a contact.
    SlowSampling {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// Samples in contact.
        samples: usize,
        /// Sampling rate that would do; Hz.
        needed: f64,
    },
    /// What follows the contacts is not the ringing of one mode.
    RingingNotOneMode {
        /// Residual over noise.
        misfit: f64,
        /// Begin of the stretch; s.
        from: f64,
    },
}

impl BounceFinding {
    /// Stable short name, for tables and JSON.
    #[must_use]
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

impl fmt::Display for BounceFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBounce { largest, threshold } => write!(
                f,
                "no bounce: the force departs by {largest:.4} N at most from its static level, and a contact begins above {threshold:.4} N; check channel and volts per newton, lower [bounces] threshold, or leave the recording out"
            ),
            Self::NotValid => write!(
                f,
                "not valid: one impact on the plate, and two are needed; the rebound missed the plate, or the recording ends too early. Without a second impact there is no restitution from time; impulse and waveform remain"
            ),
            Self::Reversed => write!(
                f,
                "the force is negative in contact; its sign was changed. Give volts per newton with the sign of the wiring to be rid of this message"
            ),
            Self::BeginsInContact { samples } => write!(
                f,
                "{samples} samples before the first contact: the static level is taken from quiet stretches elsewhere, and the first onset and impulse are not to be trusted; record with a pre-trigger of a tenth of a second"
            ),
            Self::EndsInContact { onset } => write!(
                f,
                "the recording ends in the contact that begins at {} s: its impulse and end are not known; record longer",
                Rounded(*onset)
            ),
            Self::EndsInRinging { onset, amplitude } => write!(
                f,
                "the recording ends while the plate rings from the impact at {} s, with {amplitude:.1} times the noise: the impulse of this impact is corrected for what is left; record until the force is quiet",
                Rounded(*onset)
            ),
            Self::StaticLevelDrifts { change, from, to } => write!(
                f,
                "the static level moves by {change:.4} N from {} s to {} s: forces and impulses are off by that much; let the transmitter warm up, or set [bounces] static_level = \"follow\"",
                Rounded(*from),
                Rounded(*to)
            ),
            Self::Clipped {
                bounce,
                limit,
                samples,
            } => write!(
                f,
                "bounce {bounce} is clipped: {samples} successive samples at {limit:.4} N where both flanks point higher; its peak and impulse are too small. Choose a larger range, or a lower height"
            ),
            Self::StillRinging {
                bounce,
                onset,
                amplitude,
                peak,
            } => write!(
                f,
                "the plate still rings with {amplitude:.4} N when bounce {bounce} begins at {} s (peak {peak:.4} N): the ringing is taken out for onset, first peak and impulse, but the largest support force contains it; do not compare that with other peaks",
                Rounded(*onset)
            ),
            Self::SlowSampling {
                bounce,
                samples,
                needed,
            } => write!(
                f,
                "bounce {bounce} has {samples} samples in contact: its peak falls between them, and impulse and onset are rough; sample at {needed:.0} Hz or faster"
            ),
            Self::RingingNotOneMode { misfit, from } => write!(
                f,
                "after {} s the plate does not ring as one damped mode does: {misfit:.1} times the noise is left; damping ratio and stiffness describe it roughly. Look for a loose plate, a second mode or a cable that touches",
                Rounded(*from)
            ),
        }
    }
}
