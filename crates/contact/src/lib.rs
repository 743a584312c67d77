//! Normal contact-force laws of fruit: formulas with exact derivatives, their
//! registry and the expression language that names them.
//!
//! This crate knows no instrument, no rig and no file.

pub mod law;
pub mod law_hertz;
pub mod law_kuwabara_kono;
pub mod parameter;
