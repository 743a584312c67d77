//! Tails and quantiles of distributions.

mod incomplete_beta;
mod incomplete_gamma;
pub mod largest_t;
pub mod log_gamma_rest;
pub mod noncentral;
pub mod quantile;
pub mod studentized_range;
pub mod tail;
