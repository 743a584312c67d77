//! Start values: Hertz's stiffness carried over to the exponent of another law,
//! and a coarse search around it.

use crate::coordinates::LawCoordinates;
use crate::feature_problem::{FeatureProblem, linearise, nuisances};
use windfall_contact::parameter::{Elastic, LawDescription, Power};

/// Exponent of Hertz's contact of a sphere.
const HERTZ_EXPONENT: f64 = 1.5;

/// Stiffness of F = k xⁿ that has the peak force of Hertz's F = k xᵉ for a body of
/// some energy: E = F x/(n + 1) at the peak of either; N/mⁿ.
///
/// With gravity and damping left out, which a start need not know.
///
/// * `hertz`: Hertz's stiffness; N/m^1.5
/// * `energy`: of the impact; J
pub fn stiffness_of_equal_peak(hertz: f64, energy: f64, exponent: f64) -> f64 {
    let depth = ((HERTZ_EXPONENT + 1.0) * energy / hertz).powf(1.0 / (HERTZ_EXPONENT + 1.0));
    let force = hertz * depth.powf(HERTZ_EXPONENT);
    stiffness_of_peak(force, energy, exponent)
}

/// Stiffness of F = k xⁿ at which a body of some energy meets a peak force; N/mⁿ.
pub fn stiffness_of_peak(force: f64, energy: f64, exponent: f64) -> f64 {
    force / ((exponent + 1.0) * energy / force).powf(exponent)
}

/// Position of the exponent of a law's displacement; `None` where it is 1.5.
pub fn exponent_position(description: &LawDescription) -> Option<usize> {
    match description.elastic {
        Elastic::Power(Power::Parameter(name)) => description.index_of(name),
        Elastic::Power(Power::Number(_)) | Elastic::Hertzian => None,
        // The exponents of a user's law are known by name only.
        Elastic::Other => ["n", "e"]
            .into_iter()
            .find_map(|name| description.index_of(name)),
    }
}

/// Exponents, damping (in parts of the value at which a body is slowed at touch by
/// the peak force) and stiffness (in parts of what meets the force) that are tried.
const EXPONENTS: [f64; 3] = [1.5, 1.9, 2.4];
const DAMPING: [f64; 4] = [0.02, 0.08, 0.2, 0.45];
const STIFFNESS: [f64; 2] = [0.7, 1.4];
/// Starts that are kept.
const KEPT: usize = 3;

/// Coordinates to start from: the given ones and the best of a coarse grid about a
/// peak force and speed.
///
/// * `force`: peak of the first impact; N
/// * `mass`, `speed`: of that impact; kg, m/s
pub fn coarse_starts(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    (force, mass, speed): (f64, f64, f64),
) -> Vec<Vec<f64>> {
    let description = coordinates.kind.describe();
    let energy = 0.5 * mass * speed * speed;
    let is_free = |position: &usize| coordinates.free.iter().any(|f| f.position == *position);
    let exponent = exponent_position(description);
    let exponents = match exponent {
        Some(position) if is_free(&position) => EXPONENTS.to_vec(),
        held => vec![held.map_or(HERTZ_EXPONENT, |position| coordinates.values[position])],
    };
    let damped = description.damping.and_then(|(name, power)| {
        let position = description.index_of(name).filter(is_free)?;
        Some((position, power))
    });
    let damping = match damped {
        Some(_) => DAMPING.to_vec(),
        None => vec![0.0],
    };
    let mut grid = vec![coordinates.start()];
    for n in &exponents {
        let stiffness = stiffness_of_peak(force, energy, *n);
        let depth = (force / stiffness).powf(1.0 / n);
        for part in &damping {
            for times in STIFFNESS {
                let mut values = coordinates.values.clone();
                if let Some(position) = exponent {
                    values[position] = *n;
                }
                if let Some(position) = description.index_of("k") {
                    values[position] = times * stiffness;
                }
                if let Some((position, power)) = damped {
                    let known: Vec<_> = values.iter().copied().map(Some).collect();
                    let power = description.exponent(power, &known).unwrap_or(0.0);
                    values[position] = part * force / speed / depth.powf(power);
                }
                grid.push(coordinates.of_values(&values));
            }
        }
    }
    best_of(problem, coordinates, grid)
}

/// The given start first, then the best of the others.
fn best_of(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    grid: Vec<Vec<f64>>,
) -> Vec<Vec<f64>> {
    let known = nuisances(problem);
    let shifts = vec![0.0; known.len()];
    let cost = |at: &[f64]| {
        linearise(problem, coordinates, &known, (at, &shifts))
            .map_or(f64::INFINITY, |found| found.residuals.norm_squared())
    };
    let given = grid[0].clone();
    let others = grid.into_iter().skip(1).map(|at| (cost(&at), at));
    let mut others: Vec<(f64, Vec<f64>)> = others.filter(|(c, _)| c.is_finite()).collect();
    others.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = others.into_iter().take(KEPT).map(|(_, at)| at);
    std::iter::once(given).chain(best).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hertz's closed form of the peak, F = (5/4)^(3/5) (k² m³ v⁶)^(1/5)
    /// (DOMAIN 1.2), is met by every exponent.
    #[test]
    fn closed_form_peak_of_every_exponent() {
        let (k, m, v) = (5.396954 * 1000f64.powf(1.5), 0.0048_f64, 3.1316_f64);
        let peak = 1.25f64.powf(0.6) * (k * k * m.powi(3) * v.powi(6)).powf(0.2);
        let energy = 0.5 * m * v * v;
        for n in [1.0, 1.5, 1.91, 3.0] {
            let found = stiffness_of_equal_peak(k, energy, n);
            // Undamped F = k xⁿ: (n+1)/k E = x^(n+1).
            let depth = ((n + 1.0) * energy / found).powf(1.0 / (n + 1.0));
            let force = found * depth.powf(n);
            assert!((force / peak - 1.0).abs() < 1e-12, "{n}: {force} {peak}");
        }
        let same = stiffness_of_equal_peak(k, energy, 1.5);
        assert!((same / k - 1.0).abs() < 1e-12);
    }
}
