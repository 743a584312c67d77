//! The no-U-turn sampler: a trajectory of Hamiltonian motion is doubled until it
//! turns back, and one of its points is the next draw.
//!
//! # Source
//! Hoffman and Gelman (2014), J. Machine Learning Research 15:1593; Betancourt (2017),
//! arXiv:1701.02434, appendix A, for points drawn by their weight and for the
//! criterion of turning.

use crate::sampler::density::{LogDensity, Point};
use windfall_signal::noise::gaussian::{NoiseSource, normal, uniform};

/// Doublings of a trajectory at most.
const MOST_DOUBLINGS: usize = 10;
/// Error of the energy at which a trajectory has diverged.
const DIVERGED: f64 = 1000.0;

/// A point in motion.
#[derive(Clone)]
struct Moving {
    point: Point,
    momentum: Vec<f64>,
}

/// Part of a trajectory, in the order in which it was followed.
struct Stretch {
    first: Moving,
    last: Moving,
    /// Sum of the momenta.
    momenta: Vec<f64>,
    /// One of its points, drawn by weight.
    drawn: Point,
    /// Logarithm of the sum of the points' weights exp(H₀ − H).
    log_weight: f64,
}

/// What a draw tells besides its position.
pub(crate) struct Drawn {
    /// Mean probability that a step of the trajectory is accepted.
    pub acceptance: f64,
    /// Whether the motion could not be followed.
    pub diverged: bool,
}

/// A Markov chain.
pub(crate) struct Chain<'a> {
    density: &'a dyn LogDensity,
    point: Point,
    source: NoiseSource,
    /// Width of a step of the motion.
    pub step: f64,
    /// Variance of each coordinate: the inverse of its mass.
    pub variances: Vec<f64>,
}

/// What the trajectory of one draw has in common.
struct Trajectory {
    /// Energy at the start.
    energy: f64,
    /// Width of a step, negative back in time.
    step: f64,
    steps: usize,
    acceptance: f64,
    diverged: bool,
}

impl<'a> Chain<'a> {
    pub(crate) fn new(density: &'a dyn LogDensity, point: Point, source: NoiseSource) -> Self {
        Self {
            variances: vec![1.0; point.at.len()],
            density,
            point,
            source,
            step: 1.0,
        }
    }

    /// Coordinates of the last draw.
    pub(crate) fn position(&self) -> &[f64] {
        &self.point.at
    }

    /// Moves to the next draw.
    pub(crate) fn draw(&mut self) -> Drawn {
        let start = self.pushed();
        let mut trajectory = Trajectory {
            energy: self.energy(&start),
            step: self.step,
            steps: 0,
            acceptance: 0.0,
            diverged: false,
        };
        let mut whole = Stretch {
            momenta: start.momentum.clone(),
            drawn: self.point.clone(),
            log_weight: 0.0,
            first: start.clone(),
            last: start,
        };
        for doublings in 0..MOST_DOUBLINGS {
            let back = uniform(&mut self.source) < 0.5;
            if back {
                std::mem::swap(&mut whole.first, &mut whole.last);
            }
            trajectory.step = if back { -self.step } else { self.step };
            let Some(more) = self.follow(&whole.last, doublings, &mut trajectory) else {
                break;
            };
            // The further from the start the better.
            let odds = more.log_weight - whole.log_weight;
            let turned;
            (whole, turned) = self.joined(whole, more, odds);
            if turned {
                break;
            }
            if back {
                std::mem::swap(&mut whole.first, &mut whole.last);
            }
        }
        self.point = whole.drawn;
        Drawn {
            acceptance: trajectory.acceptance / trajectory.steps as f64,
            diverged: trajectory.diverged,
        }
    }

    /// Change of the energy, with its sign turned, over one step of width `step` from
    /// the last draw with a new momentum.
    pub(crate) fn gain_of_a_step(&mut self, step: f64) -> f64 {
        let start = self.pushed();
        let end = self.stepped(&start, step);
        end.map_or(f64::NEG_INFINITY, |end| {
            self.energy(&start) - self.energy(&end)
        })
    }

