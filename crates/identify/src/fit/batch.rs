//! Fits of many impacts side by side, one per vector lane: the fastest way to
//! fit a campaign on one core.
//!
//! The impacts are integrated in lock-step and a lane whose integration is over
//! takes its next evaluation, or the next impact, at once. The samples of an
//! impact are read by the same pass as in a single fit. Every fit ends at the
//! bits of a single one, whatever the others are.

use crate::fit::batch_law::{BatchLaw, IMPACTS};
use crate::fit::batch_motion::{Impacts, Next, Way, attempt_all};
use crate::fit::condensed::Condensed;
use crate::fit::estimator::Estimator;
use crate::fit::model::Model;
use crate::fit::residual::{Found, Tally, read_piece, span};
use crate::fit::search::{Search, Share};
use crate::samples::SampleGroup;
use windfall_numerics::least_squares::{Minimum, Options};
use windfall_numerics::ode::lockstep::{Lockstep, Outcome};

/// One impact to fit.
#[derive(Clone)]
pub struct BatchProblem<'a, L, const N: usize, const W: usize, const P: usize> {
    /// Samples, free parameters and, where `from` is `None`, where they start.
    pub estimator: Estimator<'a, L, N, W, P>,
    /// Coordinates to start from when they are near the minimum: all samples count
    /// at once, as in [`Estimator::minimise_from`].
    pub from: Option<[f64; P]>,
    /// When to stop.
    pub options: Options<P>,
}

/// Room for the condensed samples of the impacts that are fitted side by side.
pub struct Room([Condensed; IMPACTS]);

impl Room {
    /// Room for impacts of as many samples as these.
    pub fn of(groups: &[SampleGroup]) -> Self {
        Self(std::array::from_fn(|_| Condensed::room(groups)))
    }
}

/// Minimises the cost of each problem, as [`Estimator::minimise`] does or, with
/// [`BatchProblem::from`], [`Estimator::minimise_from`]; `minima` takes the
/// results, in the order of the problems, as many as there are of both.
///
/// # Numerics
/// [`IMPACTS`] impacts at a time. Laws with history or with a kink are integrated
/// one by one. Where `room` is large enough, nothing is allocated but copies of samples that
/// are not condensed (edges of a count, persistent noise) beside some that are.
pub fn minimise_batch<L, const N: usize, const W: usize, const P: usize>(
    problems: &[BatchProblem<L, N, W, P>],
    minima: &mut [Minimum<P>],
    room: &mut Room,
) where
    L: BatchLaw<N>,
{
    let Some(first) = problems.first() else {
        return;
    };
    let mut waiting = problems.iter().zip(minima);
    let mut batch = Batch {
        impacts: Impacts::new(first.estimator.law()),
        lockstep: Lockstep::IDLE,
        room,
    };
    let mut slots: [Option<Slot<L, N, W, P>>; IMPACTS] = [const { None }; IMPACTS];
    for (lane, slot) in slots.iter_mut().enumerate() {
        batch.feed(lane, slot, &mut waiting);
    }
    while slots.iter().any(Option::is_some) {
        attempt_all(&batch.impacts, &mut batch.lockstep);
        for (lane, slot) in slots.iter_mut().enumerate() {
            if batch.step(lane, slot) {
                batch.feed(lane, slot, &mut waiting);
            }
        }
    }
}

/// What all lanes share.
struct Batch<'r, L: BatchLaw<N>, const N: usize, const W: usize> {
    impacts: Impacts<L, N, W>,
    lockstep: Lockstep<2, W, IMPACTS>,
    room: &'r mut Room,
}

/// The impact of one lane.
struct Slot<'p, 'a, L, const N: usize, const W: usize, const P: usize> {
    problem: &'p BatchProblem<'a, L, N, W, P>,
    minimum: &'p mut Minimum<P>,
    search: Search<'a, P>,
    run: Option<Run<L, N, W, P>>,
}

/// One evaluation of an impact.
struct Run<L, const N: usize, const W: usize, const P: usize> {
    model: Model<L, N, W, P>,
    end: f64,
    way: Way,
    tally: Tally<P>,
}

