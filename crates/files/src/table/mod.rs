//! Tables in CSV files, read and written.

mod columns;
mod columns_text;
pub mod csv;
pub mod data;
mod records;
pub mod write;
