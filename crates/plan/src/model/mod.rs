//! A mixed model of earlier impacts, simulated again and again with more or fewer fruit.

mod question;
pub mod request;
pub mod run;
mod simulate;
