//! The linear regression of eq. (9): force against the law's terms at the
//! measured displacement and rate. No motion is simulated.

use windfall_contact::law::ContactLaw;
use windfall_contact::laws::any_law::AnyLaw;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::UserKind;
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::NormalEquations;
use windfall_signal::impact::{Impact, Series};
use windfall_signal::kinematics::{Walk, smoothing_window};

/// Parameters at most that a law is linear in.
const TERMS: usize = 2;

/// A parameter estimated by regression.
#[derive(Clone, Debug, PartialEq)]
pub struct RegressionEstimate {
    /// Position in the law's description.
    pub position: usize,
    /// Estimate; SI.
    pub value: f64,
    /// Standard error of ordinary least squares, which takes displacement and
    /// rate as exact and residuals as independent; SI.
    pub standard_error: f64,
}

/// Parameters that the force is linear in, by position.
fn linear_positions(law: &Law) -> Vec<usize> {
    if let LawKind::User(user) = law.kind() {
        return terms_of_user(law, user);
    }
    let description = law.kind().describe();
    let linear = description.linear.iter();
    linear
        .filter_map(|name| description.index_of(name))
        .collect()
}

/// State at which the terms of a user's law are added up.
const STATE: (f64, f64) = (1e-3, 0.3);

/// Parameters of a user's law whose terms are the whole force; otherwise none.
fn terms_of_user(law: &Law, user: UserKind) -> Vec<usize> {
    let positions = [user.linear_at_rest(), user.linear_in_rate()].concat();
    let at = AnyLaw(*law).evaluate(STATE.0, STATE.1, 0.0);
    let values = law.parameters();
    let sum: f64 = positions
        .iter()
        .map(|&i| values[i] * at.by_parameter[i])
        .sum();
    let whole = (sum - at.force).abs() <= 1e-9 * at.force.abs();
    match whole && positions.len() <= TERMS {
        true => positions,
        false => Vec::new(),
    }
}

/// Force regressed on the terms of `law` over the contact:
///
/// ```text
/// F = k X₁ + c X₂,   X₁ = x^1.5,   X₂ = x^0.5 x'    (Kuwabara-Kono)
/// ```
///
/// The rate is the slope of the displacement over a tenth of the
/// contact: a central difference of counted displacement would bias c towards
/// zero. Displacement counts from the threshold's onset.
///
/// `None` for a law that is linear in none of its parameters, or when force
/// and motion were not both recorded.
///
/// # Source
/// Eq. (9) of the 2003 pendulum study.
pub fn regress(impact: &Impact, law: &Law) -> Option<Vec<RegressionEstimate>> {
    let positions = linear_positions(law);
    if positions.is_empty() {
        return None;
    }
    let force = impact.force.as_ref()?;
    let displacement = impact.displacement.as_ref()?;
    let half = smoothing_half(impact, displacement)?;

    let mut slopes = LocalSlopes::of(displacement, half);
    let mut places = Walk::along(&displacement.times, &displacement.values);
    // Keep to the contact: outside, the terms are zero and the force is noise.
    let mut equations = NormalEquations::<TERMS>::ZERO;
    let mut samples = 0;
    for (&time, &measured) in force.times.iter().zip(&force.values) {
        if time < impact.onset || time > impact.end {
            continue;
        }
        let x = places.at(time);
        if x <= 0.0 {
            continue;
        }
        let v = slopes.at(time);
        let terms = AnyLaw(*law).evaluate(x, v, 0.0).by_parameter;
        let mut row = [0.0; TERMS];
        for (cell, &position) in row.iter_mut().zip(&positions) {
            *cell = terms[position];
        }
        // The residual at zero parameters is −F: its gradient step is the fit.
        equations.add(1.0, -measured, &row);
        samples += 1;
    }
    solve(&equations, &positions, samples)
}

