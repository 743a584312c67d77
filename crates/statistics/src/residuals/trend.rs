//! Slope of values over one quantity, where values come in clusters.

/// Deviations beyond which a value weighs less (Huber); 1.
const FAR: f64 = 2.0;
/// Rounds in which weights and slope are found.
const ROUNDS: usize = 4;
/// Standard deviation over median absolute deviation of a normal distribution; 1.
const NORMAL_MAD: f64 = 1.482_602_218_505_602;
/// Smallest scatter, as a part of the range of the values; 1.
const ROUNDING: f64 = 1e-12;
/// Part of the range of `x` that must remain within blocks and beside the covariate; 1.
const LEFT: f64 = 0.02;

/// A value, and where it was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// What the value may depend on.
    pub x: f64,
    /// Standard deviation of `x`.
    pub x_sd: f64,
    /// The value.
    pub y: f64,
    /// Standard deviation of `y`.
    pub y_sd: f64,
    /// What is held fixed beside `x`.
    pub beside: f64,
    /// Number of the block, each of which has a level of its own.
    pub block: usize,
    /// Number of the cluster: values of different clusters are independent.
    pub cluster: usize,
}

/// Slope of values over a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trend {
    /// ∂y/∂x.
    pub slope: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Degrees of freedom of the deviation.
    pub df: f64,
}

/// Slope of y over x within blocks, beside a covariate.
///
/// Weights are w = min(1, 2 s/|r|)/s², s² = τ² + y_sd², where τ is what the robust spread of the
/// residuals r leaves beyond the deviations. The variance of the slope is that of cluster sums,
/// each enlarged for its own leverage h,
///
/// ```text
/// b = Σ w x̃ y / S,   S = Σ w x̃²,   var b = Σ_g (Σ_{i∈g} w x̃ r / (S (1 − h_g)))²
/// ```
///
/// plus the square of the slope that errors common to x and y may cause at most, y_sd x_sd / var x.
///
/// Returns `None` where fewer than `least_df` degrees of freedom remain, or x hardly varies.
///
/// # Source
/// Bell and McCaffrey (2002), Survey Methodology 28:169, for cluster sums divided by 1 − h;
/// Huber (1981), Robust Statistics, for the weights.
pub fn trend(observations: &[Observation], least_df: f64) -> Option<Trend> {
    let blocks = 1 + observations.iter().map(|own| own.block).max()?;
    let clusters = 1 + observations.iter().map(|own| own.cluster).max()?;
    // Blocks inside clusters cost no degree of freedom of the cluster sums.
    let mut of_block = vec![None; blocks];
    let inside = observations
        .iter()
        .all(|own| *of_block[own.block].get_or_insert(own.cluster) == own.cluster);
    let spent = if inside { 0 } else { blocks };
    let df = clusters as f64 - 1.0 - spent as f64;
    if df < least_df {
        return None;
    }
    let of = |get: fn(&Observation) -> f64| observations.iter().map(get).collect::<Vec<f64>>();
    let (x, y, beside) = (of(|own| own.x), of(|own| own.y), of(|own| own.beside));
    let typical = median(of(|own| own.y_sd));
    let floor = ROUNDING * range(&y).max(f64::MIN_POSITIVE);
    let mut weights = vec![1.0; observations.len()];
    let mut found = None;
    for _ in 0..ROUNDS {
        let within = |values: &[f64]| {
            let mut own = values.to_vec();
            centre(&mut own, observations, &weights, blocks);
            own
        };
        let (mut x_left, mut y_left, other) = (within(&x), within(&y), within(&beside));
        take_out(&mut x_left, &other, &weights);
        take_out(&mut y_left, &other, &weights);
        let total = product(&x_left, &x_left, &weights);
        if range(&x_left) <= LEFT * range(&x) || total.is_nan() || total <= 0.0 {
            return None;
        }
        let slope = product(&x_left, &y_left, &weights) / total;
        let residuals: Vec<f64> = x_left
            .iter()
            .zip(&y_left)
            .map(|(x, y)| y - slope * x)
            .collect();
        let spread = NORMAL_MAD * median(residuals.iter().map(|r| r.abs()).collect());
        let beyond = (spread * spread - typical * typical).max(0.0);
        let sd = |own: &Observation| (beyond + own.y_sd * own.y_sd).sqrt().max(floor);
        let sums = cluster_sums(
            observations,
            &weights,
            (&x_left, &residuals),
            (!inside).then_some(blocks),
            clusters,
        );
        let variance: f64 = sums.iter().map(|sum| (sum / total).powi(2)).sum();
        let shared = typical * median(of(|own| own.x_sd)) * weights.iter().sum::<f64>() / total;
        found = Some(Trend {
            slope,
            sd: variance.sqrt().hypot(shared),
            df,
        });
        for ((weight, own), residual) in weights.iter_mut().zip(observations).zip(&residuals) {
            let sd = sd(own);
            *weight = (FAR * sd / residual.abs()).min(1.0) / (sd * sd);
        }
    }
    found.filter(|own| own.slope.is_finite() && own.sd.is_finite())
}

