//! Where a fit of a user's law begins.

use crate::impact_law::ImpactScales;
use crate::law::ContactLaw;
use crate::laws::any_law::AnyLaw;
use crate::laws::kind::LawKind;
use crate::laws::user::UserKind;
use std::f64::consts::PI;

/// Instants at which the work of a user's damping is added up.
const INSTANTS: usize = 64;

/// Starts of a user's law: its own, and otherwise scales of the force that give
/// the impact's peak, and scales of the damping that lose its energy.
pub(crate) fn user_start(
    user: UserKind,
    scales: &ImpactScales,
    given: &[Option<f64>],
) -> Vec<(&'static str, f64)> {
    let kind = LawKind::User(user);
    let parameters = kind.describe().parameters;
    let starts = user.starts();
    let mut values: Vec<f64> = (0..parameters.len())
        .map(|i| given[i].or(starts[i]).unwrap_or(parameters[i].typical))
        .collect();
    // A default is kept: it is held, or where the user wants to begin.
    let open = |i: &&usize| {
        let unknown = given[**i].is_none() && parameters[**i].default.is_none();
        unknown && starts[**i].is_none_or(|start| start == 0.0)
    };
    let slope = |values: &[f64], i: usize, d: f64, v: f64| {
        let law = kind.from_values(values);
        law.map_or(0.0, |law| AnyLaw(law).evaluate(d, v, 0.0).by_parameter[i])
    };
    let scaled = |i: usize, value: f64| match value.is_finite() && value > 0.0 {
        true => value.clamp(parameters[i].lower, parameters[i].upper),
        false => parameters[i].typical,
    };
    let rest: Vec<usize> = user.linear_at_rest().iter().filter(open).copied().collect();
    for &i in &rest {
        let share = 0.9 * scales.force / rest.len() as f64;
        values[i] = scaled(i, share / slope(&values, i, scales.displacement, 0.0));
    }
    let rate: Vec<usize> = user.linear_in_rate().iter().filter(open).copied().collect();
    for &i in &rate {
        // ∮ ∂F/∂p dx over a half-sine of the displacement.
        let step = scales.duration / INSTANTS as f64;
        let work: f64 = (0..INSTANTS)
            .map(|n| {
                let phase = PI * (n as f64 + 0.5) / INSTANTS as f64;
                let d = scales.displacement * phase.sin();
                let v = scales.displacement * PI / scales.duration * phase.cos();
                slope(&values, i, d, v) * v * step
            })
            .sum();
        values[i] = scaled(i, scales.loss() / (rate.len() as f64 * work));
    }
    let names = parameters.iter().map(|parameter| parameter.name);
    names.zip(values).collect()
}
