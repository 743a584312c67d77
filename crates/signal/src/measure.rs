//! What the signals say without a law: velocities, peaks, impulse, energies.

use crate::impact::Measured;
use crate::kinematics::Motion;
use crate::polynomial::{PolynomialFit, fit_polynomial};

/// Margin of the velocity fits next to onset and end; part of the contact's duration.
pub(crate) const GUARD: f64 = 0.05;

/// Samples wanted for a velocity fit, where the recording has them.
const WANTED_SAMPLES: usize = 5;

/// Fewest samples in which a curvature is looked for.
const CURVATURE_SAMPLES: usize = 10;

/// A curvature is fitted if it exceeds this many of its standard deviations; 1.
const SIGNIFICANT: f64 = 4.0;

/// Free motion with more samples than this is not searched for a glitch.
const GLITCH_SAMPLES: usize = 50;

/// A glitch is a sample without which the scatter falls by this factor; 1. Among five
/// Gaussian samples that happens by chance in less than 1 of 100.
const GLITCH_FACTOR: f64 = 10.0;

/// Half-width of the parabola at the largest displacement; part of the contact's duration.
const TOP_SHARE: f64 = 0.05;

/// Contact window and the time for which its surroundings are free motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// First contact; s.
    pub onset: f64,
    /// End of contact; s.
    pub end: f64,
    /// Begin of the free motion before it; s.
    pub from: f64,
    /// End of the free motion after it; s.
    pub until: f64,
}

impl Surroundings {
    /// `end − onset`; s.
    pub fn duration(&self) -> f64 {
        self.end - self.onset
    }
}

/// A velocity and its standard uncertainty; m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Velocity, positive into the fruit; m/s.
    pub value: f64,
    /// Standard uncertainty, from the larger of the scatter and `noise`; m/s.
    pub sd: f64,
}

/// Side of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Just before it.
    Before,
    /// Just after it.
    After,
}

/// Velocity at the onset or at the end of contact, from free motion.
///
/// A straight line through the samples of one contact duration (at least five
/// samples, where there are as many) next to the contact, less a guard of 5 %
/// of its duration; the known driving acceleration is taken out first. A
/// curvature is added if ten samples show it at four of its standard deviations. For a
/// measured rate: a constant instead of the line, a slope instead of the
/// curvature. `None` with fewer samples than coefficients.
///
/// * `noise`: standard deviation of one sample; the smallest scatter believed
/// * `driving`: acceleration of the free motion, positive into the fruit; m/s²
pub fn free_velocity(
    samples: (&[f64], &[f64], Motion),
    noise: f64,
    place: &Surroundings,
    side: Side,
    driving: f64,
) -> Option<Velocity> {
    let (times, values, motion) = samples;
    let (first, last) = free_samples(times, place, side);
    let origin = match side {
        Side::Before => place.onset,
        Side::After => place.end,
    };
    let times = &times[first..last];
    let free = undriven(times, &values[first..last], motion, origin, driving);
    let index = match motion {
        Motion::Displacement => 1,
        Motion::Rate => 0,
    };
    let simple = fit_polynomial(times, &free, origin, index)?;
    let curved = fit_polynomial(times, &free, origin, index + 1)
        .filter(|fit| times.len() >= CURVATURE_SAMPLES && significant(fit, index + 1, noise));
    let fit = curved.unwrap_or(simple);
    Some(Velocity {
        value: fit.derivatives[index],
        sd: fit.noise_gains[index] * scatter(&fit, noise),
    })
}

