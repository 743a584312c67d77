//! Residuals of an impact and their derivatives, summed into the normal
//! equations in one pass over the samples, several samples at a time.

use crate::contact_motion::{ImpactEvent, Seeds, Segment, Sink, follow, scaled_time};
use crate::model::{Columns, Model};
use crate::motion::Acceleration;
use crate::onset_average::{OnsetAverage, OnsetCorrection};
use crate::samples::{PACK, QUANTITIES, Quantity, SampleGroup};
use crate::whitening::{Row, Whitening, ZeroSums, unit_shift};
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
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
    })
}

/// One pass of [`evaluate`], compiled for the machine's vector instructions.
struct Pass<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
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
            sums: Sums::ZERO,
            noise: Noise::NONE,
        };
        follow(&model.event, before.min(0.0), after, &mut reading)?;
        let mut equations = reading.sums.total();
        reading.noise.complete(groups, &mut equations);
        Ok(equations)
    }
}

/// Reads the samples of each piece of the motion.
struct Reading<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
    end: f64,
    sums: Sums<P>,
    noise: Noise<P>,
}

/// What noise other than white keeps between pieces of the motion; each quantity
/// is in one group.
struct Noise<const P: usize> {
    whitening: [Whitening<P>; QUANTITIES],
    zeros: [ZeroSums<P>; QUANTITIES],
    /// Rows that found their predecessor in a later piece.
    joints: NormalEquations<P>,
}

impl<const P: usize> Noise<P> {
    const NONE: Self = Self {
        whitening: [Whitening::NONE; QUANTITIES],
        zeros: [ZeroSums::ZERO; QUANTITIES],
        joints: NormalEquations::ZERO,
    };

    /// Adds the rows without a predecessor and takes the zeros out.
    fn complete(&mut self, groups: &[SampleGroup], equations: &mut NormalEquations<P>) {
        for q in 0..QUANTITIES {
            let Some(group) = groups.iter().find(|g| !g.values[q].is_empty()) else {
                continue;
            };
            if let Some(row) = self.whitening[q].first() {
                let weight = group.weights[q];
                self.joints.add(weight, row.residual, &row.jacobian);
                self.zeros[q].add_row(weight, 1.0, &row);
            }
        }
        equations.cost += self.joints.cost;
        for i in 0..P {
            equations.gradient[i] += self.joints.gradient[i];
            for j in 0..P {
                equations.normal[i][j] += self.joints.normal[i][j];
            }
        }
        for q in 0..QUANTITIES {
            let of = groups.iter().find(|g| g.zero_sd[q] > 0.0);
            if let Some(group) = of {
                self.zeros[q].eliminate(group.zero_sd[q], equations);
            }
        }
    }
}

impl<L, const N: usize, const W: usize, const P: usize> Sink<W> for Reading<'_, L, N, W, P>
where
    L: ContactLaw<N>,
{
    #[inline(always)]
    fn contact(&mut self, segment: &Segment<W>) {
        for (index, group) in self.groups.iter().enumerate() {
            let rows = self.rows.as_deref_mut().map(|rows| (rows, index));
            let average = OnsetAverage::new(self.model, group);
            read_segment(
                self.model,
                segment,
                group,
                self.end,
                average.as_ref().map(|a| a as &dyn OnsetCorrection<P>),
                (&mut self.sums, &mut self.noise),
                rows,
            );
        }
    }

    #[inline(always)]
    fn flight(&mut self, segment: &Segment<W>) {
        let event = &self.model.event;
        let model = Model {
            event: ImpactEvent {
                law: NoContact,
                motion: event.motion,
                velocity: event.velocity,
                end: event.end,
                seeds: Seeds::NONE,
                tolerance: event.tolerance,
            },
            onset: self.model.onset,
            offset: self.model.offset,
            columns: self.model.columns,
            sampling: self.model.sampling,
        };
        for (index, group) in self.groups.iter().enumerate() {
            let rows = self.rows.as_deref_mut().map(|rows| (rows, index));
            // Only the flight before touches the onset.
            let average = OnsetAverage::new(self.model, group).filter(|_| segment.to <= 0.0);
            read_flight(
                &model,
                segment,
                group,
                self.end,
                average.as_ref().map(|a| a as &dyn OnsetCorrection<P>),
                (&mut self.sums, &mut self.noise),
                rows,
            );
        }
    }
}

/// No force: the samples of a flight, the same for every law and so compiled
/// once.
#[derive(Clone, Copy)]
struct NoContact;

impl ContactLaw<0> for NoContact {
    #[inline(always)]
    fn evaluate<R: Real>(&self, _d: R, _v: R, _peak: R) -> ContactForce<R, 0> {
        let zero = R::splat(0.0);
        ContactForce {
            force: zero,
            by_displacement: zero,
            by_rate: zero,
            by_parameter: [],
            by_peak: zero,
        }
    }
}

