//! General power law: spring and dashpot with free exponents.

use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
use windfall_numerics::real::Real;

/// F = k d^n + c d^p v.
///
/// * `k`: stiffness; N/m^n
/// * `n`: exponent of the displacement; 1
/// * `c`: damping; N s/m^(p+1)
/// * `p`: exponent of the displacement in the damping; 1
///
/// At first touch the force is zero for p > 0; its slope in d is infinite for
/// p < 1.
///
/// # Source
/// general form of Hertz (n = 1.5, c = 0), Kelvin-Voigt (n = 1, p = 0),
/// Kuwabara-Kono (n = 1.5, p = 0.5) and Hunt-Crossley (p = n).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Stiffness; N/m^n.
    pub k: f64,
    /// Exponent of the displacement; 1.
    pub n: f64,
    /// Damping; N s/m^(p+1).
    pub c: f64,
    /// Exponent of the displacement in the damping; 1.
    pub p: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "power-law",
    formula: "F = k d^n + c d^p v",
    first_touch: "the force is zero for p > 0; its slope in d is infinite for p < 1",
    source: "general form of Hertz (n = 1.5, c = 0), Kelvin-Voigt (n = 1, p = 0), Kuwabara-Kono (n = 1.5, p = 0.5) and Hunt-Crossley (p = n)",
    elastic: Elastic::Parameter("n"),
    from_compression: true,
    parameters: &[
        ParameterDescription {
            name: "k",
            meaning: "stiffness",
            unit: "N/m^n",
            lower: 1e-9,
            upper: 1e30,
            typical: 753_599.0,
            default: None,
        },
        ParameterDescription {
            name: "n",
            meaning: "exponent of the displacement",
            unit: "1",
            lower: 0.5,
            upper: 6.0,
            typical: 1.5,
            default: Some(1.5),
        },
        ParameterDescription {
            name: "c",
            meaning: "damping",
            unit: "N s/m^(p+1)",
            lower: 0.0,
            upper: 1e30,
            typical: 1524.0,
            default: None,
        },
        ParameterDescription {
            name: "p",
            meaning: "exponent of the displacement in the damping",
            unit: "1",
            lower: 0.0,
            upper: 6.0,
            typical: 0.5,
            default: Some(0.5),
        },
    ],
};

impl From<[f64; 4]> for PowerLaw {
    fn from([k, n, c, p]: [f64; 4]) -> Self {
        Self { k, n, c, p }
    }
}

impl From<PowerLaw> for [f64; 4] {
    fn from(law: PowerLaw) -> Self {
        [law.k, law.n, law.c, law.p]
    }
}

impl ContactLaw<4> for PowerLaw {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 4> {
        let elastic = d.powf(self.n);
        let damping = d.powf(self.p);
        let viscous = damping * v;
        let log = d.ln();
        ContactForce {
            force: elastic * self.k + viscous * self.c,
            by_displacement: (elastic * (self.k * self.n) + viscous * (self.c * self.p)) / d,
            by_rate: damping * self.c,
            by_parameter: [
                elastic,
                elastic * log * self.k,
                viscous,
                viscous * log * self.c,
            ],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for PowerLaw {
    fn nominal_restitution(&self) -> Option<f64> {
        None
    }

    fn closed_form_restitution(&self, _mass: f64, _velocity: f64) -> Option<f64> {
        None
    }

    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let n = given("n").unwrap_or(1.5);
        let p = given("p").unwrap_or(0.5);
        let (k, c) = (scales.stiffness(n), scales.damping(p));
        vec![("k", k), ("n", n), ("c", c), ("p", p)]
    }
}
