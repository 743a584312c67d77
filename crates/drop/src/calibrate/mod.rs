//! `windfall calibrate`: a law from features or waveforms of drops.

pub mod card;
pub mod design;
pub mod drops;
pub mod features;
pub mod figure;
pub mod figure_waveform;
pub mod law;
pub mod next;
pub mod outcome;
pub mod run;
pub mod store;
pub mod tables;
pub mod tables_text;
pub mod target;
pub mod text;
pub mod waveform;
pub mod waveform_drops;
pub mod waveform_outcome;
pub mod waveform_text;
