//! Least squares over all impacts of a bench: common parameters, and each fit's own besides.

use crate::bench::kind::{Cause, MOST};
use crate::bench::residuals::{BenchFault, BenchResiduals};
use windfall_numerics::least_squares::{Bounds, LeastSquares, NormalEquations, Options, minimise};

/// Impacts at most on which starts are tried.
const TRIED: usize = 12;
/// Step of the derivatives, in the coordinate of each parameter.
const STEP: f64 = 1e-4;
/// Frequencies tried, from so many swings in a contact up; and how they rise.
const FEWEST_SWINGS: f64 = 2.0;
const RISE: f64 = 1.25;
/// Damping ratios tried, and allowed.
const DAMPINGS: [f64; 2] = [0.03, 0.3];
const DAMPING: (f64, f64) = (1e-3, 0.95);
/// Highest frequency, over the sampling rate; 1.
const HIGHEST: f64 = 0.1;

/// A cause on the residuals of the impacts.
pub(crate) struct Search<'a> {
    pub impacts: &'a [BenchResiduals],
    pub cause: Cause,
    /// Displacement that the bending of the arm is counted in, per force; m/N.
    pub compliance: f64,
    /// Time that delays are counted in; s.
    pub time: f64,
}

/// A minimum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub parameters: [f64; MOST],
    pub cost: f64,
    /// Squared deviations of the parameters by how much the estimate moves without each impact.
    pub scatter: [f64; MOST],
    /// The same where residuals are white and of one size, over their squares; 1.
    pub white: [f64; MOST],
}

