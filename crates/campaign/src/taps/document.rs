//! What the store keeps of a recording of taps.

use crate::pipeline::evaluate::Document;
use crate::store::documents::StoredValue;
use serde::{Deserialize, Serialize};
use windfall_files::found::FindingOutcome;
use windfall_signal::tap::damped_mode::Mode;
use windfall_signal::tap::resonance::Resonance;

/// Taps of one recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TapsDocument {
    /// The taps, in their order.
    pub taps: Vec<TapDocument>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// One tap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TapDocument {
    /// Begin; s.
    pub onset: f64,
    /// Largest sound in the band; unit of the file.
    pub peak: f64,
    /// Resonances in order of frequency.
    pub resonances: Vec<ResonanceDocument>,
}

/// One resonance of a tap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResonanceDocument {
    /// Frequency; Hz.
    pub frequency: f64,
    /// Its standard error; `None` where the data cannot tell.
    pub frequency_sd: Option<f64>,
    /// Quality; 1.
    pub quality: f64,
    /// Its standard error.
    pub quality_sd: Option<f64>,
    /// Amplitude at the end of the hit; unit of the file.
    pub amplitude: f64,
    /// Its standard error.
    pub amplitude_sd: Option<f64>,
    /// Phase at the end of the hit; rad.
    pub phase: f64,
    /// Whether the fit reached a minimum.
    pub converged: bool,
    /// Height as a part of the highest peak; 1.
    pub level: f64,
    /// Power over that of the noise; 1.
    pub over_noise: f64,
    /// Whether the quiet before the taps shows it too.
    pub in_quiet: bool,
}

impl Document for TapsDocument {
    fn values(&self) -> Vec<StoredValue> {
        let mut values = Vec::new();
        for (tap, of_tap) in self.taps.iter().enumerate() {
            for (number, resonance) in of_tap.resonances.iter().enumerate() {
                let name = |what: &str| format!("tap {} resonance {} {what}", tap + 1, number + 1);
                let value = |what, value, sd, unit: &str| StoredValue {
                    name: name(what),
                    value,
                    sd,
                    unit: unit.to_owned(),
                };
                let (f, q) = (resonance.frequency, resonance.quality);
                values.push(value("frequency", f, resonance.frequency_sd, "Hz"));
                values.push(value("quality", q, resonance.quality_sd, "1"));
                values.push(value("level", resonance.level, None, "1"));
            }
        }
        values
    }
}

/// A resonance as it is kept.
#[must_use]
pub fn document_of(resonance: &Resonance) -> ResonanceDocument {
    let finite = |sd: f64| sd.is_finite().then_some(sd);
    let mode = &resonance.mode;
    ResonanceDocument {
        frequency: mode.frequency,
        frequency_sd: finite(mode.frequency_sd),
        quality: mode.quality,
        quality_sd: finite(mode.quality_sd),
        amplitude: mode.amplitude,
        amplitude_sd: finite(mode.amplitude_sd),
        phase: mode.phase,
        converged: mode.converged,
        level: resonance.level,
        // A recording without any noise is simulated; JSON holds no infinity.
        over_noise: resonance.over_noise.min(f64::MAX),
        in_quiet: resonance.in_quiet,
    }
}

/// A resonance as it was.
#[must_use]
pub fn resonance_of(document: &ResonanceDocument) -> Resonance {
    let sd = |sd: Option<f64>| sd.unwrap_or(f64::INFINITY);
    Resonance {
        mode: Mode {
            frequency: document.frequency,
            frequency_sd: sd(document.frequency_sd),
            quality: document.quality,
            quality_sd: sd(document.quality_sd),
            amplitude: document.amplitude,
            amplitude_sd: sd(document.amplitude_sd),
            phase: document.phase,
            converged: document.converged,
        },
        level: document.level,
        over_noise: document.over_noise,
        in_quiet: document.in_quiet,
    }
}
