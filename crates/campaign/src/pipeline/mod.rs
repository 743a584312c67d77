//! The pipeline of every campaign: options → each recording evaluated → store.

pub mod answer;
pub mod evaluate;
pub mod request;
