//! Files of campaigns and tables, cells and units as text, errors that name file, line and key, and where a result comes from.

pub mod allowed;
pub mod cache;
pub mod confined;
pub mod error;
mod error_words;
pub mod expand;
pub mod finding_kind;
pub mod found;
pub mod inputs;
pub mod known_names;
pub mod name;
pub mod named;
pub mod npy;
pub mod on_threads;
pub mod option_value;
pub mod place;
pub mod progress;
pub mod provenance;
pub mod scratch;
pub mod severity;
pub mod sheet;
pub mod table;
pub mod text;
pub mod write_file;
pub mod written;
