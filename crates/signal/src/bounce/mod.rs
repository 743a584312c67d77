//! Contacts found in the force under a fruit that bounces.

pub mod contact;
pub mod find;
pub mod finding;
pub mod measure;
pub mod quality;
pub mod rise;
pub mod segment;
pub mod static_load;
pub mod train;
