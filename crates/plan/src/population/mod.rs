//! A parameter of a population of laws: median and spread between fruit.

mod question;
pub mod request;
pub mod run;
