//! Restitution of bounces by drop height, flights, impulse and velocities.

use crate::bounce::train::Bounce;
use crate::uncertain::Uncertain;

/// How a restitution was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestitutionMethod {
    /// Speed after the first impact over that of a fall from the drop height.
    DropHeight,
    /// A flight over the flight before.
    Flights,
    /// √ of an apex height over the one before.
    Heights,
    /// Impulse over the momentum of the approach, less 1.
    Impulse,
    /// Measured velocity after over the one before.
    Velocities,
}

impl RestitutionMethod {
    /// Stable short name, for tables and JSON.
    pub fn code(self) -> &'static str {
        match self {
            Self::DropHeight => "drop_height",
            Self::Flights => "flights",
            Self::Heights => "heights",
            Self::Impulse => "impulse",
            Self::Velocities => "velocities",
        }
    }
}

impl std::fmt::Display for RestitutionMethod {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::DropHeight => "flight and drop height",
            Self::Flights => "successive flights",
            Self::Heights => "apex heights",
            Self::Impulse => "impulse",
            Self::Velocities => "velocities",
        })
    }
}

/// Restitution of one impact by one method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restitution {
    /// Number of the bounce, from 0.
    pub bounce: usize,
    /// How it was found.
    pub method: RestitutionMethod,
    /// Speed of approach; m/s.
    pub impact_speed: Uncertain,
    /// e; 1.
    pub restitution: Uncertain,
}

/// What is known about a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropConditions {
    /// Drop height, of the lowest point of the fruit above the plate; m.
    pub height: Option<Uncertain>,
    /// Mass of the fruit; kg.
    pub mass: Option<Uncertain>,
    /// Acceleration in free flight towards the plate; m/s².
    pub gravity: Uncertain,
}

impl Default for DropConditions {
    /// Standard gravity, nothing else.
    fn default() -> Self {
        Self {
            height: None,
            mass: None,
            gravity: Uncertain::new(9.80665, 0.0),
        }
    }
}

/// Time in the air, from the end of a bounce to the onset of the next; s. `None` after the
/// last, or if either contact was not recorded in full.
pub fn flight(bounces: &[Bounce], bounce: usize) -> Option<Uncertain> {
    let (here, next) = (bounces.get(bounce)?, bounces.get(bounce + 1)?);
    let end_seen = here.complete || bounce == 0;
    let value = next.onset.value - here.end.value;
    (end_seen && value > 0.0).then(|| {
        Uncertain::new(
            value,
            here.end.sd.hypot(next.onset.sd).hypot(next.onset_shape),
        )
    })
}

/// Speed at both ends of a flight that begins and ends at one height, g t/2.
pub fn flight_speed(flight: Uncertain, gravity: Uncertain) -> Uncertain {
    let value = 0.5 * gravity.value * flight.value;
    Uncertain::new(
        value,
        value * (flight.sd / flight.value).hypot(gravity.sd / gravity.value),
    )
}

/// Speed of approach, of the first bounce from the drop height, later from the flight before.
pub fn impact_speed(
    bounces: &[Bounce],
    bounce: usize,
    conditions: &DropConditions,
) -> Option<Uncertain> {
    let gravity = conditions.gravity;
    match bounce.checked_sub(1) {
        Some(before) => flight(bounces, before).map(|t| flight_speed(t, gravity)),
        None => conditions.height.map(|height| {
            let value = (2.0 * gravity.value * height.value).sqrt();
            let relative = (gravity.sd / gravity.value).hypot(height.sd / height.value);
            Uncertain::new(value, 0.5 * value * relative)
        }),
    }
}

/// Restitution from time: of the first impact with the drop height, of later
/// ones by the flights after and before,
///
/// ```text
/// e₁ = v₁/v₀,  v₀ = √(2 g h),  v₁ = g t₁/2;   eₙ = tₙ/tₙ₋₁
/// ```
///
/// These are of the vertical velocity. A rebound that is slanted or takes up
/// spin makes them smaller than the restitution of the contact.
pub fn restitution_from_time(bounces: &[Bounce], conditions: &DropConditions) -> Vec<Restitution> {
    (0..bounces.len())
        .filter_map(|bounce| {
            let after = flight(bounces, bounce)?;
            let speed = impact_speed(bounces, bounce, conditions)?;
            let gravity = conditions.gravity.sd / conditions.gravity.value;
            let (method, value, relative) = match (bounce.checked_sub(1), conditions.height) {
                (Some(before), _) => {
                    let before = flight(bounces, before)?;
                    let relative = (after.sd / after.value).hypot(before.sd / before.value);
                    (
                        RestitutionMethod::Flights,
                        after.value / before.value,
                        relative,
                    )
                }
                // √g stays: t₁ √(g/(8 h)).
                (None, height) => {
                    let height = height?;
                    let relative = (after.sd / after.value)
                        .hypot(0.5 * gravity)
                        .hypot(0.5 * height.sd / height.value);
                    let rebound = flight_speed(after, conditions.gravity).value;
                    (
                        RestitutionMethod::DropHeight,
                        rebound / speed.value,
                        relative,
                    )
                }
            };
            Some(Restitution {
                bounce,
                method,
                impact_speed: speed,
                restitution: Uncertain::new(value, value * relative),
            })
        })
        .collect()
}

