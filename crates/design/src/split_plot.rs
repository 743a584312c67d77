//! Split-plot designs: hard-to-change factors are set once for each whole plot of several runs.

use crate::error::DesignError;
use crate::exchange::{Criterion, IMPROVEMENT, MOST_PASSES, RIDGE};
use crate::finding::DesignFinding;
use crate::kind::{Design, Factor, Point, check_factors, check_runs, design_of};
use crate::model::region_points;
use crate::optimal::{MOST_TERMS, ModelRow, check_defined, check_levels, in_order, moments};
use crate::quality::design_quality;
use crate::random::{below, generator};
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// First stream of the seed; each start has its own.
const STREAM: u64 = 100_000;

/// Multiplications of all starts, and passes over the runs per start.
const WORK: f64 = 2e9;
const PASSES: f64 = 8.0;

/// Points at which it is tried whether a term changes within whole plots.
const TRIALS: usize = 16;

/// What is asked of a split-plot design.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitPlotOptions {
    /// Places of the factors that are hard to change.
    pub hard: Vec<usize>,
    /// Whole plots.
    pub whole_plots: usize,
    /// Runs of all whole plots.
    pub runs: usize,
    /// Expected variance between whole plots over that of runs within; 1.
    pub ratio: f64,
    /// What is made good.
    pub criterion: Criterion,
    /// Random starts; `None` for 2 to 200, as many as finish in seconds.
    pub starts: Option<usize>,
    /// Their seed.
    pub seed: u64,
}

/// The best split-plot design of many starts for a model, with whole plots of equal size, or of
/// two sizes that differ by one run.
///
/// * `row`: of the model at coded values; `levels`: coded, of each factor
///
/// # Errors
/// No factor or every factor hard to change; fewer whole plots than terms of hard factors alone,
/// fewer runs than terms; a variance ratio that is none.
///
/// # Source
/// Jones and Goos (2007), A candidate-set-free algorithm for generating D-optimal split-plot
/// designs, Appl. Statist. 56, 347-364.
pub fn split_plot(
    factors: Vec<Factor>,
    row: &ModelRow,
    levels: &[Vec<f64>],
    options: &SplitPlotOptions,
) -> Result<Design, DesignError> {
    check_factors("split-plot", &factors, 2)?;
    check_runs(options.runs as f64)?;
    check_levels(&factors, levels)?;
    check_plots(&factors, options)?;
    let (weights, points): (Vec<f64>, Vec<Vec<f64>>) = region_points(&factors).into_iter().unzip();
    let rows: Vec<Vec<f64>> = points.iter().map(|point| row(point)).collect();
    check_defined(&rows, &points)?;
    let terms = rows.first().map_or(0, Vec::len);
    check_terms(terms, options)?;
    let region: Vec<(f64, Vec<f64>)> = weights.into_iter().zip(rows).collect();
    let problem = Problem {
        row,
        levels,
        hard: (0..factors.len())
            .map(|own| options.hard.contains(&own))
            .collect(),
        sizes: sizes(options),
        moments: moments(&region, terms),
        options,
    };
    let between = problem.terms_between(terms);
    if options.whole_plots < between {
        return Err(DesignError::WholePlotsTooFew {
            found: options.whole_plots,
            terms: between,
        });
    }
    let plots = problem.best();
    let mut design = arranged(factors, &plots);
    let rows: Vec<Vec<f64>> = design.runs.iter().map(|run| row(&run.coded)).collect();
    if design_quality(&decorrelated(&rows, &design, options.ratio), &[]).is_none() {
        let runs = options.runs;
        return Err(DesignError::ModelSingular { runs, terms });
    }
    let left = (
        options.whole_plots - between,
        options.runs - options.whole_plots,
    );
    if left.0 == 0 {
        design.findings.push(DesignFinding::NoWholePlotError {
            plots: options.whole_plots,
        });
    }
    if left.1 <= terms - between {
        design
            .findings
            .push(DesignFinding::NoErrorWithinPlots { runs: options.runs });
    }
    Ok(design)
}

fn check_plots(factors: &[Factor], options: &SplitPlotOptions) -> Result<(), DesignError> {
    let impossible = |problem: String| Err(DesignError::WholePlotsImpossible { problem });
    let (plots, runs) = (options.whole_plots, options.runs);
    if options.hard.is_empty() || options.hard.len() >= factors.len() {
        return impossible(
            "name the factors that are hard to change, at least one and not all".to_owned(),
        );
    }
    if plots < 2 {
        return impossible(format!("{plots} whole plots are none: give at least 2"));
    }
    if runs < plots + 1 {
        return impossible(format!(
            "{runs} runs in {plots} whole plots leave no plot of two runs: give fewer whole plots \
             or more runs"
        ));
    }
    match options.ratio.is_finite() && options.ratio >= 0.0 {
        true => Ok(()),
        false => impossible(format!(
            "the ratio of variances {} is none: give a number of 0 or more",
            options.ratio
        )),
    }
}

