//! Formulas of user-defined laws: parsed, differentiated, compiled.

pub(crate) mod compile;
pub mod error;
pub(crate) mod graph;
pub(crate) mod program;
pub(crate) mod syntax;
pub(crate) mod unit;
pub(crate) mod value;
