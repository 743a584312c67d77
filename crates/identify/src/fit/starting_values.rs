//! Where a fit begins: rough features of the impact.

use std::f64::consts::PI;
use windfall_contact::impact_law::ImpactScales;
use windfall_signal::impact::Impact;

/// Restitution assumed when the signals do not show it.
const USUAL_RESTITUTION: f64 = 0.5;
/// Restitutions outside this range are not believed for a start.
const RESTITUTIONS: (f64, f64) = (0.05, 0.95);
/// Contact duration times velocity over largest displacement of an elastic
/// sphere (Hertz; DOMAIN: (4/5) √π Γ(2/5)/Γ(9/10)).
const HERTZ_DURATION: f64 = 2.943_275_184;

/// Features of a measured impact, the missing ones by the mechanics of a
/// half-sine impact.
pub(crate) fn impact_scales(impact: &Impact, mass: f64) -> ImpactScales {
    let measured = &impact.measured;
    let positive = |value: Option<f64>| value.filter(|v| v.is_finite() && *v > 0.0);
    let duration = positive(measured.contact_duration).unwrap_or(impact.end - impact.onset);
    let (low, high) = RESTITUTIONS;
    let restitution = positive(measured.restitution)
        .unwrap_or(USUAL_RESTITUTION)
        .clamp(low, high);
    let impulse = positive(measured.impulse)
        .or(positive(measured.peak_force).map(|f| 2.0 / PI * f * duration));
    let velocity = positive(measured.impact_velocity)
        .or(impulse.map(|j| j / (mass * (1.0 + restitution))))
        .or(positive(measured.max_displacement).map(|d| HERTZ_DURATION * d / duration))
        .unwrap_or(1.0);
    ImpactScales {
        mass,
        velocity,
        displacement: positive(measured.max_displacement)
            .unwrap_or(velocity * duration / HERTZ_DURATION),
        force: positive(measured.peak_force)
            .unwrap_or(PI * mass * velocity * (1.0 + restitution) / (2.0 * duration)),
        duration,
        restitution,
    }
}
