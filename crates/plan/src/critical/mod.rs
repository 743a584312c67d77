//! The critical impact energy, by simulation.

mod question;
pub mod request;
pub mod run;
