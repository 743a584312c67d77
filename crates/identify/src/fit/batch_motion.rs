//! Motions of several impacts side by side: their equation in lanes, and the way
//! of each lane from flight through contact to flight.
//!
//! For laws without history and without kink; each lane goes through what
//! [`follow`](crate::rig::contact_motion::follow) does, to the bit.

use crate::fit::batch_law::{BatchLaw, IMPACTS, PackedLaw, PerImpact};
use crate::rig::contact_motion::{LARGEST_STEPS, Piece, Segment, first_width};
use crate::rig::contact_stop::separation;
use crate::rig::contact_time::{scaled_time, time_of};
use crate::rig::impact_event::ImpactEvent;
use crate::rig::motion::acceleration_with;
use windfall_contact::law::SMALLEST_DISPLACEMENT;
use windfall_numerics::ode::dense::DenseStep;
use windfall_numerics::ode::lockstep::{Beginning, Lockstep, LockstepSystem, attempt};
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::real_vector::{
    EightLanes, EightNumbers, compiled_for_vectors, with_eight_lanes,
};

/// Right-hand side of several impacts, each in flight or in contact.
#[repr(align(64))]
pub(crate) struct Impacts<L: BatchLaw<N>, const N: usize, const W: usize> {
    laws: [L; IMPACTS],
    packed: L::Packed,
    /// Driving, restoring, curvature, inverse mass.
    motion: [PerImpact; 4],
    /// Of each parameter, by each column.
    seeds: [[PerImpact; W]; N],
    /// 1 in contact, 0 in flight.
    touching: PerImpact,
    /// q of t = s^q in contact.
    power: u32,
}

impl<L: BatchLaw<N>, const N: usize, const W: usize> Impacts<L, N, W> {
    /// No impacts yet; those to come have laws like `law`.
    pub fn new(law: L) -> Self {
        let laws = [law; IMPACTS];
        Self {
            laws,
            packed: L::packed(&laws),
            motion: [PerImpact::ZERO; 4],
            seeds: [[PerImpact::ZERO; W]; N],
            touching: PerImpact::ZERO,
            power: law.start_power(),
        }
    }

    /// Whether the impact can be integrated here.
    pub(crate) fn suits(&self, law: &L) -> bool {
        !law.history() && law.kink() == f64::INFINITY && law.start_power() == self.power
    }

    /// Puts an impact into `lane`.
    pub(crate) fn place(&mut self, lane: usize, event: &ImpactEvent<L, N, W>) {
        self.laws[lane] = event.law;
        self.packed = L::packed(&self.laws);
        let motion = &event.motion;
        let constants = [
            motion.driving,
            motion.restoring,
            motion.curvature,
            motion.inverse_mass,
        ];
        for (to, constant) in self.motion.iter_mut().zip(constants) {
            to.0[lane] = constant;
        }
        for (to, seed) in self.seeds.iter_mut().zip(&event.seeds.parameters) {
            for w in 0..W {
                to[w].0[lane] = seed.0[w];
            }
        }
    }

    /// Begins `leg` in `lane`.
    pub(crate) fn begin(
        &mut self,
        lane: usize,
        leg: &NextLeg<W>,
        lockstep: &mut Lockstep<2, W, IMPACTS>,
    ) {
        self.touching.0[lane] = if leg.touching { 1.0 } else { 0.0 };
        lockstep.begin(lane, &leg.beginning);
    }
}

