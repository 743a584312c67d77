//! Laws F = k d^n (1 + a v) that take a nominal restitution for the damping factor a.

use crate::parameter::{Elastic, IMPACT_VELOCITY, LawDescription, ParameterDescription};

/// Declares such a law: its type, `DESCRIPTION` and what it does, from its name,
/// formula, source and the function of [`damping_factor`](crate::damping_factor).
macro_rules! damped_power_law {
    ($law:ident, $factor:ident: $name:literal, $formula:literal, $source:literal) => {
        use crate::closed_collision::damped_power_restitution;
        use crate::damping_factor::{damped_power, $factor};
        use crate::impact_law::{Given, ImpactLaw, ImpactScales};
        use crate::law::{ContactForce, ContactLaw};
        use crate::parameter::LawDescription;
        use windfall_numerics::real::Real;

        #[doc = concat!($formula, " with e the restitution and v0 the impact velocity.")]
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
        #[doc = concat!($source, ".")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $law {
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
        pub const DESCRIPTION: LawDescription =
            crate::laws::damped_power::description($name, $formula, $source);

        impl From<[f64; 4]> for $law {
            fn from([k, n, restitution, impact_velocity]: [f64; 4]) -> Self {
                Self {
                    k,
                    n,
                    restitution,
                    impact_velocity,
                }
            }
        }

        impl From<$law> for [f64; 4] {
            fn from(law: $law) -> Self {
                [law.k, law.n, law.restitution, law.impact_velocity]
            }
        }

        impl ContactLaw<4> for $law {
            #[inline(always)]
            fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 4> {
                let factor = $factor(self.restitution, self.impact_velocity);
                damped_power(self.k, self.n, factor, d, v)
            }
        }

        impl ImpactLaw for $law {
            fn nominal_restitution(&self) -> Option<f64> {
                Some(self.restitution)
            }

            fn closed_form_restitution(&self, _mass: f64, velocity: f64) -> Option<f64> {
                let factor = $factor(self.restitution, self.impact_velocity);
                Some(damped_power_restitution(factor.value * velocity))
            }

            fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
                let n = given("n").unwrap_or(1.5);
                vec![
                    ("k", scales.stiffness(n)),
                    ("n", n),
                    ("restitution", scales.restitution),
                ]
            }
        }
    };
}
pub(crate) use damped_power_law;

/// What such a law says about itself.
pub(crate) const fn description(
    name: &'static str,
    formula: &'static str,
    source: &'static str,
) -> LawDescription {
    LawDescription {
        name,
        formula,
        first_touch: "force and slope are zero for n > 1; the force never changes sign before d = 0",
        source,
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
                name: IMPACT_VELOCITY,
                meaning: "velocity at first touch of this collision, v0",
                unit: "m/s",
                lower: 1e-6,
                upper: 1e3,
                typical: 0.5,
                default: None,
            },
        ],
    }
}
