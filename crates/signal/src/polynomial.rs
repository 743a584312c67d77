//! Least-squares polynomials over short stretches of a signal.

use std::ops::Range;
use windfall_numerics::fast::fast;

/// Highest order that the routines of this module take.
pub const MAX_ORDER: usize = 4;

/// Intervals that differ by less than this part are equal: rounding of printed times.
const EVEN_SPACING: f64 = 1e-6;

/// Places of a window that are summed up together.
const BLOCK: usize = 8;

type Square = [[f64; MAX_ORDER + 1]; MAX_ORDER + 1];

/// Polynomial fitted to samples by least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialFit {
    /// Derivatives 0, 1, … at the origin asked for.
    pub derivatives: Vec<f64>,
    /// Standard deviation of each derivative; NaN without residual degrees of freedom.
    pub standard_deviations: Vec<f64>,
    /// √(Σ residual² / (n − order − 1)).
    pub residual_deviation: f64,
    /// Propagation of a unit white noise into each derivative.
    pub noise_gains: Vec<f64>,
}

/// Polynomial of `order` through (`times`, `values`), with its derivatives at
/// `origin`; `None` if there are fewer than `order + 1` samples, if times
/// coincide, or if `order` exceeds [`MAX_ORDER`].
///
/// # Numerics
/// Normal equations in time scaled to [−1, 1], Cholesky; orders are small.
pub fn fit_polynomial(
    times: &[f64],
    values: &[f64],
    origin: f64,
    order: usize,
) -> Option<PolynomialFit> {
    // Compiled for each order: the loops over its terms are short.
    match order {
        0 => fit_order::<0>(times, values, origin),
        1 => fit_order::<1>(times, values, origin),
        2 => fit_order::<2>(times, values, origin),
        3 => fit_order::<3>(times, values, origin),
        MAX_ORDER => fit_order::<MAX_ORDER>(times, values, origin),
        _ => None,
    }
}

fn fit_order<const ORDER: usize>(
    times: &[f64],
    values: &[f64],
    origin: f64,
) -> Option<PolynomialFit> {
    let order = ORDER;
    let scale = largest_distance(times, origin)?;
    let inverse = inverse_normal_matrix(times, origin, scale, order)?;
    let per_scale = scale.recip();

    // Right-hand side about a reference value, to keep small signals on large offsets.
    let reference = values[0];
    let mut moments = [0.0; MAX_ORDER + 1];
    for (time, value) in times.iter().zip(values) {
        let mut power = value - reference;
        for moment in moments.iter_mut().take(order + 1) {
            *moment += power;
            power *= (time - origin) * per_scale;
        }
    }
    let mut coefficients = [0.0; MAX_ORDER + 1];
    for i in 0..=order {
        coefficients[i] = (0..=order).map(|j| inverse[i][j] * moments[j]).sum();
    }

    // Residuals, and from them the spread of each derivative.
    let sum: f64 = times
        .iter()
        .zip(values)
        .map(|(time, value)| {
            let u = (time - origin) * per_scale;
            let fitted = (0..=order)
                .rev()
                .fold(0.0, |sum, i| sum * u + coefficients[i]);
            (value - reference - fitted).powi(2)
        })
        .sum();
    let freedom = times.len() - order - 1;
    let residual_deviation = if freedom > 0 {
        (sum / freedom as f64).sqrt()
    } else {
        f64::NAN
    };
    let mut derivatives = Vec::with_capacity(order + 1);
    let mut noise_gains = Vec::with_capacity(order + 1);
    let mut unit = 1.0;
    for i in 0..=order {
        if i > 0 {
            unit *= i as f64 / scale;
        }
        derivatives.push(coefficients[i] * unit);
        noise_gains.push(inverse[i][i].sqrt() * unit);
    }
    derivatives[0] += reference;
    Some(PolynomialFit {
        standard_deviations: noise_gains.iter().map(|g| g * residual_deviation).collect(),
        derivatives,
        residual_deviation,
        noise_gains,
    })
}

/// Savitzky-Golay filter: the given derivative of the local polynomial of
/// `order` through `window` samples (odd) around each sample; at both ends the
/// first and last full windows are used.
///
/// On uneven times the polynomial is fitted to the true times. `None` if the
/// window is even, longer than the signal or not longer than the order, or if
/// `derivative > order`.
///
/// # Source
/// Savitzky and Golay (1964), Anal. Chem. 36, 1627.
pub fn local_polynomial(
    times: &[f64],
    values: &[f64],
    window: usize,
    order: usize,
    derivative: usize,
) -> Option<Vec<f64>> {
    let n = values.len();
    if window.is_multiple_of(2)
        || window > n
        || window <= order
        || derivative > order
        || order > MAX_ORDER
    {
        return None;
    }
    let half = window / 2;
    let wanted = (order, derivative);
    let mut filtered = Vec::with_capacity(n);
    filtered.extend(near_end(times, values, (0..window, 0..half), wanted)?);
    if evenly_spaced(times) {
        let weights = weights(&times[..window], times[half], order, derivative)?;
        slide(&weights, values, derivative == 0, &mut filtered);
    } else {
        for first in 0..=n - window {
            let span = first..first + window;
            let weights = weights(&times[span.clone()], times[first + half], order, derivative)?;
            slide(&weights, &values[span], derivative == 0, &mut filtered);
        }
    }
    filtered.extend(near_end(
        times,
        values,
        (n - window..n, n - half..n),
        wanted,
    )?);
    Some(filtered)
}

