//! Recording → Impact: decoding, contact windows, displacement rate, energies.
//!
//! [`recording::Recording`] is what a reader returns, in SI units;
//! [`extract::extract_impact`] cuts one impact out of it
//! ([`impact::Impact`], with [`finding::Finding`]s about what is poor);
//! [`mass::mass_from_impulse`] finds the mass of a carriage;
//! [`instrument::record`] goes the other way and writes what an instrument
//! would have written of a motion.
//!
//! This crate opens no file and knows no force law.

pub mod accelerometer;
pub mod bounce;
mod choose;
pub mod clipping;
mod compare;
pub mod compression;
pub mod conditioning;
mod contact_window;
pub mod deceleration;
pub mod encoder;
pub mod energy_angles;
pub mod error;
pub mod extract;
pub mod filter;
pub mod finding;
mod flight;
pub mod force_loop;
mod found;
pub mod impact;
pub mod instrument;
mod jump;
pub mod kinematics;
mod linear_fit;
pub mod mass;
pub mod measure;
mod motion_check;
pub mod noise;
mod noise_track;
pub mod options;
mod orient;
mod oscillation;
pub mod polynomial;
mod rate;
pub mod recording;
pub mod response;
pub mod restitution;
pub mod ringing;
pub mod spike;
pub mod straight_line;
pub mod tap;
mod touch;
mod track;
mod trajectory;
pub mod trigger;
pub mod uncertain;
pub mod validate;
mod zero;

pub use error::Error;
pub use extract::extract_impact;
pub use finding::Finding;
pub use found::impacts_in;
pub use options::ExtractOptions;
