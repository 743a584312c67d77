//! `windfall laws`: laws compared on the impacts of a campaign.

pub mod figure;
pub mod outcome;
pub mod run;
pub mod text;
