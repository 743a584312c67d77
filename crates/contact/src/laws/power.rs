//! General power law: spring and dashpot with free exponents.

use crate::granular_law::{Damping, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{EXPONENTS, Elastic, FROM_ZERO, LawDescription, POSITIVE, Power, parameter};
use windfall_numerics::real::Real;

/// F = k d^n + c d^p v.
///
/// # Source
/// general form of Hertz (n = 1.5, c = 0), Kelvin-Voigt (n = 1, p = 0),
/// Kuwabara-Kono (n = 1.5, p = 0.5) and Hunt-Crossley (p = n).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Stiffness; N/m^n.
    pub k: f64,
    /// Exponent of the displacement; 1.
    pub n: f64,
    /// Damping; N s/m^(p+1).
    pub c: f64,
    /// Exponent of the displacement in the damping; 1.
    pub p: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "power-law",
    formula: "F = k d^n + c d^p v",
    first_touch: "the force is zero for p > 0; its slope in d is infinite for p < 1",
    source: "general form of Hertz (n = 1.5, c = 0), Kelvin-Voigt (n = 1, p = 0), Kuwabara-Kono (n = 1.5, p = 0.5) and Hunt-Crossley (p = n)",
    elastic: Elastic::Power(Power::Parameter("n")),
    damping: Some(("c", Power::Parameter("p"))),
    linear: &["k", "c"],
    from_compression: true,
    parameters: &[
        parameter("k", "N/m^n", "stiffness", POSITIVE, 753_599.0),
        parameter("n", "1", "exponent of the displacement", EXPONENTS, 1.5).held(),
        parameter("c", "N s/m^(p+1)", "damping", FROM_ZERO, 1524.0),
        parameter(
            "p",
            "1",
            "exponent of the displacement in the damping",
            [0.0, 6.0],
            0.5,
        )
        .held(),
    ],
};

from_values!(PowerLaw [k, n, c, p]);

impl ContactLaw<4> for PowerLaw {
    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 4> {
        let elastic = d.powf(self.n);
        let damping = d.powf(self.p);
        let viscous = damping * v;
        let log = d.ln();
        ContactForce {
            force: elastic * self.k + viscous * self.c,
            by_displacement: (elastic * (self.k * self.n) + viscous * (self.c * self.p)) / d,
            by_rate: damping * self.c,
            by_parameter: [
                elastic,
                elastic * log * self.k,
                viscous,
                viscous * log * self.c,
            ],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for PowerLaw {
    fn start(scales: &ImpactScales, given: &Given) -> Vec<(&'static str, f64)> {
        let n = given("n").unwrap_or(1.5);
        let p = given("p").unwrap_or(0.5);
        let (k, c) = (scales.stiffness(n), scales.damping(p));
        vec![("k", k), ("n", n), ("c", c), ("p", p)]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        let hertzian = match self.n {
            1.0 => false,
            1.5 => true,
            n => {
                return Err(format!(
                    "with n = {n}; the engine has n = 1 and n = 1.5 only"
                ));
            }
        };
        let damping = match (hertzian, self.p) {
            _ if self.c == 0.0 => Damping::None,
            (_, 0.0) => Damping::Constant(self.c),
            (true, 0.5) => Damping::Root(self.c),
            (_, p) => {
                return Err(format!(
                    "with n = {} and p = {p}; the engine has p = 0 for n = 1, and p = 0 or 0.5 for n = 1.5",
                    self.n
                ));
            }
        };
        Ok(GranularLaw {
            hertzian,
            k: self.k,
            damping,
        })
    }
}
