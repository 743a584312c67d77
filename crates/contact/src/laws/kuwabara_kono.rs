//! Kuwabara-Kono: viscoelastic spheres.

use crate::granular_law::{Damping, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, FROM_ZERO, LawDescription, POSITIVE, Power, parameter};
use crate::restitution::kuwabara_kono_pade;
use windfall_numerics::real::Real;
use windfall_numerics::root::bracketed_root;

/// F = k d^1.5 + c d^0.5 v.
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

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "kuwabara-kono",
    formula: "F = k d^1.5 + c d^0.5 v",
    first_touch: "the force is zero and its slope in d infinite",
    source: "Kuwabara and Kono (1987); Brilliantov et al. (1996); eq. (5) of the 2003 pendulum study",
    elastic: Elastic::Hertzian,
    damping: Some(("c", Power::Number(0.5))),
    linear: &["k", "c"],
    from_compression: true,
    parameters: &[
        parameter(
            "k",
            "N/m^1.5",
            "stiffness, that of Hertz",
            POSITIVE,
            753_599.0,
        ),
        parameter(
            "c",
            "N s/m^1.5",
            "damping, (3/2) A k with the dissipative time A",
            FROM_ZERO,
            1524.0,
        ),
    ],
};

from_values!(KuwabaraKono [k, c]);

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
    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        let k = scales.stiffness(1.5);
        let group = bracketed_root(0.0, LARGEST_GROUP, 1e-6, |group| {
            kuwabara_kono_pade(group) - scales.restitution
        });
        let c = group * scales.mass * (k / scales.mass).powf(0.6) / scales.velocity.powf(0.2);
        vec![("k", k), ("c", c)]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Ok(GranularLaw {
            hertzian: true,
            k: self.k,
            damping: Damping::Root(self.c),
        })
    }
}

/// Largest group (c/m)(m/k)^(3/5) v^(1/5) that a start looks at; 1.
const LARGEST_GROUP: f64 = 20.0;
