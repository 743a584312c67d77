//! Whether force and displacement tell of one motion.

use crate::encoder::edge_rate::{CountTimes, edges};
use crate::linear_fit::{LinearFit, fit_rows, sum};
use crate::measure::Surroundings;
use crate::noise::colour::mean_inflation;
use crate::response::Response;
use crate::track::Track;
use crate::uncertain::Uncertain;
use std::ops::Range;

/// Free motion on either side of the contact that is compared too; contact durations.
const SIDES: f64 = 0.5;

/// Samples of each in contact from which an impact says something by itself, and fewest edges of
/// a count.
const LEAST_SAMPLES: usize = 20;
/// Fewest samples of the force in contact: straight lines between them miss (h/T)² of it.
const LEAST_FORCES: usize = 10;
/// Fewest samples of the displacement in contact. With those of the free motion on either side
/// they are about twice as many as the coefficients.
const LEAST_PLACES: usize = 6;

/// Steps towards the delay; each is exact for small changes.
const STEPS: usize = 20;

/// Coefficients of a comparison: place, velocity, acceleration beside the force, gain, and
/// gain × delay; the first whose uncertainty is told.
const COEFFICIENTS: usize = 5;
const SHAKEN: usize = 3;

/// What Newton's law says of force and displacement together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionCheck {
    /// Recorded force over mass times acceleration; 1.
    pub gain: Uncertain,
    /// Time by which the force comes later than the displacement; s.
    pub delay: Uncertain,
    /// Root mean square of what remains between them; m.
    pub misfit: f64,
    /// What the noise of the displacement, or the timing of its counts, leaves of it; m.
    pub noise: f64,
    /// Whether one of them has so few samples in contact that many such impacts say something
    /// together, and none by itself.
    pub sparse: bool,
}

/// Compares a displacement with the force of the same contact, integrated twice:
///
/// ```text
/// m x(t) = a + b t + q t²/2 − (1/g) ∬ F(t + τ)
/// ```
///
/// Gain g and delay τ are estimated with a, b and q by least squares; q takes up what the
/// zero of the force and the driving acceleration leave. Standard uncertainties come from
/// the scatter, from its correlation between samples, and from the noise of the force, which
/// both integrations carry on to all later samples.
///
/// * `force`, `displacement`: repulsive, and positive into the fruit; N, m
/// * `mass`: what the contact accelerates; kg
/// * `response`: what the instruments make of both; the bending of an arm counts as at rest
///
/// `None` with fewer than ten samples of the force or six of the displacement in contact, or
/// where they do not determine the coefficients.
pub(crate) fn check_motion(
    (force, displacement): (&Track, &Track),
    place: &Surroundings,
    mass: f64,
    response: &Response,
) -> Option<MotionCheck> {
    let side = SIDES * place.duration();
    let (from, until) = (
        (place.onset - side).max(place.from),
        (place.end + side).min(place.until),
    );
    let within = |times: &[f64], from: f64, until: f64| {
        times.partition_point(|&t| t < from)..times.partition_point(|&t| t <= until)
    };
    let inside = |track: &Track| within(&track.times, place.onset, place.end).len();
    let (forces, places) = (inside(force), inside(displacement));
    if forces < LEAST_FORCES || places < LEAST_PLACES {
        return None;
    }
    let sparse = forces.min(places) < LEAST_SAMPLES;
    let part = within(&displacement.times, from, until);
    let (times, places, noise) = exact(displacement, part);
    let (times, places) = (&times[..], &places[..]);
    let lost = Lost::new(force, from, mass, response);

    let scale = until - from;
    let mut delay = 0.0;
    let mut found = None;
    for _ in 0..STEPS {
        // Place, velocity, acceleration beside the force, gain, gain × delay.
        let mut before = 0;
        let row = |t: &f64| {
            let u = (t - place.onset) / scale;
            let (way, velocity) = lost.at(t + delay, &mut before);
            [1.0, u, u * u, -way, -velocity]
        };
        let rows: Vec<[f64; COEFFICIENTS]> = times.iter().map(row).collect();
        let fit = fit_rows(&rows, places)?;
        let (inverse_gain, product) = (fit.coefficients[3], fit.coefficients[4]);
        if inverse_gain <= 0.0 {
            return None;
        }
        let shaken = shaken(&fit, times, &rows, force, mass);
        // The noise of the force enters by way of what the force is found to do.
        let sd = |i: usize| fit.deviations[i].hypot(inverse_gain * shaken[i - SHAKEN]);
        let step = product / inverse_gain;
        delay += step.clamp(-0.5 * place.duration(), 0.5 * place.duration());
        found = Some(MotionCheck {
            gain: Uncertain::new(1.0 / inverse_gain, sd(3) / inverse_gain.powi(2)),
            delay: Uncertain::new(delay, sd(4) / inverse_gain),
            misfit: fit.scatter,
            noise,
            sparse,
        });
        if step.abs() < 0.01 * sd(4) / inverse_gain {
            break;
        }
    }
    found.filter(|found| found.delay.value.abs() < place.duration())
}

