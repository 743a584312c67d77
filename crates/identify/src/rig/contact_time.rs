//! The time of a contact, t = s^q: a law that starts like √x is then smooth in s,
//! and the integrator keeps its order from the first step.

use windfall_numerics::real::Real;

/// s of t = s^q.
#[inline(always)]
pub fn scaled_time<R: Real>(time: R, power: u32) -> R {
    match power {
        1 => time,
        2 => time.sqrt(),
        _ => time.sqrt().sqrt(),
    }
}

/// t = s^q.
#[inline(always)]
pub fn time_of(s: f64, power: u32) -> f64 {
    match power {
        1 => s,
        2 => s * s,
        _ => (s * s) * (s * s),
    }
}

/// dt/ds of t = s^q.
#[inline(always)]
pub fn stretch(s: f64, power: u32) -> f64 {
    match power {
        1 => 1.0,
        2 => 2.0 * s,
        _ => 4.0 * s * s * s,
    }
}
