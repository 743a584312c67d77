//! Tables as Parquet and Arrow files, for programs that read columns.

pub mod batch;
pub mod container;
pub mod error;
pub mod from_csv;
pub mod write;
