//! Bruises from contacts, and from what one measures of them.

pub(crate) mod scene;
pub mod volumes;
