//! Posterior distribution of a population, by the no-U-turn sampler: the check of
//! what [`fit_population`](crate::population::fit::fit_population) approximates.

use crate::error::Error;
use crate::fit::interval::{independent_draws, mixes, quantile};
use crate::fit::posterior::mixing;
use crate::population::finding::PopulationFinding;
use crate::population::level::{Level, Normal};
use crate::population::model::{
    Expand, Expansion, PopulationData, PopulationFit, PopulationOptions,
};
use crate::sampler::chain_diagnostics::ChainDiagnostics;
use crate::sampler::{Drawing, LogDensity, check_sampler, draw_chains};
use nalgebra::{DMatrix, DVector};
use std::cell::{Cell, RefCell};

/// Summary of a quantity's draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosteriorRange {
    /// Median.
    pub median: f64,
    /// Lower end of the interval between quantiles.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// How well the chains mix.
    pub mixing: ChainDiagnostics,
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
    /// All draws, chain after chain, of each quantity: effects, then standard deviations and
    /// correlations between fruit, then within.
    pub draws: Vec<Vec<f64>>,
    /// What was drawn.
    pub drawing: Drawing,
    /// Draws at which the sampler diverged.
    pub divergences: usize,
    /// Impacts whose likelihood could often not be computed (the sampler's wildest
    /// tries do not count) and was that of its expansion at the impact's most
    /// probable parameters there.
    pub not_followed: usize,
}

