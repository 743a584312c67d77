//! Steps in time: neighbours, forces, motion, fruit that come and go.

mod clump_motion;
mod gather;
pub(crate) mod relist;
pub mod simulation;
mod sweep;
pub mod time_step;
mod traffic;
