//! Whether the restitutions of a drop agree, and what it means if they do not.

use crate::bounce::train::Bounce;
use crate::restitution::estimate::{DropConditions, Restitution, RestitutionMethod};
use crate::restitution::finding::RestitutionFinding;
use crate::uncertain::Uncertain;
use crate::uncertain::weighted_mean;

/// Differences beyond this many standard uncertainties are reported; 1.
const SIGNIFICANT: f64 = 3.0;
/// … if they are larger than this; 1. Smaller ones change no conclusion.
const MATERIAL: f64 = 0.02;
/// Drop of the restitution from one bounce to the next that is suspicious; 1.
const WEAK: f64 = 0.2;

/// Findings about restitutions of one drop.
///
/// * `bounces`: of the drop
/// * `restitutions`: by any methods
pub fn check_restitutions(
    bounces: &[Bounce],
    conditions: &DropConditions,
    restitutions: &[Restitution],
) -> Vec<RestitutionFinding> {
    let mut found = Vec::new();
    if bounces.len() == 1 {
        found.push(RestitutionFinding::NoSecondImpact);
    }
    let scale = force_scale(bounces, conditions, restitutions);
    let scaled = scale.is_some();
    found.extend(scale);
    for one in restitutions {
        // A wrong scale of the force has been said.
        if scaled && one.method == RestitutionMethod::Impulse {
            continue;
        }
        let Uncertain { value, sd } = one.restitution;
        let beyond = (-value).max(value - 1.0);
        if beyond > SIGNIFICANT * sd && beyond > MATERIAL {
            found.push(RestitutionFinding::OutOfRange {
                bounce: one.bounce + 1,
                method: one.method,
                value,
                sd,
            });
        }
    }
    found.extend(disagreements(restitutions, scaled));
    found.extend(weak_rebounds(restitutions));
    found
}

/// The common factor of the forces that would bring impulses to m v (1 + e) + m g T.
fn force_scale(
    bounces: &[Bounce],
    conditions: &DropConditions,
    restitutions: &[Restitution],
) -> Option<RestitutionFinding> {
    let mass = conditions.mass?;
    let of = |bounce: usize, impulse: bool| {
        restitutions
            .iter()
            .find(|r| r.bounce == bounce && (r.method == RestitutionMethod::Impulse) == impulse)
    };
    let due = |bounce: usize, restitution: f64| {
        let speed = of(bounce, true)?.impact_speed.value;
        let here = &bounces[bounce];
        let duration = here.end.value - here.onset.value;
        let per_mass = speed * (1.0 + restitution) + conditions.gravity.value * duration;
        Some(mass.value * per_mass / here.impulse.value)
    };
    let factors: Vec<Uncertain> = (0..bounces.len())
        .filter_map(|bounce| {
            let (by_impulse, other) = (of(bounce, true)?, of(bounce, false)?);
            let factor = due(bounce, other.restitution.value)?;
            let whole = 1.0 + by_impulse.restitution.value.max(-0.9);
            let own = without_mass(by_impulse, mass);
            Some(Uncertain::new(
                factor,
                factor
                    * (own / whole).hypot(other.restitution.sd / (1.0 + other.restitution.value)),
            ))
        })
        .collect();
    if let Some(mean) = weighted_mean(&factors) {
        // All impacts share the mass.
        let sd = mean.sd.hypot(mean.value * mass.sd / mass.value);
        let off = (mean.value - 1.0).abs();
        return (off > SIGNIFICANT * sd && off > MATERIAL).then_some(
            RestitutionFinding::ForceScale {
                factor: Uncertain::new(mean.value, sd),
                impacts: factors.len(),
            },
        );
    }
    // Without time: only an impulse outside 0 ≤ e ≤ 1 tells.
    let first = of(0, true)?;
    let beyond = (-first.restitution.value).max(first.restitution.value - 1.0);
    let (least, most) = (due(0, 0.0)?, due(0, 1.0)?);
    (beyond > SIGNIFICANT * first.restitution.sd && beyond > MATERIAL).then_some(
        RestitutionFinding::ForceScaleRange {
            bounce: 1,
            least,
            most,
        },
    )
}

/// Standard uncertainty of a restitution by impulse without that of the mass.
fn without_mass(by_impulse: &Restitution, mass: Uncertain) -> f64 {
    let of_mass = (1.0 + by_impulse.restitution.value) * mass.sd / mass.value;
    (by_impulse.restitution.sd.powi(2) - of_mass * of_mass)
        .max(0.0)
        .sqrt()
}

fn disagreements(restitutions: &[Restitution], scaled: bool) -> Vec<RestitutionFinding> {
    let mut found = Vec::new();
    for (i, first) in restitutions.iter().enumerate() {
        for second in &restitutions[i + 1..] {
            let either = first.method == RestitutionMethod::Impulse
                || second.method == RestitutionMethod::Impulse;
            if first.bounce != second.bounce || (scaled && either) {
                continue;
            }
            let apart = (first.restitution.value - second.restitution.value).abs();
            let sd = first.restitution.sd.hypot(second.restitution.sd);
            if apart > SIGNIFICANT * sd && apart > MATERIAL {
                found.push(RestitutionFinding::MethodsDisagree {
                    bounce: first.bounce + 1,
                    first: first.method,
                    first_value: first.restitution.value,
                    second: second.method,
                    second_value: second.restitution.value,
                    deviations: apart / sd,
                });
            }
        }
    }
    found
}

/// Restitutions from time that fall from one impact to the next, softer one.
fn weak_rebounds(restitutions: &[Restitution]) -> Vec<RestitutionFinding> {
    let timed: Vec<&Restitution> = restitutions
        .iter()
        .filter(|r| {
            matches!(
                r.method,
                RestitutionMethod::DropHeight | RestitutionMethod::Flights
            )
        })
        .collect();
    timed
        .windows(2)
        .filter(|pair| pair[1].bounce == pair[0].bounce + 1)
        .filter_map(|pair| {
            let fall = pair[0].restitution.value - pair[1].restitution.value;
            let sd = pair[0].restitution.sd.hypot(pair[1].restitution.sd);
            (fall > SIGNIFICANT * sd && fall > WEAK).then_some(RestitutionFinding::WeakRebound {
                bounce: pair[1].bounce + 1,
                value: pair[1].restitution.value,
                before: pair[0].restitution.value,
            })
        })
        .collect()
}
