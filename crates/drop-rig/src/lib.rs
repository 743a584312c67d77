//! Drop rigs: fruit that bounces on a sprung plate, simulated and calibrated.

mod arrow_system;
pub mod contact;
pub mod coordinates;
pub(crate) mod dual;
pub mod eccentric;
pub mod event;
pub mod experiment;
pub mod family;
pub mod feature_fit;
pub mod feature_problem;
pub mod flight;
pub mod follow;
pub mod information;
pub mod measured;
pub mod observe;
pub mod plate_ringing;
pub mod rig;
pub mod sensitivity;
pub mod simulate;
pub mod start;
pub mod tally;
pub mod waveform;
pub mod waveform_fit;
mod waveform_parameters;
mod waveform_record;
mod waveform_report;