/// Σ w x̃ r of each cluster over one less its leverage.
///
/// * `blocks`: their number, where they do not leave with a cluster
fn cluster_sums(
    observations: &[Observation],
    weights: &[f64],
    (x, residuals): (&[f64], &[f64]),
    blocks: Option<usize>,
    clusters: usize,
) -> Vec<f64> {
    let total = product(x, x, weights);
    let mut of_block = vec![0.0; blocks.unwrap_or(0)];
    for (own, weight) in observations.iter().zip(weights) {
        if blocks.is_some() {
            of_block[own.block] += weight;
        }
    }
    let (mut sums, mut leverage) = (vec![0.0; clusters], vec![0.0; clusters]);
    for (i, own) in observations.iter().enumerate() {
        let level = of_block.get(own.block).map_or(0.0, |sum| weights[i] / sum);
        sums[own.cluster] += weights[i] * x[i] * residuals[i];
        leverage[own.cluster] += weights[i] * x[i] * x[i] / total + level;
    }
    let enlarged = sums.iter().zip(&leverage);
    enlarged
        .map(|(sum, h)| sum / (1.0 - h).max(ROUNDING))
        .collect()
}

/// Takes from values the weighted mean of their block.
fn centre(values: &mut [f64], observations: &[Observation], weights: &[f64], blocks: usize) {
    let (mut sums, mut totals) = (vec![0.0; blocks], vec![0.0; blocks]);
    for ((own, value), weight) in observations.iter().zip(&*values).zip(weights) {
        sums[own.block] += weight * value;
        totals[own.block] += weight;
    }
    for (own, value) in observations.iter().zip(values) {
        *value -= sums[own.block] / totals[own.block];
    }
}

/// Takes from values what is proportional to others.
fn take_out(values: &mut [f64], others: &[f64], weights: &[f64]) {
    let square = product(others, others, weights);
    if square > 0.0 {
        let slope = product(values, others, weights) / square;
        values
            .iter_mut()
            .zip(others)
            .for_each(|(value, other)| *value -= slope * other);
    }
}

fn product(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .zip(weights)
        .map(|((a, b), w)| w * a * b)
        .sum()
}

fn range(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    0.5 * (values[(n - 1) / 2] + values[n / 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_distribution::tail::{normal_quantile, t_two_sided};

    /// Twelve values on four fruit. The deviations are so large that all weights are equal.
    fn observations(own_blocks: bool) -> Vec<Observation> {
        const X: [f64; 12] = [0.1, 0.5, 0.9, 0.2, 0.4, 1.1, 0.3, 0.35, 0.7, 0.0, 0.8, 1.0];
        const Y: [f64; 12] = [1.0, 1.3, 1.2, 2.1, 2.0, 2.6, 0.4, 0.7, 0.6, 1.5, 1.9, 2.3];
        let of = |i: usize| Observation {
            x: X[i],
            x_sd: 0.0,
            y: Y[i],
            y_sd: 100.0,
            beside: 0.0,
            block: if own_blocks { i / 3 } else { 0 },
            cluster: if own_blocks { i / 3 } else { i },
        };
        (0..12).map(of).collect()
    }

    /// NumPy 2: slope of values less the means of their fruit, and Σ (b₋g − b)² of the slopes
    /// without each of the fruit; ordinary least squares with HC3 of (X, Y) as they are.
    #[test]
    fn reference_slopes_and_deviations() {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        let within = trend(&observations(true), 1.0).unwrap();
        assert!(
            near(within.slope, WITHIN.0) && near(within.sd, WITHIN.1),
            "{within:?}"
        );
        let plain = trend(&observations(false), 1.0).unwrap();
        assert!(
            near(plain.slope, PLAIN.0) && near(plain.sd, PLAIN.1),
            "{plain:?}"
        );
        assert_eq!((within.df, plain.df), (3.0, 10.0));
        assert!(trend(&observations(true), 4.0).is_none());
        // All at one place.
        let same: Vec<Observation> = observations(false)
            .into_iter()
            .map(|own| Observation { x: 1.0, ..own })
            .collect();
        assert!(trend(&same, 1.0).is_none());
        // What is held fixed is x itself.
        let tied: Vec<Observation> = observations(false)
            .into_iter()
            .map(|own| Observation {
                beside: own.x,
                ..own
            })
            .collect();
        assert!(trend(&tied, 1.0).is_none());
    }

    const WITHIN: (f64, f64) = (0.550_996_483_001_172, 0.144_767_958_253_804);
    const PLAIN: (f64, f64) = (0.821_769_482_832_313, 0.612_735_985_158_680);

    /// Uniform numbers (Steele, Lea and Flood 2014, splitmix64).
    fn uniform(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) as f64 + 0.5) / 2f64.powi(64)
    }

    /// Fruit that differ, four values on each, one value in 20 far off: the slope is found, and
    /// without one few are seen.
    #[test]
    fn recovers_slopes_of_fruit_that_differ() {
        let (mut by_chance, mut found) = (0, 0);
        for seed in 0..400 {
            for slope in [0.0, 0.3] {
                let mut state = seed;
                let mut normal = || normal_quantile(uniform(&mut state));
                let mut all = Vec::new();
                for fruit in 0..12 {
                    let level = normal();
                    for _ in 0..4 {
                        let x = 0.3 * normal();
                        let far = if normal() > 1.64 { 5.0 } else { 1.0 };
                        all.push(Observation {
                            x,
                            x_sd: 0.001,
                            y: level + slope * x + 0.1 * far * normal(),
                            y_sd: 0.02,
                            beside: normal(),
                            block: fruit,
                            cluster: fruit,
                        });
                    }
                }
                let own = trend(&all, 3.0).unwrap();
                let chance = t_two_sided((own.slope / own.sd).abs(), own.df);
                match slope == 0.0 {
                    true => by_chance += usize::from(chance < 0.05),
                    false => found += usize::from(chance < 0.05),
                }
            }
        }
        // 20 by chance.
        assert!(
            (8..=36).contains(&by_chance) && found > 360,
            "{by_chance} {found}"
        );
    }
}