/// Samples on either side of the local slope.
fn smoothing_half(impact: &Impact, displacement: &Series) -> Option<usize> {
    let times = &displacement.times;
    let interval = (times.last()? - times.first()?) / (times.len().max(2) - 1) as f64;
    let half = smoothing_window(impact.end - impact.onset, interval) / 2;
    (times.len() > 2 * half).then_some(half)
}

/// Slopes of the straight lines through the samples around times that rise; on even times also
/// those of the local quadratic (Savitzky-Golay).
struct LocalSlopes<'a> {
    times: &'a [f64],
    half: usize,
    /// Sums of t, x, t² and t x of the first 0, 1, … samples, about the middle one.
    sums: Vec<[f64; 4]>,
    /// Samples before the last time.
    centre: usize,
}

impl<'a> LocalSlopes<'a> {
    /// Over `half` samples on either side.
    fn of(series: &'a Series, half: usize) -> Self {
        let times = &series.times[..];
        let middle = times.len() / 2;
        let origin = (times[middle], series.values[middle]);
        let mut sums = Vec::with_capacity(times.len() + 1);
        let mut sum = [0.0; 4];
        sums.push(sum);
        for (t, x) in times.iter().zip(&series.values) {
            let (t, x) = (t - origin.0, x - origin.1);
            for (sum, term) in sum.iter_mut().zip([t, x, t * t, t * x]) {
                *sum += term;
            }
            sums.push(sum);
        }
        Self {
            times,
            half,
            sums,
            centre: 0,
        }
    }

    /// At `time`, which is no earlier than the one asked for before.
    fn at(&mut self, time: f64) -> f64 {
        let width = 2 * self.half + 1;
        while self.times.get(self.centre).is_some_and(|&t| t < time) {
            self.centre += 1;
        }
        let first = self.centre.saturating_sub(self.half);
        let first = first.min(self.times.len() - width);
        let (before, after) = (&self.sums[first], &self.sums[first + width]);
        let [t1, x1, t2, tx] = std::array::from_fn(|i| after[i] - before[i]);
        let count = width as f64;
        (tx - t1 * x1 / count) / (t2 - t1 * t1 / count)
    }
}

fn solve(
    equations: &NormalEquations<TERMS>,
    positions: &[usize],
    samples: usize,
) -> Option<Vec<RegressionEstimate>> {
    let mut normal = equations.normal;
    for i in positions.len()..TERMS {
        normal[i][i] = 1.0;
    }
    let freedom = samples.checked_sub(positions.len()).filter(|f| *f > 0)?;
    let inverse = cholesky::inverse(&normal)?;
    let values = cholesky::solve(&normal, &equations.gradient.map(|g| -g))?;
    let explained: f64 = (0..TERMS).map(|i| -equations.gradient[i] * values[i]).sum();
    let variance = (equations.cost - explained).max(0.0) / freedom as f64;
    let estimate = |(i, &position): (usize, &usize)| RegressionEstimate {
        position,
        value: values[i],
        standard_error: (variance * inverse[i][i]).sqrt(),
    };
    Some(positions.iter().enumerate().map(estimate).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On even times, a parabola's slope in the middle of each window; far from the clock's
    /// zero as near it.
    #[test]
    fn closed_form_slopes_of_a_parabola() {
        for start in [0.0, 40.0] {
            let times: Vec<f64> = (0..400).map(|i| start + 5e-6 * f64::from(i)).collect();
            let at = |t: f64| 2e-3 + 0.35 * (t - start) - 90.0 * (t - start).powi(2);
            let series = Series {
                values: times.iter().map(|t| at(*t)).collect(),
                times,
                ..Series::default()
            };
            let mut slopes = LocalSlopes::of(&series, 20);
            for i in [20, 100, 379] {
                let time = series.times[i];
                let slope = 0.35 - 180.0 * (time - start);
                assert!((slopes.at(time) - slope).abs() < 1e-8, "{start} {i}");
            }
        }
    }
}
