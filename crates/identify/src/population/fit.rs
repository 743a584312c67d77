//! Nonlinear mixed effects: the impacts of many fruit → the population.

use crate::error::Error;
use crate::population::design::{Design, design};
use crate::population::linear::{LinearProblem, Mode};
use crate::population::model::{
    Approximation, Expand, Expansion, PopulationData, PopulationFit, PopulationOptions,
};
use crate::population::optimum::{Optimum, optimise};
use crate::population::report::report;
use crate::population::state::{SETTLED, State};
use crate::population::variance::{Factor, Structure, Variances, order_with};
use nalgebra::{DVector, SMatrix, SVector};
use std::f64::consts::TAU;

/// Parameters that vary between fruit.
pub const LARGEST_POPULATION: usize = 4;
/// Change of the estimates, in standard errors, at which nothing is left to
/// gain from smooth likelihoods.
const SMOOTH: f64 = 1e-5;
/// Largest step of a mode from where its impact was last expanded, in standard
/// errors of the impact; beyond, the impact is expanded on the way.
const REACH: f64 = 5.0;
/// Smallest standard deviation at the start, in units of the overall one.
const LEAST: f64 = 1e-3;
/// Smallest variance of a mode, as a share of the impact's own, over which the
/// change of its expansion is measured.
const SHORTEST: f64 = 1e-4;

/// Estimates the population of which `data` are members.
///
/// * `starts`: φ of each impact where its own likelihood is largest
/// * `expand`: expansions of all impacts' log-likelihoods; the caller may use
///   any number of threads
///
/// # Numerics
/// First-order conditional estimation: each impact's likelihood is expanded to
/// second order at its most probable φ, the linear mixed model of the expansions
/// is solved exactly, and so on until the modes settle. Then the derivative of
/// the expansions' determinants by the mode, which the first order leaves out
/// of the Laplace approximation, is added: it shifts each impact's observation
/// by V r, r_k = −½ tr(S ∂H/∂φ_k), with S the covariance of its mode. The
/// determinants use Gauss-Newton second derivatives.
///
/// # Errors
/// [`Error::FewMembers`], [`Error::ManyParameters`], [`Error::BadCovariate`],
/// [`Error::NoPopulation`].
///
/// # Source
/// Lindstrom and Bates (1990), Biometrics 46:673; Wolfinger (1993), Biometrika
/// 80:791, for the Laplace approximation; Wang (2007), J. Pharmacokinet.
/// Pharmacodyn. 34:575, for how first-order methods derive from it.
pub fn fit_population(
    data: &PopulationData,
    starts: &[Vec<f64>],
    expand: &Expand,
    options: &PopulationOptions,
) -> Result<PopulationFit, Error> {
    match data.parameters.len() {
        1 => fit::<1>(data, starts, expand, options),
        2 => fit::<2>(data, starts, expand, options),
        3 => fit::<3>(data, starts, expand, options),
        4 => fit::<4>(data, starts, expand, options),
        asked => Err(Error::ManyParameters {
            asked,
            most: LARGEST_POPULATION,
        }),
    }
}

fn fit<const Q: usize>(
    data: &PopulationData,
    starts: &[Vec<f64>],
    expand: &Expand,
    options: &PopulationOptions,
) -> Result<PopulationFit, Error> {
    let none = || Error::NoPopulation;
    check_covariates(data)?;
    let fruits = data.fruit.iter().max().map_or(0, |most| most + 1);
    let mut order: Vec<usize> = (0..data.fruit.len()).collect();
    order.sort_by_key(|&i| data.fruit[i]);
    let groups: Vec<_> = order
        .chunk_by(|&a, &b| data.fruit[a] == data.fruit[b])
        .collect();
    let design = design(data, &order);
    let needed = design.columns + 1;
    if groups.len() < 2 || groups.len() != fruits || order.len() < needed {
        return Err(Error::FewMembers {
            fruits: groups.len(),
            impacts: order.len(),
            needed,
        });
    }
    let single = groups.iter().all(|group| group.len() == 1);
    let mut first = 0;
    let ranges = groups.iter().map(|group| {
        first += group.len();
        first - group.len()..first
    });
    let ranges = ranges.collect();

    let in_order = order.clone();
    let mut looker = Looker::new(starts, &in_order, expand);
    let problem = LinearProblem::<Q> {
        fruit: ranges,
        columns: design.columns,
        design: design.rows.clone(),
        observed: Vec::new(),
        noise: Vec::new(),
        likelihood: options.likelihood,
    };
    let problem = looker.observed(&problem).ok_or_else(none)?;
    let fitted_level = looker.level();
    let variances = variances(&problem, options, single);
    let start = start(&problem, &variances);
    let fits = optimise(&problem, variances, &start).ok_or_else(none)?;

    let mut state =
        iterate(problem, fits.clone(), &mut looker, options, (order, design)).ok_or_else(none)?;
    state.single = single;
    state.not_quadratic = looker.level() - fitted_level;
    let first_order = state.optimum.clone();
    let unshifted = state.problem.clone();
    if options.approximation == Approximation::Laplace {
        second_order(&mut state, &looker).ok_or_else(none)?;
    }
    state.shift_from_first_order = shift(&first_order, &state.optimum);
    state.shift_from_fits = shift(&fits, &state.optimum);
    Ok(report(data, &state, &unshifted, options))
}

