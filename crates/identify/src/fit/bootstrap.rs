//! Bootstrap of one impact: recordings made of the fitted model and blocks of
//! its own residuals, each fitted again.

use crate::fit::batch::{BatchProblem, Room, minimise_batch};
use crate::fit::batch_law::BatchLaw;
use crate::fit::estimator::{Estimator, FreeParameter};
use crate::fit::interval::{
    Bootstrap, FreeIntervals, IntervalDetail, IntervalOptions, IntervalPlan, deviation, quantile,
};
use crate::fit::residual::Rows;
use crate::fit::uncertainty::{inflation, standardised, whitened_derivatives, whitened_zero};
use crate::noise::whitening::unit_shift;
use crate::samples::{Quantity, SampleGroup};
use windfall_distribution::tail::{normal_lower, normal_quantile};
use windfall_numerics::least_squares::{Minimum, Options, Stop};
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

/// A refit stops when less than this is left to gain, in units of χ²: a
/// hundredth of a standard deviation.
const GAIN_LEFT: f64 = 1e-4;

/// Refits that are prepared together, so that the vector lanes are rarely idle at
/// their end.
const TOGETHER: usize = 32;

/// Residuals of one channel, independent and of variance 1.
struct Channel<const P: usize> {
    group: usize,
    quantity: Quantity,
    /// Independent residuals, centred.
    pool: Vec<f64>,
    /// √w and the whitened derivatives times it.
    gradient: Vec<[f64; P]>,
    /// The fitted model at each sample.
    fitted: Vec<f64>,
    /// Noise per unit of an independent residual.
    scale: Vec<f64>,
    /// Samples of a block.
    block: usize,
    /// Σ w o J and Σ w o², for the zero.
    zero: ([f64; P], f64),
}

/// Intervals from refits of resampled recordings: bias-corrected percentiles.
///
/// # Numerics
/// Residuals are made independent by each channel's noise model, drawn one by one
/// or, where they are still correlated, in blocks of n^⅓, and coloured again; the
/// channel's zero is resampled. The first Gauss-Newton step of a refit needs no
/// evaluation, since everything it needs is known at the estimate; one or two
/// evaluations follow, of several replicates side by side. No samples are allocated
/// per replicate. Replicate i has stream i of the seed.
///
/// # Source
/// Künsch (1989), Ann. Statist. 17:1217, for the blocks; Efron (1981), Canad. J.
/// Statist. 9:139, for the correction of the percentiles.
pub(crate) fn bootstrap_intervals<
    L: BatchLaw<N>,
    const N: usize,
    const W: usize,
    const P: usize,