#[inline(never)]
fn read_flight<const W: usize, const P: usize>(
    model: &Model<NoContact, 0, W, P>,
    segment: &Segment<W>,
    group: &SampleGroup,
    end: f64,
    average: Option<&dyn OnsetCorrection<P>>,
    sums: (&mut Sums<P>, &mut Noise<P>),
    rows: Option<(&mut Rows, usize)>,
) {
    read_segment(model, segment, group, end, average, sums, rows);
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

/// A segment's dense output, gathered for packs of samples.
struct Reader<const P: usize> {
    start: f64,
    inverse_width: f64,
    displacement: [f64; DENSE_COEFFICIENTS],
    rate: [f64; DENSE_COEFFICIENTS],
    columns: [[[f64; DENSE_COEFFICIENTS]; 2]; P],
}

#[inline(always)]
fn reader<const W: usize, const P: usize>(segment: &Segment<W>, columns: &Columns<P>) -> Reader<P> {
    let step = &segment.step;
    let mut out = Reader {
        start: step.start,
        inverse_width: 1.0 / step.width,
        displacement: step.lane(0, 0),
        rate: step.lane(1, 0),
        columns: [[[0.0; DENSE_COEFFICIENTS]; 2]; P],
    };
    for (column, lane) in out.columns.iter_mut().zip(columns.lanes) {
        if lane > 0 {
            *column = [step.lane(0, lane), step.lane(1, lane)];
        }
    }
    out
}

/// Model of one pack of samples: values and derivatives by quantity.
struct PackModel<const P: usize> {
    values: [Pack; QUANTITIES],
    jacobian: [[Pack; P]; QUANTITIES],
}

#[inline(always)]
fn read_segment<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    segment: &Segment<W>,
    group: &SampleGroup,
    end: f64,
    average: Option<&dyn OnsetCorrection<P>>,
    (sums, noise): (&mut Sums<P>, &mut Noise<P>),
    mut rows: Option<(&mut Rows, usize)>,
) where
    L: ContactLaw<N>,
{
    let (first, last) = group.range(model.onset, segment.from, segment.to, end);
    if first >= last {
        return;
    }
    let reader = reader(segment, &model.columns);
    // The acceleration matters to a recorded one and to the onset's column.
    let accelerated = group.holds(Quantity::Acceleration)
        || model.columns.onset.iter().any(|onset| *onset != 0.0);
    // A copy that the compiler can keep in registers.
    let mut running = *sums;
    let mut openings = [None; QUANTITIES];
    for q in 0..QUANTITIES {
        noise.whitening[q].begin(first);
    }
    let mut at = first;
    while at < last {
        let count = PACK.min(last - at);
        let times = load(&group.times, at) + -model.onset;
        // Lanes past the range read the range's end; their weight is zero.
        let times = times
            .max(Pack::splat(segment.from))
            .min(Pack::splat(segment.to));
        let mut pack = pack_model(model, segment, &reader, times, accelerated);
        if let Some(average) = average
            && times.0[0] < average.until()
        {
            correct_onset(&mut pack, &times, average, model.event.motion.inverse_mass);
        }
        for q in 0..QUANTITIES {
            if group.weights[q] == 0.0 && group.values[q].is_empty() {
                continue;
            }
            let mut residual = pack.values[q] - load(&group.values[q], at);
            if let Some((rows, index)) = rows.as_mut() {
                let place = (at, count, group.len);
                store_rows(rows, *index, q, place, residual, &pack.jacobian[q]);
            }
            let mut weight = masked(group.weights[q], count);
            if !group.relative[q].is_empty() {
                weight = weight * load(&group.relative[q], at);
            }
            let persistence = group.persistence[q];
            if persistence != 0.0 {
                let opening = Row {
                    residual: residual.0[0],
                    jacobian: pack.jacobian[q].map(|column| column.0[0]),
                };
                let whitening = &mut noise.whitening[q];
                let jacobian = &mut pack.jacobian[q];
                if whitening.whiten(persistence, &mut residual, jacobian, count) {
                    openings[q] = Some(opening);
                    weight.0[0] = 0.0;
                }
            }
            running.add(weight, residual, &pack.jacobian[q]);
            if group.zero_sd[q] > 0.0 {
                let shift = unit_shift(persistence);
                noise.zeros[q].add(weight, shift, residual, &pack.jacobian[q]);
            }
        }
        at += PACK;
    }
    *sums = running;
    for q in 0..QUANTITIES {
        let persistence = group.persistence[q];
        if persistence == 0.0 || group.values[q].is_empty() {
            continue;
        }
        if let Some(row) = noise.whitening[q].end(first, last, openings[q], persistence) {
            let weight = group.weights[q];
            noise.joints.add(weight, row.residual, &row.jacobian);
            noise.zeros[q].add_row(weight, unit_shift(persistence), &row);
        }
    }
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

#[inline(always)]
fn pack_model<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    segment: &Segment<W>,
    reader: &Reader<P>,
    times: Pack,
    accelerated: bool,
) -> PackModel<P>
where
    L: ContactLaw<N>,
{
    let event = &model.event;
    let sigma = (scaled_time(times, segment.power) + -reader.start) * reader.inverse_width;
    let rest = -sigma + 1.0;
    let x = dense_at(&reader.displacement, sigma, rest);
    let v = dense_at(&reader.rate, sigma, rest);

    // The force is repulsive or nothing, and nothing without contact.
    let zero = Pack::ZERO;
    let touching = x.select(Pack::splat(1.0), zero);
    let law = event.law.evaluate(
        x.max(Pack::splat(SMALLEST_DISPLACEMENT)),
        v,
        Pack::splat(segment.peak),
    );
    let on = match event.end {
        EndRule::ForceZero => law.force.select(touching, zero),
        EndRule::GapZero => touching,
    };
    let force = on.select(law.force, zero);
    let by_displacement = on.select(law.by_displacement, zero);
    let by_rate = on.select(law.by_rate, zero);
    let motion: Acceleration<Pack> = if accelerated {
        event.motion.acceleration(x, v, force)
    } else {
        Acceleration {
            value: zero,
            by_displacement: zero,
            by_rate: zero,
            by_force: zero,
        }
    };

    let mut jacobian = [[Pack::ZERO; P]; QUANTITIES];
    for c in 0..P {
        let (mut dx, mut dv) = (zero, zero);
        let lane = model.columns.lanes[c];
        let mut direct = zero;
        if lane > 0 {
            let [column_x, column_v] = &reader.columns[c];
            dx = dense_at(column_x, sigma, rest);
            dv = dense_at(column_v, sigma, rest);
            for i in 0..N {
                let seed = event.seeds.parameters[i].0[lane];
                if seed != 0.0 {
                    direct += law.by_parameter[i] * seed;
                }
            }
            if event.law.history() {
                direct += law.by_peak * segment.peak_lanes.0[lane];
            }
        }
        if model.columns.onset[c] != 0.0 {
            dx += v * -model.columns.onset[c];
            dv += motion.value * -model.columns.onset[c];
        }
        let df = by_displacement * dx + by_rate * dv + on.select(direct, zero);
        jacobian[0][c] = dx + model.columns.offset[c];
        jacobian[1][c] = dv;
        jacobian[2][c] = df;
        if accelerated {
            jacobian[3][c] =
                motion.by_displacement * dx + motion.by_rate * dv + motion.by_force * df;
        }
    }
    PackModel {
        values: [x + model.offset, v, force, motion.value],
        jacobian,
    }
}