/// Restitution from impulse, with the weight's impulse during the contact:
///
/// ```text
/// J = m v (1 + e) + m g T   ⟹   e = (J/m − g T)/v − 1
/// ```
///
/// Needs the mass, and the scale of the force: unlike times, an impulse is
/// wrong by as much as the volts per newton are.
pub fn restitution_from_impulse(
    bounces: &[Bounce],
    conditions: &DropConditions,
) -> Vec<Restitution> {
    let Some(mass) = conditions.mass else {
        return Vec::new();
    };
    (0..bounces.len())
        .filter_map(|bounce| {
            let speed = impact_speed(bounces, bounce, conditions)?;
            let here = bounces.get(bounce).filter(|b| b.complete && !b.clipped)?;
            let duration = here.end.value - here.onset.value;
            let per_mass = here.impulse.value / mass.value;
            let gravity = conditions.gravity;
            let change = per_mass - gravity.value * duration;
            let relative = (here.impulse.sd / here.impulse.value).hypot(mass.sd / mass.value);
            let spread = (per_mass * relative)
                .hypot(gravity.sd * duration)
                .hypot(gravity.value * here.end.sd.hypot(here.onset_shape));
            let ratio = change / speed.value;
            Some(Restitution {
                bounce,
                method: RestitutionMethod::Impulse,
                impact_speed: speed,
                restitution: Uncertain::new(
                    ratio - 1.0,
                    (spread / speed.value).hypot(ratio * speed.sd / speed.value),
                ),
            })
        })
        .collect()
}

/// Restitution from apex heights, of the drop and after each impact: e = √(h_(n+1)/h_n).
///
/// * `heights`: above where contact begins, the drop height first; m
/// * `gravity`: for the speeds; m/s²
pub fn restitution_from_heights(heights: &[Uncertain], gravity: Uncertain) -> Vec<Restitution> {
    heights
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0].value > 0.0 && pair[1].value >= 0.0)
        .map(|(bounce, pair)| {
            let speed = (2.0 * gravity.value * pair[0].value).sqrt();
            let of_drop = pair[0].sd / pair[0].value;
            let value = (pair[1].value / pair[0].value).sqrt();
            // u(√h) = u(h)/(2√h), also where the rebound is low.
            let of_rebound = pair[1].sd / pair[1].value.max(pair[1].sd);
            Restitution {
                bounce,
                method: RestitutionMethod::Heights,
                impact_speed: Uncertain::new(
                    speed,
                    0.5 * speed * of_drop.hypot(gravity.sd / gravity.value),
                ),
                restitution: Uncertain::new(value, 0.5 * value * of_drop.hypot(of_rebound)),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(value: f64) -> Uncertain {
        Uncertain::new(value, 0.0)
    }

    #[test]
    fn closed_form_heights() {
        let gravity = exact(10.0);
        let found = restitution_from_heights(&[exact(0.8), exact(0.2), exact(0.05)], gravity);
        assert_eq!(found.len(), 2);
        assert!((found[0].restitution.value - 0.5).abs() < 1e-15);
        assert!((found[0].impact_speed.value - 4.0).abs() < 1e-15);
        assert!((found[1].impact_speed.value - 2.0).abs() < 1e-15);
        // 1 % and 2 % of heights: half of √5 % of e.
        let one = |value: f64, part: f64| Uncertain::new(value, part * value);
        let found = restitution_from_heights(&[one(0.8, 0.01), one(0.2, 0.02)], gravity);
        let relative = found[0].restitution.sd / found[0].restitution.value;
        assert!((relative - 0.005 * 5f64.sqrt()).abs() < 1e-15);
    }
}
