//! The way of one fit to its minimum: first with a share of the samples, then with
//! condensed ones, at last with all of them.

use crate::fit::condensed::{Bends, Condensed};
use crate::fit::residual::Found;
use crate::samples::SampleGroup;
use windfall_numerics::least_squares::{Bounds, Descent, Minimum, Options, Stop};

/// The way ends when the next step gains less than this fraction of the cost: by
/// then all samples pull harder.
const APPROACH_GAIN: f64 = 2e-2;
/// One step with condensed samples leads close enough when it gains less than this
/// fraction of the cost.
const CLOSE_GAIN: f64 = 0.2;

/// How much coarser the integration may be on the way.
const APPROACH_LOOSENESS: f64 = 1e4;
/// And in the step that ends close to the minimum: as condensed samples are.
const CLOSE_LOOSENESS: f64 = 1e2;

/// What the foreseen end of a fit may leave to gain, in units of the tolerated
/// gain, if its steps did not converge faster than the last one; they do, nearly
/// quadratically.
pub const FORESIGHT: f64 = 100.0;

/// What is being minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// The cost of a share of the samples, roughly integrated.
    Approach,
    /// That of condensed samples, from where the approach ended: to its minimum, or for
    /// one step where the end of the fit may be foreseen.
    Close,
    /// That of all, from where the stage before ended.
    Near,
    /// That of all, from the start.
    Alone,
}

/// The samples of a fit, and how they may be shared out on the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples<'a> {
    /// All of them.
    pub groups: &'a [SampleGroup],
    /// Of how many packs one may show the way, in place of condensed samples.
    pub stride: Option<usize>,
    /// First touch at the start of the fit where samples may be condensed: the model is
    /// smooth between first touch and separation; s.
    pub touch: Option<f64>,
}

/// The samples that an evaluation is of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share<'s> {
    /// All samples, or condensed ones.
    pub groups: &'s [SampleGroup],
    /// Of how many packs one counts.
    pub stride: usize,
    /// How much coarser than asked for the integration may be.
    pub looseness: f64,
}

impl<'s> Share<'s> {
    /// All samples.
    pub(crate) fn all(groups: &'s [SampleGroup]) -> Self {
        Self {
            groups,
            stride: 1,
            looseness: 1.0,
        }
    }
}

/// A minimisation whose evaluations use a share of the samples first, then all.
#[derive(Clone, Debug)]
pub(crate) struct Search<'a, const P: usize> {
    stage: Stage,
    samples: Samples<'a>,
    condensed: Condensed,
    /// Corners of the model at the last evaluation.
    bends: Option<Bends>,
    descent: Descent<P>,
    start: [f64; P],
    bounds: Bounds<P>,
    options: Options<P>,
    /// Evaluations of stages that are over.
    spent: usize,
}

impl<'a, const P: usize> Search<'a, P> {
    /// A search from `start`, which condenses samples into `condensed`.
    pub fn new(
        start: &[f64; P],
        bounds: &Bounds<P>,
        options: &Options<P>,
        samples: Samples<'a>,
        mut condensed: Condensed,
    ) -> Self {
        condensed.empty();
        if let (None, Some(touch)) = (samples.stride, samples.touch) {
            condensed.fill(samples.groups, Bends::of_touch(touch));
        }
        let first = seen(options);
        let (stage, first) = match samples.stride.is_some() || condensed.groups().is_some() {
            true => (Stage::Approach, coarse(&first, APPROACH_GAIN)),
            false => (Stage::Alone, first),
        };
        let mut search = Self {
            stage,
            samples,
            condensed,
            bends: None,
            descent: Descent::new(start, bounds, &first),
            start: *start,
            bounds: *bounds,
            options: *options,
            spent: 0,
        };
        search.turn();
        search
    }

    /// Where to evaluate next; `None` at the end.
    pub(crate) fn propose(&self) -> Option<[f64; P]> {
        self.descent.propose()
    }

