//! Selection of the terms of a linear model, with its trail.
//!
//! The p-values of what remains are optimistic (Harrell, Regression Modeling Strategies,
//! 2nd ed., §4.3); cross-validation with the selection inside shows what it costs.

use crate::model::linear_model::{log_likelihood, small_sample};
use crate::model::model_frame::ModelFrame;
use crate::model::reduced::Reduced;
use crate::model::term_order::{divides, powers_of_terms};
use windfall_distribution::tail::f_upper;
use windfall_mixed::weights::Weights;

/// Where selection begins, and where it may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From all terms, taking out.
    Backward,
    /// From none, putting in.
    Forward,
    /// From none, putting in and taking out.
    Stepwise,
}

/// What decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// Terms enter and leave by the probability of their F test.
    Probability {
        /// Below this it enters.
        enter: f64,
        /// At or above this it leaves.
        remove: f64,
    },
    /// Akaike's criterion for small samples.
    Aicc,
    /// Schwarz' criterion.
    Bic,
}

/// How terms are selected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectionOptions {
    /// Where it goes.
    pub direction: Direction,
    /// What decides.
    pub criterion: Criterion,
    /// Whether terms stay and enter only with their divisors (not so in SPSS).
    pub hierarchy: bool,
}

/// A step of the selection.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The term, by its position in the frame.
    pub term: usize,
    /// Whether it came in; else it went out.
    pub entered: bool,
    /// F of the term in the larger model.
    pub f: f64,
    /// Its probability.
    pub p: f64,
    /// The criterion after the step, if it is not the probability.
    pub criterion: Option<f64>,
    /// R² after the step.
    pub r2: f64,
}

/// What was selected.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Terms of the frame that are in the model.
    pub terms: Vec<usize>,
    /// How it came about.
    pub steps: Vec<Step>,
}

/// A model among others.
#[derive(Clone, Copy)]
struct Candidate {
    residual: f64,
    columns: usize,
}

struct Search<'a> {
    frame: &'a ModelFrame,
    reduced: &'a Reduced,
    total: f64,
}

/// A change and the probability and F of its term.
#[derive(Clone, Copy)]
struct Change {
    term: usize,
    f: f64,
    p: f64,
    after: Candidate,
}

/// Selects terms.
pub fn select(frame: &ModelFrame, reduced: &Reduced, options: &SelectionOptions) -> Selection {
    let base = Search {
        frame,
        reduced,
        total: 0.0,
    };
    let total = base.candidate(&[]).residual;
    let search = Search { total, ..base };
    let powers = powers_of_terms(frame);
    let every: Vec<usize> = (0..frame.terms.len()).collect();
    let mut selection = Selection {
        terms: match options.direction {
            Direction::Backward => every.clone(),
            Direction::Forward | Direction::Stepwise => Vec::new(),
        },
        steps: Vec::new(),
    };
    let may_leave = |term: usize, inside: &[usize]| {
        let mut others = inside.iter().filter(|other| **other != term);
        !options.hierarchy || !others.any(|other| divides(&powers[term], &powers[*other]))
    };
    let may_enter = |term: usize, inside: &[usize]| {
        let mut others = every.iter().filter(|other| **other != term);
        !options.hierarchy
            || others
                .all(|other| !divides(&powers[*other], &powers[term]) || inside.contains(other))
    };
    // Stepwise selection by probabilities can go in circles only if remove < enter,
    // which is refused outside; the bound is for criteria that tie.
    for _ in 0..4 * every.len() + 4 {
        let inside = selection.terms.clone();
        let now = search.candidate(&inside);
        let out = match options.direction {
            Direction::Forward => Vec::new(),
            _ => {
                let leaving = inside.iter().copied().filter(|t| may_leave(*t, &inside));
                leaving
                    .map(|term| search.removal(term, &inside, now))
                    .collect()
            }
        };
        let entering = match options.direction {
            Direction::Backward => Vec::new(),
            _ => {
                let outside = every.iter().copied().filter(|t| !inside.contains(t));
                let entering = outside.filter(|t| may_enter(*t, &inside));
                entering
                    .map(|term| search.entry(term, &inside, now))
                    .collect()
            }
        };
        let Some((change, entered)) = search.choice(now, &out, &entering, options.criterion) else {
            break;
        };
        match entered {
            true => selection.terms.push(change.term),
            false => selection.terms.retain(|term| *term != change.term),
        }
        selection.terms.sort_unstable();
        selection.steps.push(Step {
            term: change.term,
            entered,
            f: change.f,
            p: change.p,
            criterion: search.criterion(change.after, options.criterion),
            r2: 1.0 - change.after.residual / search.total,
        });
    }
    selection
}

