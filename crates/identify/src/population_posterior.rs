//! Posterior distribution of a population, by the no-U-turn sampler: the check of
//! what [`fit_population`](crate::population_fit::fit_population) approximates.

use crate::error::Error;
use crate::interval::{Mixing, quantile};
use crate::population::{
    Expand, PopulationData, PopulationFit, PopulationOptions, Structure, Variation,
};
use crate::posterior::mixing;
use crate::sampler::{Drawing, LogDensity, draw_chains};
use nalgebra::{DMatrix, DVector};

/// Smallest standard deviation at the start, as a share of what varies least.
const LEAST: f64 = 0.05;

/// How much is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PopulationDrawing {
    /// Chains.
    pub chains: usize,
    /// Kept draws of each.
    pub draws: usize,
    /// Seed of all of them.
    pub seed: u64,
}

/// A quantity as its draws tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosteriorRange {
    /// Median.
    pub median: f64,
    /// Lower end of the interval between quantiles.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// How well the chains mix.
    pub mixing: Mixing,
}

/// Variation at one level.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PosteriorVariation {
    /// Standard deviations; empty where the level does not vary.
    pub sds: Vec<PosteriorRange>,
    /// Correlations of the pairs (0, 1), (0, 2), (1, 2), …; empty where there are
    /// none.
    pub correlations: Vec<PosteriorRange>,
}

/// The posterior of a population.
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationPosterior {
    /// Fixed effects, in the order of [`PopulationFit::effects`].
    pub effects: Vec<PosteriorRange>,
    /// Between fruit.
    pub between: PosteriorVariation,
    /// Of the impacts of one fruit.
    pub within: PosteriorVariation,
    /// What was drawn.
    pub drawing: PopulationDrawing,
    /// Draws at which the sampler diverged.
    pub divergences: usize,
}

impl PopulationPosterior {
    /// Every quantity.
    pub fn ranges(&self) -> impl Iterator<Item = &PosteriorRange> {
        let levels = [&self.between, &self.within];
        let varying = levels
            .into_iter()
            .flat_map(|level| level.sds.iter().chain(&level.correlations));
        self.effects.iter().chain(varying)
    }
}

/// Draws the posterior of the population that `fit` estimated from `data`: of the
/// fixed effects and both covariance matrices, with the parameters of every fruit
/// and of every impact drawn beside them. No likelihood is approximated but by
/// `expand` itself. Without variation within fruit (each has one impact) the
/// impacts have the parameters of their fruit.
///
/// Priors: flat in the fixed effects and in the standard deviations, uniform in
/// the correlation matrices.
///
/// * `expand`: as for the fit; value and gradient are used
///
/// # Errors
/// [`Error::NoPopulation`] where fruit are told not to vary, or where no chain can
/// be started.
///
/// # Source
/// Gelman (2006), Bayesian Anal. 1:515, for flat standard deviations; Joe (2006),
/// J. Multivar. Anal. 97:2177, for uniform correlation matrices.
pub fn population_posterior(
    data: &PopulationData,
    fit: &PopulationFit,
    expand: &Expand,
    options: &PopulationOptions,
    drawing: &PopulationDrawing,
) -> Result<PopulationPosterior, Error> {
    let hierarchy = Hierarchy::new(data, fit, expand, options).ok_or(Error::NoPopulation)?;
    let mut drawn = vec![Vec::new(); hierarchy.quantities()];
    let plan = Drawing {
        chains: drawing.chains,
        draws: drawing.draws,
        seed: drawing.seed,
    };
    // The chains start around the estimate, some of its uncertainty away.
    let start = |chain: usize| {
        let sign = if chain.is_multiple_of(2) { 1.0 } else { -1.0 };
        let at = |i: usize| match i < hierarchy.fruit_from && i % 3 == chain / 2 % 3 {
            true => sign,
            false => 0.0,
        };
        (0..hierarchy.size()).map(at).collect()
    };
    let divergences = draw_chains(&hierarchy, &plan, start, |z| {
        for (all, value) in drawn.iter_mut().zip(hierarchy.told(z)) {
            all.push(value);
        }
    });
    let divergences = divergences.ok_or(Error::NoPopulation)?;
    let tail = 0.5 * (1.0 - options.confidence);
    let mut ranges = drawn.into_iter().map(|mut all| PosteriorRange {
        mixing: mixing(&all, drawing.draws),
        median: quantile(&mut all, 0.5),
        low: quantile(&mut all, tail),
        high: quantile(&mut all, 1.0 - tail),
    });
    let mut next = |count: usize| ranges.by_ref().take(count).collect::<Vec<_>>();
    let size = fit.parameters.len();
    let effects = next(fit.effects.len());
    let mut variation = |level: Option<&Level>| match level {
        None => PosteriorVariation::default(),
        Some(level) => PosteriorVariation {
            sds: next(size),
            correlations: next(level.pairs()),
        },
    };
    Ok(PopulationPosterior {
        effects,
        between: variation(Some(&hierarchy.between)),
        within: variation(hierarchy.within.as_ref()),
        drawing: *drawing,
        divergences,
    })
}

