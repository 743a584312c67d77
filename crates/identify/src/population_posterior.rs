//! Posterior distribution of a population, by the no-U-turn sampler: the check of
//! what [`fit_population`](crate::population_fit::fit_population) approximates.

use crate::error::Error;
use crate::interval::{Mixing, quantile};
use crate::population::{
    Expand, PopulationData, PopulationFit, PopulationOptions, Structure, Variation,
};
use crate::population_finding::PopulationFinding;
use crate::posterior::mixing;
use crate::sampler::{Drawing, LogDensity, draw_chains};
use nalgebra::{DMatrix, DVector};

/// Smallest standard deviation at the start, in units of the noise below it.
const LEAST: f64 = 0.3;

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
    /// What a reader should know besides its numbers.
    #[must_use]
    pub fn findings(&self) -> Vec<PopulationFinding> {
        let mut out = Vec::new();
        if self.divergences > 0 {
            out.push(PopulationFinding::Diverged {
                divergences: self.divergences,
                draws: self.drawing.chains * self.drawing.draws,
            });
        }
        let all = self.ranges().map(|range| range.mixing);
        let poor: Vec<Mixing> = all.filter(|mixing| !mixing.suffices()).collect();
        if !poor.is_empty() {
            let draws = poor.iter().map(Mixing::independent_draws);
            out.push(PopulationFinding::NotMixed {
                quantities: poor.len(),
                r_hat: poor.iter().map(|mixing| mixing.r_hat).fold(1.0, f64::max),
                draws: draws.fold(f64::INFINITY, f64::min),
            });
        }
        out
    }

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
    /// Whether the members differ by more than their noise. Then they are drawn
    /// themselves, else their deviations in units of L: either way the coordinates
    /// hardly depend on each other.
    told: bool,
    /// Standard deviations of the fit.
    scale: Vec<f64>,
    /// L of the fit.
    centre: DMatrix<f64>,
    /// Members, whose number tells how well deviations are known.
    members: f64,
}

