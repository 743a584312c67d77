//! Residuals of an impact and their derivatives, summed into the normal
//! equations in one pass over the samples, several samples at a time.

use crate::contact_motion::{Segment, Sink, follow};
use crate::model::Model;
use crate::onset_average::{OnsetAverage, OnsetCorrection};
use crate::residual_block::{BLOCK, Block, Pack, Piece, fill, load};
use crate::residual_noise::Noise;
use crate::samples::{PACK, QUANTITIES, Quantity, SampleGroup};
use windfall_contact::law::ContactLaw;
use windfall_numerics::least_squares::NormalEquations;
use windfall_numerics::ode_step::StepError;
use windfall_numerics::real::{Lanes, Real};

/// Residuals and derivatives of every sample, unweighted, for diagnostics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Per sample group and quantity: model minus measured, in time order.
    pub residuals: Vec<[Vec<f64>; QUANTITIES]>,
    /// Per sample group and quantity: P derivatives per sample, in time order.
    pub jacobian: Vec<[Vec<f64>; QUANTITIES]>,
}

/// Normal equations of `model` against `groups`; with `rows`, residuals and
/// derivatives of each sample too.
///
/// # Errors
/// [`StepError`] when the motion cannot be integrated.
///
/// # Numerics
/// One integration with sensitivities; the samples read its dense output in
/// packs. Sums run in the order of time, so they do not depend on threads.
/// Nothing is allocated (except in `rows`).
pub fn evaluate<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
    rows: Option<&mut Rows>,
) -> Result<NormalEquations<P>, StepError>
where
    L: ContactLaw<N>,
{
    pulp::Arch::new().dispatch(Pass {
        model,
        groups,
        rows,
        stride: 1,
    })
}

/// [`evaluate`] with a share of the samples and as if their noise were white, for
/// the way to the minimum: every `stride`-th pack of them, the same ones wherever
/// the pieces of the motion end.
///
/// # Errors
/// [`StepError`] when the motion cannot be integrated.
pub(crate) fn evaluate_some<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
    stride: usize,
) -> Result<NormalEquations<P>, StepError>
where
    L: ContactLaw<N>,
{
    pulp::Arch::new().dispatch(Pass {
        model,
        groups,
        rows: None,
        stride,
    })
}

/// One pass of [`evaluate`], compiled for the machine's vector instructions.
struct Pass<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
    stride: usize,
}

impl<L, const N: usize, const W: usize, const P: usize> pulp::WithSimd for Pass<'_, L, N, W, P>
where
    L: ContactLaw<N>,
{
    type Output = Result<NormalEquations<P>, StepError>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> Self::Output {
        let Self {
            model,
            groups,
            rows,
            stride,
        } = self;
        let (before, after) = span(model, groups);
        let (mut block, mut tally) = (Block::ZERO, Tally::EMPTY);
        let mut reading = Reading {
            model,
            groups,
            rows,
            end: after,
            stride,
            block: &mut block,
            tally: &mut tally,
        };
        follow(&model.event, before, after, &mut reading)?;
        Ok(tally.total(groups, stride))
    }
}

/// First (at most 0) and last time of the samples, from first touch; s.
#[inline(always)]
pub(crate) fn span<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
) -> (f64, f64) {
    let first = groups.iter().filter_map(|g| g.times().first()).copied();
    let last = groups.iter().filter_map(|g| g.times().last()).copied();
    let before = first.fold(f64::INFINITY, f64::min) - model.onset;
    let after = last.fold(f64::NEG_INFINITY, f64::max) - model.onset;
    (before.min(0.0), after)
}

/// What a pass over the samples has summed up so far.
pub(crate) struct Tally<const P: usize> {
    sums: Sums<P>,
    noise: Noise<P>,
}

impl<const P: usize> Tally<P> {
    pub(crate) const EMPTY: Self = Self {
        sums: Sums::ZERO,
        noise: Noise::NONE,
    };

    /// The normal equations, after the last piece.
    #[inline(always)]
    pub(crate) fn total(&mut self, groups: &[SampleGroup], stride: usize) -> NormalEquations<P> {
        let mut equations = self.sums.total();
        if stride == 1 {
            self.noise.complete(groups, &mut equations);
        }
        equations
    }
}

/// Adds the samples of one piece of a motion to `tally`: what [`evaluate`] does
/// with each piece, for motions that are integrated elsewhere. `end` is the last
/// time of [`span`]; `block` is room to work in.
pub(crate) fn read_piece<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    (groups, stride, end): (&[SampleGroup], usize, f64),
    (segment, piece): (&Segment<W>, Piece),
    block: &mut Block<N, P>,
    tally: &mut Tally<P>,
) where
    L: ContactLaw<N>,
{
    let mut reading = Reading {
        model,
        groups,
        rows: None,
        end,
        stride,
        block,
        tally,
    };
    reading.read(segment, piece);
}

/// Reads the samples of each piece of the motion.
struct Reading<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
    end: f64,
    stride: usize,
    block: &'a mut Block<N, P>,
    tally: &'a mut Tally<P>,
}