/// Derivatives, at some samples near an end, of the polynomial through a span of samples.
fn near_end(
    times: &[f64],
    values: &[f64],
    (span, at): (Range<usize>, Range<usize>),
    (order, derivative): (usize, usize),
) -> Option<Vec<f64>> {
    let origin = times[span.start + span.len() / 2];
    let fit = fit_polynomial(&times[span.clone()], &values[span], origin, order)?;
    let of = |t: &f64| {
        // Horner, from the highest term: each is divided by what its power brings.
        let terms = (derivative..=order).rev();
        terms.fold(0.0, |sum, i| {
            let power = (i - derivative + 1) as f64;
            fit.derivatives[i] + sum * (t - origin) / power
        })
    };
    Some(times[at].iter().map(of).collect())
}

fn slide(weights: &[f64], values: &[f64], level: bool, out: &mut Vec<f64>) {
    fast(
        #[inline(always)]
        || slide_along(weights, values, level, out),
    );
}

/// Sums of weighted samples in a window that slides along them.
///
/// * `level`: whether the weights give a value, not a derivative
#[inline(always)]
fn slide_along(weights: &[f64], values: &[f64], level: bool, out: &mut Vec<f64>) {
    let half = weights.len() / 2;
    let places = values.len() + 1 - weights.len();
    let mut at = 0;
    while at < places {
        // Several places at once: their sums do not wait for each other.
        let count = if places - at < BLOCK { 1 } else { BLOCK };
        let middle = &values[at + half..];
        let mut sums = [0.0; BLOCK];
        if let (BLOCK, Some(middle)) = (count, middle.first_chunk::<BLOCK>()) {
            for (weight, own) in weights.iter().zip(values[at..].windows(BLOCK)) {
                for j in 0..BLOCK {
                    sums[j] += weight * (own[j] - middle[j]);
                }
            }
        } else {
            let pairs = weights.iter().zip(&values[at..]);
            sums[0] = pairs.map(|(weight, own)| weight * (own - middle[0])).sum();
        }
        let sums = sums.iter().zip(middle).take(count);
        out.extend(sums.map(|(sum, middle)| if level { sum + middle } else { *sum }));
        at += count;
    }
}

/// True if all intervals are equal but for rounding.
pub fn evenly_spaced(times: &[f64]) -> bool {
    let n = times.len();
    if n < 3 {
        return true;
    }
    let mean = (times[n - 1] - times[0]) / (n - 1) as f64;
    times.windows(2).all(|pair| {
        ((pair[1] - pair[0]) - mean).abs()
            <= EVEN_SPACING * mean + f64::EPSILON * 4.0 * pair[1].abs()
    })
}

/// Weights that turn samples at `times` into a derivative at `origin`.
fn weights(times: &[f64], origin: f64, order: usize, derivative: usize) -> Option<Vec<f64>> {
    let scale = largest_distance(times, origin)?;
    let inverse = inverse_normal_matrix(times, origin, scale, order)?;
    let unit = (1..=derivative).fold(1.0, |unit, i| unit * i as f64 / scale);
    let row = inverse[derivative];
    Some(
        times
            .iter()
            .map(|time| {
                let u = (time - origin) / scale;
                unit * (0..=order).rev().fold(0.0, |sum, j| sum * u + row[j])
            })
            .collect(),
    )
}

fn largest_distance(times: &[f64], origin: f64) -> Option<f64> {
    let scale = times.iter().map(|t| (t - origin).abs()).fold(0.0, f64::max);
    if times.len() == 1 {
        return Some(scale.max(1.0));
    }
    (scale > 0.0 && scale.is_finite()).then_some(scale)
}

