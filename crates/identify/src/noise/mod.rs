//! What is noise in each channel, and residuals whitened by it.

pub(crate) mod blocks;
pub(crate) mod edges;
pub(crate) mod whitening;
