//! How sure a fit is: covariance from the residuals themselves, and a test of
//! whether they are random.

use crate::fit::edge_errors::meat_of_edges;
use crate::fit::residual::Rows;
use crate::noise::whitening::unit_shift;
use crate::samples::{QUANTITIES, Quantity, SampleGroup};
use windfall_numerics::least_squares::NormalEquations;

/// Lags beyond this fraction of the series are ignored: their correlations are
/// noise.
const LARGEST_LAG_FRACTION: f64 = 0.25;
/// Lags in a row that must be insignificant for the correlation to be over.
const QUIET_LAGS: usize = 5;
/// A correlation below this many times √(log₁₀ n / n) is insignificant.
const SIGNIFICANT: f64 = 2.0;
/// Smallest inflation of the variance: where errors of neighbours cancel in the residuals,
/// they need not cancel in what is estimated from them.
const SMALLEST_INFLATION: f64 = 1.0;

/// Covariance of weighted least-squares estimates whose weights need not be
/// the inverse variances, whose residuals may be correlated in time beyond what
/// the weights know, and whose channels may share an error of all their samples:
///
/// ```text
/// C = N⁻¹ M N⁻¹,   N = Σ w J Jᵀ
/// M = Σ_q [ λ_q s_q² Σ w J Jᵀ ]  less what the channels' zeros leave unsaid
/// ```
///
/// with rows that are whitened as the group's persistence says and weighted as
/// its weights say. s² is the mean square of a channel's residuals so
/// standardised, λ its inflation by what correlation is left ([`inflation`]).
///
/// Edges of a count have a part of their own: their errors cancel or add up.
/// A channel whose noise the user gave has λ s² = 1, and so have priors, which add J Jᵀ / σ².
///
/// * `equations`: N at the optimum, zeros taken out, with priors
/// * `rows`: residuals and Jacobian of each sample
/// * `offsets`: standard uncertainty of each quantity's zero, as far as the
///   weights do not know it; SI. It adds u² g gᵀ to M, g = Σ w J.
/// * `priors`: the part of N that is of priors
/// * `parameters`: number of free parameters
///
/// Returns C, or `None` when N is singular.
///
/// # Numerics
/// λ takes the derivatives as slow against the correlation of the residuals,
/// which holds except for the few samples at first touch.
///
/// # Source
/// Gallant (1987), Nonlinear Statistical Models, secs. 2.1-2.2, for the
/// sandwich with correlated errors.
pub fn covariance<const P: usize>(
    equations: &NormalEquations<P>,
    (rows, groups): (&Rows, &[SampleGroup]),
    offsets: &[f64; QUANTITIES],
    priors: &NormalEquations<P>,
    parameters: usize,
) -> Option<[[f64; P]; P]> {
    let bread = equations.inverse(parameters)?;
    let freedom = rows.freedom_lost(parameters);
    let mut meat = priors.normal;
    for (g, group) in groups.iter().enumerate() {
        for quantity in Quantity::ALL {
            let q = quantity as usize;
            let residuals = &rows.residuals[g][q];
            if residuals.is_empty() {
                continue;
            }
            let z = standardised(group, quantity, residuals);
            let variance = match group.given[q] {
                true => 1.0,
                false => freedom * mean_square(&z) * inflation(&z),
            };
            let jacobian = &rows.jacobian[g][q];
            if quantity == Quantity::Displacement && !group.edges.is_empty() {
                let own = meat_of_edges::<P>(group, (residuals, jacobian), inflation(&z));
                for p in 0..P {
                    for r in 0..P {
                        meat[p][r] += freedom * own[p][r];
                    }
                }
                continue;
            }
            add_meat(&mut meat, group, quantity, jacobian, variance, offsets[q]);
        }
    }
    Some(sandwich(&bread, &meat, parameters))
}

/// Residuals over their standard deviation, made independent as the group's
/// persistence says: of variance 1 if the weights are right.
pub fn standardised(group: &SampleGroup, quantity: Quantity, residuals: &[f64]) -> Vec<f64> {
    let persistence = group.persistence[quantity as usize];
    let scale = 1.0 / (1.0 - persistence * persistence).sqrt();
    (0..residuals.len())
        .map(|i| {
            let white = match i {
                0 => residuals[0],
                _ if persistence == 0.0 => residuals[i],
                _ => (residuals[i] - persistence * residuals[i - 1]) * scale,
            };
            white * group.weight_of(quantity, i).sqrt()
        })
        .collect()
}

/// √w times the derivatives of each sample, made independent like
/// [`standardised`] residuals.
///
/// * `jacobian`: P derivatives per sample
pub fn whitened_derivatives<const P: usize>(
    group: &SampleGroup,
    quantity: Quantity,
    jacobian: &[f64],
) -> Vec<[f64; P]> {
    let persistence = group.persistence[quantity as usize];
    let scale = 1.0 / (1.0 - persistence * persistence).sqrt();
    let mut before = [0.0; P];
    let rows = jacobian.chunks_exact(P).enumerate();
    rows.map(|(i, row)| {
        let row: [f64; P] = std::array::from_fn(|p| row[p]);
        let root = group.weight_of(quantity, i).sqrt();
        let white = std::array::from_fn(|p| match i {
            _ if i == 0 || persistence == 0.0 => row[p] * root,
            _ => (row[p] - persistence * before[p]) * scale * root,
        });
        before = row;
        white
    })
    .collect()
}

