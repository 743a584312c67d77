//! Least-squares polynomials over short stretches of a signal.

/// Highest order that the routines of this module take.
pub const MAX_ORDER: usize = 4;

/// Intervals that differ by less than this part count as equal; 1. Times
/// written with few decimals differ by rounding only.
const EVEN_SPACING: f64 = 1e-6;

type Square = [[f64; MAX_ORDER + 1]; MAX_ORDER + 1];

/// Polynomial fitted to samples by least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialFit {
    /// Derivatives 0, 1, … at the origin asked for.
    pub derivatives: Vec<f64>,
    /// Standard deviation of each derivative, from the residuals; NaN if there
    /// are no residual degrees of freedom.
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
#[must_use]
pub fn fit_polynomial(
    times: &[f64],
    values: &[f64],
    origin: f64,
    order: usize,
) -> Option<PolynomialFit> {
    let scale = largest_distance(times, origin)?;
    let inverse = inverse_normal_matrix(times, origin, scale, order)?;

    // Right-hand side about a reference value, to keep small signals on large offsets.
    let reference = values[0];
    let mut moments = [0.0; MAX_ORDER + 1];
    for (time, value) in times.iter().zip(values) {
        let mut power = value - reference;
        for moment in moments.iter_mut().take(order + 1) {
            *moment += power;
            power *= (time - origin) / scale;
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
            let u = (time - origin) / scale;
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
#[must_use]
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
    let even = evenly_spaced(times);
    let centre = even.then(|| weights(&times[..window], times[half], order, derivative));
    let mut filtered = Vec::with_capacity(n);
    for i in 0..n {
        let first = i.saturating_sub(half).min(n - window);
        let span = first..first + window;
        let interior = i >= half && i + half < n;
        let own;
        let weights = match &centre {
            Some(weights) if interior => weights.as_ref()?,
            _ => {
                own = weights_at(times, span.clone(), i, order, derivative)?;
                &own
            }
        };
        let reference = values[i];
        let sum: f64 = weights
            .iter()
            .zip(&values[span])
            .map(|(w, value)| w * (value - reference))
            .sum();
        filtered.push(if derivative == 0 {
            sum + reference
        } else {
            sum
        });
    }
    Some(filtered)
}

/// Standard deviation of the filter's output for white noise of unit standard
/// deviation at its input, in the middle of the signal:
///
/// ```text
/// g = √(Σ wᵢ²)
/// ```
///
/// Unit: s to the power −`derivative`. `interval`: time between samples; s.
#[must_use]
pub fn noise_gain(interval: f64, window: usize, order: usize, derivative: usize) -> Option<f64> {
    let times: Vec<f64> = (0..window).map(|i| i as f64 * interval).collect();
    let weights = weights(&times, times[window / 2], order, derivative)?;
    Some(weights.iter().map(|w| w * w).sum::<f64>().sqrt())
}

/// True if all intervals are equal but for rounding.
#[must_use]
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

fn weights_at(
    times: &[f64],
    span: std::ops::Range<usize>,
    i: usize,
    order: usize,
    derivative: usize,
) -> Option<Vec<f64>> {
    weights(&times[span], times[i], order, derivative)
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
fn inverse_normal_matrix(times: &[f64], origin: f64, scale: f64, order: usize) -> Option<Square> {
    if order > MAX_ORDER || times.len() <= order {
        return None;
    }
    let mut sums = [0.0; 2 * MAX_ORDER + 1];
    for time in times {
        let u = (time - origin) / scale;
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