>(
    estimator: &Estimator<L, N, W, P>,
    minimum: &Minimum<P>,
    rows: &Rows,
    plan: &IntervalPlan,
    options: &Options<P>,
) -> Option<FreeIntervals> {
    let IntervalOptions {
        replicates, seed, ..
    } = plan.options;
    let free = estimator.free();
    let count = free.len();
    let channels = channels::<P>(estimator.groups(), rows, count);
    let inverse = minimum.equations.inverse(count)?;
    let options = Options {
        cost_tolerance: GAIN_LEFT / minimum.equations.cost.max(1.0),
        ..*options
    };
    let mut room = Room::of(estimator.groups());
    let mut recordings = vec![estimator.groups().to_vec(); TOGETHER.min(replicates)];
    let mut starts = vec![[0.0; P]; recordings.len()];
    let mut frees = vec![free.to_vec(); recordings.len()];
    let mut minima = vec![*minimum; recordings.len()];
    let mut estimates = vec![Vec::with_capacity(replicates); count];
    let mut failed = 0;
    for first in (0..replicates).step_by(TOGETHER) {
        let together = TOGETHER.min(replicates - first);
        for (i, groups) in recordings[..together].iter_mut().enumerate() {
            let mut source = noise_source(seed, (first + i) as u64);
            let mut gradient = resample(&channels, groups, &mut source);
            redraw_priors(minimum, &mut frees[i], &mut gradient, &mut source);
            starts[i] = stepped(&minimum.parameters, &inverse, &gradient, count);
        }
        let problems: Vec<_> = recordings[..together]
            .iter()
            .zip(&starts)
            .zip(&frees)
            .map(|((groups, start), free)| BatchProblem {
                estimator: estimator.with_groups(groups).with_free(free),
                from: Some(*start),
                options,
            })
            .collect();
        minimise_batch(&problems, &mut minima[..together], &mut room);
        for (problem, found) in problems.into_iter().zip(&mut minima) {
            if found.stop == Stop::BadStart {
                let mut refit = problem.estimator;
                *found = refit.minimise_from(&minimum.parameters, &options);
            }
            if !matches!(found.stop, Stop::Converged | Stop::Stuck) {
                failed += 1;
                continue;
            }
            for (i, parameter) in free.iter().enumerate() {
                estimates[i].push(parameter.coordinate.value(found.parameters[i]));
            }
        }
    }
    if estimates[0].len() < 2 {
        return None;
    }
    let ends = free.iter().zip(&estimates).enumerate();
    let (low, high) = ends
        .map(|(i, (parameter, estimates))| {
            let estimate = parameter.coordinate.value(minimum.parameters[i]);
            corrected_percentiles(estimates, estimate, plan.confidence)
        })
        .unzip();
    Some(FreeIntervals {
        low,
        high,
        sd: Some(estimates.iter().map(|e| deviation(e)).collect()),
        detail: IntervalDetail::Bootstrap(Bootstrap {
            replicates,
            failed,
            estimates,
        }),
    })
}

/// Draws the means of priors anew around the estimate, as if they were data; adds half the
/// gradient of their cost at the estimate.
fn redraw_priors<const P: usize>(
    minimum: &Minimum<P>,
    free: &mut [FreeParameter],
    gradient: &mut [f64; P],
    source: &mut NoiseSource,
) {
    for (i, parameter) in free.iter_mut().enumerate() {
        let coordinate = parameter.coordinate;
        if let Some(prior) = &mut parameter.prior {
            let value = coordinate.value(minimum.parameters[i]);
            let drawn = normal(source);
            prior.mean = value - prior.sd * drawn;
            gradient[i] += drawn * coordinate.slope(value) / prior.sd;
        }
    }
}

/// `from` less the first `count` components of `inverse` · `gradient`.
fn stepped<const P: usize>(
    from: &[f64; P],
    inverse: &[[f64; P]; P],
    gradient: &[f64; P],
    count: usize,
) -> [f64; P] {
    let mut to = *from;
    for i in 0..count {
        for j in 0..count {
            to[i] -= inverse[i][j] * gradient[j];
        }
    }
    to
}

fn channels<const P: usize>(
    groups: &[SampleGroup],
    rows: &Rows,
    parameters: usize,
) -> Vec<Channel<P>> {
    let freedom = rows.freedom_lost(parameters);
    let mut out = Vec::new();
    for (g, group) in groups.iter().enumerate() {
        for quantity in Quantity::ALL {
            let residuals = &rows.residuals[g][quantity as usize];
            if residuals.is_empty() {
                continue;
            }
            let mut pool = standardised(group, quantity, residuals);
            let n = pool.len();
            let mean = pool.iter().sum::<f64>() / n as f64;
            // The weights are those of the residuals with what correlation they
            // have left: blocks must not spread less than that.
            let square = pool.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / n as f64;
            let unit = 1.0 / square.max(f64::MIN_POSITIVE);
            // Those of edges also know how far the errors of neighbours cancel, which draws
            // that are independent do not.
            let edges = quantity == Quantity::Displacement && !group.edges.is_empty();
            let scale = match group.given[quantity as usize] {
                true => unit.sqrt(),
                false if edges => (unit * freedom).sqrt(),
                false => unit.max(freedom).sqrt(),
            };
            pool.iter_mut().for_each(|z| *z = (*z - mean) * scale);
            out.push(Channel {
                group: g,
                quantity,
                gradient: whitened_derivatives(
                    group,
                    quantity,
                    &rows.jacobian[g][quantity as usize],
                ),
                fitted: (0..n)
                    .map(|i| group.values(quantity)[i] + residuals[i])
                    .collect(),
                scale: (0..n)
                    .map(|i| group.weight_of(quantity, i).sqrt().recip())
                    .collect(),
                block: block_of(&pool),
                zero: ([0.0; P], 0.0),
                pool,
            });
        }
    }
    for channel in &mut out {
        let group = &groups[channel.group];
        let (mut sum, mut square) = ([0.0; P], 0.0);
        let own = whitened_zero(group, channel.quantity);
        for (row, own) in channel.gradient.iter().zip(own) {
            square += own * own;
            for p in 0..P {
                sum[p] += own * row[p];
            }
        }
        channel.zero = (sum, square);
    }
    out
}

