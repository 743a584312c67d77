//! Questions after the model: marginal means, slopes at levels, and their contrasts.

pub mod outcome;
pub mod request;
pub mod run;
pub mod text;