/// One covariance matrix S = L Lᵀ. Coordinates: ln L_ii, then L_ij in units of
/// the i-th standard deviation of the fit, row by row.
struct Level {
    size: usize,
    full: bool,
    /// Standard deviations of the fit.
    scale: Vec<f64>,
    /// L of the fit.
    centre: DMatrix<f64>,
    /// Members, whose number tells how well deviations are known.
    members: f64,
}

impl Level {
    fn new(variation: &Variation, structure: Structure, members: usize) -> Option<Self> {
        let size = variation.sds.len();
        let largest = variation.sds.iter().map(|s| s.value).fold(0.0, f64::max);
        if structure == Structure::Zero || largest == 0.0 {
            return None;
        }
        let scale: Vec<f64> = variation
            .sds
            .iter()
            .map(|s| s.value.max(LEAST * largest))
            .collect();
        // Where the fit ends at a bound its matrix is singular: less correlated,
        // it is a place to start from.
        let covariance = DMatrix::from_fn(size, size, |i, j| match i == j {
            true => scale[i] * scale[i],
            false => 0.9 * variation.covariance[i][j],
        });
        Some(Self {
            size,
            full: structure == Structure::Full,
            centre: covariance.cholesky()?.l(),
            scale,
            members: members as f64,
        })
    }

    fn pairs(&self) -> usize {
        match self.full {
            true => self.size * (self.size - 1) / 2,
            false => 0,
        }
    }

    fn count(&self) -> usize {
        self.size + self.pairs()
    }

    /// Positions below the diagonal.
    fn below(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = if self.full { self.size } else { 0 };
        (0..rows).flat_map(|i| (0..i).map(move |j| (i, j)))
    }

    fn root(&self, z: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.size, self.size);
        for i in 0..self.size {
            out[(i, i)] = self.centre[(i, i)] * (z[i] / (2.0 * self.members).sqrt()).exp();
        }
        for ((i, j), z) in self.below().zip(&z[self.size..]) {
            out[(i, j)] = self.centre[(i, j)] + self.scale[i] * z / self.members.sqrt();
        }
        out
    }

    /// Logarithm of the prior's density in the coordinates, and the gradient of
    /// that and of `by_root` by them.
    fn prior(&self, root: &DMatrix<f64>, by_root: &DMatrix<f64>, gradient: &mut [f64]) -> f64 {
        let mut by_root = by_root.clone();
        let mut density = 0.0;
        for i in 0..self.size {
            // dS = 2^Q Π L_ii^(Q−i) dL (i from 0), and flat standard deviations
            // with uniform correlations are Π σ_i^(−Q) dS.
            let rank = if self.full { self.size as f64 } else { 1.0 };
            let power = if self.full {
                (self.size - i) as f64
            } else {
                1.0
            };
            let row = root.row(i);
            let variance = row.dot(&row);
            density -= 0.5 * rank * variance.ln();
            for j in 0..=i {
                by_root[(i, j)] -= rank * row[j] / variance;
            }
            // One more for dL_ii = L_ii d ln L_ii.
            density += (power + 1.0) * root[(i, i)].ln();
            by_root[(i, i)] += (power + 1.0) / root[(i, i)];
        }
        for i in 0..self.size {
            gradient[i] = by_root[(i, i)] * root[(i, i)] / (2.0 * self.members).sqrt();
        }
        for (k, (i, j)) in self.below().enumerate() {
            gradient[self.size + k] = by_root[(i, j)] * self.scale[i] / self.members.sqrt();
        }
        density
    }

    /// Standard deviations and correlations.
    fn told(&self, root: &DMatrix<f64>) -> Vec<f64> {
        let covariance = root * root.transpose();
        let sd = |i: usize| covariance[(i, i)].sqrt();
        let mut out: Vec<f64> = (0..self.size).map(sd).collect();
        if self.full {
            let pairs = (0..self.size).flat_map(|k| (k + 1..self.size).map(move |l| (k, l)));
            out.extend(pairs.map(|(k, l)| covariance[(k, l)] / (sd(k) * sd(l))));
        }
        out
    }
}

/// Log-density of deviations `r` of which each is N(0, L Lᵀ), with what its
/// derivatives are made of.
struct Normal<'a> {
    root: &'a DMatrix<f64>,
    by_root: DMatrix<f64>,
    density: f64,
}

impl<'a> Normal<'a> {
    fn new(root: &'a DMatrix<f64>) -> Self {
        Self {
            root,
            by_root: DMatrix::zeros(root.nrows(), root.ncols()),
            density: 0.0,
        }
    }

