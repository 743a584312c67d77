//! Exchange of runs that makes a design better for a model.

use crate::random::{below, generator};
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;

/// Added to the diagonal of X'X, relative to its mean, so that singular starts improve.
pub(crate) const RIDGE: f64 = 1e-10;

/// Improvements below this are rounding, relative; 1.
pub(crate) const IMPROVEMENT: f64 = 1e-9;

/// Most passes over all runs of one start.
pub(crate) const MOST_PASSES: usize = 200;

/// First stream of the seed; each start has its own.
const STREAM: u64 = 1000;

/// What is made as good as possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The volume of the joint confidence region of the coefficients: |X'X|.
    D,
    /// The mean variance of prediction over the region.
    I,
}

/// Runs to be chosen and what they are chosen for.
pub struct Exchange<'a> {
    /// Model rows of the candidates, or of what candidates make.
    pub rows: &'a (dyn Fn(&[usize]) -> Vec<f64> + Sync),
    /// Alternatives of each coordinate: candidates of a list, or levels of each factor.
    pub choices: &'a [usize],
    /// Model rows of runs that are kept.
    pub kept: &'a [Vec<f64>],
    /// Runs to be chosen.
    pub runs: usize,
    /// Mean of row · rowᵀ over the region, for [`Criterion::I`].
    pub moments: &'a DMatrix<f64>,
    /// What is made good.
    pub criterion: Criterion,
}

/// Chosen runs: for each its place in every coordinate's alternatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Exchanged {
    /// The runs.
    pub places: Vec<Vec<usize>>,
    /// What was minimised: −ln |X'X|, or the mean variance.
    pub cost: f64,
}

/// One start: random runs, each replaced by its best alternative in one
/// coordinate until none is better.
///
/// # Source
/// Fedorov (1972), Theory of Optimal Experiments, for a list of candidates;
/// Meyer and Nachtsheim (1995), Technometrics 37, 60-69, by coordinates.
pub fn exchange(problem: &Exchange, seed: u64, start: u64) -> Exchanged {
    let mut generator = generator(seed, STREAM + start);
    let mut state = State::of(problem, random_places(problem, &mut generator));
    for _ in 0..MOST_PASSES {
        let mut improved = false;
        for run in 0..problem.runs {
            for coordinate in 0..problem.choices.len() {
                improved |= state.improve(run, coordinate);
            }
        }
        if !improved {
            break;
        }
    }
    Exchanged {
        cost: state.cost,
        places: state.places,
    }
}

fn random_places(problem: &Exchange, generator: &mut ChaCha8Rng) -> Vec<Vec<usize>> {
    let place = |_| {
        let choices = problem.choices.iter();
        choices.map(|count| below(generator, *count)).collect()
    };
    (0..problem.runs).map(place).collect()
}

/// A design with D = (X'X)⁻¹.
struct State<'a> {
    problem: &'a Exchange<'a>,
    places: Vec<Vec<usize>>,
    rows: Vec<DVector<f64>>,
    inverse: DMatrix<f64>,
    /// D M D, for [`Criterion::I`].
    weighted: DMatrix<f64>,
    cost: f64,
}

impl<'a> State<'a> {
    fn of(problem: &'a Exchange<'a>, places: Vec<Vec<usize>>) -> Self {
        let rows = places
            .iter()
            .map(|place| DVector::from_vec((problem.rows)(place)));
        let mut state = Self {
            problem,
            rows: rows.collect(),
            places,
            inverse: DMatrix::zeros(0, 0),
            weighted: DMatrix::zeros(0, 0),
            cost: f64::INFINITY,
        };
        state.refresh();
        state
    }

    /// Inverse and cost, anew from all rows: no rounding piles up.
    fn refresh(&mut self) {
        let terms = self.problem.moments.nrows();
        let mut information = DMatrix::zeros(terms, terms);
        for row in &self.rows {
            information.ger(1.0, row, row, 1.0);
        }
        for row in self.problem.kept {
            let row = DVector::from_column_slice(row);
            information.ger(1.0, &row, &row, 1.0);
        }
        let ridge = RIDGE * information.trace() / terms as f64;
        for place in 0..terms {
            information[(place, place)] += ridge;
        }
        let Some(factor) = information.cholesky() else {
            self.cost = f64::INFINITY;
            return;
        };
        let diagonal = factor.l_dirty().diagonal();
        self.inverse = factor.inverse();
        self.cost = match self.problem.criterion {
            Criterion::D => -2.0 * diagonal.iter().map(|d| d.ln()).sum::<f64>(),
            Criterion::I => {
                let product = &self.inverse * self.problem.moments;
                self.weighted = &product * &self.inverse;
                product.trace()
            }
        };
    }

    /// Replaces a run by its best alternative in one coordinate; whether any was better.
    fn improve(&mut self, run: usize, coordinate: usize) -> bool {
        let old = &self.rows[run];
        let projected = &self.inverse * old;
        let old_variance = old.dot(&projected);
        let weighted_old = match self.problem.criterion {
            Criterion::D => DVector::zeros(0),
            Criterion::I => &self.weighted * old,
        };
        let mut place = self.places[run].clone();
        let present = place[coordinate];
        let mut best: Option<(f64, usize, DVector<f64>)> = None;
        for choice in (0..self.problem.choices[coordinate]).filter(|c| *c != present) {
            place[coordinate] = choice;
            let new = DVector::from_vec((self.problem.rows)(&place));
            let lowered = self.lowered(&new, &projected, old_variance, &weighted_old, old);
            if lowered > best.as_ref().map_or(self.least_gain(), |(gain, ..)| *gain) {
                best = Some((lowered, choice, new));
            }
        }
        let Some((_, choice, new)) = best else {
            return false;
        };
        let (before, old_row) = (self.cost, std::mem::replace(&mut self.rows[run], new));
        self.refresh();
        if self.cost < before {
            self.places[run][coordinate] = choice;
            return true;
        }
        // The promise was rounding: back to the old run.
        self.rows[run] = old_row;
        self.refresh();
        false
    }

    /// By how much the cost must fall to be more than rounding.
    fn least_gain(&self) -> f64 {
        match self.problem.criterion {
            Criterion::D => IMPROVEMENT,
            Criterion::I => IMPROVEMENT * self.cost.abs(),
        }
    }

    /// Decrease of the cost for a replacement (Sherman, Morrison and Woodbury).
    fn lowered(
        &self,
        new: &DVector<f64>,
        projected: &DVector<f64>,
        old_variance: f64,
        weighted_old: &DVector<f64>,
        old: &DVector<f64>,
    ) -> f64 {
        let between = new.dot(projected);
        let variance = quadratic_form(&self.inverse, new);
        let ratio = (1.0 + variance) * (1.0 - old_variance) + between * between;
        if self.problem.criterion == Criterion::D {
            return ratio.max(f64::MIN_POSITIVE).ln();
        }
        if ratio <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let new_part = quadratic_form(&self.weighted, new);
        let cross = new.dot(weighted_old);
        let old_part = old.dot(weighted_old);
        ((1.0 - old_variance) * new_part + 2.0 * between * cross - (1.0 + variance) * old_part)
            / ratio
    }
}

/// x' A x.
fn quadratic_form(matrix: &DMatrix<f64>, vector: &DVector<f64>) -> f64 {
    let columns = matrix.column_iter().zip(vector.iter());
    columns
        .map(|(column, value)| value * column.dot(vector))
        .sum()
}
