//! What residuals say of a model.

pub mod box_cox;
pub mod cross_validation;
pub mod diagnostics;
pub mod heteroscedasticity;
pub mod normality;
pub mod order;
pub mod quantile_band;
pub mod trend;
