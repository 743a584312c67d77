//! The pipeline of every campaign: options → each recording evaluated → store.

pub mod evaluate;
pub mod request;
mod saved_results;
