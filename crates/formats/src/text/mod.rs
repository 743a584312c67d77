//! Delimited text, and LVM by LabVIEW.

mod cells;
mod date;
mod dialect;
pub mod encoding;
mod header;
mod lines;
pub(crate) mod lvm;
pub(crate) mod number;
pub mod options;
mod power;
pub(crate) mod read;
pub mod rows;
pub(crate) mod table;
