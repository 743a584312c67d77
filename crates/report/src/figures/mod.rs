//! Figures of a report on impacts: of the whole campaign, and of what the fit of one leaves.

pub mod bench;
pub mod covariate;
pub mod parameters;
pub mod posterior;
pub mod profiles;
pub mod residuals;
pub mod stacked;
pub mod trends;
