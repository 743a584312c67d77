//! TDMS, by LabVIEW and DIAdem.

pub mod layout;
pub mod metadata;
pub mod read;
pub mod scale;
pub mod segments;
pub mod value_type;
