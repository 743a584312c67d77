//! HDF5, and MAT files of version 7.3.

mod attribute;
mod blocks;
mod btree1;
mod btree2;
mod checksum;
mod chunk_entry;
mod chunks;
mod cursor;
mod dataset;
mod extensible;
mod file;
mod filter;
mod group;
mod heap;
mod layout;
mod lzf;
mod number;
mod object;
pub mod read;
mod tree;
mod value_type;