impl<L: BatchLaw<N>, const N: usize, const W: usize> LockstepSystem<2, W, IMPACTS>
    for Impacts<L, N, W>
{
    #[inline(always)]
    fn derivative<R: Real<Plain = PerImpact>>(&self, s: R, [x, v]: &[[R; W]; 2]) -> [[R; W]; 2] {
        let on = s.with_plain(self.touching);
        let one = s.constant(1.0);
        let stretch = match self.power {
            1 => one,
            2 => on.select(s * 2.0, one),
            _ => on.select(s * 4.0 * s * s, one),
        };
        let d = x[0].max(s.constant(SMALLEST_DISPLACEMENT));
        let force = self.packed.evaluate(d, v[0]);
        let motion = s.with_each_plain(self.motion);
        let a = acceleration_with(motion, [x[0], v[0], force.force * on]);
        let by_force = a.by_force * on;
        let by_displacement = a.by_displacement + by_force * force.by_displacement;
        let by_rate = a.by_rate + by_force * force.by_rate;
        let mut out = [[s; W]; 2];
        out[0][0] = v[0] * stretch;
        out[1][0] = a.value * stretch;
        for w in 1..W {
            let mut direct = s.constant(0.0);
            for (by, seed) in force.by_parameter.iter().zip(&self.seeds) {
                direct = direct + s.with_plain(seed[w]) * *by;
            }
            let rate = x[w] * by_displacement + v[w] * by_rate + direct * by_force;
            out[0][w] = v[w] * stretch;
            out[1][w] = rate * stretch;
        }
        out
    }
}

/// Tries one step in every lane.
#[inline(never)]
pub(crate) fn attempt_all<L: BatchLaw<N>, const N: usize, const W: usize>(
    impacts: &Impacts<L, N, W>,
    lockstep: &mut Lockstep<2, W, IMPACTS>,
) {
    with_eight_lanes(Attempt { impacts, lockstep });
}

/// [`attempt_all`], compiled for the machine's vector instructions.
struct Attempt<'a, L: BatchLaw<N>, const N: usize, const W: usize> {
    impacts: &'a Impacts<L, N, W>,
    lockstep: &'a mut Lockstep<2, W, IMPACTS>,
}

impl<L: BatchLaw<N>, const N: usize, const W: usize> EightLanes for Attempt<'_, L, N, W> {
    type Output = ();

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) {
        attempt(zero, self.impacts, self.lockstep);
    }
}

/// What a lane integrates next.
#[derive(Clone, Copy)]
pub(crate) struct NextLeg<const W: usize> {
    touching: bool,
    beginning: Beginning<2, W>,
}

/// What follows a step.
pub(crate) enum Next<const W: usize> {
    /// More steps of the same leg.
    Step,
    /// Another leg.
    Leg(NextLeg<W>),
    /// Nothing: the samples end here.
    End,
    /// Nothing: there were too many steps.
    Fail,
}

#[derive(Clone, Copy, PartialEq)]
enum Leg {
    Before,
    Contact,
    After,
}

/// The way of one impact through its legs.
pub(crate) struct Way {
    leg: Leg,
    before: f64,
    after: f64,
    steps: usize,
}

impl Way {
    /// The way from `before` (≤ 0) to `after`, s from first touch, and its first
    /// leg; `None` when there is nothing to integrate.
    pub fn new<L: BatchLaw<N>, const N: usize, const W: usize>(
        event: &ImpactEvent<L, N, W>,
        before: f64,
        after: f64,
    ) -> Option<(Self, NextLeg<W>)> {
        let mut way = Self {
            leg: Leg::Before,
            before,
            after,
            steps: 0,
        };
        let first = if before < 0.0 {
            Some(flight(event, event.touch_state(), 0.0, before))
        } else {
            way.contact(event)
        };
        first.map(|first| (way, first))
    }

    /// The leg of contact, if there is one.
    fn contact<L: BatchLaw<N>, const N: usize, const W: usize>(
        &mut self,
        event: &ImpactEvent<L, N, W>,
    ) -> Option<NextLeg<W>> {
        (self.leg, self.steps) = (Leg::Contact, 0);
        let limit = scaled_time(self.after, event.law.start_power());
        (self.after > 0.0).then(|| NextLeg {
            touching: true,
            beginning: Beginning {
                s: 0.0,
                state: event.touch_state(),
                width: first_width(limit, &event.tolerance),
                limit,
                tolerance: event.tolerance,
            },
        })
    }

