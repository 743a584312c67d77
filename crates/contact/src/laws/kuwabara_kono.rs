//! Kuwabara-Kono: viscoelastic spheres.

use crate::closed_collision::kuwabara_kono_pade;
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
use windfall_numerics::real::Real;
use windfall_numerics::root::bracketed_root;

/// F = k d^1.5 + c d^0.5 v.
///
/// * `k`: stiffness, that of Hertz; N/m^1.5
/// * `c`: damping, (3/2) A k with the dissipative time A; N s/m^1.5
///
/// At first touch the force is zero and its slope in d infinite.
///
/// # Source
/// Kuwabara and Kono (1987); Brilliantov et al. (1996); eq. (5) of the 2003
/// pendulum study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KuwabaraKono {
    /// Stiffness, that of Hertz; N/m^1.5.
    pub k: f64,
    /// Damping, (3/2) A k with the dissipative time A; N s/m^1.5.
    pub c: f64,
}

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "kuwabara-kono",
    formula: "F = k d^1.5 + c d^0.5 v",
    first_touch: "the force is zero and its slope in d infinite",
    source: "Kuwabara and Kono (1987); Brilliantov et al. (1996); eq. (5) of the 2003 pendulum study",
    elastic: Elastic::Hertzian,
    from_compression: true,
    parameters: &[
        ParameterDescription {
            name: "k",
            meaning: "stiffness, that of Hertz",
            unit: "N/m^1.5",
            lower: 1e-9,
            upper: 1e30,
            typical: 753_599.0,
            default: None,
        },
        ParameterDescription {
            name: "c",
            meaning: "damping, (3/2) A k with the dissipative time A",
            unit: "N s/m^1.5",
            lower: 0.0,
            upper: 1e30,
            typical: 1524.0,
            default: None,
        },
    ],
};

impl From<[f64; 2]> for KuwabaraKono {
    fn from([k, c]: [f64; 2]) -> Self {
        Self { k, c }
    }
}

impl From<KuwabaraKono> for [f64; 2] {
    fn from(law: KuwabaraKono) -> Self {
        [law.k, law.c]
    }
}

impl ContactLaw<2> for KuwabaraKono {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 2> {
        let root = d.sqrt();
        ContactForce {
            force: root * (d * self.k + v * self.c),
            // The quotient by d and not by its root: it need not wait for it.
            by_displacement: root * ((v / d) * (0.5 * self.c) + 1.5 * self.k),
            by_rate: root * self.c,
            by_parameter: [d * root, root * v],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for KuwabaraKono {
    fn nominal_restitution(&self) -> Option<f64> {
        None
    }

    fn closed_form_restitution(&self, _mass: f64, _velocity: f64) -> Option<f64> {
        None
    }

    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        let k = scales.stiffness(1.5);
        let group = bracketed_root(0.0, LARGEST_GROUP, 1e-6, |group| {
            kuwabara_kono_pade(group) - scales.restitution
        });
        let c = group * scales.mass * (k / scales.mass).powf(0.6) / scales.velocity.powf(0.2);
        vec![("k", k), ("c", c)]
    }
}

/// Largest group (c/m)(m/k)^(3/5) v^(1/5) that a start looks at; 1.
const LARGEST_GROUP: f64 = 20.0;
