//! Tables in CSV files, read and written.

mod columns;
pub mod csv;
pub mod data;
mod records;
pub mod write;
