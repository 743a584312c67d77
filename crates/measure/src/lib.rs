//! Campaigns whose recordings hold no single impact to fit: compressions, relaxations,
//! taps and repeated impacts, and what those kinds share.

pub mod any_outcome;
pub mod compression;
pub mod kind;
pub mod measured;
pub mod relaxation;
pub mod repeats;
pub mod run;
pub mod schema;
pub mod taps;
pub mod text;
pub mod words;
