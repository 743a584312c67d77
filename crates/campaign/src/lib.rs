//! Campaigns: what their files say, their recordings, the evaluation of each, results and their store.

pub mod compression;
pub mod error;
pub mod impacts;
pub mod measure;
pub mod pipeline;
pub mod recording;
pub mod relaxation;
pub mod repeats;
pub mod result;
pub mod settings;
pub mod store;
pub mod taps;
