//! `windfall regress`: linear and mixed models.

pub mod findings;
pub mod means;
pub mod mixed;
pub mod mixed_text;
pub mod outcome;
pub mod request;
pub mod residuals;
pub mod run;
pub mod text;
