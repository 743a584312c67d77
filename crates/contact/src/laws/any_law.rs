//! A law chosen at run time, where code is not compiled for each law.

use crate::law::{ContactForce, ContactLaw};
use crate::laws::kind::Law;
use crate::with_law;
use windfall_numerics::real::Real;

pub use crate::laws::any_law_size::LARGEST_PARAMETERS;

/// Any law of the registry as one type; derivatives by parameters that it does
/// not have are zero.
///
/// Each evaluation dispatches on the law. That costs a few nanoseconds, and
/// saves compiling the integrator and the residuals once per law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyLaw(pub Law);

impl ContactLaw<LARGEST_PARAMETERS> for AnyLaw {
    fn history(&self) -> bool {
        with_law!(&self.0, law => law.history())
    }

    fn start_power(&self) -> u32 {
        with_law!(&self.0, law => law.start_power())
    }

    fn kink(&self) -> f64 {
        with_law!(&self.0, law => law.kink())
    }

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, peak: R) -> ContactForce<R, LARGEST_PARAMETERS> {
        evaluate(&self.0, d.plain(), v.plain(), peak.plain()).with_plain(d)
    }
}

#[inline(never)]
fn evaluate<R: Real>(law: &Law, d: R, v: R, peak: R) -> ContactForce<R, LARGEST_PARAMETERS> {
    with_law!(law, law => widened(law.evaluate(d, v, peak)))
}

fn widened<R: Real, const N: usize>(
    force: ContactForce<R, N>,
) -> ContactForce<R, LARGEST_PARAMETERS> {
    let mut by_parameter = [force.force.constant(0.0); LARGEST_PARAMETERS];
    by_parameter[..N].copy_from_slice(&force.by_parameter);
    ContactForce {
        force: force.force,
        by_displacement: force.by_displacement,
        by_rate: force.by_rate,
        by_parameter,
        by_peak: force.by_peak,
    }
}
