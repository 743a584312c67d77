//! Herbert-McWhannell: Hunt-Crossley damping from an impact pair.

use crate::damping_factor::{self, damped_power};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{LawDescription, ParameterDescription};
use windfall_numerics::real::Real;

/// F = k d^n (1 + a v), a = 6 (1 - e)/(((2 e - 1)^2 + 3) v0) with e the restitution and v0 the
/// impact velocity.
///
/// * `k`: stiffness; N/m^n
/// * `n`: exponent of the displacement; 1
/// * `restitution`: nominal coefficient of restitution; 1
/// * `impact_velocity`: velocity at first touch of this collision; m/s
///
/// At first touch force and slope are zero for n > 1; the force never changes
/// sign before d = 0.
///
/// # Source
/// Herbert and McWhannell (1977), J. Eng. Ind. 99, 513.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HerbertMcWhannell {
    /// Stiffness; N/m^n.
    pub k: f64,
    /// Exponent of the displacement; 1.
    pub n: f64,
    /// Nominal coefficient of restitution; 1.
    pub restitution: f64,
    /// Velocity at first touch of this collision; m/s.
    pub impact_velocity: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "herbert-mcwhannell",
    formula: "F = k d^n (1 + a v), a = 6 (1 - e)/(((2 e - 1)^2 + 3) v0)",
    first_touch: "force and slope are zero for n > 1; the force never changes sign before d = 0",
    source: "Herbert and McWhannell (1977), J. Eng. Ind. 99, 513",
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
            name: "restitution",
            meaning: "nominal coefficient of restitution, e",
            unit: "1",
            lower: 1e-3,
            upper: 1.0,
            typical: 0.5,
            default: None,
        },
        ParameterDescription {
            name: "impact_velocity",
            meaning: "velocity at first touch of this collision, v0",
            unit: "m/s",
            lower: 1e-6,
            upper: 1e3,
            typical: 0.5,
            default: None,
        },
    ],
};

impl From<[f64; 4]> for HerbertMcWhannell {
    fn from([k, n, restitution, impact_velocity]: [f64; 4]) -> Self {
        Self {
            k,
            n,
            restitution,
            impact_velocity,
        }
    }
}

impl From<HerbertMcWhannell> for [f64; 4] {
    fn from(law: HerbertMcWhannell) -> Self {
        [law.k, law.n, law.restitution, law.impact_velocity]
    }
}

impl ContactLaw<4> for HerbertMcWhannell {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 4> {
        let factor = damping_factor::herbert_mcwhannell(self.restitution, self.impact_velocity);
        damped_power(self.k, self.n, factor, d, v)
    }
}
