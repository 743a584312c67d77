//! Laws F = k d^n (1 + a v) that take a nominal restitution for the damping factor a.

use crate::parameter::{
    EXPONENTS, Elastic, IMPACT_VELOCITY, LawDescription, POSITIVE, ParameterDescription, Power,
    RESTITUTION, parameter,
};

/// Declares such a law: its type, `DESCRIPTION` and what it does, from its name,
/// formula, source and the function of [`damping_factor`](crate::damping_factor).
macro_rules! damped_power_law {
    ($law:ident, $factor:ident: $name:literal, $formula:literal, $source:literal) => {
        use crate::damping_factor::{damped_power, $factor};
        use crate::granular_law::{GROWING_DAMPING, GranularLaw};
        use crate::impact_law::{Given, ImpactLaw, ImpactScales};
        use crate::law::{ContactForce, ContactLaw};
        use crate::parameter::LawDescription;
        use windfall_numerics::real::Real;

        #[doc = concat!($formula, " with e the restitution and v0 the impact velocity.")]
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

        /// Description of the law.
        pub const DESCRIPTION: LawDescription =
            crate::laws::damped_power::description($name, $formula, $source);

        crate::law::from_values!($law [k, n, restitution, impact_velocity]);

        impl ContactLaw<4> for $law {
            #[inline(always)]
            fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 4> {
                let factor = $factor(self.restitution, self.impact_velocity);
                damped_power(self.k, self.n, factor, d, v)
            }
        }

        impl ImpactLaw for $law {
            fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
                let n = given("n").unwrap_or(1.5);
                vec![
                    ("k", scales.stiffness(n)),
                    ("n", n),
                    ("restitution", scales.restitution),
                ]
            }

            fn granular(&self) -> Result<GranularLaw, String> {
                Err(GROWING_DAMPING.to_owned())
            }
        }
    };
}
pub(crate) use damped_power_law;

const PARAMETERS: [ParameterDescription; 4] = [
    parameter("k", "N/m^n", "stiffness", POSITIVE, 753_599.0),
    parameter("n", "1", "exponent of the displacement", EXPONENTS, 1.5).held(),
    parameter(
        RESTITUTION,
        "1",
        "nominal coefficient of restitution, e",
        [1e-3, 1.0],
        0.5,
    ),
    parameter(
        IMPACT_VELOCITY,
        "m/s",
        "velocity at first touch of this collision, v0",
        [1e-6, 1e3],
        0.5,
    ),
];

/// Description of such a law.
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
        elastic: Elastic::Power(Power::Parameter("n")),
        damping: None,
        linear: &[],
        from_compression: false,
        parameters: &PARAMETERS,
    }
}
