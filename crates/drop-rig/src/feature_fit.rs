//! Least squares of measured features: estimates, what they are worth, and what
//! the features cannot tell.

use crate::coordinates::LawCoordinates;
use crate::feature_problem::{FeatureProblem, Linearised, Nuisance, linearise, nuisances};
use crate::information::{Information, information};
use nalgebra::{DMatrix, DVector};
use windfall_contact::laws::kind::Law;
use windfall_distribution::tail::{chi_squared_upper, chi_squared_upper_quantile};
use windfall_identify::error::Error;

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureFitOptions {
    /// Steps at most.
    pub steps: usize,
    /// Relative change of the cost that is not worth a step.
    pub tolerance: f64,
    /// Whether profile intervals are made.
    pub profile: bool,
    /// Level of intervals.
    pub confidence: f64,
}

impl Default for FeatureFitOptions {
    fn default() -> Self {
        Self {
            steps: 200,
            tolerance: 1e-10,
            profile: false,
            confidence: 0.95,
        }
    }
}

/// A free parameter as estimated; values with the coordinates' unit of length.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureEstimate {
    /// Its name.
    pub name: &'static str,
    /// Estimate.
    pub value: f64,
    /// Standard uncertainty; infinite where the features do not determine it.
    pub sd: f64,
    /// Ends of the profile interval, if requested; infinite where open.
    pub profile: Option<(f64, f64)>,
    /// −1, 0 or 1: at its lowest value, at none, at its highest.
    pub at_bound: i8,
}

/// A nuisance as estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NuisanceEstimate {
    /// What was known.
    pub nuisance: Nuisance,
    /// Estimate; SI.
    pub value: f64,
}

/// A law fitted to features.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureFit {
    /// The law.
    pub law: Law,
    /// Coordinates of its free parameters.
    pub at: Vec<f64>,
    /// The free parameters.
    pub parameters: Vec<FeatureEstimate>,
    /// What was estimated along.
    pub nuisances: Vec<NuisanceEstimate>,
    /// Nuisances in units of their uncertainty.
    pub shifts: Vec<f64>,
    /// Information of the features.
    pub information: Information,
    /// Factor by which uncertainties are wider than the features' own say, because
    /// they scatter more; 1 where they do not.
    pub widened: f64,
    /// Sum of squared residuals over their uncertainties.
    pub chi_square: f64,
    /// Features and priors less what was determined.
    pub freedom: usize,
    /// Probability of a sum as large by chance; `None` without freedom.
    pub p: Option<f64>,
    /// Features as the law has them, drop by drop.
    pub simulated: Vec<Vec<f64>>,
    /// Whether a minimum was reached.
    pub converged: bool,
    /// Evaluations of all features with derivatives.
    pub evaluations: usize,
}

/// Scatter this improbable widens the uncertainties.
const IMPROBABLE: f64 = 0.01;

/// Fits the free parameters of a law to measured features.
///
/// The covariance is that of Gauss and Newton: the inverse of the information with
/// masses, heights and plate estimated along.
///
/// * `starts`: coordinates to start from; the best end is taken
///
/// # Errors
/// No start can be simulated.
pub fn fit_features(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    starts: &[Vec<f64>],
    options: &FeatureFitOptions,
) -> Result<FeatureFit, Error> {
    let nuisances = nuisances(problem);
    let search = Search {
        problem,
        coordinates,
        nuisances: &nuisances,
        options,
    };
    let mut best: Option<Minimum> = None;
    let mut failed = None;
    let mut evaluations = 0;
    for start in starts {
        match search.minimise(start, None) {
            Ok(found) => {
                evaluations += found.evaluations;
                if best.as_ref().is_none_or(|best| found.cost < best.cost) {
                    best = Some(found);
                }
            }
            Err(error) => failed = Some(error),
        }
    }
    let best = match (best, failed) {
        (Some(best), _) => best,
        (None, Some(error)) => return Err(error),
        (None, None) => {
            let law = coordinates.kind.name();
            return Err(Error::NoStart { law });
        }
    };
    let mut fit = search.report(&best)?;
    fit.evaluations = evaluations;
    if options.profile {
        search.profile(&best, &mut fit);
    }
    Ok(fit)
}

/// How much smaller the cost would be after a step if residuals were linear.
fn promised(linearised: &Linearised, step: &DVector<f64>) -> f64 {
    let free = linearised.by_law.ncols();
    let moved = &linearised.by_law * step.rows(0, free)
        + &linearised.by_nuisance * step.rows(free, step.len() - free);
    linearised.residuals.norm_squared() - (&linearised.residuals + moved).norm_squared()
}

