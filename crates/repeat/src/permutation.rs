//! Sign-flip test of whether curves change from one impact to the next, over all fruit.

use windfall_signal::error::Error;
use windfall_signal::noise::gaussian::{noise_source, uniform};

/// Ties are counted as reached within this relative difference; 1.
const TIE: f64 = 1e-9;

/// Stream of the seed that sign patterns are drawn from.
const STREAM: u64 = 26;

/// How the test is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignFlipOptions {
    /// All patterns are enumerated where there are no more than this.
    pub most_patterns: usize,
    /// Patterns drawn otherwise.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Level of the critical values; 1.
    pub level: f64,
    /// Floor of standard deviations relative to their typical size; 1.
    pub floor: f64,
}

impl Default for SignFlipOptions {
    fn default() -> Self {
        Self {
            most_patterns: 1 << 16,
            draws: 19_999,
            seed: 1,
            level: 0.05,
            floor: 0.1,
        }
    }
}

/// One comparison: the difference curve of each fruit, in one order; `None` if missing.
pub type Differences = Vec<Option<Vec<f64>>>;

/// What the test says of one comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedCurves {
    /// Fruit in it.
    pub fruit: usize,
    /// Mean difference at each instant; unit of the differences.
    pub mean: Vec<f64>,
    /// Standard deviation between fruit; unit of the differences.
    pub sd: Vec<f64>,
    /// Studentised mean; 1.
    pub statistic: Vec<f64>,
    /// Family-wise probability of so large a value if nothing changes; 1.
    pub adjusted_p: Vec<f64>,
    /// Index of the largest |statistic|.
    pub largest: usize,
    /// p of the largest over the instants of this comparison alone; 1.
    pub p_alone: f64,
    /// p of the largest over all comparisons; 1.
    pub p: f64,
    /// Least p that so many fruit can give; 1.
    pub least_p: f64,
}

/// What the test says.
#[derive(Clone, Debug, PartialEq)]
pub struct SignFlipTest {
    /// Each comparison, in their order.
    pub comparisons: Vec<ComparedCurves>,
    /// Critical |statistic| over all comparisons; `None` with too few fruit.
    pub critical: Option<f64>,
    /// Sign patterns that were evaluated; a pattern and its opposite are one.
    pub patterns: usize,
    /// Whether these are all there are.
    pub exact: bool,
}

/// Tests whether difference curves have mean zero, at all instants of all
/// comparisons together.
///
/// ```text
/// t = mean(D) / √((s² + s₀²)/n)      T = max |t| over instants and comparisons
/// ```
///
/// If nothing changes, a fruit's curves are as likely with the opposite sign.
/// All sign patterns are enumerated (or drawn), a fruit keeping its sign in all
/// comparisons, and p is the share of patterns whose T is not less than the one
/// observed: single-step max-T, which keeps the family-wise error rate. Exact for
/// differences that are symmetric about zero; the two impacts of a pair being
/// exchangeable makes them so.
///
/// * `s₀`: `floor` times the median root mean square of the comparison; it does
///   not depend on the signs, so p stays exact
///
/// # Errors
/// [`Error::TooFewFruit`] where a comparison has fewer than two,
/// [`Error::CurvesUnequal`].
///
/// # Source
/// Westfall and Young (1993), Resampling-based multiple testing, sect. 2.5;
/// Nichols and Holmes (2002), Human Brain Mapping 15, 1.
pub fn sign_flip_test(
    comparisons: &[Differences],
    options: &SignFlipOptions,
) -> Result<SignFlipTest, Error> {
    let stacks = comparisons
        .iter()
        .map(|differences| stack(differences, options.floor))
        .collect::<Result<Vec<Stack>, Error>>()?;
    let fruit = comparisons.iter().map(Vec::len).max().unwrap_or(0);
    let present: Vec<usize> = (0..fruit)
        .filter(|&i| {
            comparisons
                .iter()
                .any(|c| c.get(i).is_some_and(Option::is_some))
        })
        .collect();
    // A pattern and its opposite have the same |t|: the first sign is held.
    let free = present.len().saturating_sub(1);
    let exact = free < usize::BITS as usize - 1 && 1_usize << free <= options.most_patterns / 2;
    let largest = match exact {
        true => enumerate(&stacks, &present),
        false => draw(&stacks, &present, options),
    };
    let patterns = largest.len();
    let all = Distribution::new(
        largest
            .iter()
            .map(|each| each.iter().copied().fold(0.0, f64::max)),
    );
    let compared = stacks.iter().enumerate().map(|(index, stack)| {
        let alone = Distribution::new(largest.iter().map(|each| each[index]));
        compare(stack, &alone, &all)
    });
    Ok(SignFlipTest {
        comparisons: compared.collect(),
        critical: all.critical(options.level),
        patterns,
        exact,
    })
}

