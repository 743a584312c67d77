//! What the store keeps of a recording of taps.

use crate::measured::value_with_sd;
use serde::{Deserialize, Serialize};
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::store::documents::StoredValue;
use windfall_files::found::FindingOutcome;
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
    pub resonances: Vec<Resonance>,
}

impl Document for TapsDocument {
    fn values(&self) -> Vec<StoredValue> {
        let mut values = Vec::new();
        for (tap, of_tap) in self.taps.iter().enumerate() {
            for (number, Resonance { mode, level, .. }) in of_tap.resonances.iter().enumerate() {
                let name = |what: &str| format!("tap {} resonance {} {what}", tap + 1, number + 1);
                let value =
                    |what, value, sd, unit| value_with_sd(value, sd, unit).stored(name(what));
                values.push(value("frequency", mode.frequency, mode.frequency_sd, "Hz"));
                values.push(value("quality", mode.quality, mode.quality_sd, "1"));
                values.push(value("level", *level, f64::INFINITY, "1"));
            }
        }
        values
    }
}

/// A resonance as it is read back from the store: standard errors that are not known are
/// infinite, and JSON has no infinity for a recording without noise, which is simulated.
pub fn kept(mut resonance: Resonance) -> Resonance {
    let mode = &mut resonance.mode;
    for sd in [
        &mut mode.frequency_sd,
        &mut mode.quality_sd,
        &mut mode.amplitude_sd,
    ] {
        *sd = if sd.is_finite() { *sd } else { f64::INFINITY };
    }
    resonance.over_noise = resonance.over_noise.min(f64::MAX);
    resonance
}
