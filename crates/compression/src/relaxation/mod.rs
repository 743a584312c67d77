//! Models of stress relaxation, fitted to the force while the position is held.

mod curve;
pub mod hold;
pub mod maxwell;
pub mod peleg;
pub mod ramp;
