#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Rigs forward and backward: simulate an impact under a force law, and
//! estimate the law's parameters from a measured impact.
//!
//! This crate opens no file and reads no clock.

mod arrow_system;
mod bootstrap;
pub mod compression_fit;
pub mod contact_motion;
mod correlated_scores;
pub mod drop_contact;
pub mod drop_coordinates;
pub mod drop_event;
pub mod drop_experiment;
pub mod drop_family;
pub mod drop_feature_fit;
pub mod drop_feature_problem;
pub mod drop_flight;
pub mod drop_follow;
pub mod drop_information;
pub mod drop_measured;
pub mod drop_observe;
pub mod drop_rig;
pub mod drop_sensitivity;
pub mod drop_simulate;
pub mod drop_start;
pub mod drop_tally;
pub mod drop_waveform;
pub mod drop_waveform_fit;
mod drop_waveform_parameters;
mod drop_waveform_record;
mod drop_waveform_report;
mod dual;
pub mod eccentric_body;
mod eccentric_contact;
mod eccentric_flight;
mod eccentric_follow;
pub mod eccentric_impact;
mod eccentric_motion;
pub mod eccentric_shape;
pub mod eccentric_simulate;
mod eccentric_tally;
pub mod error;
pub mod estimator;
pub mod finding;
pub mod fit;
mod fit_plan;
mod fit_report;
mod fit_types;
pub mod interval;
pub mod model;
pub mod motion;
mod noise_edges;
mod noise_plan;
mod onset_average;
pub mod plate_ringing;
mod posterior;
pub mod problem;
mod profile;
pub mod regression;
pub mod residual;
pub mod rig;
pub mod samples;
pub mod simulate;
mod solve;
mod starting_values;
pub mod uncertainty;
mod whitening;
