//! Hunt-Crossley: damping in proportion to the elastic force.

use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{LawDescription, ParameterDescription};
use windfall_numerics::real::Real;

/// F = k d^n + lambda d^n v.
///
/// * `k`: stiffness; N/m^n
/// * `lambda`: damping; N s/m^(n+1)
/// * `n`: exponent of the displacement; 1
///
/// At first touch force and slope are zero for n > 1; the force never changes
/// sign before d = 0.
///
/// # Source
/// Hunt and Crossley (1975), J. Appl. Mech. 42, 440.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HuntCrossley {
    /// Stiffness; N/m^n.
    pub k: f64,
    /// Damping; N s/m^(n+1).
    pub lambda: f64,
    /// Exponent of the displacement; 1.
    pub n: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "hunt-crossley",
    formula: "F = k d^n + lambda d^n v",
    first_touch: "force and slope are zero for n > 1; the force never changes sign before d = 0",
    source: "Hunt and Crossley (1975), J. Appl. Mech. 42, 440",
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
            name: "lambda",
            meaning: "damping",
            unit: "N s/m^(n+1)",
            lower: 0.0,
            upper: 1e30,
            typical: 678_239.0,
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
    ],
};

impl From<[f64; 3]> for HuntCrossley {
    fn from([k, lambda, n]: [f64; 3]) -> Self {
        Self { k, lambda, n }
    }
}

impl From<HuntCrossley> for [f64; 3] {
    fn from(law: HuntCrossley) -> Self {
        [law.k, law.lambda, law.n]
    }
}

impl ContactLaw<3> for HuntCrossley {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 3> {
        let power = d.powf(self.n);
        let stiffness = v * self.lambda + self.k;
        let force = power * stiffness;
        ContactForce {
            force,
            by_displacement: force / d * self.n,
            by_rate: power * self.lambda,
            by_parameter: [power, power * v, force * d.ln()],
            by_peak: d.constant(0.0),
        }
    }
}
