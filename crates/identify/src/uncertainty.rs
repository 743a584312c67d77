//! How sure a fit is: covariance from the residuals themselves, and a test of
//! whether they are random.

use crate::residual::{QUANTITIES, Rows, SampleGroup};
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::NormalEquations;

/// Residuals are taken as correlated at most this far apart, as a fraction of
/// the series: beyond, the estimate of a correlation is noise itself.
const LARGEST_LAG_FRACTION: f64 = 0.1;

/// Covariance of weighted least-squares estimates whose weights need not be
/// the inverse variances and whose residuals may be correlated in time:
///
/// ```text
/// C = N⁻¹ M N⁻¹,   N = Σ w J Jᵀ,   M = Σ_q w_q² s_q² Σ_ij ρ_q(i−j) J_i J_jᵀ
/// ```
///
/// s² and ρ are the variance and the autocorrelation of each channel's
/// residuals. ρ is kept up to its first pair of lags that does not add
/// anything (the initial positive sequence), so that a slowly decaying
/// correlation counts in full and the noise of the far lags does not.
///
/// * `equations`: N at the optimum
/// * `rows`: residuals and Jacobian of each sample
/// * `parameters`: number of free parameters
///
/// Returns C, or `None` when N is singular.
///
/// # Source
/// Gallant (1987), Nonlinear Statistical Models, sec. 2.1-2.2, for the
/// sandwich; Geyer (1992), Statistical Science 7:473, for the cut-off.
#[must_use]
pub fn covariance<const P: usize>(
    equations: &NormalEquations<P>,
    rows: &Rows,
    groups: &[SampleGroup],
    parameters: usize,
) -> Option<[[f64; P]; P]> {
    let mut normal = equations.normal;
    for i in parameters..P {
        normal[i][i] = 1.0;
    }
    let bread = cholesky::inverse(&normal)?;
    let total: usize = rows.residuals.iter().flatten().map(Vec::len).sum();
    // Degrees of freedom that the parameters used up, shared by all channels.
    let freedom = total as f64 / total.saturating_sub(parameters).max(1) as f64;
    let mut meat = [[0.0; P]; P];
    for (g, group) in groups.iter().enumerate() {
        for q in 0..QUANTITIES {
            let (residuals, jacobian) = (&rows.residuals[g][q], &rows.jacobian[g][q]);
            if residuals.is_empty() {
                continue;
            }
            let weight = group.weight(crate::residual::Quantity::ALL[q]);
            let variance = freedom * mean_square(residuals);
            let correlations = autocorrelation(residuals);
            add_meat(&mut meat, jacobian, &correlations, weight * weight * variance);
        }
    }
    let mut out = [[0.0; P]; P];
    for i in 0..parameters {
        for j in 0..parameters {
            for k in 0..parameters {
                for l in 0..parameters {
                    out[i][j] += bread[i][k] * meat[k][l] * bread[l][j];
                }
            }
        }
    }
    Some(out)
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

/// Autocorrelation from lag 1 up to the cut-off.
fn autocorrelation(residuals: &[f64]) -> Vec<f64> {
    let n = residuals.len();
    let power: f64 = residuals.iter().map(|r| r * r).sum();
    let limit = (LARGEST_LAG_FRACTION * n as f64) as usize;
    let at = |lag: usize| -> f64 {
        let pairs = residuals[..n - lag].iter().zip(&residuals[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / power
    };
    let mut out = Vec::new();
    let mut lag = 1;
    while lag + 1 <= limit && power > 0.0 {
        let (odd, even) = (at(lag), at(lag + 1));
        if odd + even <= 0.0 {
            break;
        }
        out.extend([odd, even]);
        lag += 2;
    }
    out
}

/// Adds scale · Σ_ij ρ(i−j) J_i J_jᵀ.
fn add_meat<const P: usize>(
    meat: &mut [[f64; P]; P],
    jacobian: &[f64],
    correlations: &[f64],
    scale: f64,
) {
    let rows: Vec<&[f64]> = jacobian.chunks_exact(P).collect();
    let n = rows.len();
    // Σ_j ρ(i−j) J_j as a vector per i would cost n·lags·P too; this needs no
    // storage.
    for i in 0..n {
        let mut smoothed: [f64; P] = std::array::from_fn(|p| rows[i][p]);
        for (lag, rho) in (1..).zip(correlations) {
            for p in 0..P {
                if i >= lag {
                    smoothed[p] += rho * rows[i - lag][p];
                }
                if i + lag < n {
                    smoothed[p] += rho * rows[i + lag][p];
                }
            }
        }
        for p in 0..P {
            for q in 0..P {
                meat[p][q] += 0.5 * scale * (rows[i][p] * smoothed[q] + rows[i][q] * smoothed[p]);
            }
        }
    }
}

/// Wald-Wolfowitz runs test of residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunsTest {
    /// Runs of equal sign found.
    pub runs: usize,
    /// Runs expected of random signs.
    pub expected: f64,
    /// Standardised difference: negative when there are too few runs.
    pub z: f64,
}

/// Runs test of the signs of `residuals`; `None` when they have one sign only
/// or there are fewer than ten.
///
/// # Source
/// Wald and Wolfowitz (1940), Ann. Math. Statist. 11:147.
#[must_use]
pub fn runs_test(residuals: &[f64]) -> Option<RunsTest> {
    let signs: Vec<bool> = residuals.iter().filter(|r| **r != 0.0).map(|r| *r > 0.0).collect();
    let positive = signs.iter().filter(|s| **s).count() as f64;
    let total = signs.len() as f64;
    let negative = total - positive;
    if total < 10.0 || positive == 0.0 || negative == 0.0 {
        return None;
    }
    let runs = 1 + signs.windows(2).filter(|w| w[0] != w[1]).count();
    let product = 2.0 * positive * negative;
    let expected = product / total + 1.0;
    let variance = product * (product - total) / (total * total * (total - 1.0));
    Some(RunsTest {
        runs,
        expected,
        z: (runs as f64 - expected) / variance.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sequence and result of the worked example in the NIST/SEMATECH
    /// e-Handbook's definition: 10 positive, 10 negative alternating in pairs
    /// has 10 runs against 11 expected, variance 2·10·10·180/(400·19).
    #[test]
    fn closed_form_runs() {
        let residuals: Vec<f64> = (0..20).map(|i| if i / 2 % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let found = runs_test(&residuals).unwrap();
        assert_eq!((found.runs, found.expected), (10, 11.0));
        let variance: f64 = 200.0 * 180.0 / (400.0 * 19.0);
        assert!((found.z + 1.0 / variance.sqrt()).abs() < 1e-12);
        assert!(runs_test(&[1.0; 30]).is_none());
    }

    /// A constant fitted to AR(1) noise: the variance of its mean is
    /// σ²/n (1+φ)/(1−φ).
    #[test]
    fn closed_form_variance_of_a_correlated_mean() {
        let (n, phi) = (20_000, 0.7);
        let mut state = 12345_u64;
        let mut noise = || {
            let mut sum = 0.0;
            for _ in 0..12 {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
            }
            sum - 6.0
        };
        let mut residuals = vec![0.0];
        for i in 1..n {
            residuals.push(phi * residuals[i - 1] + noise());
        }
        let group = SampleGroup::new(&vec![0.0; n], [Some((&residuals, 3.0)), None, None, None]);
        let mut rows = Rows::default();
        rows.residuals.push([residuals.clone(), vec![], vec![], vec![]]);
        rows.jacobian.push([vec![1.0; n], vec![], vec![], vec![]]);
        let mut equations = NormalEquations::<1>::ZERO;
        for r in &residuals {
            equations.add(3.0, *r, &[1.0]);
        }
        let found = covariance(&equations, &rows, &[group], 1).unwrap()[0][0];
        let expected = 1.0 / (1.0 - phi * phi) / n as f64 * (1.0 + phi) / (1.0 - phi);
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
    }
}
