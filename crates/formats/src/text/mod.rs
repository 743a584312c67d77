//! Delimited text, and LVM by LabVIEW.

mod cells;
mod date;
mod decimal;
mod dialect;
pub mod encoding;
mod ending;
mod header;
mod lines;
mod look;
pub(crate) mod lvm;
mod lvm_lines;
mod measurements;
mod midnight;
mod missing;
pub(crate) mod number;
pub mod options;
mod power;
pub(crate) mod read;
pub mod rows;
pub(crate) mod table;
