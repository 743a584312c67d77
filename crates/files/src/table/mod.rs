//! Tables in CSV files, read and written.

pub mod csv;
pub mod data;
pub mod write;
