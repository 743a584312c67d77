//! Tsuji: damping that gives one restitution at every velocity.

use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw};
use crate::parameter::{Elastic, LawDescription, ParameterDescription};
use std::f64::consts::PI;
use windfall_numerics::real::Real;

/// F = k d^1.5 + alpha sqrt(m k) d^0.25 v, alpha = -sqrt(5) ln e/sqrt((ln e)^2 + pi^2).
///
/// * `k`: stiffness; N/m^1.5
/// * `restitution`: nominal coefficient of restitution; 1
/// * `mass`: effective mass of the collision; kg
///
/// At first touch the force is zero and its slope in d infinite.
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

/// What the law says about itself.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "tsuji",
    formula: "F = k d^1.5 + alpha sqrt(m k) d^0.25 v, alpha = -sqrt(5) ln e/sqrt((ln e)^2 + pi^2)",
    first_touch: "the force is zero and its slope in d infinite",
    source: "Tsuji, Tanaka and Ishida (1992), Powder Technol. 71, 239; alpha in closed form: the restitution is e exactly where contact ends with the gap (gap-zero)",
    elastic: Elastic::Power(1.5),
    from_compression: false,
    parameters: &[
        ParameterDescription {
            name: "k",
            meaning: "stiffness",
            unit: "N/m^1.5",
            lower: 1e-9,
            upper: 1e30,
            typical: 753_599.0,
            default: None,
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
            name: "mass",
            meaning: "effective mass of the collision, m",
            unit: "kg",
            lower: 1e-9,
            upper: 1e6,
            typical: 0.2,
            default: None,
        },
    ],
};

impl From<[f64; 3]> for Tsuji {
    fn from([k, restitution, mass]: [f64; 3]) -> Self {
        Self {
            k,
            restitution,
            mass,
        }
    }
}

impl From<Tsuji> for [f64; 3] {
    fn from(law: Tsuji) -> Self {
        [law.k, law.restitution, law.mass]
    }
}

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
    fn nominal_restitution(&self) -> Option<f64> {
        Some(self.restitution)
    }

    fn closed_form_restitution(&self, _mass: f64, _velocity: f64) -> Option<f64> {
        None
    }

    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        vec![
            ("k", scales.stiffness(1.5)),
            ("restitution", scales.restitution),
        ]
    }
}
