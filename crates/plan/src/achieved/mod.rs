//! What a finished campaign has achieved, and what more or fewer fruit would have.

pub mod outcome;
pub mod request;
pub mod run;
pub mod text;
