//! The restitution that a normal force delivers, and the coefficient that delivers another's.

use serde::Serialize;
use std::fmt::Write;

/// A normal force, N, of displacement, m, and its rate, m/s.
pub(crate) type Force<'a> = Box<dyn Fn(f64, f64) -> f64 + 'a>;

/// When an engine ends a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// When the force is back at zero: it never pulls.
    Force,
    /// When the bodies part: damping pulls them back at the end.
    Gap,
}

/// An impact of which only the force differs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impact {
    /// Effective mass; kg.
    pub mass: f64,
    /// m/s
    pub speed: f64,
    /// A displacement that it may reach; m.
    pub depth: f64,
}

/// Restitution at a speed: of the law, and what an engine delivers of what it is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Delivered {
    /// Impact speed; m/s.
    pub speed: f64,
    /// Of the law; 1.
    pub law: f64,
    /// Of the engine; 1.
    pub engine: f64,
}

impl Delivered {
    /// How far the engine is off, over the law's; 1.
    pub(crate) fn error(&self) -> f64 {
        (self.engine / self.law - 1.0).abs()
    }
}

/// What is delivered, in words.
pub(crate) fn text_of_delivered(all: &[Delivered]) -> String {
    let mut text = String::new();
    for (place, own) in all.iter().enumerate() {
        let comma = if place > 0 { "; " } else { "" };
        let _ = write!(
            text,
            "{comma}{:.4} for {:.4} at {:.3} m/s",
            own.engine, own.law, own.speed
        );
    }
    text
}

/// Steps in the time in which an impact would cross its depth.
const STEPS: f64 = 1000.0;

impl Impact {
    /// Restitution under a force, by Runge and Kutta's method.
    pub(crate) fn restitution(&self, force: &dyn Fn(f64, f64) -> f64, ends: Ends) -> f64 {
        let step = self.depth / self.speed / STEPS;
        let (mut d, mut v) = (0.0_f64, self.speed);
        let rate = |d: f64, v: f64| -force(d.max(0.0), v) / self.mass;
        for _ in 0..(100.0 * STEPS) as usize {
            let a = (v, rate(d, v));
            let b = (
                v + 0.5 * step * a.1,
                rate(d + 0.5 * step * a.0, v + 0.5 * step * a.1),
            );
            let c = (
                v + 0.5 * step * b.1,
                rate(d + 0.5 * step * b.0, v + 0.5 * step * b.1),
            );
            let e = (v + step * c.1, rate(d + step * c.0, v + step * c.1));
            d += step / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + e.0);
            v += step / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + e.1);
            let over = d <= 0.0 || ends == Ends::Force && force(d, v) <= 0.0;
            if v < 0.0 && over {
                break;
            }
        }
        (-v / self.speed).max(0.0)
    }

    /// The coefficient with which a force delivers a restitution.
    pub(crate) fn matched<F: Fn(f64, f64) -> f64>(
        &self,
        wanted: f64,
        like: impl Fn(f64) -> F,
        ends: Ends,
    ) -> f64 {
        // Up to where hardly anything comes back.
        let mut high = 1.0;
        while self.restitution(&like(high), ends) > wanted && high < 1e9 {
            high *= 4.0;
        }
        let mut low = 0.0;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match self.restitution(&like(middle), ends) > wanted {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring with a dashpot, ζ = c/(2 √(k m)): exp(−π ζ/√(1 − ζ²)) where the bodies part;
    /// where the force ends, exp(−ζ/√(1 − ζ²) · (π − atan(2 ζ √(1 − ζ²)/(2 ζ² − 1)))) with the
    /// angle in the second quadrant (Schwager and Pöschel 2007, Granular Matter 9, 465, eq. 22).
    #[test]
    fn closed_form_restitution_of_a_spring_and_a_dashpot() {
        let (k, mass) = (4e4_f64, 0.2_f64);
        for zeta in [0.05_f64, 0.2, 0.4, 0.65] {
            let c = 2.0 * zeta * (k * mass).sqrt();
            let force = move |d: f64, v: f64| k * d + c * v;
            for speed in [0.1, 2.0] {
                let depth = speed * (mass / k).sqrt();
                let impact = Impact { mass, speed, depth };
                let root = (1.0 - zeta * zeta).sqrt();
                let gap = (-std::f64::consts::PI * zeta / root).exp();
                let found = impact.restitution(&force, Ends::Gap);
                assert!((found - gap).abs() < 2e-3 * gap, "{zeta}: {found} {gap}");
                let angle = (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta);
                let ends = (-zeta / root * (std::f64::consts::PI - angle)).exp();
                let found = impact.restitution(&force, Ends::Force);
                assert!((found - ends).abs() < 2e-3 * ends, "{zeta}: {found} {ends}");
                let like = |c: f64| move |d: f64, v: f64| k * d + c * v;
                let back = impact.matched(ends, like, Ends::Force);
                assert!((back / c - 1.0).abs() < 2e-3, "{back} {c}");
            }
        }
    }
}
