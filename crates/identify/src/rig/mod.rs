//! Rigs, and the motion of an impactor under a force law.

pub mod contact_motion;
pub mod kind;
pub mod motion;
pub mod simulate;
