//! What an instrument wrote, in SI units and with names that a person gave.

/// Physical quantity of a channel, after calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Position or displacement of the impactor; m.
    Displacement,
    /// Displacement rate of the impactor; m/s.
    Rate,
    /// Contact force; N.
    Force,
    /// Acceleration of the impactor; m/s².
    Acceleration,
    /// Angle of the pendulum arm; rad.
    Angle,
    /// Count of an incremental encoder after ×4 decoding; 1.
    EncoderCount,
    /// Phase A of an incremental encoder; V or logic level.
    PhaseA,
    /// Phase B of an incremental encoder; V or logic level.
    PhaseB,
    /// Sound of a microphone, or vibration, in any unit.
    Sound,
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Displacement => "displacement",
            Self::Rate => "displacement rate",
            Self::Force => "force",
            Self::Acceleration => "acceleration",
            Self::Angle => "angle",
            Self::EncoderCount => "encoder count",
            Self::PhaseA => "phase A",
            Self::PhaseB => "phase B",
            Self::Sound => "sound",
        })
    }
}

/// Sampling times of a channel; s.
#[derive(Clone, Debug, PartialEq)]
pub enum Times {
    /// `start + i · interval`.
    Uniform {
        /// Time of the first sample; s.
        start: f64,
        /// Time between samples; s.
        interval: f64,
    },
    /// One time per sample, strictly increasing; s.
    Listed(Vec<f64>),
}

impl Times {
    /// Time of sample `index`; s.
    pub fn at(&self, index: usize) -> f64 {
        match self {
            Self::Uniform { start, interval } => start + index as f64 * interval,
            Self::Listed(times) => times[index],
        }
    }
}

/// One channel of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name in the file, for messages.
    pub name: String,
    /// What the samples are.
    pub quantity: Quantity,
    /// When they were taken.
    pub times: Times,
    /// Samples; SI unit of `quantity`.
    pub samples: Vec<f64>,
}

/// One recording of one or more impacts: what a reader returns.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Where it came from, for messages (a file name).
    pub name: String,
    /// Channels, each with its own sampling times.
    pub channels: Vec<Channel>,
    /// Samples that the instrument could not give.
    pub missing: Vec<Missing>,
    /// What was assumed about the numbers themselves, in a sentence each.
    pub doubts: Vec<String>,
}

/// Samples of a channel that the instrument could not give; the channel is without them.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// Name of the channel in the file.
    pub channel: String,
    /// When they would have been taken; s.
    pub times: Vec<f64>,
    /// What stands in place of the first, and where.
    pub first: String,
}
