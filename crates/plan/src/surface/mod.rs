//! The optimum of a response surface: where it lies, and the response there.

mod question;
pub mod request;
pub mod run;
