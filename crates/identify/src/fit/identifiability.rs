//! Which parameters the data can separate, in words.

use crate::finding::in_a_sentence;
use nalgebra::{DMatrix, SymmetricEigen};
use windfall_numerics::written::{unit_text, with_digits};

/// Shares of a direction smaller than this are not worth a word; of its largest.
const WORTH_A_WORD: f64 = 0.25;

/// Uncertainty along one combination of a fit's parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Change of each parameter along it that changes −2 ln of the likelihood by
    /// 1; SI.
    pub change: Vec<f64>,
    /// Eigenvalue of the correlation matrix: 1 where parameters do not trade, up
    /// to their number for the weakest direction.
    pub strength: f64,
}

/// How much better a parameter would be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trade {
    /// The parameter.
    pub parameter: usize,
    /// The one whose knowledge would help most.
    pub partner: usize,
    /// Standard deviation over that with the partner known; 1.
    pub factor: f64,
}

/// Directions of a covariance matrix, the weakest first; empty where it is singular.
pub fn directions(covariance: &[Vec<f64>]) -> Vec<Direction> {
    let n = covariance.len();
    let sd: Vec<f64> = (0..n).map(|i| covariance[i][i].sqrt()).collect();
    if n == 0 || sd.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
        return Vec::new();
    }
    let correlation = DMatrix::from_fn(n, n, |i, j| covariance[i][j] / (sd[i] * sd[j]));
    let eigen = SymmetricEigen::new(correlation);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    order
        .into_iter()
        .map(|k| {
            let strength = eigen.eigenvalues[k].max(0.0);
            let vector = eigen.eigenvectors.column(k);
            // The sign is nobody's: the largest share is positive.
            let largest = (0..n).max_by(|a, b| vector[*a].abs().total_cmp(&vector[*b].abs()));
            let sign = largest.map_or(1.0, |i| vector[i].signum());
            Direction {
                change: (0..n)
                    .map(|i| sign * vector[i] * sd[i] * strength.sqrt())
                    .collect(),
                strength,
            }
        })
        .collect()
}

/// For parameter `parameter`, the other one whose knowledge would sharpen it most.
pub fn trade(covariance: &[Vec<f64>], parameter: usize) -> Option<Trade> {
    let own = covariance[parameter][parameter];
    let left = |other: usize| {
        let shared = covariance[parameter][other];
        (own - shared * shared / covariance[other][other]).max(0.0)
    };
    let others = (0..covariance.len()).filter(|other| *other != parameter);
    let partner = others.min_by(|a, b| left(*a).total_cmp(&left(*b)))?;
    let factor = (own / left(partner).max(f64::MIN_POSITIVE * own)).sqrt();
    factor.is_finite().then_some(Trade {
        parameter,
        partner,
        factor,
    })
}

/// A direction in words: "k -0.9 %, c +4.1 %, onset -3.50·10⁻⁵ s". Parameters with
/// `relative` are given in % of their value.
pub fn in_words(
    direction: &Direction,
    covariance: &[Vec<f64>],
    parameters: &[(&str, f64, &str, bool)],
) -> String {
    let share = |i: usize| (direction.change[i] / covariance[i][i].sqrt()).abs();
    let largest = (0..parameters.len()).map(share).fold(0.0, f64::max);
    let words = parameters.iter().enumerate();
    let words = words.filter(|(i, _)| share(*i) >= WORTH_A_WORD * largest);
    let words = words.map(|(i, (name, value, unit, relative))| {
        let (name, change) = (in_a_sentence(name), direction.change[i]);
        match (*relative, *unit) {
            (true, _) => format!("{name} {:+.2} %", 100.0 * change / value),
            (false, "1") => format!("{name} {change:+.3}"),
            (false, unit) => {
                let sign = if change < 0.0 { "" } else { "+" };
                format!(
                    "{name} {sign}{} {}",
                    with_digits(change, 3),
                    unit_text(unit)
                )
            }
        }
    });
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parameters of correlation ρ: directions (1, ±1)/√2 with eigenvalues
    /// 1 ± ρ, and a gain of 1/√(1 − ρ²).
    #[test]
    fn closed_form_of_two_parameters() {
        let rho = 0.98;
        let covariance = vec![vec![4.0, 6.0 * rho], vec![6.0 * rho, 9.0]];
        let found = directions(&covariance);
        assert!((found[0].strength - 1.98).abs() < 1e-12);
        assert!((found[1].strength - 0.02).abs() < 1e-12);
        let scale = (1.98_f64 / 2.0).sqrt();
        assert!((found[0].change[0].abs() - 2.0 * scale).abs() < 1e-12);
        assert!((found[0].change[1] / found[0].change[0] - 1.5).abs() < 1e-12);
        let trade = trade(&covariance, 1).unwrap();
        assert_eq!(trade.partner, 0);
        assert!((trade.factor - 1.0 / (1.0 - rho * rho).sqrt()).abs() < 1e-9);
        // The whole change moves −2 ln L by δᵀ C⁻¹ δ = 1.
        let determinant = 36.0 * (1.0 - rho * rho);
        let [a, b] = [found[0].change[0], found[0].change[1]];
        let rise = (9.0 * a * a - 2.0 * 6.0 * rho * a * b + 4.0 * b * b) / determinant;
        assert!((rise - 1.0).abs() < 1e-9);
        let words = in_words(
            &found[0],
            &covariance,
            &[("k", 100.0, "N/m", true), ("onset", 0.0, "s", false)],
        );
        assert!(words.starts_with("k +1.99 %, onset +2.98 s"), "{words}");
    }

    #[test]
    fn rejects_what_the_data_do_not_tell() {
        assert!(directions(&[]).is_empty());
        assert!(directions(&[vec![f64::INFINITY]]).is_empty());
    }
}
