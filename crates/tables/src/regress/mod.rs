//! `windfall regress`: linear and mixed models.

mod after;
mod figures;
pub mod findings;
pub mod means;
pub mod mixed;
pub(crate) mod mixed_figures;
pub mod mixed_outcome;
pub mod mixed_text;
pub(crate) mod mixed_variances;
pub mod outcome;
pub mod request;
pub mod residuals;
pub mod run;
pub mod text;
pub mod variances;
