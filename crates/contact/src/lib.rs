#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
//! Normal contact-force laws of fruit: formulas with exact derivatives, their
//! registry and the expression language that names them.
//!
//! In the order of use: [`parse_law`](expression::parse_law) reads an
//! expression, [`LawExpression`](expression::LawExpression) holds the values
//! that were given, [`Law`](law_kind::Law) is a law with all its parameters,
//! and [`with_law!`] hands the concrete type to code that is generic over
//! [`ContactLaw`](law::ContactLaw).
//!
//! ```
//! use windfall_contact::expression::parse_law;
//!
//! let expression = parse_law("kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")")?;
//! let law = expression.complete()?;
//! // 1 mm deep, at rest: k d^1.5
//! assert!((law.force(1e-3, 0.0, 0.0) - 23.8309).abs() < 1e-4);
//! # Ok::<(), windfall_contact::error::Error>(())
//! ```
//!
//! This crate knows no instrument, no rig and no file.

pub mod any_law;
mod any_law_size;
pub mod apparent_modulus;
pub mod curvature;
pub mod damping_factor;
pub mod define_law;
pub mod effective;
pub mod error;
pub mod expression;
pub mod force_table;
pub mod formula_error;
mod formula_graph;
mod formula_program;
mod formula_syntax;
mod formula_unit;
mod formula_value;
pub mod hertz_elliptic;
pub mod law;
pub mod law_adams_impact;
pub mod law_flores;
pub mod law_herbert_mcwhannell;
pub mod law_hertz;
pub mod law_hunt_crossley;
pub mod law_kelvin_voigt;
pub mod law_kind;
pub mod law_kuwabara_kono;
pub mod law_lankarani_nikravesh;
pub mod law_power;
pub mod law_thornton;
pub mod law_tsuji;
pub mod law_user;
pub mod law_walton_braun;
pub mod parameter;
pub mod restitution;
pub mod transfer;
mod user_law_check;
pub mod user_law_finding;
