//! The largest |t| of several that share their noise: the multivariate t distribution between
//! bounds that are alike.

use crate::tail::f_upper;
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// Eigenvalues below this share of the largest are zero.
const RANK: f64 = 1e-10;

/// Most and fewest directions, and about how many products are made in all.
const MOST: usize = 1_048_576;
const FEWEST: usize = 16_384;
const PRODUCTS: usize = 1_000_000_000;

/// Reaches of about equal size are taken together.
const REACHES: usize = 2_048;

/// The largest |t| of some estimates with a known correlation and one estimate of noise.
///
/// Errors e = A z of rank r are a direction u, uniform on the sphere, and a length ℓ, of which
/// ℓ²/r over the estimated variance has an F distribution: P(max |t| > c) is the mean over u of
/// P(F(r, ν) > c² / (r m²)) with the reach m(u) = max |A u|. The mean is taken over directions
/// spread evenly.
///
/// # Source
/// Dunnett, C. W. (1955), A multiple comparison procedure for comparing several treatments with a
/// control, J. Am. Stat. Assoc. 50, 1096; Genz, A. and Bretz, F. (2009), Computation of
/// Multivariate Normal and t Probabilities, sec. 4.2 (spherical-radial form).
#[derive(Clone, Debug, PartialEq)]
pub struct LargestT {
    rank: usize,
    /// Reaches, each standing for an equal share of the directions.
    reaches: Vec<f64>,
}

impl LargestT {
    /// Of a covariance matrix, or its correlation; `None` where it is not finite or a variance is
    /// zero.
    pub fn of_covariance(covariance: &DMatrix<f64>) -> Option<Self> {
        let count = covariance.nrows();
        let scale: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
        if count == 0 || scale.iter().any(|own| !own.is_finite() || *own <= 0.0) {
            return None;
        }
        let correlation = DMatrix::from_fn(count, count, |i, j| {
            covariance[(i, j)] / (scale[i] * scale[j])
        });
        if correlation.iter().any(|own| !own.is_finite()) {
            return None;
        }
        let eigen = correlation.symmetric_eigen();
        let largest = eigen.eigenvalues.amax();
        let kept: Vec<usize> = (0..count)
            .filter(|place| eigen.eigenvalues[*place] > RANK * largest)
            .collect();
        // A row for each direction's coordinate, a column for each estimate.
        let factor = DMatrix::from_fn(kept.len(), count, |row, column| {
            eigen.eigenvectors[(column, kept[row])] * eigen.eigenvalues[kept[row]].sqrt()
        });
        Some(Self {
            rank: kept.len(),
            reaches: alike(reaches(&factor)),
        })
    }

    /// P(max |t| > c); p of a |t| adjusted for all others.
    pub fn upper(&self, c: f64, df: f64) -> f64 {
        let rank = self.rank as f64;
        let upper = |reach: &f64| f_upper((c / reach).powi(2) / rank, rank, df);
        self.reaches.iter().map(upper).sum::<f64>() / self.reaches.len() as f64
    }

    /// The c with P(max |t| > c) = `probability`.
    pub fn upper_quantile(&self, probability: f64, df: f64) -> f64 {
        if !(probability > 0.0 && probability < 1.0) || self.upper(1.0, df).is_nan() {
            return f64::NAN;
        }
        let (mut low, mut high) = (0.0, 1.0);
        while self.upper(high, df) > probability {
            (low, high) = (high, 2.0 * high);
        }
        while high - low > 1e-10 * high {
            let middle = f64::midpoint(low, high);
            match self.upper(middle, df) > probability {
                true => low = middle,
                false => high = middle,
            }
        }
        f64::midpoint(low, high)
    }
}

/// How far each direction reaches.
fn reaches(factor: &DMatrix<f64>) -> Vec<f64> {
    let (rank, count) = factor.shape();
    let reach = |direction: &[f64]| {
        let products = factor.column_iter().map(|own| {
            let parts = own.iter().zip(direction);
            parts.map(|(a, u)| a * u).sum::<f64>().abs()
        });
        products.fold(0.0, f64::max)
    };
    match rank {
        1 => vec![reach(&[1.0])],
        2 => {
            // Half of the circle is enough: a direction reaches as far as its opposite.
            let angle = |place: usize| 0.5 * TAU * (place as f64 + 0.5) / MOST as f64;
            let circle = (0..MOST).map(angle);
            circle
                .map(|angle| reach(&[angle.cos(), angle.sin()]))
                .collect()
        }
        _ => {
            let wanted = (PRODUCTS / (rank * count)).clamp(FEWEST, MOST);
            let steps = steps(rank + rank % 2);
            let directions = (1..=wanted).map(|point| direction(point, &steps, rank));
            directions.map(|own| reach(&own)).collect()
        }
    }
}