fn check_terms(terms: usize, options: &SplitPlotOptions) -> Result<(), DesignError> {
    if terms > MOST_TERMS {
        let most = MOST_TERMS;
        return Err(DesignError::TermsTooMany { terms, most });
    }
    match options.runs < terms {
        true => Err(DesignError::RunsTooFew {
            runs: options.runs,
            least: terms,
            what: format!("a model of {terms} terms"),
        }),
        false => Ok(()),
    }
}

/// Runs of each whole plot, the larger plots first.
fn sizes(options: &SplitPlotOptions) -> Vec<usize> {
    let (each, more) = (
        options.runs / options.whole_plots,
        options.runs % options.whole_plots,
    );
    (0..options.whole_plots)
        .map(|plot| each + usize::from(plot < more))
        .collect()
}

/// Model rows that are independent of each other and of one variance, that of a run within a
/// whole plot; as they are where there are no whole plots.
///
/// * `ratio`: variance between whole plots over that within
///
/// A row loses the share 1 − 1/√(1 + k·ratio) of the mean of its plot of k runs.
pub fn decorrelated(rows: &[Vec<f64>], design: &Design, ratio: f64) -> Vec<Vec<f64>> {
    let mut changed = rows.to_vec();
    let plots = design.runs.iter().filter_map(|run| run.whole_plot).max();
    for plot in 1..=plots.unwrap_or(0) {
        let runs = design.runs.iter().enumerate();
        let own = runs.filter(|(_, run)| run.whole_plot == Some(plot));
        let own: Vec<usize> = own.map(|(place, _)| place).collect();
        let count = own.len() as f64;
        let share = 1.0 - (1.0 + count * ratio).sqrt().recip();
        let terms = rows.first().map_or(0, Vec::len);
        for term in 0..terms {
            let mean = own.iter().map(|run| rows[*run][term]).sum::<f64>() / count;
            own.iter()
                .for_each(|run| changed[*run][term] -= share * mean);
        }
    }
    changed
}

fn arranged(factors: Vec<Factor>, plots: &[Vec<Vec<f64>>]) -> Design {
    let points = plots.iter().flatten();
    let points = points
        .map(|coded| (Point::Optimal, coded.clone()))
        .collect();
    let mut design = design_of(
        format!("split-plot, {} whole plots", plots.len()),
        factors,
        points,
    );
    let places = plots.iter().enumerate();
    let places = places.flat_map(|(plot, runs)| std::iter::repeat_n(plot + 1, runs.len()));
    for (run, plot) in design.runs.iter_mut().zip(places) {
        run.whole_plot = Some(plot);
    }
    design
}

struct Problem<'a> {
    row: &'a ModelRow<'a>,
    levels: &'a [Vec<f64>],
    /// Whether each factor is hard to change.
    hard: Vec<bool>,
    /// Runs of each whole plot.
    sizes: Vec<usize>,
    /// Mean of row · rowᵀ over the region, for [`Criterion::I`].
    moments: DMatrix<f64>,
    options: &'a SplitPlotOptions,
}

