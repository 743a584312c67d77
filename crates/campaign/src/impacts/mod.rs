//! `windfall fit` for single impacts: the main job.

pub mod bench;
pub mod card;
pub mod csv;
pub mod failed_fit;
pub mod figure_covariate;
pub mod figure_impact;
pub mod figure_parameters;
pub mod figure_posterior;
pub mod figure_profiles;
pub mod figure_residuals;
pub mod figure_stacked;
pub mod findings;
pub mod fit;
pub mod groups;
pub mod key;
pub mod mass;
pub mod run;
pub mod text;
pub mod two_stage;