/// √w times what a zero of 1 shifts each sample by, made independent.
pub(crate) fn whitened_zero(
    group: &SampleGroup,
    quantity: Quantity,
) -> impl Iterator<Item = f64> + '_ {
    let shift = unit_shift(group.persistence[quantity as usize]);
    (0..group.times().len()).map(move |i| {
        let root = group.weight_of(quantity, i).sqrt();
        if i == 0 { root } else { shift * root }
    })
}

/// N⁻¹ M N⁻¹ of the first parameters.
pub(crate) fn sandwich<const P: usize>(
    bread: &[[f64; P]; P],
    meat: &[[f64; P]; P],
    parameters: usize,
) -> [[f64; P]; P] {
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
    out
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

/// By how much the correlation of residuals in time widens the variance of
/// what is estimated from them: λ = Σ ρ(lag) over all lags, but at least 1.
///
/// # Numerics
/// Flat-top lag window: correlations count in full up to the lag m after which
/// five in a row are insignificant, and fade to nothing at 2m.
///
/// # Source
/// Politis (2003), Adaptive bandwidth choice, J. Nonparametric Statistics
/// 15:517.
pub fn inflation(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let power = sum_of_products(residuals, residuals);
    let limit = (LARGEST_LAG_FRACTION * n as f64) as usize;
    if power <= 0.0 || limit < 2 {
        return 1.0;
    }
    let correlation =
        |lag: usize| -> f64 { sum_of_products(&residuals[..n - lag], &residuals[lag..]) / power };
    let significant = SIGNIFICANT * ((n as f64).log10() / n as f64).sqrt();
    let mut correlations = Vec::new();
    let (mut last, mut quiet) = (0, 0);
    for lag in 1..=limit {
        correlations.push(correlation(lag));
        quiet = if correlations[lag - 1].abs() < significant {
            quiet + 1
        } else {
            0
        };
        if quiet == 0 {
            last = lag;
        }
        if quiet >= QUIET_LAGS && lag >= 2 * last {
            break;
        }
    }
    let mut sum = 1.0;
    for (lag, rho) in (1..=2 * last).zip(&correlations) {
        let fade = (2.0 - lag as f64 / last as f64).clamp(0.0, 1.0);
        sum += 2.0 * fade * rho;
    }
    sum.max(SMALLEST_INFLATION)
}

/// Σ aᵢ bᵢ, in several sums that do not wait for each other.
fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    const SUMS: usize = 8;
    let (a, b) = (a.chunks_exact(SUMS), b.chunks_exact(SUMS));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    let mut sums = [0.0; SUMS];
    for (a, b) in a.zip(b) {
        for i in 0..SUMS {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Adds `variance` Σ w J Jᵀ of one channel, whitened, less what its zero leaves
/// unsaid.
fn add_meat<const P: usize>(
    meat: &mut [[f64; P]; P],
    group: &SampleGroup,
    quantity: Quantity,
    jacobian: &[f64],
    variance: f64,
    offset: f64,
) {
    let (mut total, mut square, mut sums) = ([0.0; P], 0.0, [[0.0; P]; P]);
    let rows = whitened_derivatives::<P>(group, quantity, jacobian);
    for (row, own) in rows.iter().zip(whitened_zero(group, quantity)) {
        square += own * own;
        for p in 0..P {
            total[p] += own * row[p];
            for q in 0..P {
                sums[p][q] += row[p] * row[q];
            }
        }
    }
    for p in 0..P {
        for q in 0..P {
            meat[p][q] += variance * sums[p][q];
        }
    }
    for p in 0..P {
        for q in 0..P {
            meat[p][q] += offset * offset * total[p] * total[q];
        }
    }
    let sd = group.zero_sd[quantity as usize];
    if sd > 0.0 {
        let pivot = variance / (square + 1.0 / (sd * sd));
        for p in 0..P {
            for q in 0..P {
                meat[p][q] -= pivot * total[p] * total[q];
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
pub fn runs_test(residuals: &[f64]) -> Option<RunsTest> {
    let signs: Vec<bool> = residuals
        .iter()
        .filter(|r| **r != 0.0)
        .map(|r| *r > 0.0)
        .collect();
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
        let residuals: Vec<f64> = (0..20)
            .map(|i| if i / 2 % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
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
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
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
        rows.residuals
            .push([residuals.clone(), vec![], vec![], vec![]]);
        rows.jacobian.push([vec![1.0; n], vec![], vec![], vec![]]);
        let mut equations = NormalEquations::<1>::ZERO;
        for r in &residuals {
            equations.add(3.0, *r, &[1.0]);
        }
        let found = covariance(
            &equations,
            (&rows, &[group]),
            &[0.0; 4],
            &NormalEquations::ZERO,
            1,
        )
        .unwrap()[0][0];
        let expected = 1.0 / (1.0 - phi * phi) / n as f64 * (1.0 + phi) / (1.0 - phi);
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
        // Moving average x_i − x_(i−2): every correlation cancels but the ends'.
        let differences: Vec<f64> = (0..n).map(|_| noise()).collect();
        let differences: Vec<f64> = differences.windows(3).map(|w| w[2] - w[0]).collect();
        assert_eq!(inflation(&differences), SMALLEST_INFLATION);
    }
}
