//! One impact: samples and weights, the least-squares problem, its solution, and the uncertainty of what it gives.

pub mod batch;
pub mod batch_law;
mod batch_motion;
mod bootstrap;
pub mod estimator;
pub mod identifiability;
pub mod interval;
pub mod model;
mod noise;
mod onset_average;
pub(crate) mod plan;
pub(crate) mod posterior;
pub mod problem;
mod profile;
pub mod regression;
mod report;
pub mod residual;
mod residual_noise;
mod residual_pack;
mod residual_sums;
pub(crate) mod response;
pub mod result;
mod search;
pub(crate) mod solve;
mod starting_values;
mod types;
pub mod uncertainty;
