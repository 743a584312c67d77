//! The damping factor a of laws of the form F = k d^n (1 + a v), for a nominal
//! restitution e and an impact velocity v0.

use crate::law::ContactForce;
use windfall_numerics::real::Real;

/// a with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampingFactor {
    /// a; s/m.
    pub value: f64,
    /// ∂a/∂e; s/m.
    pub by_restitution: f64,
    /// ∂a/∂v0; s²/m².
    pub by_impact_velocity: f64,
}

/// a = g(e)/v0 from g and its derivative.
#[inline(always)]
fn divided(shape: f64, slope: f64, impact_velocity: f64) -> DampingFactor {
    let value = shape / impact_velocity;
    DampingFactor {
        value,
        by_restitution: slope / impact_velocity,
        by_impact_velocity: -value / impact_velocity,
    }
}

/// a = 0.75 (1 − e²)/v0, Lankarani and Nikravesh (1990).
#[inline(always)]
pub fn lankarani_nikravesh(e: f64, v0: f64) -> DampingFactor {
    divided(0.75 * (1.0 - e * e), -1.5 * e, v0)
}

/// a = 8 (1 − e)/(5 e v0), Flores et al. (2011).
#[inline(always)]
pub fn flores(e: f64, v0: f64) -> DampingFactor {
    divided(1.6 * (1.0 - e) / e, -1.6 / (e * e), v0)
}

/// a = 6 (1 − e)/(((2e − 1)² + 3) v0), Herbert and McWhannell (1977).
#[inline(always)]
pub fn herbert_mcwhannell(e: f64, v0: f64) -> DampingFactor {
    let below = (2.0 * e - 1.0) * (2.0 * e - 1.0) + 3.0;
    let below_slope = 4.0 * (2.0 * e - 1.0);
    let shape = 6.0 * (1.0 - e) / below;
    divided(shape, -(6.0 + shape * below_slope) / below, v0)
}

/// F = k d^n (1 + a v) with derivatives by k, n, restitution, impact velocity.
#[inline(always)]
pub(crate) fn damped_power<R: Real>(
    k: f64,
    n: f64,
    factor: DampingFactor,
    d: R,
    v: R,
) -> ContactForce<R, 4> {
    let power = d.powf(n);
    let elastic = power * k;
    let damping = v * factor.value + 1.0;
    let force = elastic * damping;
    ContactForce {
        force,
        by_displacement: force / d * n,
        by_rate: elastic * factor.value,
        by_parameter: [
            power * damping,
            force * d.ln(),
            elastic * v * factor.by_restitution,
            elastic * v * factor.by_impact_velocity,
        ],
        by_peak: d.constant(0.0),
    }
}
