//! Hertz: elastic spheres.

use crate::law::{ContactForce, ContactLaw};
use windfall_numerics::real::Real;

/// F = k d^1.5.
///
/// * `k`: stiffness, (4/3) E* √R*; N/m^1.5
///
/// At first touch force and slope are zero.
///
/// # Source
/// Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Stiffness; N/m^1.5.
    pub k: f64,
}

impl ContactLaw<1> for Hertz {
    fn with_parameters([k]: [f64; 1]) -> Self {
        Self { k }
    }

    fn parameters(&self) -> [f64; 1] {
        [self.k]
    }

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, _v: R, _peak: R) -> ContactForce<R, 1> {
        let root = d.sqrt();
        ContactForce {
            force: d * root * self.k,
            by_displacement: root * (1.5 * self.k),
            by_rate: R::splat(0.0),
            by_parameter: [d * root],
            by_peak: R::splat(0.0),
        }
    }
}
