//! Coefficient of restitution of collisions where it is known without an integration.

use crate::error::Error;

/// Restitution e of F = k d^n (1 + a v), any n, from z = a v0.
///
/// ```text
/// z (1 + e) = ln[(1 + z)/(1 − e z)]
/// ```
///
/// * `z`: damping factor times velocity at first touch, at or above zero; 1
///
/// # Numerics
/// With w = e z the equation is −w − ln(1 − w) = z − ln(1 + z); the left side
/// is convex, so Newton's method from the right converges without overshoot.
pub fn damped_power_restitution(z: f64) -> f64 {
    if z < SMALLEST_DAMPING {
        return 1.0 - 2.0 / 3.0 * z;
    }
    let excess = excess_over_log(z);
    // −w − ln(1 − w) ≥ w²/2 and w ≤ 1 bound the root from above.
    let bound = (2.0 * excess).sqrt().min(-(-excess - 1.0).exp_m1());
    let mut w = bound;
    for _ in 0..NEWTON_STEPS {
        // So much damping that 1 − w is lost in rounding.
        if w == 1.0 {
            break;
        }
        let step = (excess_over_log(-w) - excess) * (1.0 - w) / w;
        w = (w - step).min(bound);
        if step.abs() <= f64::EPSILON * w {
            break;
        }
    }
    w / z
}

/// Below this z the restitution is linear in z to the last digit; 1.
const SMALLEST_DAMPING: f64 = 1e-9;
/// More than Newton's method ever took in the tests, from z = 1e-9 to 1e9.
const NEWTON_STEPS: usize = 100;

/// x − ln(1 + x), without cancellation for small x.
fn excess_over_log(x: f64) -> f64 {
    if x.abs() > 0.1 {
        return x - x.ln_1p();
    }
    // x²/2 − x³/3 + …: 17 terms reach the last digit at 0.1.
    let mut sum = 0.0;
    for power in (2..=18).rev() {
        sum = 1.0 / f64::from(power) - x * sum;
    }
    x * x * sum
}

/// Damping factor a of F = k d^n (1 + a v) that truly delivers a restitution; s/m.
///
/// * `restitution`: above 0, at most 1; 1
/// * `velocity`: at first touch; m/s
///
/// Hunt-Crossley takes λ = a k.
///
/// # Errors
/// [`Error::ImpossibleRestitution`].
///
/// # Numerics
/// Bisection: [`damped_power_restitution`] falls from 1 to 0 as z = a v0 grows
/// from 0 to 1/e.
pub fn damping_for_restitution(restitution: f64, velocity: f64) -> Result<f64, Error> {
    if !(restitution > 0.0 && restitution <= 1.0) {
        return Err(Error::ImpossibleRestitution { value: restitution });
    }
    let (mut low, mut high) = (0.0, 1.0 / restitution);
    if restitution == 1.0 {
        high = 0.0;
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Ok(middle / velocity);
        }
        if damped_power_restitution(middle) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Restitution of Kuwabara-Kono ending at zero force, by a Padé approximation.
///
/// * `group`: B = (c/m)(m/k)^(3/5) v^(1/5), the one group of such an impact (Ramirez et al.
///   1999, Phys. Rev. E 60, 4465); 1
///
/// In error by 4e-4 at B = 0.25 and 5e-3 at B = 1: a first guess and a
/// cross-check, not the truth.
///
/// # Source
/// Mueller and Poeschel (2011), Phys. Rev. E 84, 021302, approximant \[1/4\].
pub fn kuwabara_kono_pade(group: f64) -> f64 {
    let s = group.sqrt();
    let above = 1.0 + 0.501086 * s;
    above / (above + s * s * (1.15345 + s * (0.577977 + s * 0.532178)))
}
