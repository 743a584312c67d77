//! Properties of a law besides its force: of whole impacts, and for other engines.

use crate::granular_law::GranularLaw;

/// What is given of a law's parameters, or else their defaults, by name; SI.
pub type Given<'a> = dyn Fn(&str) -> Option<f64> + 'a;

/// Properties of a law besides its force. There are no defaults.
pub trait ImpactLaw: Sized {
    /// Parameters with which a fit may begin, right in order of magnitude; SI.
    /// Parameters that are left out take their default or typical value.
    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)>;

    /// The law in the terms of engines for granular matter.
    ///
    /// # Errors
    /// Why it has no counterpart there; the caller names the law.
    fn granular(&self) -> Result<GranularLaw, String>;
}

/// Rough features of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactScales {
    /// Effective mass; kg.
    pub mass: f64,
    /// Velocity at first touch; m/s.
    pub velocity: f64,
    /// Largest displacement; m.
    pub displacement: f64,
    /// Largest force; N.
    pub force: f64,
    /// Contact duration; s.
    pub duration: f64,
    /// Coefficient of restitution; 1.
    pub restitution: f64,
}

impl ImpactScales {
    /// Energy lost; J.
    pub fn loss(&self) -> f64 {
        0.5 * self.mass * self.velocity.powi(2) * (1.0 - self.restitution.powi(2))
    }

    /// k of an elastic force k d^n; N/m^n.
    pub fn stiffness(&self, n: f64) -> f64 {
        // A damped force peaks before the displacement does.
        0.9 * self.force / self.displacement.powf(n)
    }

    /// c of a damping c d^p v; N s/m^(p+1).
    pub fn damping(&self, p: f64) -> f64 {
        // ∮ c d^p v dd over loading and unloading, with v falling to zero halfway.
        self.loss() * (p + 1.5) / (1.3 * self.velocity * self.displacement.powf(p + 1.0))
    }
}