impl<L, const N: usize, const W: usize, const P: usize> Sink<W> for Reading<'_, L, N, W, P>
where
    L: ContactLaw<N>,
{
    #[inline(always)]
    fn contact(&mut self, segment: &Segment<W>) {
        self.read(segment, Piece::Contact);
    }

    #[inline(always)]
    fn flight(&mut self, segment: &Segment<W>) {
        self.read(segment, Piece::Flight);
    }
}

impl<L, const N: usize, const W: usize, const P: usize> Reading<'_, L, N, W, P>
where
    L: ContactLaw<N>,
{
    #[inline(never)]
    fn read(&mut self, segment: &Segment<W>, piece: Piece) {
        pulp::Arch::new().dispatch(ReadPiece {
            reading: self,
            segment,
            piece,
        });
    }
}

/// The samples of one piece; a function of its own, and of several short loops,
/// because the compiler finds the vectors in short loops only.
struct ReadPiece<'a, 'b, L, const N: usize, const W: usize, const P: usize> {
    reading: &'a mut Reading<'b, L, N, W, P>,
    segment: &'a Segment<W>,
    piece: Piece,
}

impl<L, const N: usize, const W: usize, const P: usize> pulp::WithSimd
    for ReadPiece<'_, '_, L, N, W, P>
where
    L: ContactLaw<N>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Reading {
            model,
            groups,
            rows,
            end,
            stride,
            block,
            tally,
        } = self.reading;
        for (index, group) in groups.iter().enumerate() {
            let rows = rows.as_deref_mut().map(|rows| (rows, index));
            // Only contact and the flight before touch the onset.
            let average = OnsetAverage::new(model, group)
                .filter(|_| self.piece == Piece::Contact || self.segment.to <= 0.0);
            read_segment(
                model,
                (self.segment, self.piece),
                (group, *stride),
                *end,
                average.as_ref().map(|a| a as &dyn OnsetCorrection<P>),
                block,
                (&mut tally.sums, &mut tally.noise),
                rows,
            );
        }
    }
}

/// Running sums, one lane per sample of a pack.
#[derive(Clone, Copy)]
struct Sums<const P: usize> {
    cost: Pack,
    gradient: [Pack; P],
    normal: [[Pack; P]; P],
}

impl<const P: usize> Sums<P> {
    const ZERO: Self = Self {
        cost: Pack::ZERO,
        gradient: [Pack::ZERO; P],
        normal: [[Pack::ZERO; P]; P],
    };

    #[inline(always)]
    fn add(&mut self, weight: Pack, residual: Pack, jacobian: &[Pack; P]) {
        self.cost = (weight * residual).mul_add(residual, self.cost);
        for i in 0..P {
            let weighted = weight * jacobian[i];
            self.gradient[i] = weighted.mul_add(residual, self.gradient[i]);
            for j in 0..=i {
                self.normal[i][j] = weighted.mul_add(jacobian[j], self.normal[i][j]);
            }
        }
    }

    #[inline(always)]
    fn total(&self) -> NormalEquations<P> {
        let mut normal = [[0.0; P]; P];
        for i in 0..P {
            for j in 0..=i {
                normal[i][j] = self.normal[i][j].sum();
                normal[j][i] = normal[i][j];
            }
        }
        NormalEquations {
            cost: self.cost.sum(),
            gradient: self.gradient.map(|g| g.sum()),
            normal,
        }
    }
}

#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn read_segment<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    (segment, piece): (&Segment<W>, Piece),
    (group, stride): (&SampleGroup, usize),
    end: f64,
    average: Option<&dyn OnsetCorrection<P>>,
    block: &mut Block<N, P>,
    (sums, noise): (&mut Sums<P>, &mut Noise<P>),
    mut rows: Option<(&mut Rows, usize)>,
) where
    L: ContactLaw<N>,
{
    let (first, last) = group.range(model.onset, segment.from, segment.to, end);
    // The acceleration matters to a recorded one and to the onset's column.
    let accelerated = group.holds(Quantity::Acceleration)
        || model.columns.onset.iter().any(|onset| *onset != 0.0);
    if stride == 1 && first < last {
        noise.begin(first);
    }
    let mut at = first_sample(first, stride);
    while at < last {
        at = next_packs(block, at, last, stride);
        let piece = (segment, piece);
        fill(block, model, piece, &group.times, accelerated, average);
        for q in 0..QUANTITIES {
            if group.weights[q] == 0.0 && group.values[q].is_empty() {
                continue;
            }
            if stride > 1 || group.is_white(q) {
                sum_up(block, q, group, sums);
            } else {
                sum_up_noisy(block, q, group, (sums, noise));
            }
            if let Some((rows, index)) = rows.as_mut() {
                store_rows(rows, *index, q, group, block);
            }
        }
    }
    if stride == 1 && first < last {
        noise.end(group, first, last);
    }
}

/// The first sample from `at` on that belongs to the share.
#[inline(always)]
fn first_sample(at: usize, stride: usize) -> usize {
    if (at / PACK).is_multiple_of(stride) {
        at
    } else {
        at.next_multiple_of(stride * PACK)
    }
}

