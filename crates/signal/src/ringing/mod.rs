//! Ringing of the plate between contacts.

pub mod model;
pub mod peaks;
pub mod plate;
pub mod search;