/// Replaces the force at an instant by its mean, in the lanes near first touch.
#[cold]
#[inline(never)]
fn correct_onset<const P: usize>(
    pack: &mut PackModel<P>,
    times: &Pack,
    average: &dyn OnsetCorrection<P>,
    inverse_mass: f64,
) {
    let (force, acceleration) = (Quantity::Force as usize, Quantity::Acceleration as usize);
    for lane in 0..PACK {
        let Some((change, by_column)) = average.at(times.0[lane]) else {
            continue;
        };
        pack.values[force].0[lane] += change;
        pack.values[acceleration].0[lane] -= change * inverse_mass;
        for c in 0..P {
            pack.jacobian[force][c].0[lane] += by_column[c];
            pack.jacobian[acceleration][c].0[lane] -= by_column[c] * inverse_mass;
        }
    }
}

#[cold]
#[inline(never)]
fn store_rows<const P: usize>(
    rows: &mut Rows,
    group: usize,
    quantity: usize,
    (at, count, len): (usize, usize, usize),
    residual: Pack,
    jacobian: &[Pack; P],
) {
    while rows.residuals.len() <= group {
        rows.residuals.push(Default::default());
        rows.jacobian.push(Default::default());
    }
    // By their index: pieces of the motion do not come in the order of time.
    let residuals = &mut rows.residuals[group][quantity];
    residuals.resize(len, 0.0);
    residuals[at..at + count].copy_from_slice(&residual.0[..count]);
    let derivatives = &mut rows.jacobian[group][quantity];
    derivatives.resize(len * P, 0.0);
    for lane in 0..count {
        for (c, column) in jacobian.iter().enumerate() {
            derivatives[(at + lane) * P + c] = column.0[lane];
        }
    }
}
