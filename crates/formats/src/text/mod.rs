//! Delimited text, and LVM by LabVIEW.

pub mod cells;
pub mod date;
pub mod dialect;
pub mod encoding;
pub mod header;
pub mod lines;
pub mod lvm;
pub mod number;
pub mod options;
mod power;
pub mod read;
pub mod rows;
pub mod table;
