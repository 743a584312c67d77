//! Samples of smooth stretches, each stretch replaced by a few that say as much.
//!
//! Where the model is smooth, a block of m samples sees of it a polynomial of low
//! degree only. Gauss quadrature over the block's own samples then gives
//!
//! ```text
//! Σᵢ (f(tᵢ) − yᵢ)² = Σⱼ Wⱼ (f(τⱼ) − ỹⱼ)² + Σᵢ (yᵢ − ỹ(tᵢ))²
//! ```
//!
//! for every polynomial f of degree below [`NODES`], with as many nodes τⱼ and the
//! least-squares polynomial ỹ of the samples. The last sum does not depend on the
//! model. A fit sees the same cost, gradient and normal matrix, at a fraction of
//! the evaluations; what the polynomial misses of the model is of the order of 1e-5
//! of it next to first touch and far less elsewhere.
//!
//! # Source
//! Gautschi (2004), Orthogonal Polynomials, section 2.1.1 (discrete measures), and
//! theorem 1.45 (Gauss quadrature).

use crate::fit::residual_pack::Pack;
use crate::samples::{PACK, QUANTITIES, SampleGroup};
use std::sync::LazyLock;
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::real_vector::{FourLanes, LANES, with_four_lanes};

/// Samples that take the place of a block.
pub(crate) const NODES: usize = 6;
/// Lengths of blocks; samples.
const LENGTHS: [usize; 4] = [16, 32, 64, 128];
/// Samples kept as they are on either side of a time at which the model has a corner;
/// behind first touch, where it has a root, a block is as far from it as it is long.
const MARGIN: usize = 16;
/// The longest block is this part of the contact, or has the samples below where it is
/// not known how long contact lasts.
const LARGEST_PART: f64 = 0.25;
const LARGEST_UNKNOWN: usize = 64;
/// Fewer samples are not worth it.
const LEAST_SAMPLES: usize = 128;

/// Times at which the model is not smooth, on the clock of the samples; s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bends {
    /// First touch.
    pub touch: f64,
    /// End of contact, where it is known.
    pub separation: Option<f64>,
}

impl Bends {
    /// Those of a motion of which only first touch is known; s.
    pub(crate) fn of_touch(touch: f64) -> Self {
        Self {
            touch,
            separation: None,
        }
    }
}

/// Quadrature over a block of evenly spaced samples.
struct Block {
    length: usize,
    /// Places of the nodes; samples from the block's first.
    nodes: [f64; NODES],
    weights: [f64; NODES],
    /// Value of the least-squares polynomial at each node, by the samples of each pack.
    values: Vec<[Pack; NODES]>,
}

static BLOCKS: LazyLock<[Block; LENGTHS.len()]> = LazyLock::new(|| LENGTHS.map(Block::new));

impl Block {
    fn new(length: usize) -> Self {
        let m = length as f64;
        // Orthogonal on the samples, by their three-term recurrence on (−1, 1).
        let place = |i: usize| (2 * i + 1) as f64 / m - 1.0;
        let mut squares = [0.0; NODES + 1];
        let mut steps = [0.0; NODES];
        for k in 0..=NODES {
            squares[k] = (0..length)
                .map(|i| polynomials(place(i), &steps)[k].powi(2))
                .sum();
            if (1..NODES).contains(&k) {
                steps[k] = squares[k] / squares[k - 1];
            }
        }
        let nodes: [f64; NODES] = std::array::from_fn(|j| root(j, &steps));
        let weight = |u: f64| -> f64 {
            let p = polynomials(u, &steps);
            1.0 / (0..NODES).map(|k| p[k] * p[k] / squares[k]).sum::<f64>()
        };
        let at_nodes = nodes.map(|u| polynomials(u, &steps));
        let kernel = |j: usize, i: usize| -> f64 {
            let p = polynomials(place(i), &steps);
            let part = |k: usize| at_nodes[j][k] * p[k] / squares[k];
            (0..NODES).map(part).sum()
        };
        let pack = |first: usize| {
            let of_node = |j: usize| Lanes(std::array::from_fn(|lane| kernel(j, first + lane)));
            std::array::from_fn(of_node)
        };
        Self {
            length,
            nodes: nodes.map(|u| 0.5 * ((u + 1.0) * m - 1.0)),
            weights: nodes.map(weight),
            values: (0..length).step_by(PACK).map(pack).collect(),
        }
    }
}

/// p₀ … p of degree [`NODES`] at u: pₖ₊₁ = u pₖ − bₖ pₖ₋₁.
fn polynomials(u: f64, steps: &[f64; NODES]) -> [f64; NODES + 1] {
    let mut p = [1.0; NODES + 1];
    p[1] = u;
    for k in 1..NODES {
        p[k + 1] = u * p[k] - steps[k] * p[k - 1];
    }
    p
}

