//! A law calibrated on the whole recorded waveform of drops: types and answer.

use crate::rig::DropRig;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_signal::uncertain::Uncertain;

/// What is known of a quantity beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Knowledge {
    /// Exactly its value.
    Fixed(f64),
    /// A value with its standard uncertainty.
    Prior(Uncertain),
    /// Nothing: the value is where to begin.
    Free(f64),
}

impl Knowledge {
    /// The value to begin with.
    pub fn start(self) -> f64 {
        match self {
            Self::Fixed(value) | Self::Free(value) => value,
            Self::Prior(known) => known.value,
        }
    }

    /// A measured value: exact where its uncertainty is zero.
    pub fn measured(known: Uncertain) -> Self {
        if known.sd > 0.0 {
            Self::Prior(known)
        } else {
            Self::Fixed(known.value)
        }
    }
}

/// One drop, or one bounce of it, as it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct DropRecord {
    /// Times of the samples, ascending; s.
    pub times: Vec<f64>,
    /// Force on the support about its static level; N.
    pub force: Vec<f64>,
    /// Standard deviation of the noise of a sample; N.
    pub noise: f64,
    /// First touches of the impacts that are fitted, as seen in the signal; s.
    pub onsets: Vec<f64>,
    /// From when to when samples are used, one stretch for each impact; s.
    pub windows: Vec<(f64, f64)>,
    /// Velocity at first touch; m/s.
    pub velocity: Knowledge,
    /// Mass of the fruit; kg.
    pub mass: Knowledge,
}

/// The rig that all drops share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveformRig {
    /// Acceleration between impacts; m/s².
    pub gravity: f64,
    /// Effective mass factor; 1.
    pub effective_mass_factor: Knowledge,
    /// The plate; `None` for one that does not move.
    pub plate: Option<WaveformPlate>,
}

/// What is known of the plate.
///
/// Its mass and stiffness enter the support force almost only by their ratio:
/// one of them has to be known from elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveformPlate {
    /// Mass; kg.
    pub mass: Knowledge,
    /// Stiffness; N/m.
    pub stiffness: Knowledge,
    /// Damping; N s/m.
    pub damping: Knowledge,
}

/// What is calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveformProblem {
    /// The law at its start values.
    pub law: Law,
    /// Positions of its parameters that are estimated.
    pub free: Vec<usize>,
    /// When a contact is over.
    pub end: EndRule,
    /// The rig.
    pub rig: WaveformRig,
    /// The drops.
    pub records: Vec<DropRecord>,
}

/// An estimate with its uncertainties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Value; SI.
    pub value: f64,
    /// Standard uncertainty; SI.
    pub sd: f64,
    /// Lower end of the 95 % interval; SI.
    pub low: f64,
    /// Upper end; SI.
    pub high: f64,
}

/// One record's part of the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFit {
    /// First touch on the record's clock; s.
    pub onset: Estimate,
    /// Velocity at first touch; m/s.
    pub velocity: Estimate,
    /// Mass; kg.
    pub mass: Estimate,
    /// Level of the signal; N.
    pub level: Estimate,
    /// χ² of its samples over their number.
    pub misfit: f64,
    /// Samples.
    pub samples: usize,
}

/// A poorly determined direction.
#[derive(Clone, Debug, PartialEq)]
pub struct WeakDirection {
    /// Standard deviation along it, in units of the estimate: of logarithms
    /// for positive parameters; 1.
    pub sd: f64,
    /// Share of each shared parameter in it, largest 1, in the order of
    /// [`WaveformFit::names`].
    pub shares: Vec<f64>,
}

/// A calibrated law.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveformFit {
    /// The law at the optimum.
    pub law: Law,
    /// The rig at the optimum, with the mass of the first record.
    pub rig: DropRig,
    /// Names of what was estimated: parameters of the law, then
    /// "plate_stiffness", "plate_damping", "plate_mass",
    /// "effective_mass_factor".
    pub names: Vec<String>,
    /// The estimates, in that order.
    pub estimates: Vec<Estimate>,
    /// Covariance of the logarithms of positive parameters and the plain values
    /// of others; `logarithmic` says which.
    pub covariance: Vec<Vec<f64>>,
    /// Whether the row of `covariance` is that of a logarithm.
    pub logarithmic: Vec<bool>,
    /// Standard uncertainties if the noise were all (before records were held
    /// against each other).
    pub sd_of_noise: Vec<f64>,
    /// Standard uncertainties by the scatter from record to record; empty for
    /// too few records.
    pub sd_of_records: Vec<f64>,
    /// Whether the intervals are those of the records.
    pub by_records: bool,
    /// The direction that is known least; `None` where one parameter is free.
    pub weakest: Option<WeakDirection>,
    /// One for each record.
    pub records: Vec<RecordFit>,
    /// Weighted sum of squares, priors included.
    pub cost: f64,
    /// Samples.
    pub samples: usize,
    /// χ² of the samples over their number less the free parameters.
    pub misfit: f64,
    /// Evaluations of all records.
    pub evaluations: usize,
    /// Whether the minimum was reached.
    pub converged: bool,
}
