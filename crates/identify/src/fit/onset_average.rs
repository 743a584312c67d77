//! Force samples around first touch as means over the sampling interval.

use crate::fit::model::{Model, Sampling};
use crate::samples::{Quantity, SampleGroup};
use windfall_contact::law::{ContactForce, ContactLaw, SMALLEST_DISPLACEMENT};
use windfall_numerics::quadrature::FOUR_NODES;

/// Samples later than this many intervals are taken at their instant; between
/// one interval and this the mean fades into the instantaneous force.
pub(crate) const FADE_END: f64 = 2.0;

/// What to add to the instantaneous force and to its derivatives.
pub trait OnsetCorrection<const P: usize> {
    /// End of the range in which there is something to add; s from first touch.
    fn until(&self) -> f64;
    /// Change of the force and of its derivatives by each column at a time from
    /// first touch; `None` outside the range.
    fn at(&self, time: f64) -> Option<(f64, [f64; P])>;
}

/// The correction of a sample group. During so short a time the velocity is
/// that of first touch, so the force is F(v₀ t, v₀) and
///
/// ```text
/// mean = (1/h) ∫ F(v₀ t, v₀) dt   over   max(0, t − h/2) … t + h/2
/// ```
pub(crate) struct OnsetAverage<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    interval: f64,
}

impl<'a, L: ContactLaw<N>, const N: usize, const W: usize, const P: usize>
    OnsetAverage<'a, L, N, W, P>
{
    /// `None` when samples are instantaneous or hold no force.
    pub fn new(model: &'a Model<L, N, W, P>, group: &SampleGroup) -> Option<Self> {
        let forces = group.holds(Quantity::Force) || group.holds(Quantity::Acceleration);
        let averaged = model.sampling == Sampling::Averaged && forces && group.interval() > 0.0;
        averaged.then(|| Self {
            model,
            interval: group.interval(),
        })
    }

    /// The law at `time` > 0 after first touch.
    fn law(&self, time: f64) -> ContactForce<f64, N> {
        let event = &self.model.event;
        let displacement = (event.velocity * time).max(SMALLEST_DISPLACEMENT);
        event.law.evaluate(displacement, event.velocity, 0.0)
    }

    /// ∂F/∂column at `time`, without the onset's column.
    fn by_columns(&self, force: &ContactForce<f64, N>, time: f64) -> [f64; P] {
        let seeds = &self.model.event.seeds;
        self.model.columns.lanes.map(|lane| {
            if lane == 0 {
                return 0.0;
            }
            let by_velocity = force.by_displacement * time + force.by_rate;
            let mut sum = by_velocity * seeds.velocity.0[lane];
            for (by, seed) in force.by_parameter.iter().zip(&seeds.parameters) {
                sum += by * seed.0[lane];
            }
            sum
        })
    }

    /// Mean force around `time`, its derivatives by the columns, and its
    /// derivative by time.
    fn mean(&self, time: f64) -> (f64, [f64; P], f64) {
        let half = 0.5 * self.interval;
        let (low, high) = ((time - half).max(0.0), time + half);
        let (mut mean, mut by_columns) = (0.0, [0.0; P]);
        // With t = u⁴ the rule is exact for a force that starts like a constant,
        // t^¼, √t or t.
        let (from, to) = (low.sqrt().sqrt(), high.sqrt().sqrt());
        for (node, weight) in FOUR_NODES {
            let u = from + (to - from) * node;
            let time = (u * u) * (u * u);
            let measure = weight * (to - from) * 4.0 * u * u * u / self.interval;
            let force = self.law(time);
            mean += measure * force.force;
            for (sum, by) in by_columns.iter_mut().zip(self.by_columns(&force, time)) {
                *sum += measure * by;
            }
        }
        let leaving = if low > 0.0 { self.law(low).force } else { 0.0 };
        let by_time = (self.law(high).force - leaving) / self.interval;
        (mean, by_columns, by_time)
    }
}

impl<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize> OnsetCorrection<P>
    for OnsetAverage<'_, L, N, W, P>
{
    fn until(&self) -> f64 {
        FADE_END * self.interval
    }

    fn at(&self, time: f64) -> Option<(f64, [f64; P])> {
        if time <= -0.5 * self.interval || time >= self.until() {
            return None;
        }
        let (mut change, mut by_columns, mut by_time) = self.mean(time);
        if time > 0.0 {
            let force = self.law(time);
            change -= force.force;
            by_time -= force.by_displacement * self.model.event.velocity;
            let instant = self.by_columns(&force, time);
            for (sum, by) in by_columns.iter_mut().zip(instant) {
                *sum -= by;
            }
        }
        let (keep, keep_by_time) = self.fade(time);
        for (sum, onset) in by_columns.iter_mut().zip(self.model.columns.onset) {
            *sum = keep * *sum - onset * (keep * by_time + keep_by_time * change);
        }
        Some((keep * change, by_columns))
    }
}

impl<L, const N: usize, const W: usize, const P: usize> OnsetAverage<'_, L, N, W, P> {
    /// How much of the correction is kept at `time`, and its derivative.
    fn fade(&self, time: f64) -> (f64, f64) {
        let (keep, slope) = kept(time / self.interval);
        (keep, slope / self.interval)
    }
}

/// How much of the mean is kept so many intervals after first touch, and its derivative.
pub(crate) fn kept(intervals: f64) -> (f64, f64) {
    let u = (intervals - 1.0) / (FADE_END - 1.0);
    if u <= 0.0 {
        return (1.0, 0.0);
    }
    let slope = 1.0 / (FADE_END - 1.0);
    (1.0 - u * u * (3.0 - 2.0 * u), -6.0 * u * (1.0 - u) * slope)
}