/// (AᵀA)⁻¹ of the powers of (t − origin)/scale.
#[inline(always)]
fn inverse_normal_matrix(times: &[f64], origin: f64, scale: f64, order: usize) -> Option<Square> {
    if order > MAX_ORDER || times.len() <= order {
        return None;
    }
    let mut sums = [0.0; 2 * MAX_ORDER + 1];
    let per_scale = scale.recip();
    for time in times {
        let u = (time - origin) * per_scale;
        let mut power = 1.0;
        for sum in sums.iter_mut().take(2 * order + 1) {
            *sum += power;
            power *= u;
        }
    }
    let size = order + 1;
    let mut lower: Square = [[0.0; MAX_ORDER + 1]; MAX_ORDER + 1];
    for i in 0..size {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = sums[i + j] - dot;
            if i == j {
                if rest <= sums[2 * i] * 1e-14 {
                    return None;
                }
                lower[i][i] = rest.sqrt();
            } else {
                lower[i][j] = rest / lower[j][j];
            }
        }
    }
    Some(inverse_from_cholesky(&lower, size))
}

fn inverse_from_cholesky(lower: &Square, size: usize) -> Square {
    let mut inverse: Square = [[0.0; MAX_ORDER + 1]; MAX_ORDER + 1];
    #[allow(clippy::needless_range_loop)] // columns and rows, as in the algebra
    for column in 0..size {
        let mut y = [0.0; MAX_ORDER + 1];
        for i in 0..size {
            let unit = if i == column { 1.0 } else { 0.0 };
            let dot: f64 = (0..i).map(|k| lower[i][k] * y[k]).sum();
            y[i] = (unit - dot) / lower[i][i];
        }
        for i in (0..size).rev() {
            let dot: f64 = (i + 1..size)
                .map(|k| lower[k][i] * inverse[k][column])
                .sum();
            inverse[i][column] = (y[i] - dot) / lower[i][i];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: [f64; 11] = [0.0, 1.0, 4.0, 2.0, 7.0, 5.0, 9.0, 6.0, 3.0, 8.0, 2.0];

    fn check(window: usize, order: usize, derivative: usize, expected: [f64; 11]) {
        let times: Vec<f64> = (0..11).map(|i| 7.0 + 0.5 * f64::from(i)).collect();
        let filtered = local_polynomial(&times, &SAMPLES, window, order, derivative).unwrap();
        for (found, expected) in filtered.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
    }

    // scipy.signal.savgol_filter(x, window, order, deriv, delta=0.5,
    // mode='interp'), SciPy 1.17.1.
    #[test]
    fn reference_savitzky_golay() {
        let smooth = [
            0.228571428571429,
            1.08571428571429,
            2.37142857142857,
            4.22857142857143,
            4.68571428571428,
            7.22857142857143,
            7.28571428571428,
            5.91428571428571,
            5.31428571428571,
            4.25714285714285,
            3.48571428571428,
        ];
        check(5, 2, 0, smooth);
        let slope = [
            4.36507936507935,
            2.88888888888888,
            2.07936507936508,
            1.93650793650794,
            3.16666666666667,
            3.22222222222222,
            -2.71428571428571,
            -0.293650793650793,
            -1.34126984126984,
            -3.05555555555555,
            -5.43650793650792,
        ];
        check(7, 3, 1, slope);
        let start = 0.380952380952381;
        let end = -1.42857142857143;
        let middle = [-1.33333333333333, -3.14285714285714, -1.80952380952381];
        let [a, b, c] = middle;
        let bend = [start, start, start, start, a, b, c, end, end, end, end];
        check(7, 2, 2, bend);
        // √Σ savgol_coeffs(7, 2, deriv=1, delta=0.5)².
        let times = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];
        let weights = weights(&times, times[3], 2, 1).unwrap();
        let gain = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        assert!((gain - 0.3779644730092273).abs() < 1e-14);
    }

    #[test]
    fn closed_form_cubic_on_uneven_times() {
        let times: Vec<f64> = (0..9)
            .map(|i| f64::from(i) + 0.3 * f64::from(i % 3))
            .collect();
        let values: Vec<f64> = times.iter().map(|t| t * t * t - 2.0 * t).collect();
        let slopes = local_polynomial(&times, &values, 5, 3, 1).unwrap();
        for (t, slope) in times.iter().zip(slopes) {
            assert!((slope - (3.0 * t * t - 2.0)).abs() < 1e-9);
        }
    }

    // Straight line through (0, 1), (1, 3), (2, 4), (3, 4): slope 1, intercept
    // 1.5; residuals -0.5, 0.5, 0.5, -0.5, so s² = 1/2 on 2 degrees of freedom;
    // Σ(t - 1.5)² = 5.
    #[test]
    fn closed_form_straight_line() {
        let fit = fit_polynomial(&[0.0, 1.0, 2.0, 3.0], &[1.0, 3.0, 4.0, 4.0], 0.0, 1).unwrap();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(fit.derivatives[0], 1.5) && close(fit.derivatives[1], 1.0));
        assert!(close(fit.residual_deviation, 0.5f64.sqrt()));
        assert!(close(fit.standard_deviations[1], 0.1f64.sqrt()));
        // Intercept: s² (1/4 + 1.5²/5).
        assert!(close(fit.standard_deviations[0], (0.5f64 * 0.7).sqrt()));
    }
}
