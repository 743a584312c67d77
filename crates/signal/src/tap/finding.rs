//! What is poor in recordings of taps.

use crate::error::Rounded;

/// Something about a recording of taps that a reader must know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum TapFinding {
    #[error(
        "the recording begins in a tap: its first milliseconds are taken as the hit, and there is no quiet part that would show hum and resonances of the room; record with a pre-trigger"
    )]
    BeginsInTap,
    #[error(
        "the tap at {} s is left out: too little of its ringing before the next tap or the end of the recording",
        Rounded(*time)
    )]
    TapTooShort { time: f64 },
    #[error(
        "the tap at {} s is clipped: amplitudes and decay are wrong, and peaks appear that are none; lower the gain",
        Rounded(*time)
    )]
    TapClipped { time: f64 },
    #[error(
        "the tap at {} s shows no peak above noise in the band",
        Rounded(*time)
    )]
    NoPeak { time: f64 },
}

impl TapFinding {
    /// Stable short name, for tables and JSON.
    pub fn code(&self) -> &'static str {
        match self {
            Self::BeginsInTap => "begins_in_tap",
            Self::TapTooShort { .. } => "tap_too_short",
            Self::TapClipped { .. } => "tap_clipped",
            Self::NoPeak { .. } => "no_peak",
        }
    }
}