    /// Adds one deviation; returns S⁻¹ r, minus the gradient by it.
    fn add(&mut self, mut r: DVector<f64>) -> Option<DVector<f64>> {
        if !self.root.solve_lower_triangular_mut(&mut r) {
            return None;
        }
        let mut pull = r.clone();
        if !self.root.tr_solve_lower_triangular_mut(&mut pull) {
            return None;
        }
        self.density -= 0.5 * r.dot(&r);
        self.by_root += &pull * r.transpose();
        for i in 0..r.len() {
            self.density -= self.root[(i, i)].ln();
            self.by_root[(i, i)] -= 1.0 / self.root[(i, i)];
        }
        Some(pull)
    }
}

/// The whole model: coordinates are those of the effects, of the covariance
/// matrices, of each fruit and of each impact, in units of their uncertainty.
struct Hierarchy<'a, 'b> {
    fit: &'a PopulationFit,
    expand: &'a Expand<'b>,
    fruit: &'a [usize],
    /// Covariates of each impact less their centres.
    covariates: Vec<Vec<f64>>,
    between: Level,
    within: Option<Level>,
    /// Unit of a fruit's and of an impact's coordinates.
    fruit_unit: Vec<DMatrix<f64>>,
    impact_unit: Vec<DMatrix<f64>>,
    /// First coordinate of the fruit.
    fruit_from: usize,
}

impl<'a, 'b> Hierarchy<'a, 'b> {
    fn new(
        data: &'a PopulationData,
        fit: &'a PopulationFit,
        expand: &'a Expand<'b>,
        options: &PopulationOptions,
    ) -> Option<Self> {
        let size = fit.parameters.len();
        let fruits = fit.fruit.len();
        let mut impacts = vec![0; fruits];
        for &fruit in &data.fruit {
            impacts[fruit] += 1;
        }
        let between = Level::new(&fit.between, options.between, fruits)?;
        let single = impacts.iter().all(|&n| n == 1);
        let within = match single {
            true => None,
            false => {
                let spare = data.fruit.len() - fruits;
                Some(Level::new(&fit.within, options.within, spare.max(1))?)
            }
        };
        let inverse = |level: &Level| {
            let root = &level.centre;
            (root * root.transpose()).try_inverse()
        };
        let between_inverse = inverse(&between)?;
        let within_inverse = match &within {
            Some(level) => inverse(level)?,
            None => DMatrix::zeros(size, size),
        };
        let noise = curvatures(&expand(&fit.impacts), size)?;
        let unit = |information: DMatrix<f64>| Some(information.try_inverse()?.cholesky()?.l());
        let mut known = vec![between_inverse; fruits];
        for (&fruit, noise) in data.fruit.iter().zip(&noise) {
            // What an impact tells of its fruit.
            known[fruit] += match &within {
                Some(level) => {
                    let root = &level.centre;
                    let spread = root * root.transpose() + noise.clone().try_inverse()?;
                    spread.try_inverse()?
                }
                None => noise.clone(),
            };
        }
        let impact_unit: Option<Vec<_>> = match within {
            Some(_) => noise
                .into_iter()
                .map(|n| unit(n + &within_inverse))
                .collect(),
            None => Some(Vec::new()),
        };
        let covariates = fit.covariates.iter().map(|(name, centre)| {
            let all = data.covariates.iter().find(|c| c.name == *name)?;
            Some(all.values.iter().map(|value| value - centre).collect())
        });
        let matrices = between.count() + within.as_ref().map_or(0, Level::count);
        Some(Self {
            fit,
            expand,
            fruit: &data.fruit,
            covariates: covariates.collect::<Option<Vec<Vec<f64>>>>()?,
            fruit_unit: known.into_iter().map(unit).collect::<Option<_>>()?,
            impact_unit: impact_unit?,
            fruit_from: fit.effects.len() + matrices,
            between,
            within,
        })
    }

    fn parameters(&self) -> usize {
        self.fit.parameters.len()
    }

    /// Effects with the covariance matrices' standard deviations and correlations.
    fn quantities(&self) -> usize {
        let within = self.within.as_ref().map_or(0, Level::count);
        self.fit.effects.len() + self.between.count() + within
    }

    fn effect(&self, z: &[f64], at: usize) -> f64 {
        let effect = &self.fit.effects[at];
        effect.value + effect.se * z[at]
    }

    fn roots(&self, z: &[f64]) -> (DMatrix<f64>, Option<DMatrix<f64>>) {
        let z = &z[self.fit.effects.len()..];
        let between = self.between.root(z);
        let within = &self.within;
        let z = &z[self.between.count()..];
        (between, within.as_ref().map(|level| level.root(z)))
    }

