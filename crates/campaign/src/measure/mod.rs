//! What campaigns share that fit no impacts.

pub mod any_outcome;
pub mod kind;
pub mod measured;
pub mod run;
pub mod text;
pub mod words;
