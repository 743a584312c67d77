//! Taps and the resonances of the fruit that is tapped.

pub mod acoustic_stiffness;
pub mod damped_mode;
pub mod find;
pub mod finding;
pub mod first_mode;
pub mod resonance;
pub mod spectrum;
pub mod spectrum_peak;
