//! Mixed models: penalised least squares by groups, and inference from them.

mod basis;
mod blocks;
mod boundary;
pub mod coefficient;
pub mod constraint;
pub mod effects;
mod envelope;
pub mod error;
mod evaluate;
pub mod finding;
pub mod fit;
pub mod fit_levels;
pub mod inference;
pub mod kenward_roger;
mod levels;
mod minimise;
pub mod model;
pub mod predict;
pub mod profile;
pub mod residual_levels;
mod row;
mod slope;
pub mod summary;
pub mod term;
mod theta;
pub mod weights;