/// Root `j` of the polynomial of degree [`NODES`], by bisection.
fn root(j: usize, steps: &[f64; NODES]) -> f64 {
    let value = |u: f64| polynomials(u, steps)[NODES];
    // Roots are ten times as far apart as the points of this grid.
    let at = |i: usize| 2.0 * i as f64 / 101.0 - 1.0;
    let mut changes = (0..101).filter(|&i| (value(at(i)) < 0.0) != (value(at(i + 1)) < 0.0));
    let first = changes.nth(j).unwrap_or(0);
    let (mut low, mut high) = (at(first), at(first + 1));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (value(middle) < 0.0) == (value(low) < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Condensed samples of a fit, and room for those of others.
#[derive(Clone, Debug, Default)]
pub struct Condensed {
    groups: Vec<SampleGroup>,
    /// Whether they are those of the fit.
    filled: bool,
}

impl Condensed {
    /// Room for what samples like these are condensed to.
    pub(crate) fn room(groups: &[SampleGroup]) -> Self {
        LazyLock::force(&BLOCKS);
        let mut groups = groups.to_vec();
        for group in &mut groups {
            group.shares.reserve(group.len + PACK);
        }
        Self {
            groups,
            filled: false,
        }
    }

    /// Takes the groups with their smooth stretches condensed, in the room that there is;
    /// nothing where that is not worth it, since few samples are evenly spaced and of white
    /// noise.
    pub(crate) fn fill(&mut self, groups: &[SampleGroup], bends: Bends) {
        self.filled = groups.iter().any(suits);
        if !self.filled {
            return;
        }
        let none = || SampleGroup::new(&[], [None; QUANTITIES]);
        self.groups.resize_with(groups.len(), none);
        for (to, group) in self.groups.iter_mut().zip(groups) {
            match suits(group) {
                true => condense(group, bends, to),
                false => to.clone_from(group),
            }
        }
    }

    /// Takes nothing; the room stays.
    pub(crate) fn empty(&mut self) {
        self.filled = false;
    }

    /// The condensed samples, if any.
    pub(crate) fn groups(&self) -> Option<&[SampleGroup]> {
        self.filled.then_some(&self.groups)
    }
}

fn suits(group: &SampleGroup) -> bool {
    group.even
        && group.len >= LEAST_SAMPLES
        && !group.means
        && group.relative.iter().all(Vec::is_empty)
        && group
            .persistence
            .iter()
            .all(|persistence| *persistence == 0.0)
}

/// Writes a condensed group into `to`.
fn condense(group: &SampleGroup, bends: Bends, to: &mut SampleGroup) {
    let interval = group.interval();
    let first = group.times[0];
    let place = |time: f64| (time - first) / interval;
    let touch = place(bends.touch);
    let separation = bends.separation.map(place);
    let longest = match separation {
        Some(end) => (LARGEST_PART * (end - touch)) as usize,
        None => LARGEST_UNKNOWN,
    };
    let margin = MARGIN as f64;
    let fits = |at: usize, length: usize| {
        let (from, to) = (at as f64, (at + length - 1) as f64);
        let clear = |bend: f64, after: f64| to <= bend - margin || from >= bend + after;
        at + length <= group.len
            && length <= longest
            && clear(touch, margin.max(length as f64))
            && separation.is_none_or(|end| clear(end, margin))
    };
    clear(to, group);
    let mut at = 0;
    while at < group.len {
        let blocks = BLOCKS.iter().rev();
        match blocks.into_iter().find(|block| fits(at, block.length)) {
            Some(block) => {
                add_block(to, (group, at), block, first + at as f64 * interval);
                at += block.length;
            }
            None => {
                add_sample(to, group, at);
                at += 1;
            }
        }
    }
    to.len = to.times.len();
    let values = to.values.iter_mut().chain([&mut to.times, &mut to.shares]);
    for own in values.filter(|own| !own.is_empty()) {
        own.resize(own.len() + PACK, 0.0);
    }
}

/// Makes `to` a group like `group`, without samples.
fn clear(to: &mut SampleGroup, group: &SampleGroup) {
    let vectors = to.values.iter_mut().chain(&mut to.relative);
    for own in vectors.chain([&mut to.times, &mut to.shares]) {
        own.clear();
    }
    to.edges.clear();
    to.remainder = [0.0; QUANTITIES];
    to.even = false;
    to.weights = group.weights;
    to.persistence = group.persistence;
    to.zero_sd = group.zero_sd;
    to.means = group.means;
    to.given = group.given;
    to.interval = group.interval;
}

fn add_sample(to: &mut SampleGroup, group: &SampleGroup, at: usize) {
    to.times.push(group.times[at]);
    to.shares.push(1.0);
    for (to, from) in to.values.iter_mut().zip(&group.values) {
        to.extend(from.get(at));
    }
}

/// Adds what the samples of `group` from `at` are condensed to; their first is at `start`.
fn add_block(to: &mut SampleGroup, (group, at): (&SampleGroup, usize), block: &Block, start: f64) {
    let interval = group.interval();
    to.times
        .extend(block.nodes.map(|node| start + node * interval));
    to.shares.extend(block.weights);
    for q in 0..QUANTITIES {
        if group.values[q].is_empty() {
            continue;
        }
        let samples = &group.values[q][at..at + block.length];
        let (values, square) = with_four_lanes(Project { block, samples });
        let seen: f64 = (0..NODES)
            .map(|j| block.weights[j] * values[j] * values[j])
            .sum();
        to.remainder[q] += (square - seen).max(0.0);
        to.values[q].extend(values);
    }
}

/// Values of the least-squares polynomial of a block's samples at its nodes, and the
/// sum of the squares of the samples.
struct Project<'a> {
    block: &'a Block,
    samples: &'a [f64],
}

impl FourLanes for Project<'_> {
    type Output = ([f64; NODES], f64);

    #[inline(always)]
    fn run<R: Real<Plain = Lanes<LANES>>>(self, zero: R) -> Self::Output {
        let zero = zero.constant(0.0);
        let mut sums = [zero; NODES];
        let mut square = zero;
        let packs = self.samples.as_chunks::<PACK>().0;
        for (pack, values) in packs.iter().zip(&self.block.values) {
            let y = zero.with_plain(Lanes(*pack));
            square = y.mul_add(y, square);
            for j in 0..NODES {
                let by = zero.with_plain(values[j]);
                sums[j] = by.mul_add(y, sums[j]);
            }
        }
        (sums.map(|sum| sum.plain().sum()), square.plain().sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes and weights against those of Gauss-Legendre, which those of ever more
    /// samples approach (Abramowitz and Stegun, table 25.4, n = 6).
    #[test]
    fn closed_form_many_samples_are_an_integral() {
        let block = Block::new(20_000);
        let nodes = [
            0.238_619_186_083_197,
            0.661_209_386_466_265,
            0.932_469_514_203_152,
        ];
        let weights = [
            0.467_913_934_572_691,
            0.360_761_573_048_139,
            0.171_324_492_379_170,
        ];
        for j in 0..3 {
            let u = (2.0 * block.nodes[3 + j] + 1.0) / 20_000.0 - 1.0;
            assert!((u - nodes[j]).abs() < 1e-7, "{u}");
            assert!((block.weights[3 + j] / 10_000.0 - weights[j]).abs() < 1e-7);
        }
    }

    /// The sums over a block against those over its samples, which any polynomial of
    /// degree 5 must leave the same.
    #[test]
    fn closed_form_a_polynomial_has_the_same_cost() {
        let noise = |i: usize| ((i * i * 7919) % 1000) as f64 / 500.0 - 1.0;
        let f = |t: f64| 3.0 + t * (1.0 + t * (0.2 - t * (0.03 + t * (0.001 - 2e-4 * t))));
        for block in BLOCKS.iter() {
            let m = block.length;
            let unit = 10.0 / m as f64;
            let samples: Vec<f64> = (0..m).map(|i| f(i as f64 * unit) + noise(i)).collect();
            let samples = &samples[..];
            let (values, square) = with_four_lanes(Project { block, samples });
            let model = |t: f64| 1.1 * f(1.03 * t) + 0.5;
            let exact: f64 = (0..m)
                .map(|i| (model(i as f64 * unit) - samples[i]).powi(2))
                .sum();
            let part = |j: usize, v: f64| block.weights[j] * v * v;
            let seen: f64 = (0..NODES).map(|j| part(j, values[j])).sum();
            let short: f64 = (0..NODES)
                .map(|j| part(j, model(block.nodes[j] * unit) - values[j]))
                .sum();
            let found = short + square - seen;
            assert!((found / exact - 1.0).abs() < 1e-11, "{found} {exact}");
            let weight: f64 = block.weights.iter().sum();
            assert!((weight / m as f64 - 1.0).abs() < 1e-12);
        }
    }

    /// Every sample counts once, none within the margin of a bend is replaced, and the
    /// stretch behind first touch is condensed in blocks that grow.
    #[test]
    fn closed_form_samples_near_bends_stay() {
        let times: Vec<f64> = (0..1000).map(|i| 1e-5 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| (300.0 * t).sin()).collect();
        let group = SampleGroup::new(&times, [Some((&values, 1.0)), None, None, None]);
        let bends = Bends {
            touch: 2.003e-3,
            separation: Some(8.007e-3),
        };
        let mut found = Condensed::default();
        found.fill(&[group], bends);
        let found = &found.groups().unwrap()[0];
        let total: f64 = found.shares[..found.len].iter().sum();
        assert!((total - 1000.0).abs() < 1e-9);
        assert!(found.len < 250, "{}", found.len);
        let kept = found.times().iter().zip(&found.shares);
        let kept = kept.filter(|(_, share)| **share == 1.0).map(|(t, _)| *t);
        let kept: Vec<f64> = kept.collect();
        for near in [1.99e-3, 2.12e-3, 7.92e-3, 8.11e-3] {
            assert!(kept.iter().any(|t| (t - near).abs() < 1e-9), "{near}");
        }
        assert!(found.remainder[0] < 1e-9);
        assert_eq!(found.interval(), 1e-5);
    }
}
