//! Impacts repeated on one spot.

pub mod compare;
pub mod evaluate;
pub mod figure;
pub mod file;
pub mod methods;
pub mod pairs;
pub mod read;
pub mod run;