/// Times and values of samples with their noise, or of the changes of a count where there are
/// fewer of these: the displacement is known exactly there, at a time known to one sample.
fn exact(track: &Track, part: Range<usize>) -> (Vec<f64>, Vec<f64>, f64) {
    let (times, values) = (&track.times[part.clone()], &track.values[part]);
    let found = edges(times, values, CountTimes::Sampled);
    let count = found.times.len();
    if track.quantum.is_some() && count >= LEAST_SAMPLES && 2 * count < times.len() {
        let way: f64 = found.values.windows(2).map(|x| (x[1] - x[0]).abs()).sum();
        return (
            found.times,
            found.values,
            way / times.len() as f64 / 12f64.sqrt(),
        );
    }
    (times.to_vec(), values.to_vec(), track.noise)
}

/// What the force takes from a mass, from a time on, as the instruments show it.
///
/// Between its samples the force is a smooth curve: a straight line between them would lie
/// beside it by h² F″/12 in the mean, and the gain below by 2.7 (h/T)².
struct Lost<'a> {
    times: &'a [f64],
    /// Force over mass, and its integrals with straight lines between the samples.
    pushes: Vec<f64>,
    velocities: Vec<f64>,
    ways: Vec<f64>,
    /// Of a recorded force F + late F′ + slow F″ is the force; s, s².
    late: f64,
    slow: f64,
}

impl<'a> Lost<'a> {
    fn new(force: &'a Track, from: f64, mass: f64, response: &Response) -> Self {
        let (late, slow) = response.force_terms();
        // Of a displacement behind a bent arm the arm's part is missing.
        let bent = response.arm.map_or(0.0, |arm| arm.compliance) * mass;
        let pushes: Vec<f64> = force.values.iter().map(|value| value / mass).collect();
        let (mut velocity, mut way) = (0.0, 0.0);
        let room = || Vec::with_capacity(pushes.len());
        let (mut velocities, mut ways) = (room(), room());
        velocities.push(0.0);
        ways.push(0.0);
        for (times, push) in force.times.windows(2).zip(pushes.windows(2)) {
            if times[1] >= from {
                let h = times[1] - times[0];
                way += (velocity + (push[0] / 3.0 + push[1] / 6.0) * h) * h;
                velocity += 0.5 * (push[0] + push[1]) * h;
            }
            velocities.push(velocity);
            ways.push(way);
        }
        Self {
            times: &force.times,
            pushes,
            velocities,
            ways,
            late,
            slow: slow + bent,
        }
    }

