//! Kelvin-Voigt: linear spring and dashpot.

use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
use std::f64::consts::PI;
use windfall_numerics::real::Real;

/// F = k d + c v.
///
/// * `k`: stiffness; N/m
/// * `c`: damping; N s/m
///
/// At first touch the force jumps to c v0, which no body does; the slope is
/// k.
///
/// # Source
/// Voigt (1892); Schwager and Poeschel (2007) for contact that ends at zero
/// force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KelvinVoigt {
    /// Stiffness; N/m.
    pub k: f64,
    /// Damping; N s/m.
    pub c: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "kelvin-voigt",
    formula: "F = k d + c v",
    first_touch: "the force jumps to c v0, which no body does; the slope is k",
    source: "Voigt (1892); Schwager and Poeschel (2007) for contact that ends at zero force",
    elastic: Elastic::Power(1.0),
    from_compression: true,
    parameters: &[
        ParameterDescription {
            name: "k",
            meaning: "stiffness",
            unit: "N/m",
            lower: 1e-9,
            upper: 1e30,
            typical: 30_000.0,
            default: None,
        },
        ParameterDescription {
            name: "c",
            meaning: "damping",
            unit: "N s/m",
            lower: 0.0,
            upper: 1e30,
            typical: 40.0,
            default: None,
        },
    ],
};

impl From<[f64; 2]> for KelvinVoigt {
    fn from([k, c]: [f64; 2]) -> Self {
        Self { k, c }
    }
}

impl From<KelvinVoigt> for [f64; 2] {
    fn from(law: KelvinVoigt) -> Self {
        [law.k, law.c]
    }
}

impl ContactLaw<2> for KelvinVoigt {
    const START_POWER: u32 = 1;

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 2> {
        ContactForce {
            force: d * self.k + v * self.c,
            by_displacement: d.constant(self.k),
            by_rate: d.constant(self.c),
            by_parameter: [d, v],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for KelvinVoigt {
    fn nominal_restitution(&self) -> Option<f64> {
        None
    }

    fn closed_form_restitution(&self, mass: f64, _velocity: f64) -> Option<f64> {
        Some(kelvin_voigt_impact(self, mass).restitution)
    }

    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        let logarithm = -scales.restitution.ln();
        let ratio = logarithm / (PI * PI + logarithm * logarithm).sqrt();
        let frequency = PI / scales.duration;
        vec![
            ("k", scales.mass * frequency * frequency),
            ("c", 2.0 * ratio * scales.mass * frequency),
        ]
    }
}

/// Duration and restitution of a Kelvin-Voigt impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearImpact {
    /// Time from first touch to zero force; s.
    pub duration: f64,
    /// Restitution; 1.
    pub restitution: f64,
}

/// Kelvin-Voigt impact that ends at zero force, for any damping.
///
/// ```text
/// b = c/(2m),  w0² = k/m,  e = exp(−b T)
/// b < w0:  T = atan2(2 b w, b² − w²)/w,     w² = w0² − b²
/// b = w0:  T = 2/b
/// b > w0:  T = ln((b + W)/(b − W))/W,    W² = b² − w0²
/// ```
///
/// # Source
/// Schwager and Poeschel (2007), Granular Matter 9, 465.
#[must_use]
pub fn kelvin_voigt_impact(law: &KelvinVoigt, mass: f64) -> LinearImpact {
    let b = law.c / (2.0 * mass);
    let square = law.k / mass - b * b;
    let duration = if square > 0.0 {
        let w = square.sqrt();
        // The angle runs from π (no damping) to 0 (critical).
        (2.0 * b * w).atan2(b * b - square) / w
    } else if square < 0.0 {
        let w = (-square).sqrt();
        // (b + W)/(b − W) = (b + W)²/w0², without cancellation.
        ((b + w) * (b + w) / (law.k / mass)).ln() / w
    } else {
        2.0 / b
    };
    LinearImpact {
        duration,
        restitution: (-b * duration).exp(),
    }
}
