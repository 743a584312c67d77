//! Taps: resonances and the stiffness of fruit.

pub mod document;
pub mod evaluate;
pub mod figure;
pub mod file;
pub mod methods;
pub mod read;
pub mod run;
pub mod specimen;
pub mod text;