struct Search<'a> {
    problem: &'a FeatureProblem,
    coordinates: &'a LawCoordinates,
    nuisances: &'a [Nuisance],
    options: &'a FeatureFitOptions,
}

struct Minimum {
    at: Vec<f64>,
    shifts: Vec<f64>,
    linearised: Linearised,
    cost: f64,
    converged: bool,
    evaluations: usize,
}

impl Search<'_> {
    fn evaluate(&self, at: &[f64], shifts: &[f64]) -> Result<Linearised, Error> {
        linearise(self.problem, self.coordinates, self.nuisances, (at, shifts))
    }

    /// Levenberg-Marquardt with limits; one coordinate may be held.
    fn minimise(&self, start: &[f64], held: Option<usize>) -> Result<Minimum, Error> {
        let mut at: Vec<f64> = start.to_vec();
        self.clamp(&mut at);
        let mut shifts = vec![0.0; self.nuisances.len()];
        let mut linearised = self.evaluate(&at, &shifts)?;
        let mut cost = linearised.residuals.norm_squared();
        let (mut damping, mut evaluations, mut converged) = (1e-3, 1, false);
        for _ in 0..self.options.steps {
            let step = self.step(&linearised, &at, held, damping);
            // What the linear model still promises is nothing: no need to try it.
            if promised(&linearised, &step) <= self.options.tolerance * cost.max(1e-9) {
                converged = true;
                break;
            }
            let free = at.len();
            let mut moved: Vec<f64> = (0..free).map(|i| at[i] + step[i]).collect();
            self.clamp(&mut moved);
            let tried: Vec<f64> = (0..shifts.len())
                .map(|i| shifts[i] + step[free + i])
                .collect();
            let found = self.evaluate(&moved, &tried);
            evaluations += 1;
            let better = found
                .ok()
                .map(|found| (found.residuals.norm_squared(), found))
                .filter(|(new, _)| *new <= cost);
            let small = step.amax() < 1e-9;
            match better {
                Some((new, found)) => {
                    (at, shifts, linearised) = (moved, tried, found);
                    damping = (damping * 0.1).max(1e-14);
                    cost = new;
                }
                None if small || damping > 1e12 => {
                    converged = small;
                    break;
                }
                None => damping *= 10.0,
            }
        }
        Ok(Minimum {
            at,
            shifts,
            linearised,
            cost,
            converged,
            evaluations,
        })
    }

    fn clamp(&self, at: &mut [f64]) {
        for (value, free) in at.iter_mut().zip(&self.coordinates.free) {
            *value = value.clamp(free.low, free.high);
        }
    }

    /// Damped Gauss-Newton step of coordinates and nuisances; what is held, or
    /// would leave its limits, stays.
    fn step(
        &self,
        linearised: &Linearised,
        at: &[f64],
        held: Option<usize>,
        damping: f64,
    ) -> DVector<f64> {
        let (free, rows) = (at.len(), linearised.residuals.len());
        let count = free + self.nuisances.len();
        let mut still: Vec<bool> = (0..count).map(|place| held == Some(place)).collect();
        loop {
            let mut all = DMatrix::zeros(rows + count, count);
            let mut right = DVector::zeros(rows + count);
            right.rows_mut(0, rows).copy_from(&-&linearised.residuals);
            for column in (0..count).filter(|column| !still[*column]) {
                let own = match column < free {
                    true => linearised.by_law.column(column),
                    false => linearised.by_nuisance.column(column - free),
                };
                all.view_mut((0, column), (rows, 1)).copy_from(&own);
            }
            for column in 0..count {
                let norm = all.column(column).norm();
                all[(rows + column, column)] = match still[column] || norm == 0.0 {
                    true => 1.0,
                    false => damping.sqrt() * norm,
                };
            }
            let decomposed = all.qr();
            let mut rotated = right;
            decomposed.q_tr_mul(&mut rotated);
            let top = rotated.rows(0, count).into_owned();
            let mut step = decomposed
                .r()
                .solve_upper_triangular(&top)
                .unwrap_or_else(|| DVector::zeros(count));
            (0..count).for_each(|i| step[i] = if still[i] { 0.0 } else { step[i] });
            let leaving = (0..free).find(|place| {
                let limits = &self.coordinates.free[*place];
                let low = at[*place] <= limits.low && step[*place] < 0.0;
                let high = at[*place] >= limits.high && step[*place] > 0.0;
                !still[*place] && (low || high)
            });
            match leaving {
                Some(place) => still[place] = true,
                None => return step,
            }
        }
    }

    fn report(&self, best: &Minimum) -> Result<FeatureFit, Error> {
        let told = information(&best.linearised);
        let measured = best.linearised.features + self.problem.priors.len();
        let freedom = measured.saturating_sub(told.rank);
        let p = (freedom > 0).then(|| chi_squared_upper(best.cost, freedom as f64));
        let widened = match p {
            Some(p) if p < IMPROBABLE => (best.cost / freedom as f64).sqrt(),
            _ => 1.0,
        };
        let written = self.coordinates.written(&best.at);
        let names = self.coordinates.names();
        let parameters = (0..best.at.len()).map(|place| {
            let limits = &self.coordinates.free[place];
            let sd = told
                .covariance
                .as_ref()
                .map_or(f64::INFINITY, |c| widened * c[(place, place)].sqrt());
            FeatureEstimate {
                name: names[place],
                value: written[place],
                sd: self.coordinates.sd_of_value(place, written[place], sd),
                profile: None,
                at_bound: i8::from(best.at[place] >= limits.high)
                    - i8::from(best.at[place] <= limits.low),
            }
        });
        let estimates = self.nuisances.iter().zip(&best.shifts);
        Ok(FeatureFit {
            law: self.coordinates.law_at(&best.at)?,
            parameters: parameters.collect(),
            nuisances: estimates
                .map(|(nuisance, shift)| NuisanceEstimate {
                    nuisance: *nuisance,
                    value: nuisance.known.value + nuisance.known.sd * shift,
                })
                .collect(),
            at: best.at.clone(),
            shifts: best.shifts.clone(),
            information: told,
            widened,
            chi_square: best.cost,
            freedom,
            p,
            simulated: best.linearised.simulated.clone(),
            converged: best.converged,
            evaluations: best.evaluations,
        })
    }

    /// Profile intervals: how far a parameter can go, with all others at their
    /// best, before χ² has grown by what chance allows.
    fn profile(&self, best: &Minimum, fit: &mut FeatureFit) {
        let chance = chi_squared_upper_quantile(1.0 - self.options.confidence, 1.0);
        let allowed = chance * fit.widened * fit.widened;
        for place in 0..best.at.len() {
            let sd = fit
                .information
                .covariance
                .as_ref()
                .map_or(1.0, |c| fit.widened * c[(place, place)].sqrt());
            let end = |side: f64| {
                self.profile_end(best, place, side * sd, allowed)
                    .map_or(side * f64::INFINITY, |at| at)
            };
            let (low, high) = (end(-1.0), end(1.0));
            let written = |value: f64| {
                let mut at = best.at.clone();
                at[place] = value;
                self.coordinates.written(&at)[place]
            };
            fit.parameters[place].profile = Some((written(low), written(high)));
        }
    }

    /// Coordinate at which the profile has grown by `allowed`; `None` where it never
    /// does within the limits.
    fn profile_end(&self, best: &Minimum, place: usize, sd: f64, allowed: f64) -> Option<f64> {
        let limits = &self.coordinates.free[place];
        let mut start = best.at.clone();
        let mut grown = |value: f64| -> Option<f64> {
            let mut from = start.clone();
            from[place] = value;
            let found = self.minimise(&from, Some(place)).ok()?;
            start.clone_from(&found.at);
            Some(found.cost - best.cost - allowed)
        };
        let (mut inside, mut below) = (best.at[place], -allowed);
        let mut step = 2.0 * sd;
        for _ in 0..12 {
            let value = (inside + step).clamp(limits.low, limits.high);
            let above = grown(value)?;
            if above >= 0.0 {
                // Secant on the root of χ², which is nearly straight.
                let (mut low, mut high) = ((inside, below), (value, above));
                for _ in 0..40 {
                    let root = |grown: f64| (grown + allowed).max(0.0).sqrt() - allowed.sqrt();
                    let (a, b) = (root(low.1), root(high.1));
                    let part = (-a / (b - a)).clamp(0.05, 0.95);
                    let middle = low.0 + part * (high.0 - low.0);
                    let found = grown(middle)?;
                    if found.abs() < 1e-6 * allowed || (high.0 - low.0).abs() < 1e-9 {
                        return Some(middle);
                    }
                    match found < 0.0 {
                        true => low = (middle, found),
                        false => high = (middle, found),
                    }
                }
                return Some(0.5 * (low.0 + high.0));
            }
            if value == limits.low || value == limits.high {
                return None;
            }
            (inside, below) = (value, above);
            step *= 1.6;
        }
        None
    }
}
