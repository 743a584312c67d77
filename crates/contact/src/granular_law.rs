//! Force laws in the terms of engines for granular matter.

/// How a law damps, beside k d or k d^1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// Not at all.
    None,
    /// c v; N s/m.
    Constant(f64),
    /// c √d v; N s/m^1.5.
    Root(f64),
    /// c d^¼ v; N s/m^1.25.
    Quarter(f64),
}

/// A law that engines have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GranularLaw {
    /// Whether the force is k d^1.5, rather than k d.
    pub hertzian: bool,
    /// k; N/m^1.5 or N/m.
    pub k: f64,
    /// Damping.
    pub damping: Damping,
}

/// Why laws with such a force have no counterpart, after "LAW: ".
pub(crate) const GROWING_DAMPING: &str =
    "the engine has no damping that grows with the elastic force";
pub(crate) const MEMORY: &str = "the engine has no force that remembers the largest displacement";