/// 1 in the first 0, 1, … lanes.
const COUNTED: [Pack; PACK + 1] = [
    Lanes([0.0; PACK]),
    Lanes([1.0, 0.0, 0.0, 0.0]),
    Lanes([1.0, 1.0, 0.0, 0.0]),
    Lanes([1.0, 1.0, 1.0, 0.0]),
    Lanes([1.0; PACK]),
];

/// The packs of the next block from sample `at` on, and where the block after it
/// begins.
#[inline(always)]
fn next_packs<const N: usize, const P: usize>(
    block: &mut Block<N, P>,
    at: usize,
    last: usize,
    stride: usize,
) -> usize {
    let mut at = at;
    for i in 0..BLOCK {
        let mut end = at + PACK;
        if stride > 1 {
            at = first_sample(at, stride);
            end = (at / PACK + 1) * PACK;
        }
        if at >= last {
            // What is left of the block repeats its first pack, without weight.
            block.starts.copy_within(0..1, i);
            block.counts[i] = 0;
            block.counted[i] = COUNTED[0];
            continue;
        }
        block.starts[i] = at;
        block.counts[i] = end.min(last) - at;
        block.counted[i] = COUNTED[block.counts[i]];
        at = end;
    }
    at
}

/// Adds the rows of quantity `q`, whose noise is white.
#[inline(always)]
fn sum_up<const N: usize, const P: usize>(
    block: &Block<N, P>,
    q: usize,
    group: &SampleGroup,
    sums: &mut Sums<P>,
) {
    // A copy that the compiler can keep in registers.
    let mut running = *sums;
    for i in 0..BLOCK {
        let (residual, jacobian) = block_row(block, q, group, i);
        running.add(weights(group, q, block, i), residual, &jacobian);
    }
    *sums = running;
}

/// Adds the rows of quantity `q`, whose noise persists or has a zero in common.
#[inline(never)]
fn sum_up_noisy<const N: usize, const P: usize>(
    block: &Block<N, P>,
    q: usize,
    group: &SampleGroup,
    (sums, noise): (&mut Sums<P>, &mut Noise<P>),
) {
    pulp::Arch::new().dispatch(Noisy {
        block,
        q,
        group,
        sums,
        noise,
    });
}

/// [`sum_up_noisy`], compiled for the machine's vector instructions.
struct Noisy<'a, const N: usize, const P: usize> {
    block: &'a Block<N, P>,
    q: usize,
    group: &'a SampleGroup,
    sums: &'a mut Sums<P>,
    noise: &'a mut Noise<P>,
}

impl<const N: usize, const P: usize> pulp::WithSimd for Noisy<'_, N, P> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Self {
            block, q, group, ..
        } = self;
        let mut running = *self.sums;
        for i in (0..BLOCK).filter(|&i| block.counts[i] > 0) {
            let (mut residual, mut jacobian) = block_row(block, q, group, i);
            let mut weight = weights(group, q, block, i);
            let count = block.counts[i];
            self.noise
                .whiten(q, group, &mut weight, &mut residual, &mut jacobian, count);
            running.add(weight, residual, &jacobian);
        }
        *self.sums = running;
    }
}

/// Residuals and derivatives of one pack.
#[inline(always)]
fn block_row<const N: usize, const P: usize>(
    block: &Block<N, P>,
    q: usize,
    group: &SampleGroup,
    i: usize,
) -> (Pack, [Pack; P]) {
    let residual = block.values[q][i] - load(&group.values[q], block.starts[i]);
    let mut jacobian = [Pack::ZERO; P];
    for (column, from) in jacobian.iter_mut().zip(&block.jacobian[q]) {
        *column = from[i];
    }
    (residual, jacobian)
}

/// Weights of one pack.
#[inline(always)]
fn weights<const N: usize, const P: usize>(
    group: &SampleGroup,
    q: usize,
    block: &Block<N, P>,
    i: usize,
) -> Pack {
    let weight = block.counted[i] * group.weights[q];
    if group.relative[q].is_empty() {
        weight
    } else {
        weight * load(&group.relative[q], block.starts[i])
    }
}

#[cold]
#[inline(never)]
fn store_rows<const N: usize, const P: usize>(
    rows: &mut Rows,
    index: usize,
    q: usize,
    group: &SampleGroup,
    block: &Block<N, P>,
) {
    while rows.residuals.len() <= index {
        rows.residuals.push(Default::default());
        rows.jacobian.push(Default::default());
    }
    // By their index: pieces of the motion do not come in the order of time.
    let residuals = &mut rows.residuals[index][q];
    residuals.resize(group.len, 0.0);
    let derivatives = &mut rows.jacobian[index][q];
    derivatives.resize(group.len * P, 0.0);
    let counts = block.counts;
    let samples = (0..BLOCK).flat_map(|pack| (0..counts[pack]).map(move |lane| (pack, lane)));
    for (pack, lane) in samples {
        let at = block.starts[pack] + lane;
        residuals[at] = block.values[q][pack].0[lane] - group.values[q][at];
        for (c, column) in block.jacobian[q].iter().enumerate() {
            derivatives[at * P + c] = column[pack].0[lane];
        }
    }
}
