//! The way of one fit to its minimum: first with a share of the samples, then
//! with all of them.

use windfall_numerics::least_squares::{Bounds, Descent, Minimum, NormalEquations, Options, Stop};

/// The way ends when the next step gains less than this fraction of the cost: by
/// then all samples pull harder.
const APPROACH_GAIN: f64 = 2e-2;

/// What the foreseen end of a fit may leave to gain, in units of the tolerated
/// gain, if its steps did not converge faster than the last one; they do, nearly
/// quadratically.
pub const FORESIGHT: f64 = 100.0;

/// What is being minimised.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// The cost of one in so many packs of samples.
    Approach(usize),
    /// That of all, from where the approach ended.
    Near,
    /// That of all, from the start.
    Alone,
}

/// A minimisation whose evaluations use a share of the samples first, then all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<const P: usize> {
    stage: Stage,
    descent: Descent<P>,
    start: [f64; P],
    bounds: Bounds<P>,
    options: Options<P>,
    /// Evaluations of stages that are over.
    spent: usize,
}

impl<const P: usize> Search<P> {
    /// A search from `start`; on the way, one in `stride` packs of samples counts.
    pub fn new(
        start: &[f64; P],
        bounds: &Bounds<P>,
        options: &Options<P>,
        stride: Option<usize>,
    ) -> Self {
        let (stage, first) = match stride {
            Some(stride) => {
                let coarse = Options {
                    cost_tolerance: options.cost_tolerance.max(APPROACH_GAIN),
                    ..seen(options)
                };
                (Stage::Approach(stride), coarse)
            }
            None => (Stage::Alone, seen(options)),
        };
        let mut search = Self {
            stage,
            descent: Descent::new(start, bounds, &first),
            start: *start,
            bounds: *bounds,
            options: *options,
            spent: 0,
        };
        search.turn();
        search
    }

    /// A search from `start`, which is near the minimum, with all samples; its end
    /// is never foreseen.
    pub(crate) fn near(start: &[f64; P], bounds: &Bounds<P>, options: &Options<P>) -> Self {
        Self {
            stage: Stage::Alone,
            descent: Descent::new(start, bounds, &seen(options)),
            start: *start,
            bounds: *bounds,
            options: *options,
            spent: 0,
        }
    }

    /// Where to evaluate next, and of how many packs of samples one; `None` at the
    /// end.
    pub(crate) fn propose(&self) -> Option<([f64; P], usize)> {
        let stride = match self.stage {
            Stage::Approach(stride) => stride,
            Stage::Near | Stage::Alone => 1,
        };
        self.descent.propose().map(|at| (at, stride))
    }

    /// Takes the normal equations at the last proposal; `None` where there are none.
    pub(crate) fn take(&mut self, found: Option<NormalEquations<P>>) {
        self.descent.take(found);
        self.turn();
    }

    /// The minimum, with the evaluations of all stages that led to it.
    pub(crate) fn minimum(&self) -> Minimum<P> {
        let mut minimum = self.descent.minimum();
        minimum.evaluations += self.spent;
        minimum
    }

    /// Enters the next stage where one has ended.
    fn turn(&mut self) {
        while self.descent.propose().is_none() {
            let found = self.descent.minimum();
            let inside = found.at_bound.iter().all(|side| *side == 0);
            let from = match self.stage {
                Stage::Approach(_) if found.stop == Stop::Converged && inside => {
                    self.stage = Stage::Near;
                    self.spent = found.evaluations;
                    // The first damped step would hide how well the steps converge,
                    // which a foreseen end is judged by.
                    if self.options.foresight > 0.0 {
                        self.descent = Descent::resumed(&self.descent, &self.bounds, &self.options);
                        continue;
                    }
                    found.parameters
                }
                Stage::Approach(_) => {
                    self.stage = Stage::Alone;
                    self.start
                }
                Stage::Near if matches!(found.stop, Stop::BadStart | Stop::EvaluationLimit) => {
                    self.stage = Stage::Alone;
                    self.spent += found.evaluations;
                    self.start
                }
                Stage::Near | Stage::Alone => return,
            };
            let options = match self.stage {
                Stage::Near => self.options,
                Stage::Approach(_) | Stage::Alone => seen(&self.options),
            };
            self.descent = Descent::new(&from, &self.bounds, &options);
        }
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
