//! The generalised Maxwell model of stress relaxation.

use crate::fit::CompressionEstimate;
use crate::relaxation::curve::{Curve, Parameters, Problem, SIZE, options};
use crate::relaxation::ramp::left_after_ramp;
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{Bounds, Minimum, Stop, minimise};
use windfall_signal::noise::colour::{mean_inflation, persistence};

/// Most elements of a model.
pub const MOST_ELEMENTS: usize = 3;

/// Relaxation times at which fits begin, as parts of the hold's duration, of models with
/// one, two and three elements.
const STARTS: [&[&[f64]]; MOST_ELEMENTS] = [
    &[&[0.03], &[0.1], &[0.3], &[1.0]],
    &[&[0.01, 0.1], &[0.05, 0.3], &[0.05, 1.0], &[0.2, 1.0]],
    &[
        &[0.003, 0.05, 0.6],
        &[0.01, 0.1, 1.0],
        &[0.02, 0.1, 0.4],
        &[0.005, 0.02, 0.3],
    ],
];

/// Relaxation times beyond this many durations of the hold look like a straight line.
const LONGEST: f64 = 10.0;

/// Two relaxation times nearer than this factor are one.
const APART: f64 = 1.5;

/// How the elements of a model are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elements {
    /// As many as Akaike's criterion for small samples asks for, three at most.
    Chosen,
    /// This many.
    Given(usize),
}

/// The force of a hold.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldForce {
    /// Since the hold began; s.
    pub times: Vec<f64>,
    /// At these times; N.
    pub force: Vec<f64>,
    /// Duration of the ramp before the hold; `None` where it is not known. s.
    pub ramp: Option<f64>,
    /// The elastic force grows during the ramp as time to this power; 1.
    pub exponent: f64,
}

/// One element: a spring and a damper in series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellElement {
    /// Its relaxation time; s.
    pub time: CompressionEstimate,
    /// Its part of the force after a sudden step: of the modulus. 1.
    pub fraction: CompressionEstimate,
    /// Part of its force that was left when the ramp ended; 1.
    pub left: f64,
}

/// A generalised Maxwell model, fitted to a hold.
#[derive(Clone, Debug, PartialEq)]
pub struct MaxwellFit {
    /// Elements, by rising relaxation time.
    pub elements: Vec<MaxwellElement>,
    /// Part of the force after a sudden step that stays; 1.
    pub equilibrium: CompressionEstimate,
    /// Force after a sudden step to the position held; N.
    pub initial_force: CompressionEstimate,
    /// Force that stays; N.
    pub equilibrium_force: CompressionEstimate,
    /// Root mean square residual; N.
    pub rms: f64,
    /// Samples over which the residuals stay correlated.
    pub correlation_length: f64,
    /// Akaike's criterion for small samples of models with 1, 2 and 3 elements, as far as they
    /// were fitted; by it the number was chosen.
    pub criteria: Vec<f64>,
    /// Whether the minimum was found.
    pub converged: bool,
    /// Whether a relaxation time is at its bound, or an element has no force.
    pub at_bound: bool,
    /// Equilibrium force, forces of the elements at the start of the hold, and logarithms of
    /// their relaxation times.
    parameters: Parameters,
}

impl MaxwellFit {
    /// Force at the start of the hold; N.
    pub fn force_at_start(&self) -> f64 {
        maxwell_force(self, 0.0)
    }
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RelaxationFitError {
    /// The minimiser could not begin.
    #[error(
        "no model with {elements} elements fits this hold: the force does not fall as an exponential does"
    )]
    NoFit {
        /// Elements.
        elements: usize,
    },
}

/// F(t) = Fₑ + Σ Aᵢ e^(−t/τᵢ) with the parameters Fₑ, A₁, A₂, A₃, ln τ₁, ln τ₂, ln τ₃.
struct Maxwell {
    elements: usize,
}

impl Curve for Maxwell {
    fn force(&self, time: f64, parameters: &Parameters) -> (f64, Parameters) {
        let mut slopes = [0.0; SIZE];
        slopes[0] = 1.0;
        let mut force = parameters[0];
        for i in 1..=self.elements {
            let passed = time / parameters[3 + i].exp();
            let left = (-passed).exp();
            slopes[i] = left;
            slopes[3 + i] = parameters[i] * left * passed;
            force += parameters[i] * left;
        }
        (force, slopes)
    }
}

