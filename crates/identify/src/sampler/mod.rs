//! Draws from a posterior by the no-U-turn sampler, from its log-density and gradient.

pub mod chains;
pub(crate) mod density;
mod no_u_turn;
#[cfg(test)]
mod reference;
mod tuning;