    /// The samples that the next evaluation is of.
    pub(crate) fn share(&self) -> Share<'_> {
        let all = Share::all(self.samples.groups);
        let few = Share {
            groups: self.condensed.groups().unwrap_or(all.groups),
            ..all
        };
        match self.stage {
            Stage::Approach => Share {
                stride: self.samples.stride.unwrap_or(1),
                looseness: APPROACH_LOOSENESS,
                ..few
            },
            Stage::Close if self.options.foresight > 0.0 => Share {
                looseness: CLOSE_LOOSENESS,
                ..few
            },
            Stage::Close => few,
            Stage::Near | Stage::Alone => all,
        }
    }

    /// Takes what is found at the last proposal; `None` where nothing is.
    pub(crate) fn take(&mut self, found: Option<Found<P>>) {
        self.bends = found.map(|found| found.bends).or(self.bends);
        self.descent.take(found.map(|found| found.equations));
        self.turn();
    }

    /// The minimum, with the evaluations of all stages that led to it.
    pub(crate) fn minimum(&self) -> Minimum<P> {
        let mut minimum = self.descent.minimum();
        minimum.evaluations += self.spent;
        minimum
    }

    /// The room that its condensed samples took.
    pub(crate) fn into_room(self) -> Condensed {
        self.condensed
    }

    /// Enters the next stage where one has ended.
    fn turn(&mut self) {
        while self.descent.propose().is_none() {
            let found = self.descent.minimum();
            let usable = match self.stage {
                Stage::Approach => {
                    let inside = found.at_bound.iter().all(|side| *side == 0);
                    found.stop == Stop::Converged && inside
                }
                Stage::Close | Stage::Near => {
                    !matches!(found.stop, Stop::BadStart | Stop::EvaluationLimit)
                }
                Stage::Alone => return,
            };
            if !usable {
                if self.stage != Stage::Approach {
                    self.spent += found.evaluations;
                }
                self.stage = Stage::Alone;
                self.descent = Descent::new(&self.start, &self.bounds, &seen(&self.options));
                continue;
            }
            let over = self.stage;
            self.stage = match over {
                Stage::Approach => self.come_close(),
                Stage::Close => Stage::Near,
                Stage::Near | Stage::Alone => return,
            };
            self.spent += found.evaluations;
            let foreseen = self.options.foresight > 0.0;
            let options = match self.stage {
                // One step, by which the first of all samples is judged.
                Stage::Close if foreseen => coarse(&self.options, CLOSE_GAIN),
                _ => self.options,
            };
            // The first damped step would hide how well the steps converge, which a
            // foreseen end is judged by.
            self.descent = match over {
                Stage::Close => Descent::continued(&self.descent, &self.bounds, &options),
                _ if foreseen || self.stage == Stage::Close => {
                    Descent::resumed(&self.descent, &self.bounds, &options)
                }
                _ => Descent::new(&found.parameters, &self.bounds, &options),
            };
        }
    }

    /// What follows the approach: condensed samples, where there are such.
    fn come_close(&mut self) -> Stage {
        self.condensed.empty();
        if let (Some(_), Some(bends)) = (self.samples.touch, self.bends) {
            self.condensed.fill(self.samples.groups, bends);
        }
        match self.condensed.groups() {
            Some(_) => Stage::Close,
            None => Stage::Near,
        }
    }
}

/// The options of a stage that only leads to the next: it ends when the next step gains
/// less than `gain`.
fn coarse<const P: usize>(options: &Options<P>, gain: f64) -> Options<P> {
    Options {
        cost_tolerance: options.cost_tolerance.max(gain),
        ..*options
    }
}

/// The options of a stage whose end is never foreseen: the cost is not smooth (an
/// onset is free), or the way was not smooth.
pub(crate) fn seen<const P: usize>(options: &Options<P>) -> Options<P> {
    Options {
        foresight: 0.0,
        ..*options
    }
}
