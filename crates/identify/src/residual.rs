//! Residuals of an impact and their derivatives, summed into the normal
//! equations in one pass over the samples, several samples at a time.

use crate::contact_motion::{Segment, Sink, follow};
use crate::model::{Columns, Model};
use crate::motion::Acceleration;
use crate::onset_average::{OnsetAverage, OnsetCorrection};
use crate::samples::{PACK, QUANTITIES, Quantity, SampleGroup};
use windfall_contact::law::{ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::least_squares::NormalEquations;
use windfall_numerics::ode_step::{DENSE_COEFFICIENTS, StepError, dense_at};
use windfall_numerics::real::{Lanes, Real};

type Pack = Lanes<PACK>;

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

/// [`evaluate`] with a share of the samples, for the way to the minimum: every
/// `stride`-th pack of them, the same ones wherever the pieces of the motion end.
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
        let first = groups.iter().filter_map(|g| g.times().first()).copied();
        let last = groups.iter().filter_map(|g| g.times().last()).copied();
        let before = first.fold(f64::INFINITY, f64::min) - model.onset;
        let after = last.fold(f64::NEG_INFINITY, f64::max) - model.onset;

        let mut reading = Reading {
            model,
            groups,
            rows,
            end: after,
            stride,
            block: Block::ZERO,
            sums: Sums::ZERO,
        };
        follow(&model.event, before.min(0.0), after, &mut reading)?;
        Ok(reading.sums.total())
    }
}

/// Reads the samples of each piece of the motion.
struct Reading<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
    end: f64,
    stride: usize,
    block: Block<N, P>,
    sums: Sums<P>,
}

/// Whether the bodies touch during a piece of the motion.
#[derive(Clone, Copy, PartialEq)]
enum Piece {
    Contact,
    Flight,
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
            sums,
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
                sums,
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

/// Packs of one block: each formula runs over all of them before the next does,
/// always over the whole block, as a loop without a count costs less than what
/// it evaluates in vain.
const BLOCK: usize = 8;

type PerPack = [Pack; BLOCK];

/// Model of a block of samples and what it is made of.
struct Block<const N: usize, const P: usize> {
    /// Index of the first sample of each pack.
    starts: [usize; BLOCK],
    /// Samples of each pack: [`PACK`] but where the range begins or ends.
    counts: [usize; BLOCK],
    sigma: PerPack,
    rest: PerPack,
    displacement: PerPack,
    force: ForceBlock<N>,
    motion: [Acceleration<Pack>; BLOCK],
    /// Model of each quantity.
    values: [PerPack; QUANTITIES],
    /// Its derivatives by the columns.
    jacobian: [[PerPack; P]; QUANTITIES],
}

/// Derivatives of the contact force, zero without contact.
struct ForceBlock<const N: usize> {
    by_displacement: PerPack,
    by_rate: PerPack,
    by_parameter: [PerPack; N],
    by_peak: PerPack,
}

impl<const N: usize, const P: usize> Block<N, P> {
    const ZERO: Self = {
        let zero = [Pack::ZERO; BLOCK];
        let still = Acceleration {
            value: Pack::ZERO,
            by_displacement: Pack::ZERO,
            by_rate: Pack::ZERO,
            by_force: Pack::ZERO,
        };
        Self {
            starts: [0; BLOCK],
            counts: [0; BLOCK],
            sigma: zero,
            rest: zero,
            displacement: zero,
            force: ForceBlock {
                by_displacement: zero,
                by_rate: zero,
                by_parameter: [zero; N],
                by_peak: zero,
            },
            motion: [still; BLOCK],
            values: [zero; QUANTITIES],
            jacobian: [[zero; P]; QUANTITIES],
        }
    };
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
    sums: &mut Sums<P>,
    mut rows: Option<(&mut Rows, usize)>,
) where
    L: ContactLaw<N>,
{
    let (first, last) = group.range(model.onset, segment.from, segment.to, end);
    // The acceleration matters to a recorded one and to the onset's column.
    let accelerated = group.holds(Quantity::Acceleration)
        || model.columns.onset.iter().any(|onset| *onset != 0.0);
    let mut at = first_sample(first, stride);
    while at < last {
        at = next_packs(block, at, last, stride);
        place(block, model.onset, segment, &group.times);
        read_motion(block, &model.columns, segment);
        if piece == Piece::Contact {
            read_force(block, model, segment);
        } else {
            block.values[Quantity::Force as usize] = [Pack::ZERO; BLOCK];
        }
        if accelerated {
            accelerate(block, model);
        }
        read_columns(block, model, (segment, piece), accelerated);
        if let Some(average) = average {
            correct_onset(block, model, &group.times, average);
        }
        for q in 0..QUANTITIES {
            if group.weights[q] == 0.0 && group.values[q].is_empty() {
                continue;
            }
            sum_up(block, q, &group.values[q], group.weights[q], sums);
            if let Some((rows, index)) = rows.as_mut() {
                store_rows(rows, *index, q, &group.values[q], block);
            }
        }
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
            continue;
        }
        block.starts[i] = at;
        block.counts[i] = end.min(last) - at;
        at = end;
    }
    at
}

