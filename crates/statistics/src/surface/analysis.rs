//! Response surfaces: polynomials of coded factors.

use crate::error::Error;
use crate::model::anova::{LackOfFit, lack_of_fit};
use crate::model::contrast::Contrast;
use crate::model::linear_model::{LinearFit, fit_reduced};
use crate::model::model_frame::{ModelFrame, TermColumns};
use crate::model::prediction::{Prediction, predict};
use crate::model::reduced::{Reduced, reduce};
use crate::surface::coding::FactorCoding;
use crate::surface::random_groups::RandomGroups;
use crate::surface::terms::{Monomial, SurfaceTerms, monomial_name, monomial_value};
use crate::table::Categories;
use nalgebra::DMatrix;
use windfall_mixed::term::RandomTerm;
use windfall_mixed::weights::Weights;
use windfall_numerics::double_double::DoubleDouble;

/// A fitted surface.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its factors.
    pub factors: Vec<FactorCoding>,
    /// Its terms.
    pub terms: SurfaceTerms,
    /// Coefficients in coded units, the intercept first; zero where a term is aliased.
    pub coded: Vec<f64>,
    /// Terms of the same polynomial in actual units with their coefficients.
    pub actual: Vec<(Monomial, f64)>,
    /// The fit by least squares; where groups are random, it tells which terms can be estimated,
    /// and `random` has the estimates.
    pub fit: LinearFit,
    /// Columns of the fit.
    pub frame: ModelFrame,
    /// Rows of the fit as their triangle.
    pub reduced: Reduced,
    /// Model matrix in coded units, the columns of blocks behind the terms.
    pub x: DMatrix<f64>,
    /// Block of each run, where there are blocks.
    pub blocks: Option<Categories>,
    /// The fit with random groups, where there are any.
    pub random: Option<RandomGroups>,
}

/// Fits a surface.
///
/// * `coded`: coded values, a vector for each factor
/// * `y`: response
///
/// # Errors
/// Too few rows; a response of one value.
pub fn fit_surface(
    factors: &[FactorCoding],
    terms: &SurfaceTerms,
    coded: &[Vec<f64>],
    y: &[f64],
    confidence: f64,
) -> Result<Surface, Error> {
    fit_surface_in_blocks(factors, terms, (coded, None), y, confidence)
}

/// [`fit_surface`] of runs that were made in blocks, each with a mean of its own: the surface is
/// that of the mean of the blocks.
///
/// * `coded`: with the block of each run
///
/// # Source
/// Box, G. E. P. and Hunter, J. S. (1957), Multi-factor experimental designs for exploring
/// response surfaces, Ann. Math. Statist. 28, 195.
pub fn fit_surface_in_blocks(
    factors: &[FactorCoding],
    terms: &SurfaceTerms,
    (coded, blocks): (&[Vec<f64>], Option<&Categories>),
    y: &[f64],
    confidence: f64,
) -> Result<Surface, Error> {
    let points: Vec<Vec<f64>> = (0..y.len())
        .map(|row| coded.iter().map(|factor| factor[row]).collect())
        .collect();
    let own = terms.monomials.len() + 1;
    let block_columns: Vec<usize> = (own..own + blocks.map_or(0, |b| b.levels.len() - 1)).collect();
    let x = rows_of(&terms.monomials, &points, &block_rows(blocks, y.len()));
    let mut frame = frame_of(factors, terms);
    let levels = blocks.iter().flat_map(|own| &own.levels);
    let names = levels.map(|level| format!("block[{level}]"));
    frame.names.extend(names.take(block_columns.len()));
    // Blocks stand before the terms: a term that they hide has no estimate.
    let wanted = std::iter::once(0).chain(block_columns.iter().copied());
    let wanted: Vec<usize> = wanted.chain(1..own).collect();
    let reduced = reduce(&x, y);
    let fit = fit_reduced(&frame, &x, y, &reduced, &wanted, confidence)?;
    let fit = fit.in_blocks(&reduced, &block_columns);
    let estimates = fit.coefficients.iter().map(|own| own.estimate);
    let coded = coded_terms(&fit.columns, estimates, own);
    Ok(Surface {
        actual: actual_terms(factors, &terms.monomials, &coded),
        factors: factors.to_vec(),
        terms: terms.clone(),
        coded,
        fit,
        frame,
        reduced,
        x,
        blocks: blocks.cloned(),
        random: None,
    })
}