    /// The last draw with a new momentum.
    fn pushed(&mut self) -> Moving {
        let source = &mut self.source;
        let momenta = self.variances.iter().map(|v| normal(source) / v.sqrt());
        Moving {
            momentum: momenta.collect(),
            point: self.point.clone(),
        }
    }

    fn energy(&self, moving: &Moving) -> f64 {
        let twice: f64 = moving
            .momentum
            .iter()
            .zip(&self.variances)
            .map(|(p, v)| p * p * v)
            .sum();
        0.5 * twice - moving.point.log_density
    }

    /// One step of the leapfrog; `None` out of the density.
    fn stepped(&self, from: &Moving, step: f64) -> Option<Moving> {
        let kicked = |momentum: &[f64], gradient: &[f64]| -> Vec<f64> {
            let pairs = momentum.iter().zip(gradient);
            pairs.map(|(p, g)| p + 0.5 * step * g).collect()
        };
        let momentum = kicked(&from.momentum, &from.point.gradient);
        let moved = from.point.at.iter().zip(&momentum).zip(&self.variances);
        let at = moved.map(|((q, p), v)| q + step * p * v).collect();
        let point = Point::new(self.density, at)?;
        Some(Moving {
            momentum: kicked(&momentum, &point.gradient),
            point,
        })
    }

    /// Follows the motion for 2^`doublings` steps; `None` when it turns or diverges
    /// on the way.
    fn follow(
        &mut self,
        from: &Moving,
        doublings: usize,
        trajectory: &mut Trajectory,
    ) -> Option<Stretch> {
        if doublings == 0 {
            return self.follow_step(from, trajectory);
        }
        let one = self.follow(from, doublings - 1, trajectory)?;
        let other = self.follow(&one.last, doublings - 1, trajectory)?;
        let odds = other.log_weight - sum_of_exponentials(one.log_weight, other.log_weight);
        let (both, turned) = self.joined(one, other, odds);
        (!turned).then_some(both)
    }

    fn follow_step(&self, from: &Moving, trajectory: &mut Trajectory) -> Option<Stretch> {
        let to = self.stepped(from, trajectory.step);
        let gain = to
            .as_ref()
            .map_or(f64::NEG_INFINITY, |to| trajectory.energy - self.energy(to));
        trajectory.steps += 1;
        trajectory.acceptance += gain.min(0.0).exp();
        if gain.is_nan() || gain <= -DIVERGED {
            trajectory.diverged = true;
            return None;
        }
        let to = to?;
        Some(Stretch {
            momenta: to.momentum.clone(),
            drawn: to.point.clone(),
            log_weight: gain,
            first: to.clone(),
            last: to,
        })
    }

    /// Two stretches, one behind the other, and whether they turn back. The point of
    /// the second is drawn with probability exp(`odds`).
    fn joined(&mut self, one: Stretch, other: Stretch, odds: f64) -> (Stretch, bool) {
        let sum =
            |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
        let momenta = sum(&one.momenta, &other.momenta);
        let turned = self.turns(&momenta, &one.first, &other.last)
            // What two stretches of one period hide from their ends shows across the seam.
            || self.turns(&sum(&one.momenta, &other.first.momentum), &one.first, &other.first)
            || self.turns(&sum(&one.last.momentum, &other.momenta), &one.last, &other.last);
        let taken = uniform(&mut self.source).ln() < odds;
        let both = Stretch {
            momenta,
            drawn: if taken { other.drawn } else { one.drawn },
            log_weight: sum_of_exponentials(one.log_weight, other.log_weight),
            first: one.first,
            last: other.last,
        };
        (both, turned)
    }

    /// Whether the motion from `first` to `last` has begun to come back.
    fn turns(&self, momenta: &[f64], first: &Moving, last: &Moving) -> bool {
        let along = |end: &Moving| -> f64 {
            let terms = momenta.iter().zip(&end.momentum).zip(&self.variances);
            terms.map(|((sum, p), v)| sum * p * v).sum()
        };
        !(along(first) > 0.0 && along(last) > 0.0)
    }
}

/// ln(eᵃ + eᵇ).
fn sum_of_exponentials(a: f64, b: f64) -> f64 {
    a.max(b) + (-(a - b).abs()).exp().ln_1p()
}
