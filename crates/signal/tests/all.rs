//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod as_recorded;
mod bounces;
mod conditioning;
mod encoder_capture;
mod encoder_events;
mod extract;
mod first_mode;
mod foam_pads;
mod plate;
mod quadrature_properties;
mod rejects;
mod restitution;
mod ringing;
mod scipy_filters;
mod spectrum;
mod tap;
mod uncertainties;