/// Where the samples are in the step: σ and 1 − σ.
#[inline(always)]
fn place<const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    onset: f64,
    segment: &Segment<W>,
    times: &[f64],
) {
    let sigma = &mut block.sigma;
    for (i, sigma) in sigma.iter_mut().enumerate() {
        // Lanes past the range read the range's end; their weight is zero.
        *sigma = (load(times, block.starts[i]) + -onset)
            .max(Pack::splat(segment.from))
            .min(Pack::splat(segment.to));
    }
    let mut power = segment.power;
    while power > 1 {
        for sigma in sigma.iter_mut() {
            *sigma = sigma.sqrt();
        }
        power /= 2;
    }
    let (start, inverse_width) = (segment.step.start, 1.0 / segment.step.width);
    for (sigma, rest) in sigma.iter_mut().zip(&mut block.rest) {
        *sigma = (*sigma + -start) * inverse_width;
        *rest = -*sigma + 1.0;
    }
}

/// Dense output of one lane for all packs.
#[inline(always)]
fn dense(
    coefficients: [f64; DENSE_COEFFICIENTS],
    sigma: &PerPack,
    rest: &PerPack,
    out: &mut PerPack,
) {
    for i in 0..BLOCK {
        out[i] = dense_at(&coefficients, sigma[i], rest[i]);
    }
}

/// Displacement and rate, and their derivatives by the columns of the motion.
#[inline(always)]
fn read_motion<const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    columns: &Columns<P>,
    segment: &Segment<W>,
) {
    let step = &segment.step;
    let (sigma, rest) = (&block.sigma, &block.rest);
    dense(step.lane(0, 0), sigma, rest, &mut block.displacement);
    dense(step.lane(1, 0), sigma, rest, &mut block.values[1]);
    for (c, &lane) in columns.lanes.iter().enumerate() {
        for component in 0..2 {
            let out = &mut block.jacobian[component][c];
            if lane > 0 {
                dense(step.lane(component, lane), sigma, rest, out);
            } else {
                *out = [Pack::ZERO; BLOCK];
            }
        }
    }
}

/// The force, which is repulsive or nothing and nothing without contact, and
/// its derivatives.
#[inline(always)]
fn read_force<L, const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    model: &Model<L, N, W, P>,
    segment: &Segment<W>,
) where
    L: ContactLaw<N>,
{
    let event = &model.event;
    let (one, zero) = (Pack::splat(1.0), Pack::ZERO);
    for i in 0..BLOCK {
        let (x, v) = (block.displacement[i], block.values[1][i]);
        let d = x.max(Pack::splat(SMALLEST_DISPLACEMENT));
        let law = event.law.evaluate(d, v, Pack::splat(segment.peak));
        // Factors instead of choices: the compiler turns choices into branches.
        let touching = x.select(one, zero);
        let on = match event.end {
            EndRule::ForceZero => touching * law.force.select(one, zero),
            EndRule::GapZero => touching,
        };
        block.values[2][i] = law.force * on;
        let force = &mut block.force;
        force.by_displacement[i] = law.by_displacement * on;
        force.by_rate[i] = law.by_rate * on;
        for (out, by) in force.by_parameter.iter_mut().zip(law.by_parameter) {
            out[i] = by * on;
        }
        force.by_peak[i] = law.by_peak * on;
    }
}

/// Acceleration and its derivatives.
#[inline(always)]
fn accelerate<L, const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    model: &Model<L, N, W, P>,
) {
    for i in 0..BLOCK {
        let (x, v) = (block.displacement[i], block.values[1][i]);
        let motion = model.event.motion.acceleration(x, v, block.values[2][i]);
        block.values[3][i] = motion.value;
        block.motion[i] = motion;
    }
}

/// The columns of the Jacobian, from those of displacement and rate.
#[inline(always)]
fn read_columns<L, const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    model: &Model<L, N, W, P>,
    (segment, piece): (&Segment<W>, Piece),
    accelerated: bool,
) where
    L: ContactLaw<N>,
{
    let Block {
        displacement,
        force,
        motion,
        values,
        jacobian: [dx, dv, df, da],
        ..
    } = block;
    for c in 0..P {
        let (dx, dv, df) = (&mut dx[c], &mut dv[c], &mut df[c]);
        let onset = model.columns.onset[c];
        if onset != 0.0 {
            for i in 0..BLOCK {
                dx[i] += values[1][i] * -onset;
                dv[i] += motion[i].value * -onset;
            }
        }
        if piece == Piece::Contact {
            for i in 0..BLOCK {
                df[i] = force.by_displacement[i] * dx[i] + force.by_rate[i] * dv[i];
            }
            add_direct(df, force, model, segment, c);
        } else {
            *df = [Pack::ZERO; BLOCK];
        }
        if accelerated {
            let da = &mut da[c];
            for i in 0..BLOCK {
                let m = &motion[i];
                da[i] = m.by_displacement * dx[i] + m.by_rate * dv[i] + m.by_force * df[i];
            }
        }
        let offset = model.columns.offset[c];
        if offset != 0.0 {
            for i in 0..BLOCK {
                dx[i] = dx[i] + offset;
            }
        }
    }
    for i in 0..BLOCK {
        values[0][i] = displacement[i] + model.offset;
    }
}

