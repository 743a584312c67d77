//! `windfall fit` for single impacts: the main job.

pub mod answer;
pub mod bench;
pub mod card;
mod detail;
pub mod failed_fit;
pub mod figure_impact;
pub mod findings;
pub mod fit;
pub mod groups;
pub mod key;
mod listed;
pub mod mass;
mod response;
pub mod run;
pub mod shard;
pub mod table;
pub mod text;
pub mod two_stage;
