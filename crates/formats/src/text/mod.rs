//! Delimited text, and LVM by LabVIEW.

mod cells;
mod date;
pub(crate) mod decimal;
mod dialect;
pub mod encoding;
mod ending;
mod header;
pub(crate) mod lines;
mod look;
pub(crate) mod lvm;
mod lvm_lines;
mod measurements;
mod midnight;
pub(crate) mod missing;
pub mod number;
pub mod options;
mod power;
pub(crate) mod read;
pub mod rows;
pub mod spreadsheet;
pub(crate) mod table;

pub use read::is_time_name;
