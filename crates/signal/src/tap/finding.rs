//! What is poor in recordings of taps.

use crate::error::Rounded;
use std::fmt;

/// Something about a recording of taps that a reader must know.
#[derive(Clone, Debug, PartialEq)]
pub enum TapFinding {
    /// The recording begins in a tap: what the hit was is not known.
    BeginsInTap,
    /// Too little of the ringing before the next tap or the end.
    TapTooShort {
        /// Begin of the tap; s.
        time: f64,
    },
    /// The sound stands at the limit of the instrument.
    TapClipped {
        /// Begin of the tap; s.
        time: f64,
    },
    /// No peak in the band.
    NoPeak {
        /// Begin of the tap; s.
        time: f64,
    },
}

impl TapFinding {
    /// Stable short name, for tables and JSON.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::BeginsInTap => "begins_in_tap",
            Self::TapTooShort { .. } => "tap_too_short",
            Self::TapClipped { .. } => "tap_clipped",
            Self::NoPeak { .. } => "no_peak",
        }
    }
}

impl fmt::Display for TapFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BeginsInTap => write!(
                f,
                "the recording begins in a tap: its first milliseconds are taken as the hit, and there is no quiet part that would show hum and resonances of the room; record with a pre-trigger"
            ),
            Self::TapTooShort { time } => write!(
                f,
                "the tap at {} s is left out: too little of its ringing before the next tap or the end of the recording",
                Rounded(*time)
            ),
            Self::TapClipped { time } => write!(
                f,
                "the tap at {} s is clipped: amplitudes and decay are wrong, and peaks appear that are none; lower the gain",
                Rounded(*time)
            ),
            Self::NoPeak { time } => write!(
                f,
                "the tap at {} s shows no peak above noise in the band",
                Rounded(*time)
            ),
        }
    }
}
