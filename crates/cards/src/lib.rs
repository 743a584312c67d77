//! Law cards, laws of the user, published values, and the transfer of a law from one geometry to another.

pub mod card_text;
pub mod geometry;
pub mod law_card;
pub mod law_use;
pub mod library;
pub mod read_card;
pub mod transfer;
pub mod user_laws;