/// Length of a block: n^⅓ where residuals are correlated beyond what the noise
/// model knows, else one. A fit takes slow parts out of its residuals, so that
/// blocks without need spread less than the noise.
fn block_of(pool: &[f64]) -> usize {
    match inflation(pool) > 1.0 {
        true => (pool.len() as f64).cbrt().round().max(1.0) as usize,
        false => 1,
    }
}

/// Writes a new recording into `groups`; returns half the gradient of its cost
/// at the estimate.
fn resample<const P: usize>(
    channels: &[Channel<P>],
    groups: &mut [SampleGroup],
    source: &mut NoiseSource,
) -> [f64; P] {
    let mut gradient = [0.0; P];
    for channel in channels {
        let group = &mut groups[channel.group];
        let q = channel.quantity as usize;
        let persistence = group.persistence[q];
        let innovation = (1.0 - persistence * persistence).sqrt();
        let shift = unit_shift(persistence);
        let zero_sd = group.zero_sd[q];
        let zero = if zero_sd > 0.0 {
            zero_sd * normal(source)
        } else {
            0.0
        };
        let n = channel.pool.len();
        let (mut own, mut noise) = (0.0, 0.0);
        let mut from = 0;
        for i in 0..n {
            if i % channel.block == 0 {
                from = (uniform(source) * n as f64) as usize;
            }
            let at = from + i % channel.block;
            let z = channel.pool[if at < n { at } else { at - n }];
            noise = match i {
                0 => z * channel.scale[0],
                _ if persistence == 0.0 => z * channel.scale[i],
                _ => persistence * noise + innovation * z * channel.scale[i],
            };
            let moved = if i == 0 { 1.0 } else { shift };
            let white = z + zero * moved / channel.scale[i];
            for p in 0..P {
                gradient[p] += channel.gradient[i][p] * white;
            }
            own += moved / channel.scale[i] * white;
            // A residual is the model less the sample.
            group.values[q][i] = channel.fitted[i] - noise - zero;
        }
        if zero_sd > 0.0 {
            let (sums, square) = &channel.zero;
            let pivot = 1.0 / (square + 1.0 / (zero_sd * zero_sd));
            for p in 0..P {
                gradient[p] -= pivot * own * sums[p];
            }
        }
    }
    gradient
}

/// Percentiles whose levels are shifted by how far the estimate is from the
/// median of the replicates.
fn corrected_percentiles(estimates: &[f64], estimate: f64, confidence: f64) -> (f64, f64) {
    let n = estimates.len() as f64;
    let below = estimates.iter().filter(|e| **e < estimate).count() as f64;
    let share = (below / n).clamp(0.5 / n, 1.0 - 0.5 / n);
    let tail = 0.5 * (1.0 - confidence);
    let mut sorted = estimates.to_vec();
    let bias = normal_quantile(share);
    let level = |p: f64| normal_lower(2.0 * bias + normal_quantile(p));
    (
        quantile(&mut sorted, level(tail)),
        quantile(&mut sorted, level(1.0 - tail)),
    )
}