/// Index of the sample of the free motion next to the contact that does not fit it.
pub fn glitch(
    samples: (&[f64], &[f64], Motion),
    noise: f64,
    place: &Surroundings,
    side: Side,
    driving: f64,
) -> Option<usize> {
    let (times, values, motion) = samples;
    let (first, last) = free_samples(times, place, side);
    let n = last - first;
    if !(WANTED_SAMPLES..=GLITCH_SAMPLES).contains(&n) {
        return None;
    }
    let times = &times[first..last];
    let origin = times[0];
    let free = undriven(times, &values[first..last], motion, origin, driving);
    let order = match motion {
        Motion::Displacement => 1,
        Motion::Rate => 0,
    };
    let without = |left_out: usize| {
        let kept = |values: &[f64]| [&values[..left_out], &values[left_out + 1..]].concat();
        fit_polynomial(&kept(times), &kept(&free), origin, order)
            .map_or(f64::INFINITY, |fit| scatter(&fit, noise))
    };
    let all = fit_polynomial(times, &free, origin, order)?;
    let (index, least) = (0..n)
        .map(|i| (i, without(i)))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })?;
    (all.residual_deviation > GLITCH_FACTOR * least).then_some(first + index)
}

/// Samples less what the driving acceleration does to them.
fn undriven(times: &[f64], values: &[f64], motion: Motion, origin: f64, driving: f64) -> Vec<f64> {
    let driven = |time: f64| {
        let t = time - origin;
        match motion {
            Motion::Displacement => 0.5 * driving * t * t,
            Motion::Rate => driving * t,
        }
    };
    times
        .iter()
        .zip(values)
        .map(|(&time, value)| value - driven(time))
        .collect()
}

fn scatter(fit: &PolynomialFit, noise: f64) -> f64 {
    if fit.residual_deviation > noise {
        fit.residual_deviation
    } else {
        noise
    }
}

fn significant(fit: &PolynomialFit, index: usize, noise: f64) -> bool {
    fit.derivatives[index].abs() > SIGNIFICANT * fit.noise_gains[index] * scatter(fit, noise)
}

/// Samples of the free motion next to the contact: first, and one past the last.
fn free_samples(times: &[f64], place: &Surroundings, side: Side) -> (usize, usize) {
    let length = place.duration();
    let guard = GUARD * length;
    match side {
        Side::Before => {
            let earliest = times.partition_point(|&t| t < place.from);
            let last = times.partition_point(|&t| t <= place.onset - guard);
            let near = times.partition_point(|&t| t < place.onset - guard - length);
            let first = near.min(last.saturating_sub(WANTED_SAMPLES)).max(earliest);
            (first.min(last), last)
        }
        Side::After => {
            let latest = times.partition_point(|&t| t <= place.until);
            let first = times.partition_point(|&t| t < place.end + guard);
            let near = times.partition_point(|&t| t <= place.end + guard + length);
            let last = near.max(first + WANTED_SAMPLES).min(latest);
            (first, last.max(first))
        }
    }
}

/// Largest displacement: the top of a parabola through the samples within 5 %
/// of the contact's duration of the largest sample (at least one on each side).
pub fn largest_displacement(times: &[f64], values: &[f64], place: &Surroundings) -> Option<f64> {
    let summit = summit(times, values, place)?;
    Some(summit.0)
}

/// Standard uncertainty of [`largest_displacement`]: of the parabola, of the zero between two
/// samples, and of the onset at which the zero is.
///
/// * `noise`: standard deviation of one sample; m
/// * `onset_sd`: displacement in the standard uncertainty of the onset; m
pub fn largest_displacement_sd(
    (times, values): (&[f64], &[f64]),
    noise: f64,
    onset_sd: f64,
    place: &Surroundings,
) -> Option<f64> {
    let (_, gain) = summit(times, values, place)?;
    let after = times.partition_point(|&t| t < place.onset);
    let zero = match after.checked_sub(1).zip(times.get(after)) {
        Some((before, next)) => {
            let part = (place.onset - times[before]) / (next - times[before]);
            part.hypot(1.0 - part)
        }
        None => 1.0,
    };
    Some((noise * gain.hypot(zero)).hypot(onset_sd))
}

