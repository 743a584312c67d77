//! Laws compared on the same impacts, by information criteria and by prediction.

pub mod correlated_scores;
pub mod levels;
mod prediction;
pub mod ranking;
