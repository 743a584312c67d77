//! sigrok logic-analyser captures.

pub mod read;
