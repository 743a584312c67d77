//! What campaigns share that fit no impacts.

pub mod any_outcome;
pub mod evaluate;
pub mod item_campaign;
pub mod measured;
pub mod reported_items;
pub mod request;
pub mod text;
pub mod words;
