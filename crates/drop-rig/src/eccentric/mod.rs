//! Planar impacts of a body that is struck off its centre, with friction.

pub mod body;
mod contact;
mod flight;
mod follow;
pub mod impact;
mod motion;
pub mod shape;
pub mod simulate;
mod tally;
