//! Stress relaxation: the force while a fruit is held at a deformation.

pub mod evaluate;
pub mod figure;
pub mod file;
pub mod methods;
pub mod read;
pub mod run;
