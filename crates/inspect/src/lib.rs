//! `windfall inspect`: what a recording holds, and what looks wrong, in bounded memory.

pub mod envelope;
pub mod export;
pub mod figure;
pub mod gather;
pub mod run;
pub mod scan_decimated;
pub mod scan_time;
pub mod scan_value;
pub mod text;
