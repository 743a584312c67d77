//! How far the draws of Markov chains can be trusted.
//!
//! Chains are slices of equal length, one parameter at a time.

use windfall_distribution::quantile::{median, quantile};
use windfall_distribution::tail::normal_quantile;

/// Variance within chains, relative to that of all, below which they do not move; 1.
const STILL: f64 = 1e-20;

/// Levels whose estimates tell how well the ends of an interval are known; 1.
const TAILS: [f64; 2] = [0.05, 0.95];

/// How well the chains of one parameter agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainDiagnostics {
    /// Spread of all chains over that within: 1 when they agree, usable below 1.01.
    pub r_hat: f64,
    /// Independent draws that would tell the centre as well.
    pub bulk_draws: f64,
    /// Independent draws that would tell the 5 % and 95 % quantiles as well.
    pub tail_draws: f64,
}

/// Diagnostics of one parameter; `None` with fewer than four draws a chain,
/// chains of unequal length, or draws that are not numbers.
///
/// # Numerics
/// Each chain is split in halves. R-hat is the larger of those of the ranks and
/// of the ranks of the distance from the median, both made normal; draws that do
/// not vary give R-hat 1 in agreement and infinity otherwise.
///
/// # Source
/// Vehtari, Gelman, Simpson, Carpenter and Bürkner (2021), Bayesian Analysis
/// 16:667, eqs. (4), (10)-(14); Geyer (1992), Statist. Sci. 7:473, for where the
/// sum of correlations ends.
pub fn chain_diagnostics(chains: &[&[f64]]) -> Option<ChainDiagnostics> {
    let length = chains.first()?.len();
    let usable = length >= 4
        && chains
            .iter()
            .all(|c| c.len() == length && c.iter().all(|v| v.is_finite()));
    if !usable {
        return None;
    }
    let halves = split(chains);
    let all: Vec<f64> = halves.concat();
    let middle = median(&all);
    let folded: Vec<Vec<f64>> = halves
        .iter()
        .map(|chain| chain.iter().map(|v| (v - middle).abs()).collect())
        .collect();
    let ranked = rank_normalised(&halves);
    let r_hat = r_hat(&ranked).max(r_hat(&rank_normalised(&folded)));
    let tails = TAILS.map(|level| {
        let limit = quantile(&all, level);
        let below: Vec<Vec<f64>> = halves
            .iter()
            .map(|chain| chain.iter().map(|v| f64::from(*v <= limit)).collect())
            .collect();
        independent_draws(&below)
    });
    Some(ChainDiagnostics {
        r_hat,
        bulk_draws: independent_draws(&ranked),
        tail_draws: tails[0].min(tails[1]),
    })
}

fn split(chains: &[&[f64]]) -> Vec<Vec<f64>> {
    let half = chains[0].len() / 2;
    let parts = chains
        .iter()
        .flat_map(|chain| [&chain[..half], &chain[chain.len() - half..]]);
    parts.map(<[f64]>::to_vec).collect()
}

/// Ranks over all chains (ties share their mean), as Blom's normal scores.
fn rank_normalised(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let length = chains[0].len();
    let all: Vec<f64> = chains.concat();
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|a, b| all[*a].total_cmp(&all[*b]));
    let mut scores = vec![0.0; all.len()];
    let mut from = 0;
    while from < order.len() {
        let value = all[order[from]];
        let to = from + order[from..].partition_point(|i| all[*i] <= value);
        let rank = 0.5 * (from + 1 + to) as f64;
        let score = normal_quantile((rank - 0.375) / (all.len() as f64 + 0.25));
        for index in &order[from..to] {
            scores[*index] = score;
        }
        from = to;
    }
    scores.chunks_exact(length).map(<[f64]>::to_vec).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Unbiased variance.
fn variance(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|v| (v - centre).powi(2)).sum::<f64>() / (values.len() - 1) as f64
}

/// Within-chain variance, and the estimate of the variance from all chains.
fn variances(chains: &[Vec<f64>]) -> (f64, f64) {
    let length = chains[0].len() as f64;
    let within = mean(&chains.iter().map(|c| variance(c)).collect::<Vec<_>>());
    let between = if chains.len() > 1 {
        variance(&chains.iter().map(|c| mean(c)).collect::<Vec<_>>())
    } else {
        0.0
    };
    (within, within * (length - 1.0) / length + between)
}