/// Difference curves of one comparison.
struct Stack {
    /// Fruit and curve.
    curves: Vec<(usize, Vec<f64>)>,
    /// Σ D² over fruit, at each instant.
    squares: Vec<f64>,
    /// s₀².
    floor: f64,
}

fn stack(differences: &Differences, floor: f64) -> Result<Stack, Error> {
    let curves: Vec<(usize, Vec<f64>)> = differences
        .iter()
        .enumerate()
        .filter_map(|(fruit, curve)| Some((fruit, curve.clone()?)))
        .collect();
    if curves.len() < 2 {
        return Err(Error::TooFewFruit {
            fruit: curves.len(),
            least: 2,
        });
    }
    let points = curves[0].1.len();
    if let Some((_, other)) = curves.iter().find(|(_, curve)| curve.len() != points) {
        return Err(Error::CurvesUnequal {
            first: points,
            other: other.len(),
        });
    }
    let mut squares = vec![0.0; points];
    for (_, curve) in &curves {
        for (sum, d) in squares.iter_mut().zip(curve) {
            *sum += d * d;
        }
    }
    let mut sorted = squares.clone();
    sorted.sort_by(f64::total_cmp);
    let typical = sorted.get(points / 2).copied().unwrap_or(0.0) / curves.len() as f64;
    Ok(Stack {
        curves,
        squares,
        floor: floor * floor * typical,
    })
}

/// t² of a sum over fruit.
fn squared(stack: &Stack, point: usize, sum: f64) -> f64 {
    let n = stack.curves.len() as f64;
    let mean = sum / n;
    let variance = ((stack.squares[point] - n * mean * mean) / (n - 1.0)).max(0.0) + stack.floor;
    match variance > 0.0 {
        true => n * mean * mean / variance,
        false if mean == 0.0 => 0.0,
        // All differences alike, to the last bit.
        false => f64::MAX,
    }
}

fn largest_of(stack: &Stack, sums: &[f64]) -> f64 {
    let squares = sums
        .iter()
        .enumerate()
        .map(|(i, sum)| squared(stack, i, *sum));
    squares.fold(0.0, f64::max).sqrt()
}

/// Adds `factor` times the curve of a fruit to the sums.
fn add(stacks: &[Stack], sums: &mut [Vec<f64>], fruit: usize, factor: f64) {
    for (stack, sums) in stacks.iter().zip(sums) {
        let curves = stack.curves.iter().filter(|(number, _)| *number == fruit);
        for (_, curve) in curves {
            for (sum, d) in sums.iter_mut().zip(curve) {
                *sum += factor * d;
            }
        }
    }
}

fn observed_sums(stacks: &[Stack], present: &[usize]) -> Vec<Vec<f64>> {
    let mut sums: Vec<Vec<f64>> = stacks.iter().map(|s| vec![0.0; s.squares.len()]).collect();
    for &fruit in present {
        add(stacks, &mut sums, fruit, 1.0);
    }
    sums
}

fn largest_each(stacks: &[Stack], sums: &[Vec<f64>]) -> Vec<f64> {
    let pairs = stacks.iter().zip(sums);
    pairs.map(|(stack, sums)| largest_of(stack, sums)).collect()
}

