//! Draws from a distribution by the no-U-turn sampler, from its log-density and
//! gradient.

pub mod chain_diagnostics;
#[cfg(feature = "sampler")]
mod chains;
mod density;

#[cfg(feature = "sampler")]
pub(crate) use chains::draw_chains;
pub use density::Drawing;
pub(crate) use density::LogDensity;

use crate::error::Error;

/// Whether this build can draw.
///
/// # Errors
/// [`Error::NoSampler`] where the cargo feature `sampler` is off.
pub(crate) fn check_sampler() -> Result<(), Error> {
    match cfg!(feature = "sampler") {
        true => Ok(()),
        false => Err(Error::NoSampler),
    }
}

/// No chain can be started without the feature; [`check_sampler`] says so before.
#[cfg(not(feature = "sampler"))]
pub(crate) fn draw_chains(
    _: &dyn LogDensity,
    _: &Drawing,
    _: &dyn Fn(usize) -> Vec<f64>,
    _: &mut dyn FnMut(&[f64]),
) -> Option<usize> {
    None
}
