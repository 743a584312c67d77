//! MAT files of versions 4 to 7.

mod element;
mod flow;
mod matrix;
mod number;
pub mod read;
mod stored;
mod version4;
mod version5;