impl Search<'_> {
    /// The fault that coordinates stand for.
    pub(crate) fn fault(&self, at: &[f64; MOST]) -> BenchFault {
        self.cause.fault(at, self.time, self.compliance)
    }

    /// Residuals and derivatives of one impact.
    fn rows(&self, own: &BenchResiduals, at: &[f64; MOST]) -> (Vec<f64>, [Vec<f64>; MOST]) {
        let now = own.with(&self.fault(at));
        let free = self.cause.free();
        let derivatives = std::array::from_fn(|i| {
            if !free[i] {
                return Vec::new();
            }
            let mut near = *at;
            near[i] += STEP;
            let moved = own.with(&self.fault(&near));
            let change = moved.iter().zip(&now).map(|(a, b)| (a - b) / STEP);
            change.collect()
        });
        (now, derivatives)
    }

    fn equations_of(&self, own: &BenchResiduals, at: &[f64; MOST]) -> NormalEquations<MOST> {
        let (now, derivatives) = self.rows(own, at);
        let mut sums = NormalEquations::ZERO;
        for (i, residual) in now.iter().enumerate() {
            let row = std::array::from_fn(|p| derivatives[p].get(i).copied().unwrap_or(0.0));
            sums.add(1.0, *residual, &row);
        }
        sums
    }

    /// Sum of squares over every so many impacts; 1.
    fn cost(&self, at: &[f64; MOST], every: usize) -> f64 {
        let fault = self.fault(at);
        let of = |own: &BenchResiduals| own.with(&fault).iter().map(|r| r * r).sum::<f64>();
        self.impacts.iter().step_by(every).map(of).sum()
    }

    /// The lowest minimum from several starts.
    pub(crate) fn solve(&mut self) -> Option<Found> {
        let (bounds, starts) = (self.bounds(), self.starts());
        let every = self.impacts.len().div_ceil(TRIED);
        let costs = starts.iter().map(|start| (self.cost(start, every), start));
        let start = costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|own| *own.1)?;
        let options = Options {
            cost_tolerance: 1e-7,
            max_evaluations: 40,
            largest_step: [0.3; MOST],
            ..Options::default()
        };
        let minimum = minimise(self, &start, &bounds, &options);
        let at = minimum.parameters;
        if !minimum.equations.cost.is_finite() {
            return None;
        }
        let (scatter, white) = self.deviations(&at)?;
        Some(Found {
            parameters: at,
            cost: self.cost(&at, 1),
            scatter,
            white,
        })
    }

    fn longest(&self) -> f64 {
        let durations = self.impacts.iter().map(|own| own.duration);
        durations.fold(f64::INFINITY, f64::min)
    }

    fn bounds(&self) -> Bounds<MOST> {
        let mut bounds = Bounds::NONE;
        let (slowest, fastest) = self.frequencies();
        (bounds.lower[2], bounds.upper[2]) = (slowest.ln(), fastest.ln());
        (bounds.lower[3], bounds.upper[3]) = (DAMPING.0.ln(), DAMPING.1.ln());
        // A force bends an arm out of its way.
        bounds.lower[4] = 0.0;
        bounds
    }

    /// Frequencies that can be told; Hz.
    fn frequencies(&self) -> (f64, f64) {
        let interval = self.impacts.iter().map(BenchResiduals::interval);
        let interval = interval.fold(0.0, f64::max);
        let slowest = match self.cause {
            Cause { pole: true, .. } => 0.3 * FEWEST_SWINGS / self.longest(),
            _ => FEWEST_SWINGS / self.longest(),
        };
        (slowest, (HIGHEST / interval).max(2.0 * slowest))
    }

    /// Starts: every frequency and damping, and nothing else wrong.
    fn starts(&self) -> Vec<[f64; MOST]> {
        let (slowest, fastest) = self.frequencies();
        if !self.cause.swings() && !self.cause.pole {
            return vec![[0.0, 0.0, slowest.ln(), DAMPINGS[0].ln(), 0.0]];
        }
        let count = ((fastest / slowest).ln() / RISE.ln()) as i32;
        let dampings: &[f64] = match self.cause.swings() {
            true => &DAMPINGS,
            false => &DAMPINGS[..1],
        };
        let compliance = if self.cause.arm { 1.0 } else { 0.0 };
        let mut starts = Vec::new();
        for step in 0..=count {
            for damping in dampings {
                let frequency = slowest * RISE.powi(step);
                starts.push([0.0, 0.0, frequency.ln(), damping.ln(), compliance]);
            }
        }
        starts
    }

    /// Squared deviations by how far the estimate moves without each impact, and for white
    /// residuals of size 1.
    ///
    /// # Source
    /// Bell and McCaffrey (2002), Survey Methodology 28:169, the jackknife over clusters (CR3),
    /// with (n − 1)/n; the move is that of one Gauss-Newton step.
    fn deviations(&self, at: &[f64; MOST]) -> Option<([f64; MOST], [f64; MOST])> {
        let each = self.impacts.iter().map(|own| self.equations_of(own, at));
        let each: Vec<NormalEquations<MOST>> = each.collect();
        let mut all = NormalEquations::<MOST>::ZERO;
        for own in &each {
            for (sums, own) in all.normal.iter_mut().zip(&own.normal) {
                for (sum, own) in sums.iter_mut().zip(own) {
                    *sum += own;
                }
            }
        }
        for (i, free) in self.cause.free().iter().enumerate() {
            if !free {
                all.normal[i][i] = 1.0;
            }
        }
        let share = 1.0 - 1.0 / each.len() as f64;
        let mut scatter = [0.0; MOST];
        for own in &each {
            let mut others = all;
            for i in 0..MOST {
                for j in 0..MOST {
                    others.normal[i][j] -= own.normal[i][j];
                }
            }
            let inverse = others.inverse(MOST)?;
            let moved = inverse.map(|row| {
                row.iter()
                    .zip(&own.gradient)
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            });
            for (scatter, moved) in scatter.iter_mut().zip(moved) {
                *scatter += share * moved * moved;
            }
        }
        let white = all.inverse(MOST)?;
        Some((scatter, std::array::from_fn(|i| white[i][i])))
    }
}

impl LeastSquares<MOST> for Search<'_> {
    fn evaluate(&mut self, parameters: &[f64; MOST]) -> Option<NormalEquations<MOST>> {
        let mut sums = NormalEquations::ZERO;
        for own in self.impacts {
            let own = self.equations_of(own, parameters);
            sums.cost += own.cost;
            for i in 0..MOST {
                sums.gradient[i] += own.gradient[i];
                for j in 0..MOST {
                    sums.normal[i][j] += own.normal[i][j];
                }
            }
        }
        sums.cost.is_finite().then_some(sums)
    }
}
