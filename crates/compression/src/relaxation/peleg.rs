//! Peleg's two constants of stress relaxation.

use crate::fit::CompressionEstimate;
use crate::relaxation::curve::{Curve, Parameters, Problem, SIZE, options};
use windfall_numerics::least_squares::{Bounds, Stop};
use windfall_numerics::logarithmic::minimise_either;

/// Peleg's constants, fitted to a hold.
#[derive(Clone, Debug, PartialEq)]
pub struct PelegFit {
    /// F₀, the force at the start of the hold; N.
    pub initial_force: CompressionEstimate,
    /// k₁: the force begins to fall by 1/k₁ of F₀ a second; s.
    pub k1: CompressionEstimate,
    /// k₂: 1/k₂ of F₀ relaxes in the end; 1.
    pub k2: CompressionEstimate,
    /// 1 − 1/k₂, the part of F₀ that stays; 1.
    pub residual: CompressionEstimate,
    /// Root mean square residual; N.
    pub rms: f64,
    /// Samples over which the residuals stay correlated.
    pub correlation_length: f64,
    /// Whether the minimum was found.
    pub converged: bool,
}

struct Peleg;

impl Curve for Peleg {
    fn force(&self, time: f64, [initial, k1, k2, ..]: &Parameters) -> (f64, Parameters) {
        let below = k1 + k2 * time;
        let fallen = time / below;
        let mut slopes = [0.0; SIZE];
        slopes[0] = 1.0 - fallen;
        slopes[1] = initial * fallen / below;
        slopes[2] = initial * fallen * fallen;
        (initial * (1.0 - fallen), slopes)
    }
}

/// Fits F₀ t/(F₀ − F) = k₁ + k₂ t to a hold.
///
/// * `times`: since the hold began; s
/// * `force`: at these times; N
///
/// Least squares of the force, F = F₀ (1 − t/(k₁ + k₂ t)), with F₀ as a third constant: in the
/// straight line above, noise near t = 0 is divided by nothing.
///
/// # Source
/// Peleg, M. (1980), Linearization of relaxation and creep curves of solid biological materials,
/// J. Rheol. 24, 451, doi 10.1122/1.549567. Differences: least squares of the force.
pub fn fit_peleg(times: &[f64], force: &[f64]) -> PelegFit {
    let mut problem = Problem {
        curve: &Peleg,
        times,
        force,
    };
    let mut bounds = Bounds::NONE;
    bounds.lower[1] = 1e-9;
    bounds.lower[2] = 1e-9;
    let minimum = minimise_either(&mut problem, &start(times, force), &bounds, &options());
    let found = minimum.parameters;
    let free = [0, 1, 2];
    let spread = problem.spread(&found, &free);
    let of = |value: fn(&Parameters) -> f64| spread.estimate(&found, &free, value);
    PelegFit {
        initial_force: of(|own| own[0]),
        k1: of(|own| own[1]),
        k2: of(|own| own[2]),
        residual: of(|own| 1.0 - 1.0 / own[2]),
        rms: spread.rms,
        correlation_length: spread.correlation_length,
        converged: minimum.stop == Stop::Converged,
    }
}

/// Constants from the fall at the end, and the time at which half of it has happened.
fn start(times: &[f64], force: &[f64]) -> Parameters {
    let part = (force.len() / 50).max(1);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (first, last) = (mean(&force[..part]), mean(&force[force.len() - part..]));
    let half = force.iter().position(|own| *own < 0.5 * (first + last));
    let duration = times[times.len() - 1];
    let half = half.map_or(0.5 * duration, |i| times[i]);
    let fallen = (1.0 - last / first).clamp(1e-6, 1.0);
    // k₁ + k₂ T = T/s and k₁ + k₂ t = 2 t/s.
    let k2 = (duration - 2.0 * half) / (fallen * (duration - half));
    let k2 = k2.max(0.5 / fallen);
    let k1 = (duration / fallen - k2 * duration).max(1e-3 * duration);
    let mut start = [0.0; SIZE];
    (start[0], start[1], start[2]) = (first, k1, k2);
    start
}

/// Force by Peleg's constants, for drawing; N.
pub fn peleg_force(fit: &PelegFit, time: f64) -> f64 {
    fit.initial_force.value * (1.0 - time / (fit.k1.value + fit.k2.value * time))
}
