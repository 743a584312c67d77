//! What of a bench explains what the fits of all its impacts leave: a gain, a delay, a filter, a
//! sensor or an arm that swings.

pub mod cause;
mod kind;
pub mod residuals;
mod search;
