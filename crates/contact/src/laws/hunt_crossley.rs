//! Hunt-Crossley: damping in proportion to the elastic force.

use crate::granular_law::{GROWING_DAMPING, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{EXPONENTS, Elastic, FROM_ZERO, LawDescription, POSITIVE, Power, parameter};
use crate::restitution::damping_for_restitution;
use windfall_numerics::real::Real;

/// F = k d^n + lambda d^n v.
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

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "hunt-crossley",
    formula: "F = k d^n + lambda d^n v",
    first_touch: "force and slope are zero for n > 1; the force never changes sign before d = 0",
    source: "Hunt and Crossley (1975), J. Appl. Mech. 42, 440",
    elastic: Elastic::Power(Power::Parameter("n")),
    damping: Some(("lambda", Power::Parameter("n"))),
    linear: &["k", "lambda"],
    from_compression: false,
    parameters: &[
        parameter("k", "N/m^n", "stiffness", POSITIVE, 753_599.0),
        parameter("lambda", "N s/m^(n+1)", "damping", FROM_ZERO, 678_239.0),
        parameter("n", "1", "exponent of the displacement", EXPONENTS, 1.5).held(),
    ],
};

from_values!(HuntCrossley [k, lambda, n]);

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
    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let n = given("n").unwrap_or(1.5);
        let factor = damping_for_restitution(scales.restitution, scales.velocity);
        let factor = factor.unwrap_or(1.5 * (1.0 - scales.restitution) / scales.velocity);
        let k = scales.stiffness(n);
        vec![("k", k), ("lambda", factor * k), ("n", n)]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Err(GROWING_DAMPING.to_owned())
    }
}
