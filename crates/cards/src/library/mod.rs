//! Published values and models of fruit contacts.

pub mod file;
pub mod laws;
pub mod show;
pub mod text;
pub mod values;
