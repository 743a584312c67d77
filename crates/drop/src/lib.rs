//! Drop rigs: bounces, the plate, and the calibration of a law.

pub mod bounces;
pub mod calibrate;
pub mod calibrate_settings;
pub mod evaluate;
pub mod figure;
pub mod file;
pub mod intervals;
pub mod measured;
pub mod methods;
pub mod plate_ringing;
pub mod read;
pub mod run;
pub mod schema;
