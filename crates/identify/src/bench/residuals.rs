//! What a fit leaves of an impact, without what its own parameters could take up.

use crate::error::Error;
use crate::fit::plan::{Plan, plan};
use crate::fit::problem::{FitOptions, LawProblem};
use crate::fit::response::{Curve, Motion, Shift, clock};
use crate::fit::solve::Solution;
use crate::fit::uncertainty::{inflation, standardised};
use crate::rig::kind::Rig;
use crate::samples::{Quantity, SampleGroup};
use windfall_signal::impact::Impact;
use windfall_signal::response::{Response, Swing};

/// Frequency of a swing that the force is calculated finely enough for; Hz.
const FINEST: f64 = 2e4;

/// Residuals of an impact and how they answer to its bench.
///
/// Residuals are whitened and in deviations of their noise. From them, and from whatever is
/// asked of the bench, the part is taken off that the parameters of the fit explain.
#[derive(Clone, Debug)]
pub struct BenchResiduals {
    /// Residuals in the order of `channels`; 1.
    pub(crate) residuals: Vec<f64>,
    /// Parameters of the fit.
    pub(crate) parameters: usize,
    /// How much wider correlated residuals make what is estimated from them; 1.
    pub(crate) inflation: f64,
    /// Orthonormal: what the parameters of the fit can do.
    basis: Vec<Vec<f64>>,
    channels: Vec<(Quantity, SampleGroup)>,
    /// The force of the fit.
    force: Curve,
    /// What has been taken off the samples already.
    taken: Option<Shift>,
    /// Largest displacement over the largest force; m/N.
    softness: f64,
    /// Duration of the contact; s.
    pub(crate) duration: f64,
}

/// Fits `problem` to an impact and gives what that leaves.
///
/// # Errors
/// As [`fit_impact`](crate::fit::result::fit_impact).
pub fn bench_residuals(
    impact: &Impact,
    rig: &Rig,
    problem: &LawProblem,
    options: &FitOptions,
) -> Result<BenchResiduals, Error> {
    rig.check()?;
    let mut plan = plan(impact, rig, problem, options)?;
    // What a filter makes of the force is asked about the means around first touch.
    plan.instants = false;
    let solution = plan.solve(rig)?;
    of_solution(&plan, &solution, rig)
}

fn of_solution(plan: &Plan, solution: &Solution, rig: &Rig) -> Result<BenchResiduals, Error> {
    let law = plan.problem.kind.with_parameters(&solution.law)?;
    let motion = Motion {
        law: &law,
        rig,
        velocity: solution.velocity,
        end: plan.options.end,
        onset: solution.onset,
        sampling: plan.setting().sampling,
    };
    let finest = Response {
        sensor: Some(Swing {
            frequency: FINEST.min(0.1 / clock(&plan.noise.groups).0),
            damping: 0.1,
        }),
        ..Response::default()
    };
    let force = motion.curve(&finest, &plan.noise.groups)?;
    let count = plan.free.len();
    let mut own = BenchResiduals {
        residuals: Vec::new(),
        parameters: count,
        inflation: 1.0,
        basis: vec![Vec::new(); count],
        channels: Vec::new(),
        force,
        softness: plan.features.displacement / plan.features.force,
        taken: plan.noise.shift.clone(),
        duration: plan.impact.end - plan.impact.onset,
    };
    let mut wider = Vec::new();
    for (g, group) in plan.noise.groups.iter().enumerate() {
        for quantity in Quantity::ALL {
            let residuals = &solution.rows.residuals[g][quantity as usize];
            if residuals.is_empty() {
                continue;
            }
            let derivatives = &solution.rows.jacobian[g][quantity as usize];
            let width = derivatives.len() / residuals.len();
            for (c, basis) in own.basis.iter_mut().enumerate() {
                let column = derivatives.iter().skip(c).step_by(width);
                let column: Vec<f64> = column.copied().collect();
                basis.extend(standardised(group, quantity, &column));
            }
            let white = standardised(group, quantity, residuals);
            wider.push((white.len() as f64, inflation(&white)));
            own.residuals.extend(white);
            own.channels.push((quantity, group.clone()));
        }
    }
    let samples: f64 = wider.iter().map(|(count, _)| count).sum();
    own.inflation = wider.iter().map(|(count, own)| count * own).sum::<f64>() / samples;
    orthonormalise(&mut own.basis);
    let mut residuals = std::mem::take(&mut own.residuals);
    own.project(&mut residuals);
    own.residuals = residuals;
    Ok(own)
}

/// Gram and Schmidt, twice for rounding; a column that others explain becomes nothing.
fn orthonormalise(columns: &mut [Vec<f64>]) {
    for at in 0..columns.len() {
        let size = dot(&columns[at], &columns[at]).sqrt();
        let (before, rest) = columns.split_at_mut(at);
        let column = &mut rest[0];
        for _ in 0..2 {
            for other in before.iter() {
                let part = dot(other, column);
                subtract(column, part, other);
            }
        }
        let left = dot(column, column).sqrt();
        let scale = if left > 1e-10 * size { 1.0 / left } else { 0.0 };
        column.iter_mut().for_each(|own| *own *= scale);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(from: &mut [f64], part: f64, column: &[f64]) {
    for (own, other) in from.iter_mut().zip(column) {
        *own -= part * other;
    }
}

/// A fault of a bench with its parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BenchFault {
    /// What the force reads beyond what it is; 1.
    pub gain: f64,
    /// Time by which the force comes late; s.
    pub delay: f64,
    /// What the instruments do.
    pub response: Response,
}

impl BenchResiduals {
    /// Takes off what the parameters of the fit explain.
    fn project(&self, column: &mut [f64]) {
        for basis in &self.basis {
            let part = dot(basis, column);
            subtract(column, part, basis);
        }
    }

    /// Residuals as they are with a fault of the bench, after another fit; 1.
    pub(crate) fn with(&self, fault: &BenchFault) -> Vec<f64> {
        let shift = self.force.shift(&fault.response);
        let force = |time: f64| self.force.at(time) + shift.at(Quantity::Force, time);
        let added = |quantity: Quantity, time: f64| {
            let now = match quantity {
                Quantity::Force => {
                    (1.0 + fault.gain) * force(time - fault.delay) - self.force.at(time)
                }
                other => shift.at(other, time),
            };
            let taken = self.taken.as_ref();
            now - taken.map_or(0.0, |taken| taken.at(quantity, time))
        };
        let mut all = Vec::with_capacity(self.residuals.len());
        for (quantity, group) in &self.channels {
            let column: Vec<f64> = match quantity {
                Quantity::Force | Quantity::Displacement => group
                    .times()
                    .iter()
                    .map(|&time| added(*quantity, time))
                    .collect(),
                _ => vec![0.0; group.times().len()],
            };
            all.extend(standardised(group, *quantity, &column));
        }
        self.project(&mut all);
        all.iter_mut()
            .zip(&self.residuals)
            .for_each(|(own, before)| *own += before);
        all
    }

    /// Shortest time between samples; s.
    pub(crate) fn interval(&self) -> f64 {
        let groups = self.channels.iter().map(|(_, group)| group.interval());
        groups
            .filter(|own| *own > 0.0)
            .fold(f64::INFINITY, f64::min)
    }

    /// Largest displacement by the largest force; m/N.
    pub(crate) fn softness(&self) -> f64 {
        self.softness
    }
}
