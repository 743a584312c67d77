//! Tables as files of columns, Parquet and Arrow, of windfall and of others.

mod batch;
pub mod error;
pub mod read;
pub mod schema;
pub mod stream;
pub mod write;
