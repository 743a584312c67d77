//! The model of a pack of samples with its derivatives.

use crate::fit::model::Model;
use crate::fit::onset_average::OnsetCorrection;
use crate::rig::contact_motion::Segment;
use crate::samples::{PACK, QUANTITIES, Quantity};
use windfall_contact::law::{ContactForce, ContactLaw, EndRule, SMALLEST_DISPLACEMENT};
use windfall_numerics::ode::step::{DENSE_COEFFICIENTS, dense_at};
use windfall_numerics::real::{Lanes, Real};

/// Samples evaluated side by side.
pub(crate) type Pack = Lanes<PACK>;

/// Model of a pack of samples.
pub(crate) struct PackModel<R, const P: usize> {
    /// Of each quantity.
    pub values: [R; QUANTITIES],
    /// Its derivatives by the columns.
    pub jacobian: [[R; P]; QUANTITIES],
}

/// Dense output of what does not move.
const STILL: [f64; DENSE_COEFFICIENTS] = [0.0; DENSE_COEFFICIENTS];

/// What the packs of one piece of the motion have in common.
pub(crate) struct PieceModel<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    segment: &'a Segment<W>,
    accelerated: bool,
    inverse_width: f64,
    /// Dense output of displacement and rate.
    state: [&'a [f64; DENSE_COEFFICIENTS]; 2],
    /// That of their derivatives by each column; zero where it is no lane's, as it is from
    /// column W − 1 on.
    columns: [[&'a [f64; DENSE_COEFFICIENTS]; 2]; P],
    /// Derivatives of the law's parameters by each column, and which are not zero.
    parameters: [[f64; N]; P],
    moving: [[bool; N]; P],
    /// 1 where an attractive force counts, 0 where it ends the contact.
    attractive: f64,
}

impl<'a, L: ContactLaw<N>, const N: usize, const W: usize, const P: usize>
    PieceModel<'a, L, N, W, P>
{
    /// The model during `segment`; the acceleration only where it is `accelerated`.
    #[inline(always)]
    pub fn new(model: &'a Model<L, N, W, P>, segment: &'a Segment<W>, accelerated: bool) -> Self {
        let step = &segment.step;
        let [x, v] = &step.coefficients;
        let mut columns = [[&STILL; 2]; P];
        let (mut parameters, mut moving) = ([[0.0; N]; P], [[false; N]; P]);
        for (c, &lane) in model.columns.lanes.iter().enumerate() {
            if lane > 0 {
                columns[c] = [&x[lane], &v[lane]];
                for (i, seed) in model.event.seeds.parameters.iter().enumerate() {
                    parameters[c][i] = seed.0[lane];
                    moving[c][i] = seed.0[lane] != 0.0;
                }
            }
        }
        Self {
            model,
            segment,
            accelerated,
            inverse_width: 1.0 / step.width,
            state: [&x[0], &v[0]],
            columns,
            parameters,
            moving,
            attractive: match model.event.end {
                EndRule::ForceZero => 0.0,
                EndRule::GapZero => 1.0,
            },
        }
    }

    /// The model of samples at a [`place`](Self::place), with a force or without.
    #[inline(always)]
    pub(crate) fn at<R: Real>(&self, (sigma, rest): (R, R), contact: bool) -> PackModel<R, P> {
        let zero = sigma.constant(0.0);
        let columns = &self.model.columns;
        let x = dense_at(self.state[0], sigma, rest);
        let v = dense_at(self.state[1], sigma, rest);
        let mut jacobian = [[zero; P]; QUANTITIES];
        for c in 0..P.min(W - 1) {
            jacobian[0][c] = dense_at(self.columns[c][0], sigma, rest);
            jacobian[1][c] = dense_at(self.columns[c][1], sigma, rest);
        }
        let force = if contact {
            self.force(x, v)
        } else {
            no_force(zero)
        };
        let mut acceleration = zero;
        if self.accelerated {
            let motion = self.model.event.motion.acceleration(x, v, force.force);
            acceleration = motion.value;
            for c in 0..P {
                let later = zero.constant(-columns.onset[c]);
                jacobian[0][c] = v.mul_add(later, jacobian[0][c]);
                jacobian[1][c] = motion.value.mul_add(later, jacobian[1][c]);
                if contact {
                    jacobian[2][c] = self.force_column(&force, &jacobian, c);
                }
                jacobian[3][c] = motion.by_displacement * jacobian[0][c]
                    + motion.by_rate * jacobian[1][c]
                    + motion.by_force * jacobian[2][c];
            }
        } else if contact {
            for c in 0..P {
                jacobian[2][c] = self.force_column(&force, &jacobian, c);
            }
        } else {
            // Of the displacement alone.
            for c in 0..P {
                let later = zero.constant(-columns.onset[c]);
                jacobian[0][c] = v.mul_add(later, jacobian[0][c]);
            }
        }
        for c in 0..P {
            jacobian[0][c] = jacobian[0][c] + columns.offset[c];
        }
        PackModel {
            values: [x + self.model.offset, v, force.force, acceleration],
            jacobian,
        }
    }

    /// [`at`](Self::at) of samples of the displacement alone.
    #[inline(always)]
    pub(crate) fn place_at<R: Real>(&self, (sigma, rest): (R, R)) -> PackModel<R, P> {
        let zero = sigma.constant(0.0);
        let columns = &self.model.columns;
        let x = dense_at(self.state[0], sigma, rest);
        let v = dense_at(self.state[1], sigma, rest);
        let mut jacobian = [[zero; P]; QUANTITIES];
        for c in 0..P {
            let later = zero.constant(-columns.onset[c]);
            let column = match c < W - 1 {
                true => dense_at(self.columns[c][0], sigma, rest),
                false => zero,
            };
            jacobian[0][c] = v.mul_add(later, column) + columns.offset[c];
        }
        PackModel {
            values: [x + self.model.offset, v, zero, zero],
            jacobian,
        }
    }

    /// Where samples at `times` are in the step: σ and 1 − σ.
    #[inline(always)]
    pub(crate) fn place<R: Real>(&self, times: R) -> (R, R) {
        let segment = self.segment;
        // Lanes past the range read the range's end; their weight is zero.
        let mut s = (times + -self.model.onset)
            .max(times.constant(segment.from))
            .min(times.constant(segment.to));
        if segment.power >= 2 {
            s = s.sqrt();
        }
        if segment.power >= 4 {
            s = s.sqrt();
        }
        let sigma = (s + -segment.step.start) * self.inverse_width;
        (sigma, -sigma + 1.0)
    }

    /// The force, which is repulsive or nothing and nothing without contact, and
    /// its derivatives.
    #[inline(always)]
    fn force<R: Real>(&self, x: R, v: R) -> ContactForce<R, N> {
        let (one, zero) = (x.constant(1.0), x.constant(0.0));
        let d = x.max(x.constant(SMALLEST_DISPLACEMENT));
        let peak = x.constant(self.segment.peak);
        let law = self.model.event.law.evaluate(d, v, peak);
        // Factors instead of choices: the compiler turns choices into branches.
        let repulsive = law.force.select(one, x.constant(self.attractive));
        law.scaled(x.select(one, zero) * repulsive)
    }

    /// Column `c` of the force, from those of displacement and rate.
    #[inline(always)]
    fn force_column<R: Real>(
        &self,
        force: &ContactForce<R, N>,
        jacobian: &[[R; P]; QUANTITIES],
        c: usize,
    ) -> R {
        let mut sum = force.by_displacement * jacobian[0][c];
        sum = force.by_rate.mul_add(jacobian[1][c], sum);
        for i in 0..N {
            if self.moving[c][i] {
                let factor = sum.constant(self.parameters[c][i]);
                sum = force.by_parameter[i].mul_add(factor, sum);
            }
        }
        let lane = self.model.columns.lanes[c];
        if lane > 0 && self.model.event.law.history() {
            let factor = sum.constant(self.segment.peak_lanes.0[lane]);
            sum = force.by_peak.mul_add(factor, sum);
        }
        sum
    }

    /// Replaces the force at an instant by its mean, in the samples near first
    /// touch, which are at `times`.
    #[inline(always)]
    pub(crate) fn correct_onset<R: Real<Plain = Pack>>(
        &self,
        found: &mut PackModel<R, P>,
        times: Pack,
        average: &dyn OnsetCorrection<P>,
    ) {
        let times = times + -self.model.onset;
        if times.0[0] >= average.until() {
            return;
        }
        let inverse_mass = self.model.event.motion.inverse_mass;
        let (change, by_column) = correction(times, average);
        let (force, acceleration) = (Quantity::Force as usize, Quantity::Acceleration as usize);
        let add = |to: &mut R, change: R| *to = *to + change;
        let change = found.values[force].with_plain(change);
        add(&mut found.values[force], change);
        add(&mut found.values[acceleration], change * -inverse_mass);
        for c in 0..P {
            let change = change.with_plain(by_column[c]);
            add(&mut found.jacobian[force][c], change);
            add(&mut found.jacobian[acceleration][c], change * -inverse_mass);
        }
    }
}

#[inline(always)]
fn no_force<R: Real, const N: usize>(zero: R) -> ContactForce<R, N> {
    ContactForce {
        force: zero,
        by_displacement: zero,
        by_rate: zero,
        by_parameter: [zero; N],
        by_peak: zero,
    }
}

#[inline(always)]
pub(crate) fn load(values: &[f64], at: usize) -> Pack {
    let mut out = [0.0; PACK];
    out.copy_from_slice(&values[at..at + PACK]);
    Lanes(out)
}

impl<R: Real<Plain = Pack>, const P: usize> PackModel<R, P> {
    #[inline(always)]
    pub(crate) fn plain(&self) -> PackModel<Pack, P> {
        let zero = self.values[0];
        let mut jacobian = [[Pack::ZERO; P]; QUANTITIES];
        for (to, row) in jacobian.iter_mut().zip(&self.jacobian) {
            *to = zero.each_plain(*row);
        }
        PackModel {
            values: zero.each_plain(self.values),
            jacobian,
        }
    }
}

/// Change of the force and of its derivatives by the columns.
#[cold]
#[inline(never)]
fn correction<const P: usize>(times: Pack, average: &dyn OnsetCorrection<P>) -> (Pack, [Pack; P]) {
    let (mut change, mut by_column) = (Pack::ZERO, [Pack::ZERO; P]);
    for (lane, time) in times.0.into_iter().enumerate() {
        if let Some((of_force, of_columns)) = average.at(time) {
            change.0[lane] = of_force;
            for (to, by) in by_column.iter_mut().zip(of_columns) {
                to.0[lane] = by;
            }
        }
    }
    (change, by_column)
}
