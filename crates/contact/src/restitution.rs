//! Coefficient of restitution: what a law promises, and what it delivers where
//! that is known in closed form.

use crate::impact_law::ImpactLaw;
use crate::laws::kind::Law;
use crate::with_law;

pub use crate::closed_collision::{
    damped_power_restitution, damping_for_restitution, kuwabara_kono_group, kuwabara_kono_pade,
    kuwabara_kono_series,
};
pub use crate::laws::kelvin_voigt::{LinearImpact, kelvin_voigt_impact};
pub use crate::laws::thornton::thornton_yield_velocity;

/// The restitution that a law takes as a parameter; 1. `None` for laws without.
///
/// What it delivers differs: see [`closed_form_restitution`].
#[must_use]
pub fn nominal_restitution(law: &Law) -> Option<f64> {
    with_law!(law, law => law.nominal_restitution())
}

/// Restitution of a collision without gravity that ends at zero force; 1.
///
/// * `mass`: effective mass; kg
/// * `velocity`: at first touch, above zero; m/s
///
/// Returns `None` where there is no closed form: Kuwabara-Kono (see
/// [`kuwabara_kono_pade`]), the general power law, Tsuji and ADAMS IMPACT.
#[must_use]
pub fn closed_form_restitution(law: &Law, mass: f64, velocity: f64) -> Option<f64> {
    with_law!(law, law => law.closed_form_restitution(mass, velocity))
}
