//! Files of instruments → channels of numbers, as the instrument wrote them.
//!
//! [`open::open`] finds out the format of a file and returns a
//! [`reader::Reader`]; its [`contents::Contents`] names the channels with unit,
//! length and time base without reading their samples, and
//! [`reader::Reader::read`] hands over the samples in blocks, so that a file of
//! any size is looked through in bounded memory.
//!
//! One file `read_*` for each format. Values are those of the file after the
//! scaling that the file itself prescribes; what they mean on a rig, in which
//! unit, is said in a campaign and is not known here. Sizes and offsets that a
//! file declares are checked against its length before anything is allocated.

mod array_channels;
mod array_clock;
mod array_pass;
mod array_tree;
pub mod contents;
pub mod error;
mod hdf5_attribute;
mod hdf5_blocks;
mod hdf5_btree1;
mod hdf5_btree2;
mod hdf5_checksum;
mod hdf5_chunk_entry;
mod hdf5_chunks;
mod hdf5_cursor;
mod hdf5_dataset;
mod hdf5_extensible;
mod hdf5_file;
mod hdf5_filter;
mod hdf5_group;
mod hdf5_heap;
mod hdf5_layout;
mod hdf5_lzf;
mod hdf5_number;
mod hdf5_object;
mod hdf5_tree;
mod hdf5_type;
mod mat_element;
mod mat_flow;
mod mat_matrix;
mod mat_number;
mod mat_stored;
mod mat_version4;
mod mat_version5;
pub mod open;
pub mod read_hdf5;
pub mod read_lvm;
pub mod read_mat;
pub mod read_sigrok;
pub mod read_tdms;
pub mod read_text;
pub mod read_uff58;
pub mod read_wav;
pub mod reader;
mod room;
pub mod source;
pub mod tdms_layout;
pub mod tdms_metadata;
pub mod tdms_scale;
pub mod tdms_segments;
pub mod tdms_type;
pub mod text_cells;
pub mod text_date;
pub mod text_dialect;
pub mod text_encoding;
pub mod text_header;
pub mod text_lines;
pub mod text_number;
pub mod text_options;
mod text_power;
pub mod text_rows;
pub mod text_table;

pub use error::Error;
pub mod uff_header;
pub mod uff_lines;
pub mod zip_entries;
