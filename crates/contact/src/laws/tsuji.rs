//! Tsuji: damping that gives one restitution at every velocity.

use crate::granular_law::{Damping, GranularLaw};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, LawDescription, POSITIVE, Power, parameter};
use std::f64::consts::PI;
use windfall_numerics::real::Real;

/// F = k d^1.5 + alpha sqrt(m k) d^0.25 v, alpha = -sqrt(5) ln e/sqrt((ln e)^2 + pi^2).
///
/// # Source
/// Tsuji, Tanaka and Ishida (1992), Powder Technol. 71, 239; alpha in closed
/// form: the restitution is e exactly where contact ends with the gap (see
/// EndRule::GapZero).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tsuji {
    /// Stiffness; N/m^1.5.
    pub k: f64,
    /// Nominal coefficient of restitution; 1.
    pub restitution: f64,
    /// Effective mass of the collision; kg.
    pub mass: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "tsuji",
    formula: "F = k d^1.5 + alpha sqrt(m k) d^0.25 v, alpha = -sqrt(5) ln e/sqrt((ln e)^2 + pi^2)",
    first_touch: "the force is zero and its slope in d infinite",
    source: "Tsuji, Tanaka and Ishida (1992), Powder Technol. 71, 239; alpha in closed form: the restitution is e exactly where contact ends with the gap (gap-zero)",
    elastic: Elastic::Power(Power::Number(1.5)),
    damping: None,
    linear: &[],
    from_compression: false,
    parameters: &[
        parameter("k", "N/m^1.5", "stiffness", POSITIVE, 753_599.0),
        parameter(
            "restitution",
            "1",
            "nominal coefficient of restitution, e",
            [1e-3, 1.0],
            0.5,
        ),
        parameter(
            "mass",
            "kg",
            "effective mass of the collision, m",
            [1e-9, 1e6],
            0.2,
        ),
    ],
};

from_values!(Tsuji [k, restitution, mass]);

impl Tsuji {
    /// α and dα/de.
    #[inline(always)]
    fn damping_ratio(&self) -> (f64, f64) {
        let log = self.restitution.ln();
        let square = log * log + PI * PI;
        let ratio = -5.0_f64.sqrt() * log / square.sqrt();
        let slope = -5.0_f64.sqrt() * PI * PI / (square * square.sqrt());
        (ratio, slope / self.restitution)
    }
}

impl ContactLaw<3> for Tsuji {
    const START_POWER: u32 = 4;

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 3> {
        let (ratio, ratio_by_restitution) = self.damping_ratio();
        let scale = (self.mass * self.k).sqrt();
        let root = d.sqrt();
        let quarter = root.sqrt();
        let viscous = quarter * v;
        ContactForce {
            force: d * root * self.k + viscous * (ratio * scale),
            by_displacement: root * (1.5 * self.k) + viscous / d * (0.25 * ratio * scale),
            by_rate: quarter * (ratio * scale),
            by_parameter: [
                d * root + viscous * (0.5 * ratio * scale / self.k),
                viscous * (ratio_by_restitution * scale),
                viscous * (0.5 * ratio * scale / self.mass),
            ],
            by_peak: d.constant(0.0),
        }
    }
}

impl ImpactLaw for Tsuji {
    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        vec![
            ("k", scales.stiffness(1.5)),
            ("restitution", scales.restitution),
        ]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        let (ratio, _) = self.damping_ratio();
        Ok(GranularLaw {
            hertzian: true,
            k: self.k,
            damping: Damping::Quarter(ratio * (self.mass * self.k).sqrt()),
        })
    }
}