fn check_covariates(data: &PopulationData) -> Result<(), Error> {
    for covariate in &data.covariates {
        let mut values = covariate.values.iter().enumerate();
        if let Some((impact, value)) = values.find(|(_, value)| !value.is_finite()) {
            return Err(Error::BadCovariate {
                covariate: covariate.name.clone(),
                impact,
                value: *value,
            });
        }
    }
    Ok(())
}

/// Asks for expansions and keeps the last good one of each impact.
struct Looker<'a, 'b, const Q: usize> {
    order: &'a [usize],
    expand: &'a Expand<'b>,
    at: Vec<SVector<f64, Q>>,
    known: Vec<Option<Known<Q>>>,
    not_followed: usize,
}

/// An expansion that can be used.
#[derive(Clone, Copy)]
struct Known<const Q: usize> {
    at: SVector<f64, Q>,
    observed: SVector<f64, Q>,
    noise: SMatrix<f64, Q, Q>,
    curvature: SMatrix<f64, Q, Q>,
    level: f64,
}

impl<'a, 'b, const Q: usize> Looker<'a, 'b, Q> {
    fn new(starts: &[Vec<f64>], order: &'a [usize], expand: &'a Expand<'b>) -> Self {
        let at = order.iter().map(|&i| SVector::from_fn(|a, _| starts[i][a]));
        Self {
            order,
            expand,
            at: at.collect(),
            known: vec![None; order.len()],
            not_followed: 0,
        }
    }

    /// Expansions at `at`, in the order of the fruit.
    fn look(&self, at: &[SVector<f64, Q>]) -> Vec<Option<Known<Q>>> {
        let mut points = vec![Vec::new(); at.len()];
        for (&i, at) in self.order.iter().zip(at) {
            points[i] = at.as_slice().to_vec();
        }
        let found = (self.expand)(&points);
        let own = self.order.iter().zip(at);
        own.map(|(&i, at)| known(at, found.get(i)?.as_ref()?))
            .collect()
    }

    /// The problem with observations from expansions at the current points.
    fn observed(&mut self, problem: &LinearProblem<Q>) -> Option<LinearProblem<Q>> {
        let found = self.look(&self.at);
        self.not_followed = 0;
        for (known, found) in self.known.iter_mut().zip(found) {
            match found {
                Some(found) => *known = Some(found),
                None => self.not_followed += 1,
            }
        }
        let known: Option<Vec<Known<Q>>> = self.known.iter().copied().collect();
        let known = known?;
        Some(LinearProblem {
            observed: known.iter().map(|k| k.observed).collect(),
            noise: known.iter().map(|k| k.noise).collect(),
            ..problem.clone()
        })
    }

    fn level(&self) -> f64 {
        self.known.iter().flatten().map(|known| known.level).sum()
    }

    /// Goes to the modes, or as far towards them as the expansions reach.
    fn follow(&mut self, modes: &[Mode<Q>]) {
        for ((at, known), mode) in self.at.iter_mut().zip(&self.known).zip(modes) {
            let Some(known) = known else { continue };
            let way = mode.value - *at;
            let length = way.dot(&(known.curvature * way)).max(0.0).sqrt();
            *at += way * (REACH / length).min(1.0);
        }
    }
}

fn known<const Q: usize>(at: &SVector<f64, Q>, expansion: &Expansion) -> Option<Known<Q>> {
    let curvature = SMatrix::<f64, Q, Q>::from_fn(|a, b| expansion.curvature[a][b]);
    let gradient = SVector::<f64, Q>::from_fn(|a, _| expansion.gradient[a]);
    let factor = curvature.cholesky()?;
    let noise = factor.inverse();
    let step = noise * gradient;
    let log_determinant: f64 = 2.0 * (0..Q).map(|i| factor.l_dirty()[(i, i)].ln()).sum::<f64>();
    let level =
        expansion.value + 0.5 * gradient.dot(&step) + 0.5 * (Q as f64 * TAU.ln() - log_determinant);
    let finite = level.is_finite() && step.iter().all(|s| s.is_finite());
    finite.then_some(Known {
        at: *at,
        observed: at + step,
        noise,
        curvature,
        level,
    })
}

/// The covariance matrices' parameters, in units of the observations' spread.
fn variances<const Q: usize>(
    problem: &LinearProblem<Q>,
    options: &PopulationOptions,
    single: bool,
) -> Variances<Q> {
    let n = problem.observed.len() as f64;
    let mean = problem.observed.iter().sum::<SVector<f64, Q>>() / n;
    let square = problem.observed.iter().map(|z| (z - mean).map(|d| d * d));
    let square = square.sum::<SVector<f64, Q>>() / n;
    let noise = problem
        .noise
        .iter()
        .map(|v| v.diagonal())
        .sum::<SVector<f64, Q>>()
        / n;
    // Identical impacts still have the unit of their noise.
    let scale = SVector::from_fn(|a, _| square[a].max(noise[a]).max(f64::MIN_POSITIVE).sqrt());
    let factor = |structure| Factor {
        structure,
        scale,
        order: order_with(&[]),
    };
    Variances {
        between: factor(options.between),
        within: factor(if single {
            Structure::Zero
        } else {
            options.within
        }),
    }
}

