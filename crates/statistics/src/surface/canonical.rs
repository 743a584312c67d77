//! Stationary points and ridges of quadratic surfaces.

use crate::surface::analysis::Surface;
use nalgebra::{DMatrix, DVector};

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