impl Problem<'_> {
    /// Terms that no change of the other factors changes.
    fn terms_between(&self, terms: usize) -> usize {
        let mut generator = generator(self.options.seed, STREAM - 1);
        let mut constant = vec![true; terms];
        for _ in 0..TRIALS {
            let first = self.random_point(&mut generator);
            let second = self.random_point(&mut generator);
            let factors = first.iter().zip(&second).zip(&self.hard);
            let mixed: Vec<f64> = factors
                .map(|((first, second), hard)| if *hard { *first } else { *second })
                .collect();
            let rows = ((self.row)(&first), (self.row)(&mixed));
            for (term, own) in constant.iter_mut().enumerate() {
                *own &= (rows.0[term] - rows.1[term]).abs() <= 1e-12;
            }
        }
        constant.iter().filter(|own| **own).count()
    }

    fn random_point(&self, generator: &mut ChaCha8Rng) -> Vec<f64> {
        let levels = self.levels.iter();
        levels.map(|own| own[below(generator, own.len())]).collect()
    }

    /// Whole plots of the best of all starts, the first of equal ones; in standard order.
    fn best(&self) -> Vec<Vec<Vec<f64>>> {
        let starts = self.options.starts.unwrap_or_else(|| self.affordable());
        let found: Vec<State> = (0..starts.max(1) as u64)
            .into_par_iter()
            .map(|start| self.improved(start))
            .collect();
        let best = found
            .into_iter()
            .reduce(|best, next| if next.cost < best.cost { next } else { best });
        let mut plots = best.map(|own| own.plots).unwrap_or_default();
        for plot in &mut plots {
            plot.sort_by(|a, b| in_order(a, b));
        }
        plots.sort_by(|a, b| in_order(&a[0], &b[0]));
        plots
    }

    /// Starts that take [`WORK`].
    fn affordable(&self) -> usize {
        let terms = self.moments.nrows() as f64;
        let changes = |hard: bool| -> f64 {
            let own = self.hard.iter().zip(self.levels);
            let own = own.filter(|(other, _)| **other == hard);
            own.map(|(_, levels)| levels.len() as f64).sum()
        };
        let plots = self.sizes.len() as f64;
        let tried = plots * changes(true) + self.options.runs as f64 * changes(false);
        let start = PASSES * tried * (terms.powi(3) + 4.0 * terms.powi(2));
        ((WORK / start) as usize).clamp(2, 200)
    }

    /// One start: random whole plots, each coordinate replaced by its best level until none is
    /// better; a hard factor changes in all runs of a plot.
    fn improved(&self, start: u64) -> State {
        let mut generator = generator(self.options.seed, STREAM + start);
        let mut state = self.random_state(&mut generator);
        for _ in 0..MOST_PASSES {
            let mut improved = false;
            for plot in 0..self.sizes.len() {
                for factor in 0..self.hard.len() {
                    if self.hard[factor] {
                        improved |= self.improve(&mut state, plot, None, factor);
                        continue;
                    }
                    for run in 0..self.sizes[plot] {
                        improved |= self.improve(&mut state, plot, Some(run), factor);
                    }
                }
            }
            if !improved {
                break;
            }
            // No rounding piles up.
            state.information = self.information(&state.plots);
        }
        state
    }

    fn random_state(&self, generator: &mut ChaCha8Rng) -> State {
        let mut plots = Vec::new();
        for size in &self.sizes {
            let first = self.random_point(generator);
            let mut plot = Vec::with_capacity(*size);
            for _ in 0..*size {
                let own = self.random_point(generator).into_iter().zip(&first);
                let own = own.zip(&self.hard);
                plot.push(
                    own.map(|((own, first), hard)| if *hard { *first } else { own })
                        .collect(),
                );
            }
            plots.push(plot);
        }
        let information = self.information(&plots);
        State {
            cost: self.cost(&information),
            plots,
            information,
        }
    }

    fn information(&self, plots: &[Vec<Vec<f64>>]) -> DMatrix<f64> {
        let terms = self.moments.nrows();
        let sum = DMatrix::zeros(terms, terms);
        plots.iter().fold(sum, |sum, plot| sum + self.of_plot(plot))
    }

    /// X'V⁻¹X of a whole plot: X'X less ratio/(1 + k·ratio) of its sums over the k runs.
    fn of_plot(&self, plot: &[Vec<f64>]) -> DMatrix<f64> {
        let terms = self.moments.nrows();
        let mut found = DMatrix::zeros(terms, terms);
        let mut sums = DVector::zeros(terms);
        for point in plot {
            let row = DVector::from_vec((self.row)(point));
            found.ger(1.0, &row, &row, 1.0);
            sums += row;
        }
        let ratio = self.options.ratio;
        found.ger(
            -ratio / (1.0 + plot.len() as f64 * ratio),
            &sums,
            &sums,
            1.0,
        );
        found
    }

    /// −ln |X'V⁻¹X|, or the mean variance of prediction; infinite for a singular design.
    fn cost(&self, information: &DMatrix<f64>) -> f64 {
        let terms = information.nrows();
        let mut information = information.clone();
        let ridge = RIDGE * information.trace() / terms as f64;
        (0..terms).for_each(|place| information[(place, place)] += ridge);
        let Some(factor) = information.cholesky() else {
            return f64::INFINITY;
        };
        match self.options.criterion {
            Criterion::D => {
                let diagonal = factor.l_dirty().diagonal();
                -2.0 * diagonal.iter().map(|own| own.ln()).sum::<f64>()
            }
            Criterion::I => factor.solve(&self.moments).trace(),
        }
    }

    /// Puts a factor of a run, or of all runs of a plot, on the best of its levels.
    fn improve(&self, state: &mut State, plot: usize, run: Option<usize>, factor: usize) -> bool {
        let others = &state.information - self.of_plot(&state.plots[plot]);
        let mut best: Option<(f64, Vec<Vec<f64>>, DMatrix<f64>)> = None;
        for level in &self.levels[factor] {
            let mut changed = state.plots[plot].clone();
            let runs = changed.iter_mut().enumerate();
            runs.filter(|(place, _)| run.is_none_or(|own| own == *place))
                .for_each(|(_, point)| point[factor] = *level);
            if changed == state.plots[plot] {
                continue;
            }
            let information = &others + self.of_plot(&changed);
            let cost = self.cost(&information);
            let least = best.as_ref().map_or(state.cost, |best| best.0);
            if cost < least - IMPROVEMENT * least.abs().max(1.0) {
                best = Some((cost, changed, information));
            }
        }
        let Some((cost, changed, information)) = best else {
            return false;
        };
        state.plots[plot] = changed;
        (state.cost, state.information) = (cost, information);
        true
    }
}

/// Whole plots with what they tell.
struct State {
    plots: Vec<Vec<Vec<f64>>>,
    information: DMatrix<f64>,
    cost: f64,
}
