//! Laws compared on the same impacts, by information criteria and by prediction.

pub mod levels;
mod prediction;
pub mod ranking;
