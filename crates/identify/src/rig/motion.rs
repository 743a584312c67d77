//! The one equation of motion behind the rigs, in the displacement itself.
//!
//! With x = r sin θ the pendulum needs no angle:
//!
//! ```text
//! x'' = a − ω² x √(1−u) − (F/m)(1−u) − x v²/(r² (1−u)),   u = (x/r)²
//! ω² = m g l / I,   m = I/r² (effective mass)
//! ```
//!
//! and the carriage is the case r → ∞, ω = 0, with a its driving acceleration.

use crate::rig::kind::Rig;

/// Constants of the equation of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Driving acceleration a; m/s².
    pub driving: f64,
    /// ω², gravity's restoring term; 1/s².
    pub restoring: f64,
    /// 1/r²; 1/m².
    pub curvature: f64,
    /// 1/m, m the effective mass; 1/kg.
    pub inverse_mass: f64,
}

/// Acceleration and its derivatives at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceleration<R> {
    /// x''; m/s².
    pub value: R,
    /// ∂x''/∂x at constant force; 1/s².
    pub by_displacement: R,
    /// ∂x''/∂v at constant force; 1/s.
    pub by_rate: R,
    /// ∂x''/∂F; 1/kg.
    pub by_force: R,
}

impl From<&Rig> for Motion {
    fn from(rig: &Rig) -> Self {
        let inverse_mass = 1.0 / rig.effective_mass();
        match rig {
            Rig::Pendulum(p) => Self {
                driving: 0.0,
                restoring: p.mass * p.gravity * p.centre_of_mass / p.inertia,
                curvature: 1.0 / (p.arm * p.arm),
                inverse_mass,
            },
            Rig::Carriage(c) => Self {
                driving: c.driving_acceleration,
                restoring: 0.0,
                curvature: 0.0,
                inverse_mass,
            },
        }
    }
}

impl Motion {
    /// x'' and its derivatives at displacement `x`, rate `v` and force `force`.
    ///
    /// # Source
    /// Eq. (7) of the 2003 pendulum study, transformed; differences: signs and
    /// centre of mass as in [`Pendulum`](crate::rig::kind::Pendulum).
    #[inline(always)]
    pub fn acceleration<R: windfall_numerics::real::Real>(
        &self,
        x: R,
        v: R,
        force: R,
    ) -> Acceleration<R> {
        let constants = [
            self.driving,
            self.restoring,
            self.curvature,
            self.inverse_mass,
        ];
        let mut alike = [x; 4];
        for i in 0..4 {
            alike[i] = x.constant(constants[i]);
        }
        acceleration_with(alike, [x, v, force])
    }
}

/// [`Motion::acceleration`] with constants of their own in each lane: driving,
/// restoring, curvature, inverse mass; at displacement, rate and force.
#[inline(always)]
pub(crate) fn acceleration_with<R: windfall_numerics::real::Real>(
    [driving, restoring, curvature, inverse_mass]: [R; 4],
    [x, v, force]: [R; 3],
) -> Acceleration<R> {
    let u = x * x * curvature;
    let rest = -u + 1.0;
    let cosine = rest.sqrt();
    let inverse_rest = x.constant(1.0) / rest;
    let by_force = rest * -inverse_mass;
    // Centripetal part: x v²/(r² − x²).
    let turning = v * inverse_rest * curvature;
    let centripetal = x * v * turning;
    let x_curvature = x * curvature;
    Acceleration {
        value: force * by_force - x * cosine * restoring - centripetal + driving,
        by_displacement: force * x_curvature * (inverse_mass * 2.0)
            - (rest - u) * inverse_rest * cosine * restoring
            - v * turning * (u * inverse_rest * 2.0 + 1.0),
        by_rate: -(x * turning * 2.0),
        by_force,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::kind::{Carriage, Pendulum};

    fn pendulum() -> (Pendulum, Motion) {
        let rig = Pendulum {
            inertia: 0.051,
            arm: 0.505,
            mass: 0.3,
            centre_of_mass: 0.4,
            gravity: 9.81,
        };
        (rig, Motion::from(&Rig::Pendulum(rig)))
    }

    /// The transformed equation against eq. (7) in the angle itself.
    #[test]
    fn closed_form_angle_equation() {
        let (rig, motion) = pendulum();
        for (theta, omega, force) in [(0.0, 0.7, 0.0), (0.3, -2.0, 40.0), (-0.5, 1.0, 0.0)] {
            let (theta, omega, force): (f64, f64, f64) = (theta, omega, force);
            let x = rig.arm * theta.sin();
            let v = rig.arm * theta.cos() * omega;
            let angular = (-rig.mass * rig.gravity * rig.centre_of_mass * theta.sin()
                - force * rig.arm * theta.cos())
                / rig.inertia;
            let expected = rig.arm * (theta.cos() * angular - theta.sin() * omega * omega);
            let found = motion.acceleration(x, v, force).value;
            assert!(
                (found - expected).abs() < 1e-12 * (1.0 + expected.abs()),
                "{found} {expected}"
            );
        }
    }

    #[test]
    fn derivative_of_the_acceleration() {
        let (_, motion) = pendulum();
        let (x, v, force, h) = (0.2, 1.3, 25.0, 1e-6);
        let a = |x: f64, v: f64, f: f64| motion.acceleration(x, v, f).value;
        let exact = motion.acceleration(x, v, force);
        let by_x = (a(x + h, v, force) - a(x - h, v, force)) / (2.0 * h);
        let by_v = (a(x, v + h, force) - a(x, v - h, force)) / (2.0 * h);
        let by_f = (a(x, v, force + h) - a(x, v, force - h)) / (2.0 * h);
        assert!((exact.by_displacement - by_x).abs() < 1e-6 * by_x.abs());
        assert!((exact.by_rate - by_v).abs() < 1e-6 * by_v.abs());
        assert!((exact.by_force - by_f).abs() < 1e-6 * by_f.abs());
        assert!(by_x != 0.0 && by_v != 0.0 && by_f != 0.0);
    }

    #[test]
    fn closed_form_carriage_is_newton() {
        let rig = Rig::Carriage(Carriage {
            mass: 0.5,
            driving_acceleration: 0.3,
        });
        let found = Motion::from(&rig).acceleration(0.01, 2.0, 4.0);
        assert_eq!(
            (
                found.value,
                found.by_displacement,
                found.by_rate,
                found.by_force
            ),
            (0.3 - 8.0, 0.0, 0.0, -2.0)
        );
    }
}