/// Fits a generalised Maxwell model to a hold.
///
/// ```text
/// F(t) = Fₑ + Σ Aᵢ e^(−t/τᵢ),   Aᵢ = Fᵢ r(T/τᵢ),   F₀ = Fₑ + Σ Fᵢ
/// ```
///
/// A ramp of duration T leaves the part r of an element's force ([`left_after_ramp`]); fractions
/// are those of a sudden step, Fₑ/F₀ and Fᵢ/F₀. Where the ramp is not known, r is 1.
///
/// # Numerics
/// Bounded least squares of the force from several starts. The number of elements is that of
/// the least AICc = n' ln(RSS/n) + 2 k + 2 k (k+1)/(n' − k − 1), k = 2 m + 2, where n' is n
/// over the factor by which the correlation of the residuals of the largest model raises the
/// variance of a mean; models with an element of no force, a relaxation time at its bound, or
/// two within a factor of 1.5 are not chosen. Standard deviations: Newey and West, and not below
/// those for residuals that are a first-order autoregression.
///
/// # Source
/// Hurvich, C. M., and Tsai, C.-L. (1989), Regression and time series model selection in small
/// samples, Biometrika 76, 297.
///
/// # Errors
/// [`RelaxationFitError::NoFit`]
pub fn fit_maxwell(held: &HeldForce, elements: Elements) -> Result<MaxwellFit, RelaxationFitError> {
    if let Elements::Given(elements) = elements {
        let own = minimum(held, elements).ok_or(RelaxationFitError::NoFit { elements })?;
        return Ok(report(held, elements, &own, Vec::new()));
    }
    let minima: Vec<(usize, Minimum<SIZE>)> = (1..=MOST_ELEMENTS)
        .filter_map(|elements| Some((elements, minimum(held, elements)?)))
        .collect();
    let Some((richest, last)) = minima.last() else {
        return Err(RelaxationFitError::NoFit { elements: 1 });
    };
    let samples = held.force.len() as f64;
    let effective = samples / inflation(held, *richest, last);
    let criterion = |(elements, own): &(usize, Minimum<SIZE>)| {
        let k = (2 * elements + 2) as f64;
        let room = effective - k - 1.0;
        match room > 0.0 {
            true => {
                let fit = effective * (own.equations.cost / samples).ln();
                fit + 2.0 * k + 2.0 * k * (k + 1.0) / room
            }
            false => f64::INFINITY,
        }
    };
    let criteria: Vec<f64> = minima.iter().map(criterion).collect();
    let sound = |place: &usize| *place == 0 || is_sound(held, &minima[*place]);
    let best = (0..minima.len())
        .filter(sound)
        .min_by(|a, b| criteria[*a].total_cmp(&criteria[*b]));
    let (elements, own) = &minima[best.unwrap_or(0)];
    Ok(report(held, *elements, own, criteria))
}

/// The lowest of the minima from all starts; `None` where none begins.
fn minimum(held: &HeldForce, elements: usize) -> Option<Minimum<SIZE>> {
    let curve = Maxwell { elements };
    let duration = held.times[held.times.len() - 1];
    let interval = duration / (held.times.len() - 1) as f64;
    let mut bounds = Bounds::NONE;
    for i in 0..=elements {
        bounds.lower[i] = 0.0;
    }
    for i in 4..4 + elements {
        bounds.lower[i] = (0.3 * interval).ln();
        bounds.upper[i] = (LONGEST * duration).ln();
    }
    let mut found: Option<Minimum<SIZE>> = None;
    for times in STARTS[elements - 1] {
        let times: Vec<f64> = times.iter().map(|part| part * duration).collect();
        let Some(start) = start(held, &times) else {
            continue;
        };
        let mut problem = Problem {
            curve: &curve,
            times: &held.times,
            force: &held.force,
        };
        let own = minimise(&mut problem, &start, &bounds, &options());
        let better = found.is_none_or(|best| own.equations.cost < best.equations.cost);
        if own.stop != Stop::BadStart && better {
            found = Some(own);
        }
    }
    found
}