/// Square roots of the first primes: their multiples fill a cube evenly (Richtmyer 1951).
fn steps(count: usize) -> Vec<f64> {
    let is_prime = |n: &usize| {
        (2..)
            .take_while(|d| d * d <= *n)
            .all(|d| !n.is_multiple_of(d))
    };
    let primes = (2..).filter(is_prime).take(count);
    primes.map(|prime| (prime as f64).sqrt()).collect()
}

/// A direction from a point of a cube, by normal numbers (Box and Muller 1958).
fn direction(point: usize, steps: &[f64], rank: usize) -> Vec<f64> {
    let place = |step: f64| (point as f64 * step + 0.5).fract();
    let mut normal = Vec::with_capacity(steps.len());
    for pair in steps.chunks_exact(2) {
        let length = (-2.0 * (1.0 - place(pair[0])).ln()).sqrt();
        let (sine, cosine) = (TAU * place(pair[1])).sin_cos();
        normal.extend([length * cosine, length * sine]);
    }
    normal.truncate(rank);
    let length = normal.iter().map(|own| own * own).sum::<f64>().sqrt();
    normal.iter().map(|own| own / length).collect()
}

/// Sorted reaches in parts of about one size, each as its root mean square.
fn alike(mut reaches: Vec<f64>) -> Vec<f64> {
    reaches.sort_by(f64::total_cmp);
    let (count, parts) = (reaches.len(), reaches.len().min(REACHES));
    let part = |place: usize| {
        let part = &reaches[place * count / parts..(place + 1) * count / parts];
        (part.iter().map(|own| own * own).sum::<f64>() / part.len() as f64).sqrt()
    };
    (0..parts).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studentized_range::studentized_range_upper;
    use crate::tail::t_two_sided;

    /// Covariance of differences of independent means of these numbers of values, each pair a row.
    fn of_pairs(sizes: &[f64], pairs: &[(usize, usize)]) -> DMatrix<f64> {
        let variance = |a: usize, b: usize| if a == b { 1.0 / sizes[a] } else { 0.0 };
        DMatrix::from_fn(pairs.len(), pairs.len(), |i, j| {
            let ((a, b), (c, d)) = (pairs[i], pairs[j]);
            variance(a, c) - variance(a, d) - variance(b, c) + variance(b, d)
        })
    }

    #[test]
    fn closed_form_of_one_and_of_opposites() {
        for covariance in [
            DMatrix::from_element(1, 1, 4.0),
            DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]),
        ] {
            let largest = LargestT::of_covariance(&covariance).unwrap();
            assert!((largest.upper(2.1, 7.0) - t_two_sided(2.1, 7.0)).abs() < 1e-14);
            let critical = largest.upper_quantile(0.05, 7.0);
            assert!((t_two_sided(critical, 7.0) - 0.05).abs() < 1e-11);
        }
        assert_eq!(LargestT::of_covariance(&DMatrix::zeros(2, 2)), None);
    }

    /// All pairs of equal groups are the studentised range.
    #[test]
    fn reference_all_pairs_are_tukeys() {
        for count in [3, 4, 6, 10] {
            let pairs: Vec<_> = (0..count)
                .flat_map(|a| (a + 1..count).map(move |b| (a, b)))
                .collect();
            let largest = LargestT::of_covariance(&of_pairs(&vec![5.0; count], &pairs)).unwrap();
            for (c, df) in [(1.5, 8.0), (2.5, 20.0), (3.5, 12.0), (2.8, 200.0)] {
                let expected = studentized_range_upper(c * 2.0_f64.sqrt(), count, df);
                let found = largest.upper(c, df);
                let bound = if count == 3 { 1e-9 } else { 3e-5 };
                assert!(
                    (found - expected).abs() < bound,
                    "{count} {c}: {found} {expected}"
                );
            }
        }
    }
}
