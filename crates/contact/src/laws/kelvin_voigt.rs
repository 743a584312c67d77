//! Kelvin-Voigt: linear spring and dashpot.

use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{LawDescription, ParameterDescription};
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