/// A start from which both variations can grow and shrink.
fn start<const Q: usize>(problem: &LinearProblem<Q>, variances: &Variances<Q>) -> DVector<f64> {
    let scale = variances.between.scale;
    let between = SMatrix::from_diagonal(&scale.map(|s| 0.6 * s * s));
    let noise = problem
        .noise
        .iter()
        .map(|v| v.diagonal())
        .sum::<SVector<f64, Q>>();
    let noise = noise / problem.noise.len() as f64;
    let within = SVector::from_fn(|a, _| (0.1 * scale[a] * scale[a]).max(0.5 * noise[a]));
    variances.parameters(&between, &SMatrix::from_diagonal(&within), LEAST)
}

fn iterate<const Q: usize>(
    mut problem: LinearProblem<Q>,
    mut optimum: Optimum<Q>,
    looker: &mut Looker<Q>,
    options: &PopulationOptions,
    (order, design): (Vec<usize>, Design),
) -> Option<State<Q>> {
    let mut iterations = 0;
    let mut change = f64::INFINITY;
    loop {
        let modes = problem.modes(&optimum.root, &optimum.within, &optimum.value.effects)?;
        looker.follow(&modes);
        iterations += 1;
        problem = looker.observed(&problem)?;
        let next = optimise(&problem, optimum.variances, &optimum.minimum.at)?;
        let before = std::mem::replace(&mut change, shift(&optimum, &next));
        optimum = next;
        // Likelihoods of samples are not quite smooth: where their kinks keep
        // the modes moving, the changes of the estimates stop to fall.
        let rough = change < SETTLED && change > 0.5 * before;
        if change < SMOOTH || rough || iterations >= options.max_iterations {
            break;
        }
    }
    let modes = problem.modes(&optimum.root, &optimum.within, &optimum.value.effects)?;
    Some(State {
        order,
        design,
        problem,
        optimum,
        modes,
        not_quadratic: 0.0,
        shift_from_fits: 0.0,
        shift_from_first_order: 0.0,
        change,
        iterations,
        not_followed: looker.not_followed,
        single: false,
    })
}

/// Shifts the observations by what the determinants' dependence on the modes
/// requires, and estimates again.
fn second_order<const Q: usize>(state: &mut State<Q>, looker: &Looker<Q>) -> Option<()> {
    let mut slopes = vec![SVector::<f64, Q>::zeros(); state.modes.len()];
    for k in 0..Q {
        let step = |i: usize| {
            let (own, noise) = (&state.modes[i].covariance, &state.problem.noise[i]);
            own[(k, k)].max(SHORTEST * noise[(k, k)]).sqrt()
        };
        let shifted = |side: f64| -> Vec<SVector<f64, Q>> {
            let modes = state.modes.iter().enumerate();
            modes
                .map(|(i, mode)| {
                    let mut at = mode.value;
                    at[k] += side * step(i);
                    at
                })
                .collect()
        };
        let (up, down) = (looker.look(&shifted(1.0)), looker.look(&shifted(-1.0)));
        for (i, slope) in slopes.iter_mut().enumerate() {
            if let (Some(up), Some(down)) = (&up[i], &down[i]) {
                let change = (up.curvature - down.curvature) / (up.at[k] - down.at[k]);
                slope[k] = -0.5 * (state.modes[i].covariance * change).trace();
            }
        }
    }
    let mut problem = state.problem.clone();
    for (i, slope) in slopes.iter().enumerate() {
        // A shift of more than a standard error is beyond the approximation.
        let length = slope.dot(&(problem.noise[i] * slope)).sqrt();
        if length.is_finite() {
            problem.observed[i] += problem.noise[i] * slope / length.max(1.0);
        }
    }
    let optimum = optimise(&problem, state.optimum.variances, &state.optimum.minimum.at)?;
    state.modes = problem.modes(&optimum.root, &optimum.within, &optimum.value.effects)?;
    state.problem = problem;
    state.optimum = optimum;
    Some(())
}

/// Largest difference of two estimates, in standard errors of the second: fixed
/// effects, and logarithms of the standard deviations (1/√(2 fruit) each).
fn shift<const Q: usize>(one: &Optimum<Q>, other: &Optimum<Q>) -> f64 {
    let mut largest: f64 = 0.0;
    for k in 0..other.value.effects.len() {
        let se = other.value.covariance[(k, k)].sqrt();
        largest = largest.max((one.value.effects[k] - other.value.effects[k]).abs() / se);
    }
    let moved = &one.minimum.at - &other.minimum.at;
    let half = 0.5 * moved.dot(&(&other.minimum.hessian * &moved));
    largest.max(half.max(0.0).sqrt())
}
