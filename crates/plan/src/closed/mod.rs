//! Questions with an exact answer: balanced studies, normal scatter.

mod groups;
pub mod request;
pub mod run;
mod t_test;
