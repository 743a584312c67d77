//! Vectors of three numbers: of one body, or of several side by side.

use windfall_numerics::real::Real;

/// A vector of numbers of any kind.
pub type Of<R> = [R; 3];

/// A vector in space.
pub type Vector = Of<f64>;

/// Sum.
#[inline(always)]
pub fn add<R: Real>(a: Of<R>, b: Of<R>) -> Of<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Difference.
#[inline(always)]
pub fn subtract<R: Real>(a: Of<R>, b: Of<R>) -> Of<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Vector times number.
#[inline(always)]
pub fn scaled<R: Real>(a: Of<R>, by: R) -> Of<R> {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// a + b times `by`.
#[inline(always)]
pub fn plus_scaled<R: Real>(a: Of<R>, b: Of<R>, by: R) -> Of<R> {
    [a[0] + b[0] * by, a[1] + b[1] * by, a[2] + b[2] * by]
}

/// Scalar product.
#[inline(always)]
pub fn dot<R: Real>(a: Of<R>, b: Of<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline(always)]
pub fn cross<R: Real>(a: Of<R>, b: Of<R>) -> Of<R> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Length.
#[inline(always)]
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The vector of length 1 in its direction; `None` for one of no length.
pub fn unit(a: Vector) -> Option<Vector> {
    let size = length(a);
    (size > 0.0 && size.is_finite()).then(|| scaled(a, 1.0 / size))
}

/// A direction of length 1 across another.
pub fn any_normal(along: Vector) -> Vector {
    let [x, y, z] = along.map(f64::abs);
    let least = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let out = cross(along, least);
    scaled(out, 1.0 / length(out))
}

/// a - b times `by`.
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
    scaled(less(a, normal, dot(a, normal)), stretch)
}

/// A rotation as a quaternion of length 1: w, x, y, z.
pub type Rotation = [f64; 4];

/// No rotation.
pub const UNTURNED: Rotation = [1.0, 0.0, 0.0, 0.0];

/// The vector turned by the rotation.
#[inline(always)]
pub fn turned(q: Rotation, a: Vector) -> Vector {
    let axis = [q[1], q[2], q[3]];
    let twice = scaled(cross(axis, a), 2.0);
    add(plus_scaled(a, twice, q[0]), cross(axis, twice))
}

/// The vector turned back by the rotation.
#[inline(always)]
pub fn turned_back(q: Rotation, a: Vector) -> Vector {
    turned([q[0], -q[1], -q[2], -q[3]], a)
}

/// The rotation followed by a turn with `spin` (rad/s) over a time; of length 1 again. For
/// one rotation or several side by side.
#[inline(always)]
pub fn turned_on<R: Real>(q: [R; 4], spin: Of<R>, time: f64) -> [R; 4] {
    let half = [
        spin[0] * (0.5 * time),
        spin[1] * (0.5 * time),
        spin[2] * (0.5 * time),
    ];
    // Of the exponential of the half angle to third order: turns within a step are small.
    let square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2];
    let c = square * (square * (1.0 / 24.0) + -0.5) + 1.0;
    let s = square * (-1.0 / 6.0) + 1.0;
    let [x, y, z] = [half[0] * s, half[1] * s, half[2] * s];
    let next = [
        c * q[0] - x * q[1] - y * q[2] - z * q[3],
        c * q[1] + x * q[0] + y * q[3] - z * q[2],
        c * q[2] + y * q[0] + z * q[1] - x * q[3],
        c * q[3] + z * q[0] + x * q[2] - y * q[1],
    ];
    // One step of Newton's method to length 1.
    let size = next[0] * next[0] + next[1] * next[1] + next[2] * next[2] + next[3] * next[3];
    let correction = size * -0.5 + 1.5;
    [
        next[0] * correction,
        next[1] * correction,
        next[2] * correction,
        next[3] * correction,
    ]
}

/// The turn about an axis of length 1 by an angle; rad.
pub fn turn_about(axis: Vector, angle: f64) -> Rotation {
    let (s, c) = (0.5 * angle).sin_cos();
    [c, axis[0] * s, axis[1] * s, axis[2] * s]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_quarter_turn() {
        let quarter = turn_about([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2);
        let there = turned(quarter, [1.0, 2.0, 3.0]);
        for (found, wanted) in there.into_iter().zip([-2.0, 1.0, 3.0]) {
            assert!((found - wanted).abs() < 1e-15);
        }
        let back = turned_back(quarter, there);
        for (found, wanted) in back.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn closed_form_small_turns_add_up_to_a_large_one() {
        // 1 rad about an oblique axis in 1000 steps.
        let axis = unit([1.0, -2.0, 0.5]).unwrap();
        let mut q = UNTURNED;
        for _ in 0..1000 {
            q = turned_on(q, axis, 1e-3);
        }
        let whole = turn_about(axis, 1.0);
        for (found, wanted) in q.into_iter().zip(whole) {
            assert!((found - wanted).abs() < 1e-10, "{q:?} {whole:?}");
        }
    }
}
