//! Hertz: elastic spheres.

use crate::granular_law::{Damping, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, LawDescription, POSITIVE, parameter};
use windfall_numerics::real::Real;

/// F = k d^1.5.
///
/// # Source
/// Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Stiffness, (4/3) E* √R*; N/m^1.5.
    pub k: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "hertz",
    formula: "F = k d^1.5",
    first_touch: "force and slope are zero",
    source: "Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23)",
    elastic: Elastic::Hertzian,
    damping: None,
    linear: &["k"],
    from_compression: true,
    parameters: &[parameter(
        "k",
        "N/m^1.5",
        "stiffness, (4/3) E* √R*",
        POSITIVE,
        753_599.0,
    )],
};

from_values!(Hertz[k]);

impl ContactLaw<1> for Hertz {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, _v: R, _peak: R) -> ContactForce<R, 1> {
        let root = d.sqrt();
        ContactForce {
            force: d * root * self.k,
            by_displacement: root * (1.5 * self.k),
            by_rate: d.constant(0.0),
            by_parameter: [d * root],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for Hertz {
    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        vec![("k", scales.stiffness(1.5))]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Ok(GranularLaw {
            hertzian: true,
            k: self.k,
            damping: Damping::None,
        })
    }
}
