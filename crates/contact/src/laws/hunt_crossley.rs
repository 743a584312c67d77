//! Hunt-Crossley: damping in proportion to the elastic force.

use crate::closed_collision::{damped_power_restitution, damping_for_restitution};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
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
    elastic: Elastic::Parameter("n"),
    from_compression: false,
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

impl ImpactLaw for HuntCrossley {
    fn nominal_restitution(&self) -> Option<f64> {
        None
    }

    fn closed_form_restitution(&self, _mass: f64, velocity: f64) -> Option<f64> {
        Some(damped_power_restitution(self.lambda / self.k * velocity))
    }

    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let n = given("n").unwrap_or(1.5);
        let factor = damping_for_restitution(scales.restitution, scales.velocity);
        let factor = factor.unwrap_or(1.5 * (1.0 - scales.restitution) / scales.velocity);
        let k = scales.stiffness(n);
        vec![("k", k), ("lambda", factor * k), ("n", n)]
    }
}