impl<L: BatchLaw<N>, const N: usize, const W: usize> Batch<'_, L, N, W> {
    /// Gives `lane` something to integrate: the next evaluation of its impact, or
    /// the first of the next impact that waits.
    fn feed<'p, 'a: 'p, const P: usize>(
        &mut self,
        lane: usize,
        slot: &mut Option<Slot<'p, 'a, L, N, W, P>>,
        waiting: &mut impl Iterator<Item = (&'p BatchProblem<'a, L, N, W, P>, &'p mut Minimum<P>)>,
    ) {
        loop {
            let Some(fit) = slot else {
                let Some((problem, minimum)) = waiting.next() else {
                    self.lockstep.end(lane);
                    return;
                };
                let (estimator, options) = (&problem.estimator, &problem.options);
                let room = std::mem::take(&mut self.room.0[lane]);
                *slot = Some(Slot {
                    problem,
                    minimum,
                    search: match &problem.from {
                        Some(from) => estimator.search_from(from, options, room),
                        None => estimator.search(options, room),
                    },
                    run: None,
                });
                continue;
            };
            let Some(u) = fit.search.propose() else {
                *fit.minimum = fit.search.minimum();
                if let Some(fit) = slot.take() {
                    self.room.0[lane] = fit.search.into_room();
                }
                continue;
            };
            if self.begin(lane, fit, &u) {
                return;
            }
        }
    }

    /// Begins an evaluation in `lane`; `false` when it was done at once.
    fn begin<const P: usize>(
        &mut self,
        lane: usize,
        fit: &mut Slot<L, N, W, P>,
        u: &[f64; P],
    ) -> bool {
        let estimator = &fit.problem.estimator;
        let share = fit.search.share();
        let model = estimator.model_for(u, &share);
        let (before, end) = span(&model, share.groups);
        let suits = self.impacts.suits(&model.event.law);
        let way = Way::new(&model.event, before, end).filter(|_| suits);
        let Some((way, leg)) = way else {
            let found = estimator.evaluate_share(u, &share);
            fit.search.take(found);
            return false;
        };
        self.impacts.place(lane, &model.event);
        self.impacts.begin(lane, &leg, &mut self.lockstep);
        fit.run = Some(Run {
            model,
            end,
            way,
            tally: Tally::EMPTY,
        });
        true
    }

    /// Reads what `lane` did in the last attempt; whether its evaluation is over.
    fn step<const P: usize>(&mut self, lane: usize, slot: &mut Option<Slot<L, N, W, P>>) -> bool {
        let Some(fit) = slot else { return false };
        let found = match self.lockstep.outcome(lane) {
            Outcome::Idle | Outcome::Rejected => return false,
            Outcome::Failed => None,
            Outcome::Accepted => match self.read(lane, fit) {
                Progress::Going => return false,
                Progress::Done(equations) => equations,
            },
        };
        fit.search.take(found);
        true
    }

    /// Reads the samples of the step that `lane` made.
    fn read<const P: usize>(&mut self, lane: usize, fit: &mut Slot<L, N, W, P>) -> Progress<P> {
        let Some(run) = &mut fit.run else {
            return Progress::Done(None);
        };
        let (done, position) = (self.lockstep.step(lane), self.lockstep.position(lane));
        let (segment, piece, next) = run.way.took(&run.model.event, done, position);
        let Share { groups, stride, .. } = fit.search.share();
        let share = (groups, stride, run.end);
        read_piece(&run.model, share, (&segment, piece), &mut run.tally);
        match next {
            Next::Step => Progress::Going,
            Next::Leg(leg) => {
                self.impacts.begin(lane, &leg, &mut self.lockstep);
                Progress::Going
            }
            Next::End => {
                let mut found = run.tally.total(run.model.onset, groups, stride);
                if let Some(u) = fit.search.propose() {
                    let priors = &mut found.equations;
                    fit.problem.estimator.add_priors(&u, stride, priors);
                }
                Progress::Done(Some(found))
            }
            Next::Fail => Progress::Done(None),
        }
    }
}

/// How far an evaluation has come.
enum Progress<const P: usize> {
    Going,
    /// What it found, if anything.
    Done(Option<Found<P>>),
}
