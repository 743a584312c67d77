//! Kinds of faults that a bench may have.

use crate::bench::residuals::BenchFault;
use windfall_signal::response::{Bending, Response, Swing};

/// Parameters of a cause at most: gain, delay, frequency, damping, compliance.
pub(crate) const MOST: usize = 5;

/// What may be wrong with a bench: any of these together, of the last three one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cause {
    /// The force reads more or less than it is, or the mass is another.
    pub gain: bool,
    /// The force comes late.
    pub delay: bool,
    /// The force passes a filter of first order.
    pub pole: bool,
    /// The force sensor swings.
    pub sensor: bool,
    /// The arm bends between impactor and displacement sensor.
    pub arm: bool,
}

impl Cause {
    /// Which of the coordinates it has: gain, delay, frequency, damping, compliance.
    pub(crate) fn free(self) -> [bool; MOST] {
        [
            self.gain,
            self.delay,
            self.pole || self.swings(),
            self.swings(),
            self.arm,
        ]
    }

    pub(crate) fn swings(self) -> bool {
        self.sensor || self.arm
    }

    /// Number of its parameters.
    pub fn parameters(self) -> usize {
        self.free().iter().filter(|free| **free).count()
    }

    /// The fault at coordinates: gain, delay over `time`, ln of frequency and damping, bending
    /// over `compliance`.
    pub(crate) fn fault(self, at: &[f64; MOST], time: f64, compliance: f64) -> BenchFault {
        let frequency = at[2].exp();
        let swing = Swing {
            frequency,
            damping: at[3].exp().min(0.999),
        };
        BenchFault {
            gain: at[0],
            delay: at[1] * time,
            response: Response {
                pole: self.pole.then_some(frequency),
                sensor: self.sensor.then_some(swing),
                arm: self.arm.then_some(Bending {
                    swing,
                    compliance: at[4] * compliance,
                }),
            },
        }
    }
}
