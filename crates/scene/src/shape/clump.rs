//! Fruit that are no spheres: rigid clumps of spheres.

use crate::shape::spheroid::Spheroid;
use crate::vector::{Rotation, UNTURNED, Vector, dot, turned, turned_back};
use std::f64::consts::PI;

/// A body of spheres that do not move against each other; they may overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Clump {
    /// Centres from the centre of mass, in the body's own axes, and radii; m.
    pub spheres: Vec<(Vector, f64)>,
    /// Moments of inertia about the body's own axes, which are principal ones; kg m².
    pub moments: Vector,
    /// Orientation at first.
    pub turn: Rotation,
    /// The spheroid along the first axis that the spheres fill, where it is one: contacts are those
    /// of its surface.
    pub spheroid: Option<Spheroid>,
}

impl Clump {
    /// An ovate fruit: spheres along the axis of a spheroid, each as large as fits in. They tell
    /// what may be near it; it touches with the spheroid's own surface.
    ///
    /// The outermost have the curvature of the tips, b²/a. The moments are those of the spheroid.
    ///
    /// * `length`, `diameter`: along the axis (x) and across it; m
    /// * `mass`: kg
    /// * `count`: number of spheres, two or more
    ///
    /// Returns `None` where it is not longer than thick.
    pub fn spheroid(length: f64, diameter: f64, mass: f64, count: usize) -> Option<Self> {
        let (a, b) = (0.5 * length, 0.5 * diameter);
        let long = a > b && b > 0.0 && a.is_finite() && count >= 2;
        if !long {
            return None;
        }
        let own = Spheroid { long: a, wide: b };
        let sphere = |number: usize| {
            let share = 2.0 * number as f64 / (count - 1) as f64 - 1.0;
            let x = own.reach() * share;
            ([x, 0.0, 0.0], own.radius(x))
        };
        let across = 0.05 * mass * (length * length + diameter * diameter);
        Some(Self {
            spheres: (0..count).map(sphere).collect(),
            moments: [0.1 * mass * diameter * diameter, across, across],
            turn: UNTURNED,
            spheroid: Some(own),
        })
    }

    /// How far below the surface of its spheroid that of its spheres lies at most; 0 where it is
    /// none; m.
    pub fn lacks(&self) -> f64 {
        let Some(Spheroid { long: a, wide: b }) = self.spheroid else {
            return 0.0;
        };
        let pairs = self.spheres.windows(2).map(|pair| {
            let ([x, ..], r) = pair[0];
            let ([u, ..], s) = pair[1];
            // Where two spheres meet, along the axis and off it.
            let along = 0.5 * (x + u) + 0.5 * (r * r - s * s) / (u - x);
            let off = (r * r - (along - x) * (along - x)).max(0.0).sqrt();
            b * (1.0 - along * along / (a * a)).max(0.0).sqrt() - off
        });
        pairs.fold(0.0, f64::max)
    }

    /// Angular momentum; kg m²/s.
    pub fn momentum(&self, turn: Rotation, spin: Vector) -> Vector {
        let inward = turned_back(turn, spin);
        turned(
            turn,
            [0, 1, 2].map(|axis| self.moments[axis] * inward[axis]),
        )
    }

    /// Angular velocity of an angular momentum; rad/s.
    pub fn spin(&self, turn: Rotation, momentum: Vector) -> Vector {
        let inward = turned_back(turn, momentum);
        turned(
            turn,
            [0, 1, 2].map(|axis| inward[axis] / self.moments[axis]),
        )
    }

    /// Energy of rotation; J.
    pub fn rotational(&self, turn: Rotation, spin: Vector) -> f64 {
        0.5 * dot(self.momentum(turn, spin), spin)
    }

    /// Semi-axes of the ellipsoid of the same moments; m.
    pub fn semi_axes(&self, mass: f64) -> Vector {
        // Of an ellipsoid I = m (b² + c²)/5 about each axis.
        let [x, y, z] = self.moments.map(|moment| 2.5 * moment / mass);
        [y + z - x, x + z - y, x + y - z].map(|own| own.max(0.0).sqrt())
    }

    /// Volume of that ellipsoid; m³.
    pub fn volume(&self, mass: f64) -> f64 {
        4.0 / 3.0 * PI * self.semi_axes(mass).iter().product::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_spheres_in_a_spheroid() {
        let (length, diameter) = (0.1, 0.06);
        let clump = Clump::spheroid(length, diameter, 0.2, 9).unwrap();
        // Tips: where the spheroid's are, with its curvature b²/a.
        let ([x, ..], radius) = clump.spheres[8];
        assert!((x + radius - 0.05).abs() < 1e-15);
        assert!((radius - 0.03 * 0.03 / 0.05).abs() < 1e-15);
        assert_eq!(clump.spheres[4], ([0.0; 3], 0.03));
        // No sphere leaves the spheroid: points of each, by the spheroid's own equation.
        for &([x, ..], radius) in &clump.spheres {
            for angle in 0..=180 {
                let (s, c) = f64::from(angle).to_radians().sin_cos();
                let (along, off) = ((x + radius * c) / 0.05, radius * s / 0.03);
                assert!(along * along + off * off < 1.0 + 1e-12);
            }
        }
        // Of a spheroid with 0.2 kg: by hand.
        assert!((clump.moments[0] - 0.1 * 0.2 * 0.0036).abs() < 1e-18);
        assert!((clump.moments[1] - 0.2 * (0.01 + 0.0036) / 20.0).abs() < 1e-18);
        assert!((clump.volume(0.2) / (PI / 6.0 * 0.1 * 0.0036) - 1.0).abs() < 1e-12);
        // Made with Python from the same geometry.
        for (count, wanted) in [(5, 2.703998331981816e-3), (17, 3.037614676645057e-4)] {
            let own = Clump::spheroid(length, diameter, 0.2, count).unwrap();
            assert!((own.lacks() - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn rejects_what_is_not_longer_than_thick() {
        assert!(Clump::spheroid(0.06, 0.06, 0.2, 5).is_none());
        assert!(Clump::spheroid(0.1, 0.06, 0.2, 1).is_none());
        assert!(Clump::spheroid(f64::NAN, 0.06, 0.2, 5).is_none());
    }
}
