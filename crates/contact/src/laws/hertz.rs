//! Hertz: elastic spheres.

use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
use windfall_numerics::real::Real;

/// F = k d^1.5.
///
/// * `k`: stiffness, (4/3) E* √R*; N/m^1.5
///
/// At first touch force and slope are zero.
///
/// # Source
/// Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Stiffness, (4/3) E* √R*; N/m^1.5.
    pub k: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "hertz",
    formula: "F = k d^1.5",
    first_touch: "force and slope are zero",
    source: "Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23)",
    elastic: Elastic::Hertzian,
    from_compression: true,
    parameters: &[ParameterDescription {
        name: "k",
        meaning: "stiffness, (4/3) E* √R*",
        unit: "N/m^1.5",
        lower: 1e-9,
        upper: 1e30,
        typical: 753_599.0,
        default: None,
    }],
};

impl From<[f64; 1]> for Hertz {
    fn from([k]: [f64; 1]) -> Self {
        Self { k }
    }
}

impl From<Hertz> for [f64; 1] {
    fn from(law: Hertz) -> Self {
        [law.k]
    }
}

impl ContactLaw<1> for Hertz {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, _v: R, _peak: R) -> ContactForce<R, 1> {
        let root = d.sqrt();
        ContactForce {
            force: d * root * self.k,
            by_displacement: root * (1.5 * self.k),
            by_rate: d.constant(0.0),
            by_parameter: [d * root],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for Hertz {
    fn nominal_restitution(&self) -> Option<f64> {
        None
    }

    fn closed_form_restitution(&self, _mass: f64, _velocity: f64) -> Option<f64> {
        Some(1.0)
    }

    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        vec![("k", scales.stiffness(1.5))]
    }
}
