//! ADAMS IMPACT: power-law spring with damping that grows over a depth.

use crate::granular_law::GranularLaw;
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{EXPONENTS, Elastic, FROM_ZERO, LawDescription, POSITIVE, Power, parameter};
use windfall_numerics::real::Real;

/// F = k x^e + c STEP(x; 0, d) v, STEP = w^2 (3 - 2 w), w = min(x/d, 1).
///
/// # Source
/// MSC Adams function reference, IMPACT and (cubic) STEP; x is the
/// indentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdamsImpact {
    /// Stiffness; N/m^e.
    pub k: f64,
    /// Exponent of the displacement; 1.
    pub e: f64,
    /// Damping beyond the depth d; N s/m.
    pub c: f64,
    /// Depth at which the damping is full; m.
    pub d: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "adams-impact",
    formula: "F = k x^e + c STEP(x; 0, d) v, STEP = w^2 (3 - 2 w), w = min(x/d, 1)",
    first_touch: "force and slope are zero, but with a small d the force is nearly c v0 at once",
    source: "MSC Adams function reference, IMPACT and (cubic) STEP; x is the indentation",
    elastic: Elastic::Power(Power::Parameter("e")),
    damping: Some(("c", Power::Number(0.0))),
    linear: &["k", "c"],
    from_compression: false,
    parameters: &[
        parameter("k", "N/m^e", "stiffness", POSITIVE, 753_599.0),
        parameter("e", "1", "exponent of the displacement", EXPONENTS, 1.5),
        parameter("c", "N s/m", "damping beyond the depth d", FROM_ZERO, 40.0),
        parameter(
            "d",
            "m",
            "depth at which the damping is full",
            [1e-9, 1.0],
            1e-4,
        ),
    ],
};

from_values!(AdamsImpact [k, e, c, d]);

impl ContactLaw<4> for AdamsImpact {
    #[inline(always)]
    fn evaluate<R: Real>(&self, x: R, v: R, _peak: R) -> ContactForce<R, 4> {
        let power = x.powf(self.e);
        // Share of the depth d, and the cubic step with its derivative.
        let w = (x * (1.0 / self.d)).min(x.constant(1.0));
        let step = w * w * (w * -2.0 + 3.0);
        let step_by_w = w * (-w + 1.0) * 6.0;
        let viscous = v * self.c;
        ContactForce {
            force: power * self.k + step * viscous,
            by_displacement: power / x * (self.k * self.e) + step_by_w * viscous * (1.0 / self.d),
            by_rate: step * self.c,
            by_parameter: [
                power,
                power * x.ln() * self.k,
                step * v,
                step_by_w * w * viscous * (-1.0 / self.d),
            ],
            by_peak: x.constant(0.0),
        }
    }

    fn kink(&self) -> f64 {
        self.d
    }
}

impl ImpactLaw for AdamsImpact {
    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let e = given("e").unwrap_or(1.5);
        vec![
            ("k", scales.stiffness(e)),
            ("e", e),
            ("c", scales.damping(0.0)),
            ("d", 0.1 * scales.displacement),
        ]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Err("the engine has no damping that sets in by a STEP of the penetration".to_owned())
    }
}