/// Coefficients of the intercept and all terms, from those of the estimated columns.
fn coded_terms(columns: &[usize], estimates: impl Iterator<Item = f64>, count: usize) -> Vec<f64> {
    let mut coded = vec![0.0; count];
    for (column, estimate) in columns.iter().zip(estimates) {
        if let Some(own) = coded.get_mut(*column) {
            *own = estimate;
        }
    }
    coded
}

/// Contrasts of the blocks against their mean, a row for each run.
pub fn block_rows(blocks: Option<&Categories>, runs: usize) -> DMatrix<f64> {
    let Some(blocks) = blocks else {
        return DMatrix::zeros(runs, 0);
    };
    let contrast = Contrast::Sum.matrix(&blocks.levels, 0).matrix;
    DMatrix::from_fn(runs, contrast.ncols(), |run, column| {
        blocks.codes[run].map_or(0.0, |block| contrast[(block, column)])
    })
}

/// Model matrix of points in coded units, the intercept first and what stands for blocks last.
fn rows_of(monomials: &[Monomial], points: &[Vec<f64>], blocks: &DMatrix<f64>) -> DMatrix<f64> {
    let own = monomials.len() + 1;
    DMatrix::from_fn(
        points.len(),
        own + blocks.ncols(),
        |row, column| match column {
            0 => 1.0,
            _ if column < own => monomial_value(&monomials[column - 1], &points[row]),
            _ => blocks[(row, column - own)],
        },
    )
}

fn frame_of(factors: &[FactorCoding], terms: &SurfaceTerms) -> ModelFrame {
    let names: Vec<String> = factors.iter().map(|factor| factor.name.clone()).collect();
    let own = terms.monomials.iter();
    let own: Vec<String> = own
        .map(|m| monomial_name(m, &names, terms.letters))
        .collect();
    let columns = own.iter().enumerate().map(|(place, name)| TermColumns {
        name: name.clone(),
        atoms: Vec::new(),
        columns: place + 1..place + 2,
    });
    ModelFrame {
        atoms: Vec::new(),
        terms: columns.collect(),
        intercept: true,
        names: std::iter::once("(Intercept)".to_owned())
            .chain(own)
            .collect(),
    }
}

/// Multiplies ((X - centre) / half)^power out.
fn actual_terms(
    factors: &[FactorCoding],
    monomials: &[Monomial],
    coded: &[f64],
) -> Vec<(Monomial, f64)> {
    let none: Monomial = vec![0; factors.len()];
    let mut sums: Vec<(Monomial, DoubleDouble)> = vec![(none.clone(), coded[0].into())];
    for (monomial, coefficient) in monomials.iter().zip(&coded[1..]) {
        let mut parts: Vec<(Monomial, DoubleDouble)> =
            vec![(none.clone(), DoubleDouble::from(*coefficient))];
        for (place, power) in monomial.iter().enumerate() {
            let half = DoubleDouble::from(factors[place].half);
            let slope = DoubleDouble::ONE / half;
            let offset = -(DoubleDouble::from(factors[place].centre) / half);
            for _ in 0..*power {
                parts = parts
                    .into_iter()
                    .flat_map(|(powers, value)| {
                        let mut more = powers.clone();
                        more[place] += 1;
                        [(powers, value * offset), (more, value * slope)]
                    })
                    .collect();
            }
        }
        for (powers, value) in parts {
            match sums.iter_mut().find(|(known, _)| *known == powers) {
                Some((_, sum)) => *sum += value,
                None => sums.push((powers, value)),
            }
        }
    }
    sums.sort_by_key(|(powers, _)| {
        let position = monomials.iter().position(|m| m == powers);
        match powers.iter().all(|power| *power == 0) {
            true => 0,
            // What only multiplying out brings in stands last.
            false => 1 + position.unwrap_or(monomials.len()),
        }
    });
    let values = sums.into_iter().map(|(powers, sum)| (powers, sum.value()));
    values.collect()
}

