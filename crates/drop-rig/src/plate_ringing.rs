//! Free motion of the plate on its spring and damper, in closed form.

use crate::dual::{mapped, product};
use windfall_numerics::real::Lanes;

/// |q t²| below which sin and sinh are taken from their series.
const NEARLY_CRITICAL: f64 = 1e-3;
/// How near to critical damping the bound of [`Ringing::bound`] follows.
const BOUND_MARGIN: f64 = 0.01;

/// m x'' + c x' + k x = 0 from a state at time zero:
///
/// ```text
/// x = e^(−bt) (x₀ C + (u₀ + b x₀) S),   b = c/2m,   q = k/m − b²,
/// C = cos √q t,   S = sin(√q t)/√q   (cosh and sinh where q < 0)
/// ```
///
/// Lane 0 holds values, the others derivatives by free parameters.
#[derive(Clone, Copy, Debug)]
pub struct Ringing<const W: usize> {
    /// Displacement at time zero; m.
    pub displacement: Lanes<W>,
    /// Velocity at time zero; m/s.
    pub velocity: Lanes<W>,
    /// b; 1/s.
    pub decay: Lanes<W>,
    /// q; 1/s².
    pub frequency_squared: Lanes<W>,
}

/// e^(−bt) C, e^(−bt) S and e^(−bt) dS/dq at a time.
#[inline(always)]
fn oscillation(b: f64, q: f64, t: f64) -> (f64, f64, f64) {
    let z = q * t * t;
    let e = (-b * t).exp();
    let (c, s) = if q > 0.0 {
        let root = q.sqrt();
        let (sin, cos) = (root * t).sin_cos();
        (e * cos, e * sin / root)
    } else if q < 0.0 {
        // Decay and hyperbolic functions together: apart, one vanishes where
        // the other overflows.
        let root = (-q).sqrt();
        let slow = 0.5 * ((root - b) * t).exp();
        let fast = (-2.0 * root * t).exp_m1();
        (slow * (2.0 + fast), -slow * fast / root)
    } else {
        (e, e * t)
    };
    if z.abs() < NEARLY_CRITICAL {
        // S = t − q t³/6 + q² t⁵/120 − …; by the next term right to 1e-16.
        let s = t * (1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0))));
        let by_q = -t * t * t / 6.0 * (1.0 - z / 10.0 * (1.0 - z / 28.0 * (1.0 - z / 54.0)));
        return (c, e * s, e * by_q);
    }
    (c, s, (t * c - s) / (2.0 * q))
}

impl<const W: usize> Ringing<W> {
    /// Displacement (m) and velocity (m/s) at a time (s).
    #[inline(always)]
    pub fn at(&self, time: f64) -> (Lanes<W>, Lanes<W>) {
        let (b, q) = (self.decay, self.frequency_squared);
        let (c, s, s_by_q) = oscillation(b.0[0], q.0[0], time);
        // With the decay in them; derivatives by b and q.
        let by_decay = b * (-time);
        let cosine = {
            let mut out = by_decay * c + q * (-0.5 * time * s);
            out.0[0] = c;
            out
        };
        let sine = {
            let mut out = by_decay * s + q * s_by_q;
            out.0[0] = s;
            out
        };
        let (x0, u0) = (self.displacement, self.velocity);
        let slope = u0 + product(b, x0);
        let x = product(x0, cosine) + product(slope, sine);
        // x' = e^(−bt) (u₀ C − (b u₀ + (b² + q) x₀) S)
        let stiffness = mapped(b, b.0[0] * b.0[0], 2.0 * b.0[0]) + q;
        let pull = product(b, u0) + product(stiffness, x0);
        let u = product(u0, cosine) - product(pull, sine);
        (x, u)
    }

    /// Displacement and velocity at a time, values alone.
    #[inline(always)]
    pub fn values_at(&self, time: f64) -> (f64, f64) {
        let (b, q) = (self.decay.0[0], self.frequency_squared.0[0]);
        let (c, s, _) = oscillation(b, q, time);
        let (x0, u0) = (self.displacement.0[0], self.velocity.0[0]);
        let x = x0 * c + (u0 + b * x0) * s;
        (x, u0 * c - (b * u0 + (b * b + q) * x0) * s)
    }

    /// A bound of |x| from time zero on: (R, λ) of R e^(−λt); m and 1/s.
    pub fn bound(&self) -> (f64, f64) {
        let (b, q) = (self.decay.0[0], self.frequency_squared.0[0]);
        let (x0, u0) = (self.displacement.0[0], self.velocity.0[0]);
        let slope = u0 + b * x0;
        if q > (BOUND_MARGIN * b) * (BOUND_MARGIN * b) && q > 0.0 {
            return (x0.hypot(slope / q.sqrt()), b);
        }
        // S ≤ e^(pt)/p for every p ≥ √−q, C ≤ e^(pt).
        let p = f64::max((-q).max(0.0).sqrt(), BOUND_MARGIN * b);
        (x0.abs() + slope.abs() / p, b - p)
    }