/// Forces that suit some relaxation times.
fn start(held: &HeldForce, times: &[f64]) -> Option<Parameters> {
    let mut normal = [[0.0; 4]; 4];
    let mut right = [0.0; 4];
    for (time, force) in held.times.iter().zip(&held.force) {
        let mut row = [1.0, 0.0, 0.0, 0.0];
        for (cell, own) in row[1..].iter_mut().zip(times) {
            *cell = (-time / own).exp();
        }
        for i in 0..4 {
            right[i] += row[i] * force;
            for j in 0..4 {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    for (i, row) in normal.iter_mut().enumerate().skip(times.len() + 1) {
        row[i] = 1.0;
    }
    let found = cholesky::solve(&normal, &right)?;
    let least = 1e-3 * held.force[0].abs();
    let mut start = [0.0; SIZE];
    start[0] = found[0].max(least);
    for (i, time) in times.iter().enumerate() {
        start[1 + i] = found[1 + i].max(least);
        start[4 + i] = time.ln();
    }
    Some(start)
}

/// Factor by which correlated residuals raise the variance of a mean.
fn inflation(held: &HeldForce, elements: usize, own: &Minimum<SIZE>) -> f64 {
    let curve = Maxwell { elements };
    let all = held.times.iter().zip(&held.force);
    let residuals: Vec<f64> = all
        .map(|(time, force)| curve.force(*time, &own.parameters).0 - force)
        .collect();
    mean_inflation(persistence(&residuals).unwrap_or(0.0).max(0.0))
}

/// Parameters that were estimated and are at no bound.
fn free_of(elements: usize, own: &Minimum<SIZE>) -> Vec<usize> {
    let used = (0..=elements).chain(4..4 + elements);
    used.filter(|i| own.at_bound[*i] == 0).collect()
}

/// Whether every element is one: with a force, a relaxation time of its own, none at a bound.
fn is_sound(held: &HeldForce, (elements, own): &(usize, Minimum<SIZE>)) -> bool {
    let inside = (1..=*elements).all(|i| own.at_bound[i] == 0 && own.at_bound[3 + i] == 0);
    let mut logs: Vec<f64> = own.parameters[4..4 + elements].to_vec();
    logs.sort_by(f64::total_cmp);
    let apart = logs.windows(2).all(|pair| pair[1] - pair[0] > APART.ln());
    let curve = Maxwell {
        elements: *elements,
    };
    let problem = Problem {
        curve: &curve,
        times: &held.times,
        force: &held.force,
    };
    let spread = problem.spread(&own.parameters, &free_of(*elements, own));
    inside && apart && spread.covariance.is_some() && own.stop == Stop::Converged
}

fn report(
    held: &HeldForce,
    elements: usize,
    own: &Minimum<SIZE>,
    criteria: Vec<f64>,
) -> MaxwellFit {
    let curve = Maxwell { elements };
    let problem = Problem {
        curve: &curve,
        times: &held.times,
        force: &held.force,
    };
    let found = own.parameters;
    let free = free_of(elements, own);
    let spread = problem.spread(&found, &free);
    let left = |time: f64| {
        held.ramp
            .map_or(1.0, |ramp| left_after_ramp(ramp / time, held.exponent))
    };
    let step = |own: &Parameters, i: usize| own[1 + i] / left(own[4 + i].exp());
    let initial = |own: &Parameters| own[0] + (0..elements).map(|i| step(own, i)).sum::<f64>();
    let mut order: Vec<usize> = (0..elements).collect();
    order.sort_by(|a, b| found[4 + a].total_cmp(&found[4 + b]));
    let element = |i: &usize| {
        let place = *i;
        MaxwellElement {
            time: spread.estimate(&found, &free, |own| own[4 + place].exp()),
            fraction: spread.estimate(&found, &free, |own| step(own, place) / initial(own)),
            left: left(found[4 + place].exp()),
        }
    };
    MaxwellFit {
        elements: order.iter().map(element).collect(),
        equilibrium: spread.estimate(&found, &free, |own| own[0] / initial(own)),
        initial_force: spread.estimate(&found, &free, initial),
        equilibrium_force: spread.estimate(&found, &free, |own| own[0]),
        rms: spread.rms,
        correlation_length: spread.correlation_length,
        criteria,
        converged: own.stop == Stop::Converged,
        at_bound: free.len() < 2 * elements + 1,
        parameters: found,
    }
}

/// Force by a fitted model at a time since the hold began, for drawing; N.
pub fn maxwell_force(fit: &MaxwellFit, time: f64) -> f64 {
    let curve = Maxwell {
        elements: fit.elements.len(),
    };
    curve.force(time, &fit.parameters).0
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