impl Selection {
    /// The same with the criteria of rows that weigh differently: each lacks a constant.
    pub fn weighted(mut self, weights: &Weights) -> Self {
        let criteria = self
            .steps
            .iter_mut()
            .filter_map(|own| own.criterion.as_mut());
        criteria.for_each(|own| *own -= weights.log_sum());
        self
    }
}

impl Search<'_> {
    fn candidate(&self, terms: &[usize]) -> Candidate {
        let base = self.frame.intercept.then_some(0);
        let columns = terms
            .iter()
            .flat_map(|t| self.frame.terms[*t].columns.clone());
        let columns: Vec<usize> = base.into_iter().chain(columns).collect();
        let solved = self.reduced.solve(&columns);
        Candidate {
            residual: solved.residual.value().max(0.0),
            columns: solved.columns.len(),
        }
    }

    fn removal(&self, term: usize, inside: &[usize], now: Candidate) -> Change {
        let rest: Vec<usize> = inside.iter().copied().filter(|t| *t != term).collect();
        let after = self.candidate(&rest);
        self.change(term, after, now, after)
    }

    fn entry(&self, term: usize, inside: &[usize], now: Candidate) -> Change {
        let mut more = inside.to_vec();
        more.push(term);
        more.sort_unstable();
        let after = self.candidate(&more);
        self.change(term, now, after, after)
    }

    fn change(&self, term: usize, few: Candidate, many: Candidate, after: Candidate) -> Change {
        let df = (many.columns - few.columns.min(many.columns)) as f64;
        let residual_df = (self.reduced.rows - many.columns) as f64;
        let f = (few.residual - many.residual) / df / (many.residual / residual_df);
        // A term that adds no column explains nothing.
        let p = if df == 0.0 {
            1.0
        } else {
            f_upper(f, df, residual_df)
        };
        Change { term, f, p, after }
    }

    fn criterion(&self, model: Candidate, criterion: Criterion) -> Option<f64> {
        let rows = self.reduced.rows as f64;
        let parameters = model.columns as f64 + 1.0;
        let likelihood = log_likelihood(model.residual, rows);
        match criterion {
            Criterion::Probability { .. } => None,
            Criterion::Aicc => Some(small_sample(
                2.0 * parameters - 2.0 * likelihood,
                parameters,
                rows,
            )),
            Criterion::Bic => Some(parameters * rows.ln() - 2.0 * likelihood),
        }
    }

    /// The change to make, and whether its term enters.
    fn choice(
        &self,
        now: Candidate,
        out: &[Change],
        entering: &[Change],
        criterion: Criterion,
    ) -> Option<(Change, bool)> {
        if let Criterion::Probability { enter, remove } = criterion {
            // The smallest F decides among terms of one column, as the largest p does;
            // p alone would tie at 0 or 1.
            let worst = out
                .iter()
                .filter(|change| change.p >= remove || change.p.is_nan());
            let worst = worst.max_by(|a, b| a.p.total_cmp(&b.p).then(b.f.total_cmp(&a.f)));
            if let Some(worst) = worst {
                return Some((*worst, false));
            }
            let best = entering.iter().filter(|change| change.p < enter);
            let best = best.min_by(|a, b| a.p.total_cmp(&b.p).then(b.f.total_cmp(&a.f)));
            return best.map(|change| (*change, true));
        }
        let value = |model: Candidate| self.criterion(model, criterion).unwrap_or(f64::INFINITY);
        let changes = out.iter().map(|c| (*c, false));
        let changes = changes.chain(entering.iter().map(|c| (*c, true)));
        let best = changes.min_by(|a, b| value(a.0.after).total_cmp(&value(b.0.after)))?;
        (value(best.0.after) < value(now)).then_some(best)
    }
}
