//! Slow compressions.

pub mod evaluate;
pub mod figure;
pub mod file;
pub mod methods;
pub mod read;
pub mod run;