impl Surface {
    /// The same surface of runs in random groups, as days or whole plots are.
    ///
    /// # Errors
    /// Those of mixed models: variances that cannot be told apart, too few groups or rows.
    pub fn in_random_groups(mut self, y: &[f64], terms: Vec<RandomTerm>) -> Result<Self, Error> {
        let random = RandomGroups::of(&self.fit, &self.x, y, terms)?;
        let estimates = random.fit.coefficients.iter().copied();
        self.coded = coded_terms(&random.columns, estimates, self.coded.len());
        self.actual = actual_terms(&self.factors, &self.terms.monomials, &self.coded);
        self.random = Some(random);
        Ok(self)
    }

    /// The estimate of a column of the model matrix; `None` where it is aliased.
    fn estimate(&self, column: usize) -> Option<f64> {
        let place = self.fit.columns.iter().position(|own| *own == column)?;
        Some(match &self.random {
            Some(random) => random.fit.coefficients[place],
            None => self.fit.coefficients[place].estimate,
        })
    }

    /// Value at coded settings.
    pub fn value(&self, point: &[f64]) -> f64 {
        let terms = self.terms.monomials.iter().zip(&self.coded[1..]);
        let terms = terms.map(|(monomial, b)| b * monomial_value(monomial, point));
        self.coded[0] + terms.sum::<f64>()
    }

    /// Slopes at coded settings, per coded unit.
    pub fn slopes(&self, point: &[f64]) -> Vec<f64> {
        let slope = |place: usize| -> f64 {
            let terms = self.terms.monomials.iter().zip(&self.coded[1..]);
            terms
                .filter(|(monomial, _)| monomial[place] > 0)
                .map(|(monomial, b)| {
                    let mut fewer = monomial.clone();
                    fewer[place] -= 1;
                    b * f64::from(monomial[place]) * monomial_value(&fewer, point)
                })
                .sum()
        };
        (0..self.factors.len()).map(slope).collect()
    }

    /// Predictions at coded settings, at the mean of the blocks and for new random groups.
    pub fn predict(&self, points: &[Vec<f64>]) -> Vec<Prediction> {
        let count = self.x.ncols() - self.coded.len();
        let mean = DMatrix::zeros(points.len(), count);
        let rows = rows_of(&self.terms.monomials, points, &mean);
        match &self.random {
            Some(random) => random.predict(&rows),
            None => predict(&self.fit, &rows),
        }
    }

    /// Columns that stand for blocks.
    pub fn block_columns(&self) -> Vec<usize> {
        (self.coded.len()..self.x.ncols()).collect()
    }

    /// How far each block lies from the mean of the blocks, by its level; none where a block
    /// cannot be told from a term.
    pub fn block_effects(&self) -> Vec<(String, f64)> {
        let Some(blocks) = &self.blocks else {
            return Vec::new();
        };
        let columns = self.block_columns().into_iter();
        let found: Option<Vec<f64>> = columns.map(|column| self.estimate(column)).collect();
        let Some(mut effects) = found else {
            return Vec::new();
        };
        effects.push(-effects.iter().sum::<f64>());
        blocks.levels.iter().cloned().zip(effects).collect()
    }

    /// Highest degree of its terms.
    pub fn degree(&self) -> u32 {
        let degrees = self.terms.monomials.iter().map(|m| m.iter().sum::<u32>());
        degrees.max().unwrap_or(0)
    }
}

/// Lack of fit and pure error; `None` where no run is repeated within its block, and with random
/// groups, where residuals have no single variance.
pub fn surface_lack_of_fit(surface: &Surface, coded: &[Vec<f64>], y: &[f64]) -> Option<LackOfFit> {
    if surface.random.is_some() {
        return None;
    }
    let code = |row: usize| surface.blocks.as_ref().and_then(|own| own.codes[row]);
    let settings = DMatrix::from_fn(y.len(), coded.len() + 1, |row, factor| {
        match coded.get(factor) {
            Some(coded) => coded[row],
            None => code(row).map_or(0.0, |code| code as f64),
        }
    });
    let columns: Vec<usize> = (0..settings.ncols()).collect();
    let left = (surface.fit.residual_ss, surface.fit.residual_df);
    lack_of_fit(&settings, &columns, (y, &Weights::default()), left)
        .ok()
        .flatten()
}