fn r_hat(chains: &[Vec<f64>]) -> f64 {
    let (within, all) = variances(chains);
    if all <= 0.0 {
        1.0
    } else if within <= STILL * all {
        f64::INFINITY
    } else {
        (all / within).sqrt()
    }
}

/// Number of independent draws with the same accuracy of the mean.
fn independent_draws(chains: &[Vec<f64>]) -> f64 {
    let length = chains[0].len();
    let total = (chains.len() * length) as f64;
    let (within, all) = variances(chains);
    if all <= 0.0 {
        return total;
    }
    let centres: Vec<f64> = chains.iter().map(|c| mean(c)).collect();
    // Correlation at a lag over all chains.
    let correlation = |lag: usize| {
        let sum: f64 = chains
            .iter()
            .zip(&centres)
            .map(|(chain, centre)| {
                let pairs = chain.iter().zip(&chain[lag..]);
                pairs.map(|(a, b)| (a - centre) * (b - centre)).sum::<f64>()
            })
            .sum();
        let covariance = sum / total;
        1.0 - (within - covariance * length as f64 / (length - 1) as f64) / all
    };
    // Sums of neighbouring pairs, as long as they are positive, made to fall.
    let mut sum = 0.0;
    let mut smallest = f64::INFINITY;
    let mut lag = 0;
    while lag + 1 < length - 1 {
        let first = if lag == 0 { 1.0 } else { correlation(lag) };
        let pair = first + correlation(lag + 1);
        if pair <= 0.0 {
            // The even term that stands alone counts if it is positive.
            sum += first.max(0.0).min(smallest);
            break;
        }
        smallest = smallest.min(pair);
        sum += smallest;
        lag += 2;
    }
    let time = (2.0 * sum - 1.0).max(1.0 / total.log10());
    total / time
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of an AR(1) with innovation from a fixed generator.
    fn autoregression(phi: f64, n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut uniform = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let mut value = normal();
        (0..n)
            .map(|_| {
                value = phi * value + (1.0 - phi * phi).sqrt() * normal();
                value
            })
            .collect()
    }

    fn of(chains: &[Vec<f64>]) -> ChainDiagnostics {
        let chains: Vec<&[f64]> = chains.iter().map(Vec::as_slice).collect();
        chain_diagnostics(&chains).unwrap()
    }

    /// The mean of n draws of an AR(1) is as good as that of n (1−φ)/(1+φ)
    /// independent ones.
    #[test]
    fn closed_form_draws_of_an_autoregression() {
        for phi in [0.0, 0.5, 0.9] {
            let chains: Vec<_> = (1..5).map(|s| autoregression(phi, 5000, s)).collect();
            let found = of(&chains);
            let expected = 20_000.0 * (1.0 - phi) / (1.0 + phi);
            assert!(
                (found.bulk_draws / expected - 1.0).abs() < 0.15,
                "{phi} {found:?}"
            );
            assert!(found.r_hat < 1.01, "{phi} {found:?}");
        }
    }

    #[test]
    fn closed_form_chains_that_disagree() {
        let mut chains: Vec<_> = (1..5).map(|s| autoregression(0.0, 1000, s)).collect();
        chains[0].iter_mut().for_each(|v| *v += 1.0);
        assert!(of(&chains).r_hat > 1.05);
        // Equal centres, unequal widths: only the folded ranks see it.
        let mut chains: Vec<_> = (1..5).map(|s| autoregression(0.0, 1000, s)).collect();
        chains[0].iter_mut().for_each(|v| *v *= 3.0);
        assert!(of(&chains).r_hat > 1.05);
        let stuck = vec![vec![1.0; 100], vec![2.0; 100]];
        assert_eq!(of(&stuck).r_hat, f64::INFINITY);
    }

    #[test]
    fn rejects_draws_that_tell_nothing() {
        assert!(chain_diagnostics(&[]).is_none());
        assert!(chain_diagnostics(&[&[1.0, 2.0, 3.0]]).is_none());
        assert!(chain_diagnostics(&[&[1.0; 8], &[1.0; 9]]).is_none());
        assert!(chain_diagnostics(&[&[1.0, f64::NAN, 2.0, 3.0]]).is_none());
    }
}
