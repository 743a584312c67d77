//! Normal contact-force laws of fruit: formulas with exact derivatives, their
//! registry and the expression language that names them.
//!
//! In the order of use: [`parse_law`](expression::parse_law) reads an
//! expression, [`LawExpression`](expression::LawExpression) holds the values
//! that were given, [`Law`](laws::kind::Law) is a law with all its parameters,
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

pub mod apparent_modulus;
pub mod curvature;
pub mod damping_factor;
pub mod effective;
pub mod error;
pub mod expression;
pub mod formula;
pub mod granular_law;
pub mod hertz_elliptic;
pub mod impact_law;
pub mod law;
pub mod laws;
pub mod parameter;
pub mod restitution;
pub mod starting_values;
pub mod transfer;
