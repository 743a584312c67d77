//! The model of a block of samples with its derivatives, in short loops over
//! packs of samples: the compiler finds the vectors in short loops only.

use crate::contact_motion::Segment;
use crate::model::{Columns, Model};
use crate::motion::Acceleration;
use crate::onset_average::OnsetCorrection;
use crate::samples::{PACK, QUANTITIES, Quantity};
use windfall_contact::law::{ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::ode_step::{DENSE_COEFFICIENTS, dense_at};
use windfall_numerics::real::{Lanes, Real};

/// Samples evaluated side by side.
pub(crate) type Pack = Lanes<PACK>;

/// Whether the bodies touch during a piece of the motion.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    Contact,
    Flight,
}

/// Packs of one block: each formula runs over all of them before the next does,
/// always over the whole block, as a loop without a count costs less than what
/// it evaluates in vain.
pub(crate) const BLOCK: usize = 8;

pub(crate) type PerPack = [Pack; BLOCK];

/// Model of a block of samples and what it is made of.
pub(crate) struct Block<const N: usize, const P: usize> {
    /// Index of the first sample of each pack.
    pub starts: [usize; BLOCK],
    /// Samples of each pack: [`PACK`] but where the range begins or ends.
    pub counts: [usize; BLOCK],
    /// 1 in the lanes of each pack that hold a sample, 0 in the others.
    pub counted: PerPack,
    sigma: PerPack,
    rest: PerPack,
    displacement: PerPack,
    force: ForceBlock<N>,
    motion: [Acceleration<Pack>; BLOCK],
    /// Model of each quantity.
    pub values: [PerPack; QUANTITIES],
    /// Its derivatives by the columns.
    pub jacobian: [[PerPack; P]; QUANTITIES],
}

/// Derivatives of the contact force, zero without contact.
struct ForceBlock<const N: usize> {
    by_displacement: PerPack,
    by_rate: PerPack,
    by_parameter: [PerPack; N],
    by_peak: PerPack,
}

impl<const N: usize, const P: usize> Block<N, P> {
    pub(crate) const ZERO: Self = {
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
            counted: zero,
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

/// Fills the block's models for the samples of its packs, which are at `times`.
#[inline(always)]
pub(crate) fn fill<L, const N: usize, const W: usize, const P: usize>(
    block: &mut Block<N, P>,
    model: &Model<L, N, W, P>,
    (segment, piece): (&Segment<W>, Piece),
    times: &[f64],
    accelerated: bool,
    average: Option<&dyn OnsetCorrection<P>>,
) where
    L: ContactLaw<N>,
{
    place(block, model.onset, segment, times);
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
        correct_onset(block, model, times, average);
    }
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

#[inline(always)]
pub(crate) fn load(values: &[f64], at: usize) -> Pack {
    let mut out = [0.0; PACK];
    out.copy_from_slice(&values[at..at + PACK]);
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
