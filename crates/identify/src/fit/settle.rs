//! What the instruments of a bench make of a fitted motion, taken off the samples.
//!
//! A filter, a sensor or an arm that swings makes of the force F of the model what is recorded,
//! F + δ(F). The samples less δ(F) of the last fit are fitted again until nothing moves: the
//! residuals are then those of the recorded force beside the model as the instruments show it.
//! Each fit moves the parameters by a share of what is left, so the next δ(F) is taken ahead of
//! it by a secant.

use crate::error::Error;
use crate::fit::noise::NoisePlan;
use crate::fit::plan::Plan;
use crate::fit::response::{Motion, Shift};
use crate::fit::solve::{Solution, Wanted};
use crate::rig::kind::Rig;
use crate::samples::Quantity;

/// Fits at most, until what the instruments make of the motion is that of the motion fitted.
const MOST_FITS: usize = 24;
/// Most moves that a secant goes ahead.
const MOST_AHEAD: f64 = 30.0;
/// Change of each parameter, in its standard deviations, below which it stands; and below which
/// it is good enough after the most fits.
const SETTLED: f64 = 0.01;
const ENOUGH: f64 = 0.2;

impl NoisePlan {
    /// The same samples with something else taken off them than before.
    ///
    /// * `onset`: of the times of the edges; s
    fn shifted(mut self, shift: Shift, onset: f64) -> Self {
        let before = self.shift.take();
        let change = |quantity: Quantity, time: f64| {
            let off = before.as_ref().map_or(0.0, |own| own.at(quantity, time));
            off - shift.at(quantity, time)
        };
        if let Some(edges) = &mut self.edges {
            for (value, time) in edges.values.iter_mut().zip(&edges.times) {
                *value += change(Quantity::Displacement, time - onset);
            }
        }
        for group in &mut self.groups {
            group.shift(change);
        }
        self.shift = Some(shift);
        self
    }
}

/// Where fits have come to, or may be going.
#[derive(Clone, Debug)]
struct Place {
    law: Vec<f64>,
    velocity: f64,
    onset: f64,
    free: Vec<f64>,
}

impl Place {
    fn of(solution: &Solution) -> Self {
        Self {
            law: solution.law.clone(),
            velocity: solution.velocity,
            onset: solution.onset,
            free: solution.free.clone(),
        }
    }

    /// This place and `part` of the way on from another.
    fn beyond(&self, other: &Self, part: f64) -> Self {
        let on = |own: f64, other: f64| own + part * (own - other);
        let all =
            |own: &[f64], others: &[f64]| own.iter().zip(others).map(|(a, b)| on(*a, *b)).collect();
        Self {
            law: all(&self.law, &other.law),
            velocity: on(self.velocity, other.velocity),
            onset: on(self.onset, other.onset),
            free: all(&self.free, &other.free),
        }
    }
}

/// How far the fit from a place has come, and what it has reached.
struct Move {
    from: Place,
    reached: Place,
    /// In standard deviations of each free parameter; 1.
    way: Vec<f64>,
}

impl Move {
    fn new(from: &Place, solution: &Solution) -> Self {
        let reached = Place::of(solution);
        let pairs = from.free.iter().zip(&reached.free).enumerate();
        let way = pairs.map(|(i, (before, after))| {
            let variance = solution
                .covariance
                .get(i)
                .map_or(f64::INFINITY, |row| row[i]);
            if before == after {
                0.0
            } else {
                (after - before) / variance.sqrt()
            }
        });
        let way = way.collect();
        let from = from.clone();
        Self { from, reached, way }
    }

    /// The largest of the ways; 1.
    fn longest(&self) -> f64 {
        self.way.iter().fold(0.0, |most, own| own.abs().max(most))
    }

    /// Where the way would end by its change since the move before; half of it where that cannot
    /// be told, as where the cost has a corner at each sample that first touch passes.
    ///
    /// # Source
    /// Anderson (1965), J. ACM 12:547, with one place before.
    fn ahead(&self, before: &Self) -> Place {
        let changes = self.way.iter().zip(&before.way);
        let (mut along, mut square) = (0.0, 0.0);
        for (own, other) in changes {
            along += own * (own - other);
            square += (own - other).powi(2);
        }
        let part = -along / square;
        let place = self.reached.beyond(&before.reached, part);
        let same_sign = |(a, b): (&f64, &f64)| a * b > 0.0 || a == b;
        let sound = part.abs() < MOST_AHEAD && self.longest() < before.longest();
        match sound && place.law.iter().zip(&self.reached.law).all(same_sign) {
            true => place,
            false => self.reached.beyond(&self.from, -0.5),
        }
    }
}

impl Plan<'_> {
    /// Solves with what the instruments make of the solution taken off the samples, from a
    /// solution on.
    ///
    /// # Errors
    /// [`Error::ResponseTooLarge`], [`Error::ResponseUnsettled`]; a fit fails.
    pub(crate) fn settle(&mut self, first: Solution, rig: &Rig) -> Result<Solution, Error> {
        let mut place = Place::of(&first);
        let mut solution = first;
        let mut before: Option<Move> = None;
        for fit in 1..=MOST_FITS {
            let law = self.problem.kind.with_parameters(&place.law)?;
            let motion = Motion {
                law: &law,
                rig,
                velocity: place.velocity,
                end: self.options.end,
                onset: place.onset,
                sampling: self.setting().sampling,
            };
            let shift = Shift::of(&self.options.response, &motion, &self.noise.groups)?;
            self.noise = self.noise.clone().shifted(shift, self.impact.onset);
            let start = [
                solution.velocity,
                rig.effective_mass(),
                solution.onset,
                solution.offset,
            ];
            let next = self.solve_from(&[(solution.law.clone(), start)], Wanted::Covariance)?;
            let evaluations = solution.evaluations;
            let moved = Move::new(&place, &next);
            solution = next;
            solution.evaluations += evaluations;
            let limit = if fit < MOST_FITS { SETTLED } else { ENOUGH };
            if moved.longest() <= limit {
                return Ok(solution);
            }
            place = before.map_or_else(|| moved.reached.clone(), |own| moved.ahead(&own));
            before = Some(moved);
        }
        Err(Error::ResponseUnsettled { fits: MOST_FITS })
    }
}
