//! Rigs, and the motion of an impactor under a force law.

pub mod bench;
pub mod contact_motion;
pub mod contact_stop;
pub mod contact_time;
pub mod impact_event;
pub mod kind;
pub mod motion;
pub mod simulate;
