#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Recording → Impact: decoding, contact windows, displacement rate, energies.
//!
//! [`recording::Recording`] is what a reader returns, in SI units;
//! [`extract::extract_impact`] cuts one impact out of it
//! ([`impact::Impact`], with [`finding::Finding`]s about what is poor);
//! [`mass::mass_from_impulse`] finds the mass of a carriage;
//! [`instrument::record`] goes the other way and writes what an instrument
//! would have written of a motion. Impacts repeated on one spot are aligned
//! ([`repeat_align`]), compared over fruit ([`repeat_permutation`],
//! [`repeat_equivalence`]) or fruit by fruit ([`repeat_criterion`]), and give
//! the critical impact energy ([`repeat_threshold`], [`repeat_turnbull`]).
//!
//! This crate opens no file and knows no force law.

pub mod accelerometer;
pub mod acoustic_stiffness;
pub mod bounce;
pub mod bounce_contact;
pub mod bounce_finding;
pub mod bounce_measure;
pub mod bounce_quality;
pub mod bounce_rise;
pub mod bounce_segment;
pub mod bounce_static;
pub mod bounce_train;
pub mod clipping;
mod compare;
pub mod compression;
pub mod conditioning;
pub mod damped_mode;
pub mod deceleration;
pub mod edge_rate;
pub mod energy_angles;
pub mod error;
pub mod extract;
pub mod filter_butterworth;
pub mod filter_zero_phase;
pub mod finding;
pub mod first_mode;
pub mod force_loop;
pub mod impact;
pub mod instrument;
pub mod kinematics;
pub mod mass;
pub mod measure;
pub mod noise;
pub mod noise_colour;
pub mod noise_gaussian;
mod noise_track;
pub mod options;
mod orient;
pub mod phase_bits;
pub mod polynomial;
pub mod quadrature;
mod rate;
pub mod recording;
pub mod repeat_align;
pub mod repeat_criterion;
pub mod repeat_equivalence;
pub mod repeat_interval;
pub mod repeat_permutation;
pub mod repeat_threshold;
mod repeat_threshold_family;
pub mod repeat_turnbull;
pub mod resonance;
pub mod restitution;
pub mod restitution_check;
pub mod restitution_finding;
pub mod restitution_motion;
pub mod ringing;
pub mod ringing_peaks;
pub mod ringing_plate;
pub mod ringing_search;
pub mod smoothing_spline;
pub mod spectrum;
pub mod spectrum_peak;
pub mod straight_line;
pub mod tap;
pub mod tap_finding;
mod track;
pub mod trigger;
mod trigger_scale;
pub mod uncertain;
pub mod validate;

pub use error::Error;
pub use extract::extract_impact;
pub use finding::Finding;
pub use options::ExtractOptions;
