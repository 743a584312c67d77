//! What a calibration on waveforms gives; numbers are SI unless a unit stands
//! with them.

use serde::Serialize;
use windfall_files::named::Named;
use windfall_measure::measured::MeasuredValue;

/// A law calibrated on waveforms.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WaveformOutcome {
    /// The law.
    pub law: String,
    /// What was estimated: free parameters, then those of the plate.
    pub parameters: Vec<WaveformParameter>,
    /// Covariance of their logarithms (of exponents: of themselves).
    pub covariance: Vec<Vec<f64>>,
    /// Whether the covariance is that of the logarithm.
    pub logarithmic: Vec<bool>,
    /// Their correlations.
    pub correlations: Vec<Vec<f64>>,
    /// The combination that is known least.
    pub weakest: Option<WeakOutcome>,
    /// Whether uncertainties are those of the scatter from drop to drop.
    pub by_scatter: bool,
    /// χ² over the number of samples less the free parameters.
    pub misfit: f64,
    /// Samples.
    pub samples: usize,
    /// Impacts.
    pub impacts: usize,
    /// The drops.
    pub drops: Vec<WaveformDropOutcome>,
    /// Whether the minimum was reached.
    pub converged: bool,
    /// Evaluations of all waveforms with their derivatives.
    pub evaluations: usize,
}

/// An estimate.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WaveformParameter {
    /// Its name.
    pub name: String,
    /// Value with its 95 % interval.
    pub value: MeasuredValue,
    /// Standard uncertainty if noise were all.
    pub sd_of_noise: f64,
    /// A stiffness "N/m^e" also in "N/mm^e", which is less tied to e.
    pub per_millimetre: Option<MeasuredValue>,
}

/// A combination of parameters that is known little.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WeakOutcome {
    /// Its standard uncertainty: relative, of exponents absolute.
    pub sd: f64,
    /// Share of each parameter, largest 1.
    pub shares: Named<f64>,
}

/// What the waveform of one drop tells.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WaveformDropOutcome {
    /// Id in impacts.csv.
    pub id: String,
    /// The fruit.
    pub specimen: String,
    /// Drop height as measured; m.
    pub height: f64,
    /// First touch on the recording's clock.
    pub onset: MeasuredValue,
    /// Velocity at first touch.
    pub velocity: MeasuredValue,
    /// Mass.
    pub mass: MeasuredValue,
    /// Level of the force.
    pub level: MeasuredValue,
    /// χ² of its samples over their number.
    pub misfit: f64,
    /// Samples.
    pub samples: usize,
}
