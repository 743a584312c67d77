//! Zip archives: their entries, and tables of text in them, as phones export recordings.

pub mod entries;
pub mod texts;