    /// A time in which the motion changes little: part of its period; s.
    pub fn short_time(&self) -> f64 {
        let (b, q) = (self.decay.0[0], self.frequency_squared.0[0]);
        std::f64::consts::TAU / (b * b + q.abs()).sqrt() / 32.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::fixed;

    /// State, decay and frequency in lanes 1 to 4.
    fn ringing(x0: f64, u0: f64, b: f64, q: f64) -> Ringing<5> {
        let lane = |i: usize, value: f64| fixed(value) + Lanes::unit(i, 1.0);
        Ringing {
            displacement: lane(1, x0),
            velocity: lane(2, u0),
            decay: lane(3, b),
            frequency_squared: lane(4, q),
        }
    }

    /// Under-, over- and critically damped: the closed form obeys its equation
    /// of motion (by differences), and starts where it should.
    #[test]
    fn closed_form_obeys_the_equation_of_motion() {
        for q in [3e6, -1e4, 0.0, 1e-3, -1e-3] {
            let (b, x0, u0) = (130.0, 2e-5, -0.03);
            let motion = ringing(x0, u0, b, q);
            let (start, rate) = motion.at(0.0);
            assert_eq!((start.0[0], rate.0[0]), (x0, u0));
            for t in [1e-4, 1.7e-3, 0.01] {
                let h = 1e-6;
                let (x, u) = motion.values_at(t);
                let (x_after, u_after) = motion.values_at(t + h);
                let (x_before, u_before) = motion.values_at(t - h);
                let scale = u.abs().max(1e-6);
                assert!(((x_after - x_before) / (2.0 * h) - u).abs() < 1e-5 * scale);
                let a = (u_after - u_before) / (2.0 * h);
                let expected = -2.0 * b * u - (b * b + q) * x;
                assert!(
                    (a - expected).abs() < 1e-5 * (b * b + q.abs()) * 2e-5,
                    "{q} {t}"
                );
            }
        }
    }

    /// Long after the hyperbolic functions alone would overflow, the slow one of
    /// the two exponentials is left: x = (u₀ + (b + p) x₀)/(2p) e^(−(b−p)t).
    #[test]
    fn closed_form_overdamped_plate_creeps_back() {
        let (b, p, t) = (5000.0, 4990.0, 0.3);
        let (x, u) = ringing(2e-5, -0.03, b, -p * p).values_at(t);
        let expected = (-0.03 + (b + p) * 2e-5) / (2.0 * p) * (-(b - p) * t).exp();
        assert!((x / expected - 1.0).abs() < 1e-9, "{x} {expected}");
        assert!((u / expected + (b - p)).abs() < 1e-7 * (b - p), "{u}");
    }

    #[test]
    fn derivative_of_the_free_motion() {
        let at = [2e-5, -0.03, 130.0, 3e6];
        for q in [at[3], -1e4, 4.0] {
            let at = [at[0], at[1], at[2], q];
            for t in [2e-4, 3e-3] {
                let (x, u) = ringing(at[0], at[1], at[2], at[3]).at(t);
                for i in 0..4 {
                    let h = 1e-5 * at[i].abs();
                    let moved = |by: f64| {
                        let mut p = at;
                        p[i] += by;
                        ringing(p[0], p[1], p[2], p[3]).values_at(t)
                    };
                    let (after, before) = (moved(h), moved(-h));
                    let dx = (after.0 - before.0) / (2.0 * h);
                    let du = (after.1 - before.1) / (2.0 * h);
                    assert!((x.0[i + 1] - dx).abs() < 1e-5 * dx.abs() + 1e-13, "{i} {q}");
                    assert!((u.0[i + 1] - du).abs() < 1e-5 * du.abs() + 1e-9, "{i} {q}");
                }
            }
        }
    }

    #[test]
    fn closed_form_bound_is_never_passed() {
        for q in [3e6, 1.0, 0.0, -1.0, -1e4] {
            let motion = ringing(-2e-5, 0.03, 130.0, q);
            let (largest, decay) = motion.bound();
            for i in 0..2000 {
                let t = f64::from(i) * 2e-5;
                let bound = largest * (-decay * t).exp() * (1.0 + 1e-12);
                assert!(motion.values_at(t).0.abs() <= bound, "{q} {t}");
            }
        }
    }
}
