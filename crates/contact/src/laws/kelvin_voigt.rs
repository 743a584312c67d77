//! Kelvin-Voigt: linear spring and dashpot.

use crate::granular_law::{Damping, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, FROM_ZERO, LawDescription, POSITIVE, Power, parameter};
use std::f64::consts::PI;
use windfall_numerics::real::Real;

/// F = k d + c v.
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

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "kelvin-voigt",
    formula: "F = k d + c v",
    first_touch: "the force jumps to c v0, which no body does; the slope is k",
    source: "Voigt (1892); Schwager and Poeschel (2007) for contact that ends at zero force",
    elastic: Elastic::Power(Power::Number(1.0)),
    damping: Some(("c", Power::Number(0.0))),
    linear: &["k", "c"],
    from_compression: true,
    parameters: &[
        parameter("k", "N/m", "stiffness", POSITIVE, 30_000.0),
        parameter("c", "N s/m", "damping", FROM_ZERO, 40.0),
    ],
};

from_values!(KelvinVoigt [k, c]);

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
    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        let logarithm = -scales.restitution.ln();
        let ratio = logarithm / (PI * PI + logarithm * logarithm).sqrt();
        let frequency = PI / scales.duration;
        vec![
            ("k", scales.mass * frequency * frequency),
            ("c", 2.0 * ratio * scales.mass * frequency),
        ]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Ok(GranularLaw {
            hertzian: false,
            k: self.k,
            damping: Damping::Constant(self.c),
        })
    }
}
