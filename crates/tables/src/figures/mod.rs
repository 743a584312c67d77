//! Figures that several commands draw: residuals, effects, groups.

pub mod diagnostics;
pub mod distribution;
pub mod effects;
pub mod groups;
pub mod quantiles;
pub mod settings;
mod smooth;
pub mod thinning;
pub mod words;