/// Largest |t| of every comparison, for every pattern; the observed one first.
///
/// Successive patterns differ in one sign (reflected binary code), so that each
/// costs one addition per instant.
fn enumerate(stacks: &[Stack], present: &[usize]) -> Vec<Vec<f64>> {
    let free = present.len().saturating_sub(1);
    let mut sums = observed_sums(stacks, present);
    let mut signs = vec![1.0; free];
    let mut largest = vec![largest_each(stacks, &sums)];
    for pattern in 1_usize..1 << free {
        let turned = pattern.trailing_zeros() as usize;
        signs[turned] = -signs[turned];
        add(stacks, &mut sums, present[turned + 1], 2.0 * signs[turned]);
        largest.push(largest_each(stacks, &sums));
    }
    largest
}

/// The same for drawn patterns; the observed one first.
fn draw(stacks: &[Stack], present: &[usize], options: &SignFlipOptions) -> Vec<Vec<f64>> {
    let mut source = noise_source(options.seed, STREAM);
    let mut largest = vec![largest_each(stacks, &observed_sums(stacks, present))];
    for _ in 0..options.draws {
        let mut sums: Vec<Vec<f64>> = stacks.iter().map(|s| vec![0.0; s.squares.len()]).collect();
        for &fruit in present {
            let sign = if uniform(&mut source) < 0.5 {
                -1.0
            } else {
                1.0
            };
            add(stacks, &mut sums, fruit, sign);
        }
        largest.push(largest_each(stacks, &sums));
    }
    largest
}

/// Values over the patterns, rising.
struct Distribution {
    sorted: Vec<f64>,
}

impl Distribution {
    // The observed pattern is one of them: p = (1 + others reached)/(1 + others)
    // for drawn patterns (Phipson and Smyth 2010), the share for all patterns.
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        Self { sorted }
    }

    fn p(&self, value: f64) -> f64 {
        let below = self.sorted.partition_point(|&v| v < value * (1.0 - TIE));
        (self.sorted.len() - below) as f64 / self.sorted.len() as f64
    }

    /// Least value that is reached with a probability of at most the level.
    fn critical(&self, level: f64) -> Option<f64> {
        let n = self.sorted.len();
        let reached = (level * n as f64).floor() as usize;
        let candidates = (n - reached.min(n)..n).map(|i| self.sorted[i]);
        let mut candidates = candidates.filter(|value| self.p(*value) <= level);
        candidates.next()
    }
}

fn compare(stack: &Stack, alone: &Distribution, all: &Distribution) -> ComparedCurves {
    let n = stack.curves.len() as f64;
    let points = stack.squares.len();
    let mut sums = vec![0.0; points];
    for (_, curve) in &stack.curves {
        for (sum, d) in sums.iter_mut().zip(curve) {
            *sum += d;
        }
    }
    let mean: Vec<f64> = sums.iter().map(|sum| sum / n).collect();
    let deviation = |i: usize| {
        let centred = stack
            .curves
            .iter()
            .map(|(_, curve)| (curve[i] - mean[i]).powi(2));
        (centred.sum::<f64>() / (n - 1.0)).sqrt()
    };
    let statistic: Vec<f64> = (0..points)
        .map(|i| squared(stack, i, sums[i]).sqrt().copysign(mean[i]))
        .collect();
    let higher = |best: usize, i: usize| match statistic[i].abs() > statistic[best].abs() {
        true => i,
        false => best,
    };
    let largest = (0..points).fold(0, higher);
    let top = statistic.get(largest).map_or(0.0, |t| t.abs());
    ComparedCurves {
        fruit: stack.curves.len(),
        sd: (0..points).map(deviation).collect(),
        adjusted_p: statistic.iter().map(|t| all.p(t.abs())).collect(),
        largest,
        p_alone: alone.p(top),
        p: all.p(top),
        least_p: 0.5_f64.powi(stack.curves.len() as i32 - 1),
        mean,
        statistic,
    }
}
