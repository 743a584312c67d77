//! Spreadsheets: workbooks of Excel (.xlsx) and of OpenDocument (.ods).
//!
//! A sheet becomes text with one line for each row, which the readers of text understand:
//! names, units, remarks, several tables below each other, missing samples.

mod cell;
mod ods;
pub mod read;
mod render;
mod trust;
mod xlsx;
