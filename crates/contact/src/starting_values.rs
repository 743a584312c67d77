//! Where a fit of an impact begins.

use crate::for_each_law;
use crate::impact_law::{ImpactLaw, ImpactScales};
use crate::laws::kind::{self, LawKind};
use crate::laws::user_start::user_start;
use crate::parameter::{IMPACT_VELOCITY, MASS};

/// Starting parameters of a law, in the order of its description; SI.
///
/// * `given`: values that are known already, such as exponents
///
/// # Source
/// Peaks and durations of Hertz impacts (Johnson 1985, sec. 11.4); the damping
/// from the energy lost over one loading and unloading.
pub fn starting_values(kind: LawKind, scales: &ImpactScales, given: &[Option<f64>]) -> Vec<f64> {
    let start = start(kind, scales, given);
    let parameters = kind.describe().parameters.iter().zip(given);
    parameters
        .map(|(parameter, given)| {
            let named = start.iter().find(|(name, _)| *name == parameter.name);
            let event = match parameter.name {
                IMPACT_VELOCITY => Some(scales.velocity),
                MASS => Some(scales.mass),
                _ => None,
            };
            given
                .or(event)
                .or(named.map(|(_, value)| *value))
                .or(parameter.default)
                .unwrap_or(parameter.typical)
                .clamp(parameter.lower, parameter.upper)
        })
        .collect()
}

/// Values of some parameters.
fn start(kind: LawKind, scales: &ImpactScales, values: &[Option<f64>]) -> Vec<(&'static str, f64)> {
    let parameters = kind.describe().parameters;
    let given = |name: &str| {
        let index = parameters.iter().position(|p| p.name == name)?;
        values[index].or(parameters[index].default)
    };
    macro_rules! of_law {
        (() $($variant:ident in $module:ident,)*) => {
            match kind {
                $(LawKind::$variant => kind::$variant::start(scales, &given),)*
                LawKind::User(kind) => user_start(kind, scales, values),
            }
        };
    }
    for_each_law! { (of_law) () }
}
