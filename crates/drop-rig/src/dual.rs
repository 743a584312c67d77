//! Arithmetic of a value with its derivatives: lane 0 of [`Lanes`] holds the
//! value, the other lanes its derivatives by the free parameters.

use windfall_numerics::real::Lanes;

/// A value that depends on nothing that is free.
#[inline(always)]
pub(crate) fn fixed<const W: usize>(value: f64) -> Lanes<W> {
    Lanes::unit(0, value)
}

/// a b.
#[inline(always)]
pub(crate) fn product<const W: usize>(a: Lanes<W>, b: Lanes<W>) -> Lanes<W> {
    let mut out = a * b.0[0] + b * a.0[0];
    out.0[0] = a.0[0] * b.0[0];
    out
}

/// A function of `a` with its value and its slope there.
#[inline(always)]
pub(crate) fn mapped<const W: usize>(a: Lanes<W>, value: f64, slope: f64) -> Lanes<W> {
    let mut out = a * slope;
    out.0[0] = value;
    out
}

/// 1/a.
#[inline(always)]
pub(crate) fn inverse<const W: usize>(a: Lanes<W>) -> Lanes<W> {
    let value = 1.0 / a.0[0];
    mapped(a, value, -value * value)
}

/// The derivatives alone: lane 0 is zero.
#[inline(always)]
pub(crate) fn derivatives<const W: usize>(a: Lanes<W>) -> Lanes<W> {
    let mut out = a;
    out.0[0] = 0.0;
    out
}

/// Derivatives of the instant at which `gap`, of the rate `slope`, is zero.
///
/// Nothing where the gap is only grazed: there is no derivative.
#[inline(always)]
pub(crate) fn instant<const W: usize>(gap: Lanes<W>, slope: f64) -> Lanes<W> {
    let found = derivatives(gap) * (-1.0 / slope);
    match found.0.iter().all(|value| value.is_finite()) {
        true => found,
        false => Lanes::ZERO,
    }
}