impl Level {
    /// `noise`: variances of what tells the members apart.
    fn new(
        variation: &Variation,
        structure: Structure,
        members: usize,
        noise: &DVector<f64>,
    ) -> Option<Self> {
        let size = variation.sds.len();
        if structure == Structure::Zero {
            return None;
        }
        let sds = variation.sds.iter().zip(noise);
        let scale: Vec<f64> = sds
            .clone()
            .map(|(sd, noise)| sd.value.max(LEAST * noise.sqrt()))
            .collect();
        let told = sds.into_iter().all(|(sd, noise)| sd.value > noise.sqrt());
        // Where the fit ends at a bound its matrix is singular: less correlated,
        // it is a place to start from.
        let covariance = DMatrix::from_fn(size, size, |i, j| match i == j {
            true => scale[i] * scale[i],
            false => 0.9 * variation.covariance[i][j],
        });
        Some(Self {
            size,
            full: structure == Structure::Full,
            told,
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

/// Log-density of deviations of which each is N(0, L Lᵀ), with what its
/// derivatives are made of.
struct Normal<'a> {
    told: bool,
    root: &'a DMatrix<f64>,
    by_root: DMatrix<f64>,
    density: f64,
}

impl<'a> Normal<'a> {
    fn new(level: &Level, root: &'a DMatrix<f64>) -> Self {
        Self {
            told: level.told,
            root,
            by_root: DMatrix::zeros(root.nrows(), root.ncols()),
            density: 0.0,
        }
    }

    /// A member at its coordinates: around `centre` in `unit`, or around what is
    /// expected of it in units of L.
    fn member(
        &self,
        (centre, unit): (&[f64], &DMatrix<f64>),
        expected: &DVector<f64>,
        z: &[f64],
    ) -> DVector<f64> {
        let z = DVector::from_column_slice(z);
        match self.told {
            true => DVector::from_column_slice(centre) + unit * z,
            false => expected + self.root * z,
        }
    }

    /// Adds one member: `deviation` from what is expected of it, its coordinates
    /// `z` in `unit`, and what pulls at it, `slope`. Writes the gradient by the
    /// coordinates and returns that by what is expected.
    fn add(
        &mut self,
        deviation: DVector<f64>,
        slope: DVector<f64>,
        (unit, z): (&DMatrix<f64>, &[f64]),
        gradient: &mut [f64],
    ) -> Option<DVector<f64>> {
        if !self.told {
            let z = DVector::from_column_slice(z);
            self.density -= 0.5 * z.dot(&z);
            self.by_root += &slope * z.transpose();
            let own = self.root.tr_mul(&slope) - z;
            gradient.copy_from_slice(own.as_slice());
            return Some(slope);
        }
        let mut white = deviation;
        if !self.root.solve_lower_triangular_mut(&mut white) {
            return None;
        }
        let mut pull = white.clone();
        if !self.root.tr_solve_lower_triangular_mut(&mut pull) {
            return None;
        }
        self.density -= 0.5 * white.dot(&white);
        self.by_root += &pull * white.transpose();
        for i in 0..white.len() {
            self.density -= self.root[(i, i)].ln();
            self.by_root[(i, i)] -= 1.0 / self.root[(i, i)];
        }
        let own = unit.tr_mul(&(slope - &pull));
        gradient.copy_from_slice(own.as_slice());
        Some(pull)
    }
}

/// The whole model: coordinates are those of the effects, of the covariance
/// matrices, of each fruit and of each impact.
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
        let information = curvatures(&expand(&fit.impacts), size)?;
        let noise: Option<Vec<_>> = information
            .iter()
            .map(|h| h.clone().try_inverse())
            .collect();
        let noise = noise?;
        let mean = noise.iter().sum::<DMatrix<f64>>().diagonal() / noise.len() as f64;
        let within = match impacts.iter().all(|&n| n == 1) {
            true => None,
            false => {
                let spare = (data.fruit.len() - fruits).max(1);
                Some(Level::new(&fit.within, options.within, spare, &mean)?)
            }
        };
        let spread = match &within {
            Some(level) => &level.centre * level.centre.transpose(),
            None => DMatrix::zeros(size, size),
        };
        let each = data.fruit.len() as f64 / fruits as f64;
        let own = (mean + spread.diagonal()) / each;
        let between = Level::new(&fit.between, options.between, fruits, &own)?;
        let unit = |information: DMatrix<f64>| Some(information.try_inverse()?.cholesky()?.l());
        let between_information = (&between.centre * between.centre.transpose()).try_inverse()?;
        let mut known = vec![between_information; fruits];
        for (&fruit, noise) in data.fruit.iter().zip(&noise) {
            // What an impact tells of its fruit.
            known[fruit] += (&spread + noise).try_inverse()?;
        }
        let impact_unit: Option<Vec<_>> = match within {
            Some(_) => {
                let rest = spread.try_inverse()?;
                information.into_iter().map(|h| unit(h + &rest)).collect()
            }
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
        let mut between = Normal::new(&self.between, &between_root);
        let within_level = self.within.as_ref().zip(within_root.as_ref());
        let mut within = within_level.map(|(level, root)| Normal::new(level, root));
        let fruit_at = |i: usize| self.fruit_from + q * i..self.fruit_from + q * (i + 1);
        let impact_at = |j: usize| impact_from + q * j..impact_from + q * (j + 1);

        let median = DVector::from_fn(q, |a, _| self.effect(z, a * stride));
        let fruits: Vec<DVector<f64>> = (0..self.fruit_unit.len())
            .map(|i| {
                let place = (&self.fit.fruit[i][..], &self.fruit_unit[i]);
                between.member(place, &median, &z[fruit_at(i)])
            })
            .collect();
        let expected: Vec<DVector<f64>> = (0..self.fruit.len())
            .map(|j| &fruits[self.fruit[j]] + self.along(z, j))
            .collect();
        let points: Vec<Vec<f64>> = (0..self.fruit.len())
            .map(|j| match &within {
                Some(normal) => {
                    let place = (&self.fit.impacts[j][..], &self.impact_unit[j]);
                    normal.member(place, &expected[j], &z[impact_at(j)])
                }
                None => expected[j].clone(),
            })
            .map(|point| point.as_slice().to_vec())
            .collect();
        let likelihoods = (self.expand)(&points);

        gradient.fill(0.0);
        let mut density = 0.0;
        let mut by_fruit = vec![DVector::zeros(q); fruits.len()];
        for (j, likelihood) in likelihoods.iter().enumerate() {
            let likelihood = likelihood.as_ref()?;
            density += likelihood.value;
            let slope = DVector::from_column_slice(&likelihood.gradient);
            let pull = match &mut within {
                Some(normal) => {
                    let deviation = DVector::from_column_slice(&points[j]) - &expected[j];
                    let own = (&self.impact_unit[j], &z[impact_at(j)]);
                    normal.add(deviation, slope, own, &mut gradient[impact_at(j)])?
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
        for (i, (fruit, slope)) in fruits.iter().zip(by_fruit).enumerate() {
            let own = (&self.fruit_unit[i], &z[fruit_at(i)]);
            let pull = between.add(fruit - &median, slope, own, &mut gradient[fruit_at(i)])?;
            for a in 0..q {
                gradient[a * stride] += pull[a];
            }
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
