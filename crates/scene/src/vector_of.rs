//! Vectors of numbers of any kind: of one, or of several side by side.

use windfall_numerics::real::Real;

/// A vector of numbers of any kind.
pub(crate) type Of<R> = [R; 3];

#[inline(always)]
pub(crate) fn dot<R: Real>(a: Of<R>, b: Of<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross<R: Real>(a: Of<R>, b: Of<R>) -> Of<R> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
pub(crate) fn add<R: Real>(a: Of<R>, b: Of<R>) -> Of<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn times<R: Real>(a: Of<R>, by: R) -> Of<R> {
    [a[0] * by, a[1] * by, a[2] * by]
}

#[inline(always)]
pub(crate) fn less<R: Real>(a: Of<R>, b: Of<R>, by: R) -> Of<R> {
    [a[0] - b[0] * by, a[1] - b[1] * by, a[2] - b[2] * by]
}

/// What a vector that turns with the plane of contact is longer than its shadow on the plane,
/// to second order; 1.
#[inline(always)]
pub(crate) fn stretch_into_plane<R: Real>(a: Of<R>, normal: Of<R>) -> R {
    let out = dot(a, normal);
    let inside = less(a, normal, out);
    let square = dot(inside, inside);
    square.select(out * out / square, out.constant(0.0)) * 0.5 + 1.0
}

/// A vector turned with the plane of contact.
///
/// * `stretch`: as [`stretch_into_plane`] says
#[inline(always)]
pub(crate) fn into_plane<R: Real>(a: Of<R>, normal: Of<R>, stretch: R) -> Of<R> {
    times(less(a, normal, dot(a, normal)), stretch)
}