impl PopulationPosterior {
    /// Remarks.
    pub fn findings(&self) -> Vec<PopulationFinding> {
        let mut out = Vec::new();
        if self.not_followed > 0 {
            out.push(PopulationFinding::NotFollowed {
                impacts: self.not_followed,
            });
        }
        if self.divergences > 0 {
            out.push(PopulationFinding::Diverged {
                divergences: self.divergences,
                draws: self.drawing.chains * self.drawing.draws,
            });
        }
        let all = self.ranges().map(|range| range.mixing);
        let poor: Vec<ChainDiagnostics> = all.filter(|mixing| !mixes(mixing)).collect();
        if !poor.is_empty() {
            let draws = poor.iter().map(independent_draws);
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
/// * `expand`: as for the fit
/// * `progress`: called with the draws made and their total
///
/// # Errors
/// [`Error::NoPopulation`] where `options` exclude variation at a level, or where no
/// chain can be started.
///
/// # Source
/// Gelman (2006), Bayesian Anal. 1:515, for flat standard deviations; Joe (2006),
/// J. Multivar. Anal. 97:2177, for uniform correlation matrices.
pub fn population_posterior(
    data: &PopulationData,
    fit: &PopulationFit,
    expand: &Expand,
    options: &PopulationOptions,
    drawing: &Drawing,
    progress: &dyn Fn(usize, usize),
) -> Result<PopulationPosterior, Error> {
    check_sampler()?;
    let model = (expand, progress);
    let hierarchy = Hierarchy::new(data, fit, model, options).ok_or(Error::NoPopulation)?;
    let mut drawn = vec![Vec::new(); hierarchy.quantities()];
    // The chains start around the estimate, some of its uncertainty away.
    let start = |chain: usize| {
        let sign = if chain.is_multiple_of(2) { 1.0 } else { -1.0 };
        let at = |i: usize| match i < hierarchy.fruit_from && i % 3 == chain / 2 % 3 {
            true => sign,
            false => 0.1 * sign,
        };
        (0..hierarchy.size()).map(at).collect()
    };
    let divergences = draw_chains(&hierarchy, drawing, &start, &mut |z| {
        for (all, value) in drawn.iter_mut().zip(hierarchy.quantities_at(z)) {
            all.push(value);
        }
    });
    let divergences = divergences.ok_or(Error::NoPopulation)?;
    let tail = 0.5 * (1.0 - options.confidence);
    let mut ranges = drawn.iter().cloned().map(|mut all| PosteriorRange {
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
        draws: drawn.clone(),
        drawing: *drawing,
        divergences,
        not_followed: hierarchy.often_lost(),
    })
}

/// The whole model: coordinates are those of the effects, of the covariance
/// matrices, of each fruit and of each impact.
struct Hierarchy<'a, 'b> {
    fit: &'a PopulationFit,
    expand: &'a Expand<'b>,
    progress: &'a dyn Fn(usize, usize),
    /// Expansions at the impacts' most probable parameters.
    known: Vec<Expansion>,
    /// How often an impact's likelihood could not be computed.
    lost: RefCell<Vec<usize>>,
    evaluations: Cell<usize>,
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
        (expand, progress): (&'a Expand<'b>, &'a dyn Fn(usize, usize)),
        options: &PopulationOptions,
    ) -> Option<Self> {
        let size = fit.parameters.len();
        let fruits = fit.fruit.len();
        let mut impacts = vec![0; fruits];
        for &fruit in &data.fruit {
            impacts[fruit] += 1;
        }
        let known: Option<Vec<Expansion>> = expand(&fit.impacts).into_iter().collect();
        let known = known?;
        let curvature =
            |known: &Expansion| DMatrix::from_fn(size, size, |a, b| known.curvature[a][b]);
        let information: Vec<DMatrix<f64>> = known.iter().map(curvature).collect();
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
        let mut information_on_fruit = vec![between_information; fruits];
        for (&fruit, noise) in data.fruit.iter().zip(&noise) {
            information_on_fruit[fruit] += (&spread + noise).try_inverse()?;
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
            progress,
            lost: RefCell::new(vec![0; known.len()]),
            evaluations: Cell::new(0),
            known,
            fruit: &data.fruit,
            covariates: covariates.collect::<Option<Vec<Vec<f64>>>>()?,
            fruit_unit: information_on_fruit
                .into_iter()
                .map(unit)
                .collect::<Option<_>>()?,
            impact_unit: impact_unit?,
            fruit_from: fit.effects.len() + matrices,
            between,
            within,
        })
    }

    /// Impacts whose likelihood could not be computed in more than a hundredth of
    /// the evaluations.
    fn often_lost(&self) -> usize {
        let rare = self.evaluations.get() / 100;
        self.lost
            .borrow()
            .iter()
            .filter(|lost| **lost > rare)
            .count()
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

    fn quantities_at(&self, z: &[f64]) -> Vec<f64> {
        let (between, within) = self.roots(z);
        let mut out: Vec<f64> = (0..self.fit.effects.len())
            .map(|at| self.effect(z, at))
            .collect();
        out.extend(self.between.spreads(&between));
        if let (Some(level), Some(root)) = (&self.within, &within) {
            out.extend(level.spreads(root));
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

/// Log-likelihood and gradient at `to` by its expansion at `from`.
fn expanded(known: &Expansion, from: &[f64], to: &[f64]) -> (f64, DVector<f64>) {
    let way = DVector::from_iterator(to.len(), to.iter().zip(from).map(|(to, from)| to - from));
    let first = DVector::from_column_slice(&known.gradient);
    let bent = DVector::from_iterator(
        way.len(),
        known
            .curvature
            .iter()
            .map(|row| row.iter().zip(&way).map(|(h, w)| h * w).sum::<f64>()),
    );
    let value = known.value + first.dot(&way) - 0.5 * bent.dot(&way);
    (value, first - bent)
}

impl LogDensity for Hierarchy<'_, '_> {
    fn size(&self) -> usize {
        let members = self.fruit_unit.len() + self.impact_unit.len();
        self.fruit_from + members * self.parameters()
    }

    fn drawn(&self, done: usize, all: usize) {
        (self.progress)(done, all);
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
        self.evaluations.set(self.evaluations.get() + 1);

        gradient.fill(0.0);
        let mut density = 0.0;
        let mut by_fruit = vec![DVector::zeros(q); fruits.len()];
        for (j, likelihood) in likelihoods.iter().enumerate() {
            let (value, slope) = match likelihood {
                Some(found) => (found.value, DVector::from_column_slice(&found.gradient)),
                None => {
                    self.lost.borrow_mut()[j] += 1;
                    expanded(&self.known[j], &self.fit.impacts[j], &points[j])
                }
            };
            density += value;
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
