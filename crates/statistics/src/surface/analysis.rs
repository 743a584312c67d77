//! Response surfaces: polynomials of coded factors.

use crate::error::Error;
use crate::model::anova::{LackOfFit, lack_of_fit};
use crate::model::contrast::Contrast;
use crate::model::linear_model::{LinearFit, Prediction, fit_reduced, predict};
use crate::model::model_frame::{ModelFrame, TermColumns};
use crate::model::reduced::{Reduced, reduce};
use crate::surface::coding::FactorCoding;
use crate::surface::terms::{Monomial, SurfaceTerms, monomial_name, monomial_value};
use crate::table::Categories;
use crate::weights::Weights;
use nalgebra::{DMatrix, DVector};
use windfall_numerics::double_double::DoubleDouble;

/// A fitted surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its factors.
    pub factors: Vec<FactorCoding>,
    /// Its terms.
    pub terms: SurfaceTerms,
    /// Coefficients in coded units, the intercept first; zero where a term is aliased.
    pub coded: Vec<f64>,
    /// Terms of the same polynomial in actual units with their coefficients.
    pub actual: Vec<(Monomial, f64)>,
    /// The fit.
    pub fit: LinearFit,
    /// Columns of the fit.
    pub frame: ModelFrame,
    /// Rows of the fit as their triangle.
    pub reduced: Reduced,
    /// Model matrix in coded units, the columns of blocks behind the terms.
    pub x: DMatrix<f64>,
    /// Block of each run, where there are blocks.
    pub blocks: Option<Categories>,
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
    let mut coefficients = vec![0.0; x.ncols()];
    for (column, coefficient) in fit.columns.iter().zip(&fit.coefficients) {
        coefficients[*column] = coefficient.estimate;
    }
    coefficients.truncate(own);
    Ok(Surface {
        actual: actual_terms(factors, &terms.monomials, &coefficients),
        factors: factors.to_vec(),
        terms: terms.clone(),
        coded: coefficients,
        fit,
        frame,
        reduced,
        x,
        blocks: blocks.cloned(),
    })
}

