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
pub mod inference;
pub mod kenward_roger;
mod minimise;
pub mod model;
pub mod predict;
pub mod profile;
mod slope;
pub mod summary;
pub mod term;
mod theta;
pub mod weights;
