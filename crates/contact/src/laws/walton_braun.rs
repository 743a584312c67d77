//! Walton-Braun: linear loading, steeper linear unloading.

use crate::granular_law::{GranularLaw, MEMORY};
use crate::impact_law::{Given, ImpactLaw, ImpactScales};
use crate::law::{ContactForce, ContactLaw, from_values};
use crate::parameter::{Elastic, LawDescription, POSITIVE, Power, parameter};
use windfall_numerics::real::Real;

/// F = k1 d while loading; k1 d_peak + k2 (d - d_peak) below the largest displacement d_peak.
///
/// # Source
/// Walton and Braun (1986), J. Rheol. 30, 949.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaltonBraun {
    /// Stiffness while loading; N/m.
    pub k1: f64,
    /// Stiffness while unloading and reloading, at least k1; N/m.
    pub k2: f64,
}

/// Description of the law.
pub const DESCRIPTION: LawDescription = LawDescription {
    name: "walton-braun",
    formula: "F = k1 d while loading; k1 d_peak + k2 (d - d_peak) below the largest displacement d_peak",
    first_touch: "the force is zero and its slope k1",
    source: "Walton and Braun (1986), J. Rheol. 30, 949",
    elastic: Elastic::Power(Power::Number(1.0)),
    damping: None,
    linear: &[],
    from_compression: false,
    parameters: &[
        parameter("k1", "N/m", "stiffness while loading", POSITIVE, 40_000.0),
        parameter(
            "k2",
            "N/m",
            "stiffness while unloading and reloading, at least k1",
            POSITIVE,
            111_000.0,
        ),
    ],
};

from_values!(WaltonBraun [k1, k2]);

/// Unloading is never softer than loading: a `k2` below `k1` acts as `k1`, so
/// that no parameters make a contact that returns more energy than it got.
impl ContactLaw<2> for WaltonBraun {
    const HISTORY: bool = true;
    const START_POWER: u32 = 1;

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, _v: R, peak: R) -> ContactForce<R, 2> {
        let zero = d.constant(0.0);
        let steeper = self.k2 > self.k1;
        let unloading = if steeper { self.k2 } else { self.k1 };
        let (by_k1, by_k2) = if steeper { (peak, d - peak) } else { (d, zero) };
        // Below the peak; never during first loading, where the peak is zero.
        let below = peak - d;
        ContactForce {
            force: below.select(peak * self.k1 - below * unloading, d * self.k1),
            by_displacement: below.select(d.constant(unloading), d.constant(self.k1)),
            by_rate: zero,
            by_parameter: [below.select(by_k1, d), below.select(by_k2, zero)],
            by_peak: below.select(d.constant(self.k1 - unloading), zero),
        }
    }
}

impl ImpactLaw for WaltonBraun {
    fn start(scales: &ImpactScales, _given: &Given) -> Vec<(&'static str, f64)> {
        let k1 = scales.force / scales.displacement;
        vec![("k1", k1), ("k2", k1 / scales.restitution.powi(2))]
    }

    fn granular(&self) -> Result<GranularLaw, String> {
        Err(MEMORY.to_owned())
    }
}
