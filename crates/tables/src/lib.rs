//! Statistics of tables: designs, regression, response surfaces, comparison of groups.

pub mod compare;
pub mod design;
pub mod figures;
mod goodness_index;
#[cfg(feature = "clap")]
mod option_words;
pub mod reading;
pub mod regress;
pub mod rows;
pub mod surface;
pub mod term_units;
