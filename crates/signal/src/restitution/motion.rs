//! Restitution from the impactor's velocities just before and after each contact.

use crate::bounce::train::Bounce;
use crate::polynomial::fit_polynomial;
use crate::restitution::estimate::{Restitution, RestitutionMethod};
use crate::uncertain::Uncertain;

/// How velocities are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionOptions {
    /// Longest stretch of free flight that is fitted; s.
    pub longest: f64,
    /// Longest part of a flight that is fitted on either side; 1 (½ with friction).
    pub part: f64,
    /// Left out at both ends of a contact; s.
    pub clearance: f64,
    /// Least standard deviation of a position; m.
    pub least_noise: f64,
}

impl Default for MotionOptions {
    fn default() -> Self {
        Self {
            longest: 0.5,
            part: 0.5,
            clearance: 0.0,
            least_noise: 0.0,
        }
    }
}

/// Motion before and after one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactMotion {
    /// Number of the bounce, from 0.
    pub bounce: usize,
    /// Velocity at the onset, in the sign of the position; m/s.
    pub before: Uncertain,
    /// Velocity at the end; m/s.
    pub after: Uncertain,
    /// Acceleration of the approach, where positions tell; m/s².
    pub acceleration_before: Option<Uncertain>,
    /// … and of the rebound; m/s².
    pub acceleration_after: Option<Uncertain>,
}

/// Fewest positions of a parabola.
const LEAST_PARABOLA: usize = 6;
/// Fewest positions of a line.
const LEAST_LINE: usize = 3;

/// Velocities around each contact, by a parabola through the positions of the
/// flight before, and one through those of the flight after.
///
/// * `contacts`: onset and end of each; s
///
/// Contacts without enough positions on either side are left out.
pub fn contact_motions(
    times: &[f64],
    positions: &[f64],
    contacts: &[(f64, f64)],
    options: &MotionOptions,
) -> Vec<ContactMotion> {
    (0..contacts.len())
        .filter_map(|bounce| {
            let (onset, end) = contacts[bounce];
            let length = |from: f64, to: f64| options.longest.min(options.part * (to - from));
            let before = bounce
                .checked_sub(1)
                .map_or(f64::NEG_INFINITY, |b| contacts[b].1);
            let next = contacts.get(bounce + 1).map_or(f64::INFINITY, |c| c.0);
            let clear = options.clearance;
            let approach = (
                (onset - length(before, onset)).max(before + clear),
                onset - clear,
            );
            let rebound = (end + clear, (end + length(end, next)).min(next - clear));
            let (before, acceleration_before) =
                velocity(times, positions, approach, onset, options)?;
            let (after, acceleration_after) = velocity(times, positions, rebound, end, options)?;
            Some(ContactMotion {
                bounce,
                before,
                after,
                acceleration_before,
                acceleration_after,
            })
        })
        .collect()
}

/// Velocity at a time, and acceleration, from the positions in a range.
fn velocity(
    times: &[f64],
    positions: &[f64],
    range: (f64, f64),
    at: f64,
    options: &MotionOptions,
) -> Option<(Uncertain, Option<Uncertain>)> {
    let first = times.partition_point(|t| *t < range.0);
    let last = times.partition_point(|t| *t <= range.1).max(first);
    let count = last - first;
    let order = match count {
        LEAST_PARABOLA.. => 2,
        LEAST_LINE.. => 1,
        _ => return None,
    };
    let fit = fit_polynomial(&times[first..last], &positions[first..last], at, order)?;
    let noise = fit.residual_deviation.max(options.least_noise);
    let of = |derivative: usize| {
        Uncertain::new(
            fit.derivatives[derivative],
            noise * fit.noise_gains[derivative],
        )
    };
    Some((of(1), (order == 2).then(|| of(2))))
}

/// Restitution from impulse and the measured speed of approach, under an
/// acceleration a that drives the impactor into the contact:
///
/// ```text
/// J = m v (1 + e) + m a T   ⟹   e = (J/m − a T)/v − 1
/// ```
///
/// * `mass`: kg; `driving`: a; m/s²
pub fn restitution_from_impulse_and_motion(
    bounces: &[Bounce],
    motions: &[ContactMotion],
    mass: Uncertain,
    driving: Uncertain,
) -> Vec<Restitution> {
    motions
        .iter()
        .filter_map(|motion| {
            let here = bounces
                .get(motion.bounce)
                .filter(|b| b.complete && !b.clipped)?;
            let speed = motion.before.value.abs();
            let duration = here.end.value - here.onset.value;
            let per_mass = here.impulse.value / mass.value;
            let ratio = (per_mass - driving.value * duration) / speed;
            let relative = (here.impulse.sd / here.impulse.value).hypot(mass.sd / mass.value);
            let of_change = (per_mass * relative).hypot(driving.sd * duration) / speed;
            Some(Restitution {
                bounce: motion.bounce,
                method: RestitutionMethod::Impulse,
                impact_speed: Uncertain::new(speed, motion.before.sd),
                restitution: Uncertain::new(
                    ratio - 1.0,
                    of_change.hypot(ratio * motion.before.sd / speed),
                ),
            })
        })
        .collect()
}

/// Restitution by velocities, e = −v_after/v_before.
pub fn restitution_from_motion(motions: &[ContactMotion]) -> Vec<Restitution> {
    motions
        .iter()
        .filter(|motion| motion.before.value != 0.0)
        .map(|motion| {
            let value = -motion.after.value / motion.before.value;
            let of_after = motion.after.sd / motion.before.value;
            let of_before = value * motion.before.sd / motion.before.value;
            Restitution {
                bounce: motion.bounce,
                method: RestitutionMethod::Velocities,
                impact_speed: Uncertain::new(motion.before.value.abs(), motion.before.sd),
                restitution: Uncertain::new(value, of_after.hypot(of_before)),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_parabolic_flights() {
        // Falls from 0.2 m at 0.5 m/s², bounces at 0 with e = 0.6, no contact time.
        let g: f64 = 0.5;
        let fall = (2.0 * 0.2 / g).sqrt();
        let speed = g * fall;
        let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.02).collect();
        let positions: Vec<f64> = times
            .iter()
            .map(|t| match t - fall {
                s if s <= 0.0 => 0.2 - 0.5 * g * t * t,
                s => 0.6 * speed * s - 0.5 * g * s * s,
            })
            .collect();
        let options = MotionOptions::default();
        let motions = contact_motions(&times, &positions, &[(fall, fall)], &options);
        assert!((motions[0].before.value + speed).abs() < 1e-9);
        assert!((motions[0].acceleration_after.unwrap().value + g).abs() < 1e-7);
        let found = restitution_from_motion(&motions);
        assert!((found[0].restitution.value - 0.6).abs() < 1e-9);
        assert!((found[0].impact_speed.value - speed).abs() < 1e-9);
    }
}