    /// Displacement and velocity that are lost until `time`; m, m/s.
    ///
    /// * `before`: samples passed until a time that is no later
    fn at(&self, time: f64, before: &mut usize) -> (f64, f64) {
        let last = self.times.len() - 1;
        while *before + 1 < last && self.times[*before + 1] < time {
            *before += 1;
        }
        let i = *before;
        let h = self.times[i + 1] - self.times[i];
        let u = (time - self.times[i]).clamp(0.0, h);
        let slope = (self.pushes[i + 1] - self.pushes[i]) / h;
        let push = self.pushes[i] + slope * u;
        let velocity = self.velocities[i] + (self.pushes[i] + 0.5 * slope * u) * u;
        let turned = (0.5 * self.pushes[i] + slope * u / 6.0) * u;
        let way = self.ways[i] + (self.velocities[i] + turned) * u - push * h * h / 12.0;
        (
            way + self.late * velocity + self.slow * push,
            velocity + self.late * push,
        )
    }
}

/// What the noise of the force leaves in the coefficients from [`SHAKEN`] on, after both
/// integrations.
///
/// A sample that is off by σ moves every later place by σ h (t − tⱼ)/m.
fn shaken(
    fit: &LinearFit<COEFFICIENTS>,
    times: &[f64],
    rows: &[[f64; COEFFICIENTS]],
    force: &Track,
    mass: f64,
) -> [f64; COEFFICIENTS - SHAKEN] {
    let inflation = mean_inflation(force.persistence.unwrap_or(0.0)).max(1.0);
    let (first, last) = (times[0], times[times.len() - 1]);
    let begin = force.times.partition_point(|&t| t < first);
    let until = force.times.partition_point(|&t| t < last);
    // Σ wᵢ and Σ wᵢ tᵢ over the samples after tⱼ, of the weights of each coefficient.
    const P: usize = COEFFICIENTS - SHAKEN;
    let (mut weights, mut moments, mut squares) = ([0.0; P], [0.0; P], [0.0; P]);
    let mut next = times.len();
    for j in (begin + 1..until).rev() {
        let time = force.times[j];
        while next > 0 && times[next - 1] > time {
            next -= 1;
            for i in 0..P {
                let weight = sum(&fit.inverse[SHAKEN + i], &rows[next]);
                weights[i] += weight;
                moments[i] += weight * (times[next] - first);
            }
        }
        let push = force.noise / mass * (time - force.times[j - 1]);
        for i in 0..P {
            squares[i] += (push * (moments[i] - weights[i] * (time - first))).powi(2);
        }
    }
    squares.map(|square| (square * inflation).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Force and displacement under a half sine of 25 samples, the first so many intervals late.
    fn half_sine(phase: f64) -> [Track; 2] {
        let (duration, mass, peak, velocity) = (4e-3, 0.056, 20.0, 0.4);
        let interval = duration / 25.0;
        let times: Vec<f64> = (-15..40)
            .map(|i| (f64::from(i) + phase) * interval)
            .collect();
        let swing = duration / PI;
        let force = |t: f64| match t > 0.0 && t < duration {
            true => peak * (t / swing).sin(),
            false => 0.0,
        };
        let place = |t: f64| {
            let inside = t.clamp(0.0, duration);
            let push = swing * inside - swing * swing * (inside / swing).sin();
            let lost = 2.0 * swing * (t - duration).max(0.0);
            velocity * t - peak / mass * (push + lost)
        };
        let track = |of: &dyn Fn(f64) -> f64| Track {
            name: String::new(),
            values: times.iter().map(|&t| of(t)).collect(),
            times: times.clone(),
            quantum: None,
            noise: 1e-9,
            persistence: None,
        };
        [track(&force), track(&place)]
    }

    #[test]
    fn closed_form_gain_of_coarse_samples() {
        let place = Surroundings {
            onset: 0.0,
            end: 4e-3,
            from: -2e-3,
            until: 6e-3,
        };
        let mut off = 0.0;
        for phase in 0..10 {
            let [force, displacement] = half_sine(f64::from(phase) / 10.0);
            let none = Response::default();
            let found = check_motion((&force, &displacement), &place, 0.056, &none).unwrap();
            off += (found.gain.value - 1.0) / 10.0;
            assert!(found.delay.value.abs() < 2e-3 * place.duration());
        }
        // With straight lines between the samples 2.7/25² = 4e-3.
        assert!(off.abs() < 4e-4, "{off}");
    }
}
