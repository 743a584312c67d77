//! Campaigns: what their files say, their recordings, the evaluation of each, results and their store.

pub mod error;
pub mod impacts;
pub mod pipeline;
pub mod recording;
pub mod result;
pub mod settings;
pub mod store;