    fn told(&self, z: &[f64]) -> Vec<f64> {
        let (between, within) = self.roots(z);
        let mut out: Vec<f64> = (0..self.fit.effects.len())
            .map(|at| self.effect(z, at))
            .collect();
        out.extend(self.between.told(&between));
        if let (Some(level), Some(root)) = (&self.within, &within) {
            out.extend(level.told(root));
        }
        out
    }

    /// `centre` moved by the coordinates in `unit`.
    fn placed(&self, centre: &[f64], unit: &DMatrix<f64>, z: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(centre) + unit * DVector::from_column_slice(z)
    }

    /// Effects of the covariates at impact `impact`, on each parameter.
    fn along(&self, z: &[f64], impact: usize) -> DVector<f64> {
        let stride = self.covariates.len() + 1;
        DVector::from_fn(self.parameters(), |a, _| {
            let own = self.covariates.iter().enumerate();
            own.map(|(c, values)| self.effect(z, a * stride + 1 + c) * values[impact])
                .sum()
        })
    }
}

/// Negative second derivatives of each impact's log-likelihood.
fn curvatures(
    found: &[Option<crate::population::Expansion>],
    size: usize,
) -> Option<Vec<DMatrix<f64>>> {
    let own = found.iter().map(|expansion| {
        let curvature = &expansion.as_ref()?.curvature;
        Some(DMatrix::from_fn(size, size, |a, b| curvature[a][b]))
    });
    own.collect()
}

impl LogDensity for Hierarchy<'_, '_> {
    fn size(&self) -> usize {
        let members = self.fruit_unit.len() + self.impact_unit.len();
        self.fruit_from + members * self.parameters()
    }

    fn evaluate(&self, z: &[f64], gradient: &mut [f64]) -> Option<f64> {
        let q = self.parameters();
        let effects = self.fit.effects.len();
        let stride = self.covariates.len() + 1;
        let impact_from = self.fruit_from + q * self.fruit_unit.len();
        let (between_root, within_root) = self.roots(z);
        let fruits: Vec<DVector<f64>> = (0..self.fruit_unit.len())
            .map(|i| {
                let own = &z[self.fruit_from + q * i..][..q];
                self.placed(&self.fit.fruit[i], &self.fruit_unit[i], own)
            })
            .collect();
        let expected = |j: usize| &fruits[self.fruit[j]] + self.along(z, j);
        let points: Vec<DVector<f64>> = (0..self.fruit.len())
            .map(|j| match self.impact_unit.get(j) {
                Some(unit) => {
                    let own = &z[impact_from + q * j..][..q];
                    self.placed(&self.fit.impacts[j], unit, own)
                }
                None => expected(j),
            })
            .collect();
        let at: Vec<Vec<f64>> = points.iter().map(|p| p.as_slice().to_vec()).collect();
        let likelihoods = (self.expand)(&at);

        gradient.fill(0.0);
        let mut density = 0.0;
        let mut by_fruit = vec![DVector::zeros(q); fruits.len()];
        let mut within = within_root.as_ref().map(Normal::new);
        for (j, likelihood) in likelihoods.iter().enumerate() {
            let likelihood = likelihood.as_ref()?;
            density += likelihood.value;
            let slope = DVector::from_column_slice(&likelihood.gradient);
            // What pulls at the impact's expected parameters.
            let pull = match &mut within {
                Some(normal) => {
                    let pull = normal.add(&points[j] - expected(j))?;
                    let own = self.impact_unit[j].tr_mul(&(slope - &pull));
                    gradient[impact_from + q * j..][..q].copy_from_slice(own.as_slice());
                    pull
                }
                None => slope,
            };
            for a in 0..q {
                for (c, values) in self.covariates.iter().enumerate() {
                    gradient[a * stride + 1 + c] += pull[a] * values[j];
                }
            }
            by_fruit[self.fruit[j]] += pull;
        }
        let mut between = Normal::new(&between_root);
        for (i, fruit) in fruits.iter().enumerate() {
            let median = DVector::from_fn(q, |a, _| self.effect(z, a * stride));
            let pull = between.add(fruit - median)?;
            for a in 0..q {
                gradient[a * stride] += pull[a];
            }
            let own = self.fruit_unit[i].tr_mul(&(&by_fruit[i] - &pull));
            gradient[self.fruit_from + q * i..][..q].copy_from_slice(own.as_slice());
        }
        for (gradient, effect) in gradient.iter_mut().zip(&self.fit.effects) {
            *gradient *= effect.se;
        }
        density += between.density;
        let (own, rest) = gradient[effects..].split_at_mut(self.between.count());
        density += self.between.prior(&between_root, &between.by_root, own);
        if let (Some(level), Some(root), Some(normal)) = (&self.within, &within_root, &within) {
            density += normal.density + level.prior(root, &normal.by_root, rest);
        }
        Some(density)
    }
}