    /// The piece of the motion that a step, which ended at `position`, is, and what
    /// follows it.
    #[inline(never)]
    pub(crate) fn took<L: BatchLaw<N>, const N: usize, const W: usize>(
        &mut self,
        event: &ImpactEvent<L, N, W>,
        done: DenseStep<2, W>,
        position: f64,
    ) -> (Segment<W>, Piece, Next<W>) {
        compiled_for_vectors(Took {
            way: self,
            event,
            done,
            position,
        })
    }

    #[inline(always)]
    fn take<L: BatchLaw<N>, const N: usize, const W: usize>(
        &mut self,
        event: &ImpactEvent<L, N, W>,
        done: DenseStep<2, W>,
        position: f64,
    ) -> (Segment<W>, Piece, Next<W>) {
        self.steps += 1;
        let (segment, piece, mut next) = match self.leg {
            Leg::Contact => self.touched(event, done, position),
            Leg::Before | Leg::After => self.flew(event, done, position),
        };
        if self.steps >= LARGEST_STEPS && matches!(next, Next::Step) {
            next = Next::Fail;
        }
        (segment, piece, next)
    }

    #[inline(always)]
    fn flew<L: BatchLaw<N>, const N: usize, const W: usize>(
        &mut self,
        event: &ImpactEvent<L, N, W>,
        done: DenseStep<2, W>,
        position: f64,
    ) -> (Segment<W>, Piece, Next<W>) {
        let end = done.start + done.width;
        let segment = Segment::without_peak(done, 1, done.start.min(end), done.start.max(end));
        let limit = match self.leg {
            Leg::Before => self.before,
            _ => self.after,
        };
        let next = if position != limit {
            Next::Step
        } else if self.leg == Leg::Before {
            self.contact(event).map_or(Next::End, Next::Leg)
        } else {
            Next::End
        };
        (segment, Piece::Flight, next)
    }

    #[inline(always)]
    fn touched<L: BatchLaw<N>, const N: usize, const W: usize>(
        &mut self,
        event: &ImpactEvent<L, N, W>,
        done: DenseStep<2, W>,
        position: f64,
    ) -> (Segment<W>, Piece, Next<W>) {
        let power = event.law.start_power();
        let limit = scaled_time(self.after, power);
        let end = separation(event, &done);
        let to = end.map_or(position, |(sigma, _)| done.start + sigma * done.width);
        let from = time_of(done.start, power);
        // The limit was given as a time: do not lose its last bit to the root.
        let until = if to == limit {
            self.after
        } else {
            time_of(to, power)
        };
        let next = match end {
            Some((_, state)) => {
                let time = time_of(to, power);
                if self.after > time {
                    (self.leg, self.steps) = (Leg::After, 0);
                    Next::Leg(flight(event, state, time, self.after))
                } else {
                    Next::End
                }
            }
            None if position == limit => Next::End,
            None => Next::Step,
        };
        let segment = Segment::without_peak(done, power, from, until);
        (segment, Piece::Contact, next)
    }
}

/// [`Way::took`], compiled for the machine's instructions.
struct Took<'a, L, const N: usize, const W: usize> {
    way: &'a mut Way,
    event: &'a ImpactEvent<L, N, W>,
    done: DenseStep<2, W>,
    position: f64,
}

impl<L: BatchLaw<N>, const N: usize, const W: usize> pulp::NullaryFnOnce for Took<'_, L, N, W> {
    type Output = (Segment<W>, Piece, Next<W>);

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.way.take(self.event, self.done, self.position)
    }
}

/// A leg of flight, in either direction.
#[inline(always)]
fn flight<L, const N: usize, const W: usize>(
    event: &ImpactEvent<L, N, W>,
    state: [Lanes<W>; 2],
    from: f64,
    to: f64,
) -> NextLeg<W> {
    NextLeg {
        touching: false,
        beginning: Beginning {
            s: from,
            state,
            width: to - from,
            limit: to,
            tolerance: event.tolerance,
        },
    }
}
