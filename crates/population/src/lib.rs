//! `windfall population` and `windfall laws`: how fruit differ, and which law fits best.

pub mod card;
pub mod covariates;
pub mod detail;
mod draws_table;
pub mod outcome;
pub mod ranking;
pub mod run;
pub mod text;
