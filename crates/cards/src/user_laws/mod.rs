//! Laws of the user, as formulas or tables in files.

pub mod file;
pub mod read;
pub mod text;