/// The direct part of column `c` of the force: through the law's parameters.
#[inline(always)]
fn add_direct<L, const N: usize, const W: usize, const P: usize>(
    df: &mut PerPack,
    force: &ForceBlock<N>,
    model: &Model<L, N, W, P>,
    segment: &Segment<W>,
    c: usize,
) where
    L: ContactLaw<N>,
{
    let event = &model.event;
    let lane = model.columns.lanes[c];
    if lane == 0 {
        return;
    }
    let mut add = |by: &PerPack, factor: f64| {
        if factor != 0.0 {
            for i in 0..BLOCK {
                df[i] += by[i] * factor;
            }
        }
    };
    for i in 0..N {
        add(&force.by_parameter[i], event.seeds.parameters[i].0[lane]);
    }
    if event.law.history() {
        add(&force.by_peak, segment.peak_lanes.0[lane]);
    }
}

/// Adds the rows of quantity `q`.
#[inline(always)]
fn sum_up<const N: usize, const P: usize>(
    block: &Block<N, P>,
    q: usize,
    measured: &[f64],
    weight: f64,
    sums: &mut Sums<P>,
) {
    // A copy that the compiler can keep in registers.
    let mut running = *sums;
    for i in 0..BLOCK {
        let residual = block.values[q][i] - load(measured, block.starts[i]);
        let mut jacobian = [Pack::ZERO; P];
        for (column, from) in jacobian.iter_mut().zip(&block.jacobian[q]) {
            *column = from[i];
        }
        running.add(masked(weight, block.counts[i]), residual, &jacobian);
    }
    *sums = running;
}

#[inline(always)]
fn load(values: &[f64], at: usize) -> Pack {
    let mut out = [0.0; PACK];
    out.copy_from_slice(&values[at..at + PACK]);
    Lanes(out)
}

/// `weight` in the first `count` lanes.
#[inline(always)]
fn masked(weight: f64, count: usize) -> Pack {
    let mut out = [weight; PACK];
    if count < PACK {
        for lane in &mut out[count..] {
            *lane = 0.0;
        }
    }
    Lanes(out)
}

/// Replaces the force at an instant by its mean, in the samples near first touch.
#[cold]
#[inline(never)]
fn correct_onset<L, const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    model: &Model<L, N, W, P>,
    times: &[f64],
    average: &dyn OnsetCorrection<P>,
) {
    let (force, acceleration) = (Quantity::Force as usize, Quantity::Acceleration as usize);
    let inverse_mass = model.event.motion.inverse_mass;
    let starts = block.starts;
    let samples = (0..BLOCK).flat_map(|pack| (0..PACK).map(move |lane| (pack, lane)));
    for (pack, lane) in samples {
        let time = times[starts[pack] + lane] - model.onset;
        if time >= average.until() {
            break;
        }
        let Some((change, by_column)) = average.at(time) else {
            continue;
        };
        block.values[force][pack].0[lane] += change;
        block.values[acceleration][pack].0[lane] -= change * inverse_mass;
        for c in 0..P {
            block.jacobian[force][c][pack].0[lane] += by_column[c];
            block.jacobian[acceleration][c][pack].0[lane] -= by_column[c] * inverse_mass;
        }
    }
}

#[cold]
#[inline(never)]
fn store_rows<const N: usize, const P: usize>(
    rows: &mut Rows,
    group: usize,
    quantity: usize,
    measured: &[f64],
    block: &Block<N, P>,
) {
    while rows.residuals.len() <= group {
        rows.residuals.push(Default::default());
        rows.jacobian.push(Default::default());
    }
    let counts = block.counts;
    let samples = (0..BLOCK).flat_map(|pack| (0..counts[pack]).map(move |lane| (pack, lane)));
    for (pack, lane) in samples {
        let model = block.values[quantity][pack].0[lane];
        let measured = measured[block.starts[pack] + lane];
        rows.residuals[group][quantity].push(model - measured);
        for column in &block.jacobian[quantity] {
            rows.jacobian[group][quantity].push(column[pack].0[lane]);
        }
    }
}
