//! Bruises from contacts, and from what one measures of them.

pub mod scene;
pub mod volumes;