/// Contrasts of the blocks against their mean, a row for each run.
fn block_rows(blocks: Option<&Categories>, runs: usize) -> DMatrix<f64> {
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

    /// Predictions at coded settings, at the mean of the blocks.
    pub fn predict(&self, points: &[Vec<f64>]) -> Vec<Prediction> {
        let count = self.x.ncols() - self.coded.len();
        let mean = DMatrix::zeros(points.len(), count);
        predict(&self.fit, &rows_of(&self.terms.monomials, points, &mean))
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
        let place = |column: usize| self.fit.columns.iter().position(|own| *own == column);
        let estimate = |column| Some(self.fit.coefficients[place(column)?].estimate);
        let found: Option<Vec<f64>> = self.block_columns().into_iter().map(estimate).collect();
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

/// Lack of fit and pure error; `None` where no run is repeated within its block.
pub fn surface_lack_of_fit(surface: &Surface, coded: &[Vec<f64>], y: &[f64]) -> Option<LackOfFit> {
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

/// Where a quadratic surface is flat, and how it curves there (Box & Draper 2007,
/// Response Surfaces, Mixtures, and Ridge Analyses, 2nd ed., ch. 10).
#[derive(Clone, Debug, PartialEq)]
pub struct Canonical {
    /// The stationary point in coded units, the one nearest to the centre of a line.
    pub stationary: Vec<f64>,
    /// Its distance from the centre in coded units.
    pub distance: f64,
    /// The response there.
    pub value: f64,
    /// Curvatures, most negative first.
    pub eigenvalues: Vec<f64>,
    /// Directions of these in coded units, one for each.
    pub directions: Vec<Vec<f64>>,
    /// What it is.
    pub shape: Shape,
}

/// What a stationary point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Every way leads down.
    Maximum,
    /// Every way leads up.
    Minimum,
    /// Some ways up, some down.
    Saddle,
    /// Along some ways next to nothing changes: the point is not determined.
    Ridge,
}

/// Curvature below this part of the largest is none.
const FLAT: f64 = 1e-3;

/// Analyses a surface of second degree; `None` without curvature or of higher degree.
pub fn canonical(surface: &Surface) -> Option<Canonical> {
    let (slopes, curvature) = quadratic_form(surface)?;
    let eigen = curvature.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    // Rounding alone is no curvature.
    if largest <= 1e-12 * slopes.amax() || largest == 0.0 {
        return None;
    }
    let mut order: Vec<usize> = (0..slopes.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    // Directions without any curvature have no stationary point of their own.
    let mut stationary = DVector::zeros(slopes.len());
    for place in &order {
        let value = eigen.eigenvalues[*place];
        if value.abs() > 1e-12 * largest {
            let direction = eigen.eigenvectors.column(*place);
            stationary -= direction * (direction.dot(&slopes) / (2.0 * value));
        }
    }
    let eigenvalues: Vec<f64> = order
        .iter()
        .map(|place| eigen.eigenvalues[*place])
        .collect();
    let flat = eigenvalues.iter().any(|value| value.abs() < FLAT * largest);
    let shape = match (flat, eigenvalues[0] > 0.0, *eigenvalues.last()? < 0.0) {
        (true, ..) => Shape::Ridge,
        (_, true, _) => Shape::Minimum,
        (_, _, true) => Shape::Maximum,
        _ => Shape::Saddle,
    };
    let point: Vec<f64> = stationary.iter().copied().collect();
    Some(Canonical {
        distance: stationary.norm(),
        value: surface.value(&point),
        directions: order
            .iter()
            .map(|place| upright(eigen.eigenvectors.column(*place).iter().copied().collect()))
            .collect(),
        eigenvalues,
        shape,
        stationary: point,
    })
}

/// A direction whose largest part is positive.
fn upright(direction: Vec<f64>) -> Vec<f64> {
    let largest = direction
        .iter()
        .copied()
        .max_by(|a, b| a.abs().total_cmp(&b.abs()));
    match largest.is_some_and(|value| value < 0.0) {
        true => direction.iter().map(|value| -value).collect(),
        false => direction,
    }
}

/// Slopes at the centre and the symmetric matrix of curvature.
fn quadratic_form(surface: &Surface) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let count = surface.factors.len();
    if surface.degree() != 2 {
        return None;
    }
    let mut slopes = DVector::zeros(count);
    let mut curvature = DMatrix::zeros(count, count);
    for (monomial, b) in surface.terms.monomials.iter().zip(&surface.coded[1..]) {
        let places: Vec<usize> = (0..count)
            .flat_map(|place| std::iter::repeat_n(place, monomial[place] as usize))
            .collect();
        match places[..] {
            [one] => slopes[one] = *b,
            [one, two] if one == two => curvature[(one, one)] = *b,
            [one, two] => {
                curvature[(one, two)] = 0.5 * b;
                curvature[(two, one)] = 0.5 * b;
            }
            _ => return None,
        }
    }
    Some((slopes, curvature))
}

/// A point of a ridge: the best at a distance from the centre.
#[derive(Clone, Debug, PartialEq)]
pub struct RidgePoint {
    /// Distance from the centre in coded units.
    pub radius: f64,
    /// The point in coded units.
    pub point: Vec<f64>,
    /// The response there.
    pub value: f64,
}

/// Best points of a quadratic surface at distances from the centre (Draper 1963,
/// Technometrics 5, 469-479).
///
/// * `maximum`: whether the best is the largest
pub fn ridge(surface: &Surface, radii: &[f64], maximum: bool) -> Vec<RidgePoint> {
    let Some((slopes, curvature)) = quadratic_form(surface) else {
        return Vec::new();
    };
    let sign = if maximum { 1.0 } else { -1.0 };
    let eigen = (curvature * sign).symmetric_eigen();
    let along = eigen.eigenvectors.transpose() * (slopes * sign);
    let top = eigen.eigenvalues.max();
    // Beyond the largest curvature the distance falls as the multiplier grows.
    let part = |multiplier: f64, place: usize| {
        along[place] / (2.0 * (multiplier - eigen.eigenvalues[place]))
    };
    let length = |multiplier: f64| -> f64 {
        let parts = (0..along.len()).map(|place| part(multiplier, place).powi(2));
        parts.sum::<f64>().sqrt()
    };
    let scale = along.norm().max(top.abs()).max(f64::MIN_POSITIVE);
    radii
        .iter()
        .map(|radius| {
            let mut parts: Vec<f64> = vec![0.0; along.len()];
            if *radius > 0.0 {
                // With hardly any slope along the steepest curvature, the multiplier
                // ends at that curvature and the rest of the way is along it.
                let mut low = top + 1e-13 * scale;
                let mut high = top + along.norm() / radius + scale;
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    match length(middle) > *radius {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                let multiplier = 0.5 * (low + high);
                (0..parts.len()).for_each(|place| parts[place] = part(multiplier, place));
                let short = radius * radius - parts.iter().map(|p| p * p).sum::<f64>();
                if short > 1e-9 * radius * radius {
                    let steepest = eigen.eigenvalues.imax();
                    let own = parts[steepest];
                    let sign = if own < 0.0 { -1.0 } else { 1.0 };
                    parts[steepest] = sign * (own * own + short).sqrt();
                }
            }
            let point = &eigen.eigenvectors * DVector::from_vec(parts);
            let point: Vec<f64> = point.iter().copied().collect();
            RidgePoint {
                radius: *radius,
                value: surface.value(&point),
                point,
            }
        })
        .collect()
}
