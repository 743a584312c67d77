//! `windfall bounces`: restitution from the times between successive impacts, without a
//! recording.

pub mod estimate;
mod findings;
pub mod outcome;
pub mod read;
pub mod request;
pub mod run;
pub mod speed;
pub mod text;
mod usable;
