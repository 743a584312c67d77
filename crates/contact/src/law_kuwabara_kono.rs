//! Kuwabara-Kono: viscoelastic spheres.

use crate::law::{ContactForce, ContactLaw};
use windfall_numerics::real::Real;

/// F = k d^1.5 + c d^0.5 v.
///
/// * `k`: stiffness, that of Hertz; N/m^1.5
/// * `c`: damping; N s/m^1.5 (= kg m^-0.5 s^-1)
///
/// At first touch the force is zero and its slope in d infinite.
///
/// # Source
/// Kuwabara and Kono (1987); Brilliantov et al. (1996); eq. (5) of the 2003
/// pendulum study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KuwabaraKono {
    /// Stiffness; N/m^1.5.
    pub k: f64,
    /// Damping; N s/m^1.5.
    pub c: f64,
}

impl ContactLaw<2> for KuwabaraKono {
    fn with_parameters([k, c]: [f64; 2]) -> Self {
        Self { k, c }
    }

    fn parameters(&self) -> [f64; 2] {
        [self.k, self.c]
    }

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, _peak: R) -> ContactForce<R, 2> {
        let root = d.sqrt();
        ContactForce {
            force: root * (d * self.k + v * self.c),
            by_displacement: root * (1.5 * self.k) + (v / root) * (0.5 * self.c),
            by_rate: root * self.c,
            by_parameter: [d * root, root * v],
            by_peak: R::splat(0.0),
        }
    }
}
