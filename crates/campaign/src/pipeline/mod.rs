//! The pipeline of every campaign: what is asked for → each recording evaluated → store.

pub mod evaluate;
pub mod request;
