//! Tails and quantiles of distributions.

mod incomplete_beta;
mod incomplete_gamma;
pub mod largest_t;
mod log_gamma_rest;
pub mod quantile;
pub mod studentized_range;
pub mod tail;