/// Top of the parabola through the largest samples, and how it takes up unit noise.
fn summit(times: &[f64], values: &[f64], place: &Surroundings) -> Option<(f64, f64)> {
    let first = times.partition_point(|&t| t < place.onset);
    let last = times.partition_point(|&t| t <= place.end);
    let top = (first..last).reduce(|best, i| if values[i] > values[best] { i } else { best })?;
    let reach = TOP_SHARE * place.duration();
    let from = times
        .partition_point(|&t| t < times[top] - reach)
        .min(top.saturating_sub(1));
    let to = times
        .partition_point(|&t| t <= times[top] + reach)
        .max(top + 2)
        .min(times.len());
    let parabola = fit_polynomial(&times[from..to], &values[from..to], times[top], 2);
    let summit = parabola.as_ref().and_then(|fit| {
        let (value, slope, bend) = (fit.derivatives[0], fit.derivatives[1], fit.derivatives[2]);
        let shift = -slope / bend;
        let inside = bend < 0.0 && shift.abs() <= (times[to - 1] - times[from]);
        inside.then_some(value + 0.5 * slope * shift)
    });
    let gain = parabola.filter(|_| summit.is_some());
    Some((
        summit.unwrap_or(values[top]),
        gain.map_or(1.0, |fit| fit.noise_gains[0]),
    ))
}

/// Impulse of the contact force and its standard uncertainty; N s.
///
/// Trapezoidal rule over the contact and 5 % of its duration (at least one
/// interval) on either side, where the force is below the threshold.
///
/// The uncertainty is made of white noise, of the zero, and of the error of the
/// rule at few samples: a jump of the force puts the sums over even and odd
/// samples ΔF h apart, and leaves the whole sum an error uniform over ΔF h.
///
/// * `noise`: standard deviation of one sample; N
/// * `offset_sd`: standard uncertainty of the zero of the force; N
pub fn impulse(
    times: &[f64],
    force: &[f64],
    noise: f64,
    offset_sd: f64,
    place: &Surroundings,
) -> Option<(f64, f64)> {
    let guard = GUARD * place.duration();
    let from = (place.onset - guard).max(place.from);
    let until = (place.end + guard).min(place.until);
    let first = times.partition_point(|&t| t < from).saturating_sub(1);
    let last = (times.partition_point(|&t| t <= until) + 1).min(times.len());
    if last < first + 2 {
        return None;
    }
    let (times, force) = (&times[first..last], &force[first..last]);
    let mut sum = 0.0;
    let mut squares = 0.0;
    for i in 0..times.len() {
        let before = if i > 0 { times[i] - times[i - 1] } else { 0.0 };
        let after = times.get(i + 1).map_or(0.0, |next| next - times[i]);
        let weight = 0.5 * (before + after);
        sum += weight * force[i];
        squares += weight * weight;
    }
    let duration = times[times.len() - 1] - times[0];
    let white = noise * noise * squares;
    // Even and odd samples differ by their noise, and by what the rule misses.
    let halves = trapezoid(times, force, 0) - trapezoid(times, force, 1);
    let missed = (halves * halves - 4.0 * white).max(0.0) / 12.0;
    let variance = white + missed + (offset_sd * duration).powi(2);
    Some((sum, variance.sqrt()))
}

/// Trapezoidal rule over every second sample.
fn trapezoid(times: &[f64], values: &[f64], first: usize) -> f64 {
    let end = times.len();
    (first..end.saturating_sub(2))
        .step_by(2)
        .map(|i| 0.5 * (times[i + 2] - times[i]) * (values[i] + values[i + 2]))
        .sum()
}

/// Kinetic energies before and after the contact, and what was absorbed:
/// E = m v²/2 with m = I/r² for a pendulum.
///
/// # Source
/// 2003 pendulum study, eqs. (2) and (3).
pub fn with_energies(measured: Measured, effective_mass: f64) -> Measured {
    let energy = |speed: f64| 0.5 * effective_mass * speed * speed;
    let impact = measured.impact_velocity.map(energy);
    let elastic = measured.rebound_velocity.map(energy);
    Measured {
        impact_energy: impact,
        elastic_energy: elastic,
        absorbed_energy: impact.zip(elastic).map(|(before, after)| before - after),
        ..measured
    }
}
