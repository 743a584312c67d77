//! The nonlinear least-squares problem of one impact: free parameters in
//! coordinates of their own, the model behind them, the minimiser around it.

use crate::fit::condensed::Condensed;
use crate::fit::model::{Columns, Model, Sampling};
use crate::fit::problem::Prior;
use crate::fit::residual::{Found, Rows, evaluate, evaluate_some};
pub use crate::fit::search::FORESIGHT;
use crate::fit::search::{Samples, Search, Share, seen};
use crate::rig::impact_event::{ImpactEvent, Seeds};
use crate::rig::motion::Motion;
use crate::samples::SampleGroup;
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_contact::laws::user::UserLaw;
use windfall_numerics::least_squares::{Bounds, LeastSquares, Minimum, NormalEquations, Options};
use windfall_numerics::ode::step::Tolerance;
use windfall_numerics::real::Lanes;

/// Samples that show the way to the minimum, and the largest stride among them.
const APPROACH_SAMPLES: usize = 64;
const LARGEST_STRIDE: usize = 16;

/// Something that a fit can estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A parameter of the law, by its position.
    Law(usize),
    /// Velocity at first touch.
    InitialVelocity,
    /// Time of first touch.
    Onset,
    /// Constant added to the model's displacement.
    DisplacementOffset,
}

impl Target {
    /// Whether the motion must carry a sensitivity for it.
    pub(crate) fn needs_lane(self) -> bool {
        matches!(self, Self::Law(_) | Self::InitialVelocity)
    }
}

/// Coordinate in which the minimiser moves a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate {
    /// u = ln p, for positive scales.
    Logarithm,
    /// u = p / scale.
    Linear(f64),
}

impl Coordinate {
    /// Parameter at coordinate `u`.
    pub fn value(self, u: f64) -> f64 {
        match self {
            Self::Logarithm => u.exp(),
            Self::Linear(scale) => u * scale,
        }
    }

    /// Coordinate of a parameter.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Logarithm => value.ln(),
            Self::Linear(scale) => value / scale,
        }
    }

    /// dp/du at parameter `value`.
    pub fn slope(self, value: f64) -> f64 {
        match self {
            Self::Logarithm => value,
            Self::Linear(scale) => scale,
        }
    }
}

/// One free parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeParameter {
    /// What it is.
    pub target: Target,
    /// How the minimiser moves it.
    pub coordinate: Coordinate,
    /// Smallest value; SI.
    pub lower: f64,
    /// Largest value; SI.
    pub upper: f64,
    /// What is known of it before the data.
    pub prior: Option<Prior>,
}

/// Values of everything that the model depends on, free or not; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values<const N: usize> {
    /// Parameters of the law.
    pub law: [f64; N],
    /// Velocity at first touch.
    pub velocity: f64,
    /// 1/m.
    pub inverse_mass: f64,
    /// Time of first touch.
    pub onset: f64,
    /// Displacement offset.
    pub offset: f64,
}

impl<const N: usize> Values<N> {
    /// Value of one target.
    pub fn get(&self, target: Target) -> f64 {
        match target {
            Target::Law(i) => self.law[i],
            Target::InitialVelocity => self.velocity,
            Target::Onset => self.onset,
            Target::DisplacementOffset => self.offset,
        }
    }

    fn set(&mut self, target: Target, value: f64) {
        match target {
            Target::Law(i) => self.law[i] = value,
            Target::InitialVelocity => self.velocity = value,
            Target::Onset => self.onset = value,
            Target::DisplacementOffset => self.offset = value,
        }
    }
}

/// A law whose parameters a fit can replace.
pub trait FreeLaw<const N: usize>: ContactLaw<N> {
    /// The same law with other parameters.
    fn with_values(&self, values: [f64; N]) -> Self;
}

impl FreeLaw<2> for KuwabaraKono {
    fn with_values(&self, values: [f64; 2]) -> Self {
        Self::from(values)
    }
}

impl FreeLaw<LARGEST_PARAMETERS> for AnyLaw {
    fn with_values(&self, values: [f64; LARGEST_PARAMETERS]) -> Self {
        let kind = self.0.kind();
        let count = kind.describe().parameters.len();
        Self(kind.from_values(&values[..count]).unwrap_or(self.0))
    }
}

impl FreeLaw<LARGEST_PARAMETERS> for UserLaw {
    fn with_values(&self, values: [f64; LARGEST_PARAMETERS]) -> Self {
        let count = self.parameters().len();
        Self::new(self.kind(), &values[..count]).unwrap_or(*self)
    }
}

/// What a fit holds constant.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Equation of motion; its mass gives way to that of [`Values`].
    pub motion: Motion,
    /// End of contact.
    pub end: EndRule,
    /// Accuracy of the integration.
    pub tolerance: Tolerance<2>,
    /// Position of the law's impact velocity, which follows the velocity at
    /// first touch.
    pub tied_velocity: Option<usize>,
    /// How force samples near first touch are understood.
    pub sampling: Sampling,
}

/// The problem in the minimiser's coordinates.
#[derive(Clone)]
pub struct Estimator<'a, L, const N: usize, const W: usize, const P: usize> {
    setting: Setting,
    groups: &'a [SampleGroup],
    free: &'a [FreeParameter],
    base: Values<N>,
    law: L,
}

impl<'a, L: FreeLaw<N>, const N: usize, const W: usize, const P: usize> Estimator<'a, L, N, W, P> {
    /// Problem of `law` (its parameters do not matter) with `free` parameters,
    /// everything else as in `base`. At most `P` parameters, of which at most the first
    /// `W − 1` move the motion.
    pub fn new(
        law: L,
        setting: Setting,
        groups: &'a [SampleGroup],
        free: &'a [FreeParameter],
        base: Values<N>,
    ) -> Self {
        debug_assert!(free.len() <= P);
        debug_assert!(free.iter().skip(W - 1).all(|own| !own.target.needs_lane()));
        Self {
            setting,
            groups,
            free,
            base,
            law,
        }
    }

    /// The free parameters.
    pub fn free(&self) -> &'a [FreeParameter] {
        self.free
    }

    /// The law, whose parameters do not matter.
    pub(crate) fn law(&self) -> L {
        self.law
    }

    /// The samples.
    pub fn groups(&self) -> &'a [SampleGroup] {
        self.groups
    }

    /// The same problem with other free parameters, of the same targets.
    pub(crate) fn with_free(self, free: &'a [FreeParameter]) -> Self {
        Self { free, ..self }
    }

    /// The same problem with other samples.
    pub fn with_groups<'b>(&'b self, groups: &'b [SampleGroup]) -> Estimator<'b, L, N, W, P> {
        Estimator { groups, ..*self }
    }

    /// Bounds of the coordinates.
    pub fn bounds(&self) -> Bounds<P> {
        let mut bounds = Bounds::NONE;
        for (i, parameter) in self.free.iter().enumerate() {
            let coordinate = parameter.coordinate;
            bounds.lower[i] = coordinate.of(parameter.lower);
            bounds.upper[i] = coordinate.of(parameter.upper);
        }
        bounds
    }

    /// Values of everything at coordinates `u`.
    pub fn values(&self, u: &[f64; P]) -> Values<N> {
        let mut values = self.base;
        for (parameter, &u) in self.free.iter().zip(u) {
            values.set(parameter.target, parameter.coordinate.value(u));
        }
        if let Some(tied) = self.setting.tied_velocity {
            values.law[tied] = values.velocity;
        }
        values
    }

    /// The model at coordinates `u`.
    pub fn model(&self, u: &[f64; P]) -> Model<L, N, W, P> {
        let values = self.values(u);
        let mut seeds = Seeds::NONE;
        let mut columns = Columns {
            lanes: [0; P],
            onset: [0.0; P],
            offset: [0.0; P],
        };
        let mut lane = 0;
        for (c, parameter) in self.free.iter().enumerate() {
            let target = parameter.target;
            let slope = parameter.coordinate.slope(values.get(target));
            if target.needs_lane() {
                lane += 1;
                columns.lanes[c] = lane;
            }
            match target {
                Target::Law(i) => seeds.parameters[i] += Lanes::unit(lane, slope),
                Target::InitialVelocity => {
                    seeds.velocity += Lanes::unit(lane, slope);
                    if let Some(tied) = self.setting.tied_velocity {
                        seeds.parameters[tied] += Lanes::unit(lane, slope);
                    }
                }
                Target::Onset => columns.onset[c] = slope,
                Target::DisplacementOffset => columns.offset[c] = slope,
            }
        }
        let motion = Motion {
            inverse_mass: values.inverse_mass,
            ..self.setting.motion
        };
        Model {
            event: ImpactEvent {
                law: self.law.with_values(values.law),
                motion,
                velocity: values.velocity,
                end: self.setting.end,
                seeds,
                tolerance: self.setting.tolerance,
            },
            onset: values.onset,
            offset: values.offset,
            columns,
            sampling: self.setting.sampling,
        }
    }

    /// The same problem with force samples understood otherwise.
    pub fn with_sampling(&self, sampling: Sampling) -> Self {
        let setting = Setting {
            sampling,
            ..self.setting
        };
        Self { setting, ..*self }
    }

    /// Whether force samples near first touch are averages.
    pub fn averages(&self) -> bool {
        self.setting.sampling == Sampling::Averaged
    }

    /// Minimum of the cost from the values in `base`.
    ///
    /// The way there is found with a share of the samples or with condensed ones, and
    /// with a coarser integration at first; the minimum with all of them. Where that
    /// fails, all is done with all of them.
    pub fn minimise(&mut self, options: &Options<P>) -> Minimum<P> {
        self.finish(self.search(options, Condensed::default()))
    }

    fn finish(&self, mut search: Search<P>) -> Minimum<P> {
        while let Some(u) = search.propose() {
            let found = self.evaluate_share(&u, &search.share());
            search.take(found);
        }
        search.minimum()
    }

    /// The search that [`minimise`](Self::minimise) makes.
    pub(crate) fn search(&self, options: &Options<P>, room: Condensed) -> Search<'a, P> {
        let mut start = [0.0; P];
        for (u, parameter) in start.iter_mut().zip(self.free) {
            *u = parameter.coordinate.of(self.base.get(parameter.target));
        }
        let options = match self.onset_is_free() {
            true => seen(options),
            false => *options,
        };
        let samples = self.samples(&start, true);
        Search::new(&start, &self.bounds(), &options, samples, room)
    }

    /// The search that [`minimise_from`](Self::minimise_from) makes.
    pub(crate) fn search_from(
        &self,
        start: &[f64; P],
        options: &Options<P>,
        room: Condensed,
    ) -> Search<'a, P> {
        let samples = self.samples(start, false);
        Search::new(start, &self.bounds(), &seen(options), samples, room)
    }

    /// The samples, of which few packs show the way from `far`. A free onset has many
    /// minima, one beside each sample: there all samples near it decide, and the others
    /// are condensed. A law with a memory or a kink has corners during contact.
    fn samples(&self, start: &[f64; P], far: bool) -> Samples<'a> {
        let samples = self.groups.iter().map(|g| g.times().len()).max();
        let stride = (samples.unwrap_or(0) / APPROACH_SAMPLES).min(LARGEST_STRIDE);
        let stride = (stride >= 2 && far && !self.onset_is_free()).then_some(stride);
        let smooth = !self.law.history() && self.law.kink() == f64::INFINITY;
        Samples {
            groups: self.groups,
            stride,
            touch: smooth.then(|| self.values(start).onset),
        }
    }

    fn onset_is_free(&self) -> bool {
        self.free.iter().any(|p| p.target == Target::Onset)
    }

    /// The model at coordinates `u`, integrated as its share of samples deserves.
    #[inline(always)]
    pub(crate) fn model_for(&self, u: &[f64; P], share: &Share) -> Model<L, N, W, P> {
        let mut model = self.model(u);
        model.event.tolerance = self.setting.tolerance.loosened(share.looseness);
        model
    }

    /// Normal equations at coordinates `u` of a share of the samples.
    pub(crate) fn evaluate_share(&self, u: &[f64; P], share: &Share) -> Option<Found<P>> {
        let model = self.model_for(u, share);
        let mut found = evaluate_some(&model, share.groups, share.stride).ok()?;
        self.add_priors(u, share.stride, &mut found.equations);
        Some(found)
    }

    /// Adds the residuals of the priors at coordinates `u`, with the weight of one in `stride`
    /// packs of samples.
    #[inline]
    pub(crate) fn add_priors(
        &self,
        u: &[f64; P],
        stride: usize,
        equations: &mut NormalEquations<P>,
    ) {
        for (i, parameter) in self.free.iter().enumerate() {
            let Some(Prior { mean, sd }) = parameter.prior else {
                continue;
            };
            let value = parameter.coordinate.value(u[i]);
            let mut row = [0.0; P];
            row[i] = parameter.coordinate.slope(value) / sd;
            equations.add(1.0 / stride as f64, (value - mean) / sd, &row);
        }
    }

    /// Minimum of the cost from coordinates `start`, whose end is never foreseen.
    pub fn minimise_from(&mut self, start: &[f64; P], options: &Options<P>) -> Minimum<P> {
        self.finish(self.search_from(start, options, Condensed::default()))
    }

    /// Residuals and derivatives of each sample at coordinates `u`.
    pub fn rows(&self, u: &[f64; P]) -> Option<(NormalEquations<P>, Rows)> {
        self.rows_of(u, |_| true)
    }

    /// [`rows`](Self::rows) with the derivatives of edges alone, whose noise follows from them.
    pub(crate) fn residuals(&self, u: &[f64; P]) -> Option<(NormalEquations<P>, Rows)> {
        self.rows_of(u, |group| !group.edges.is_empty())
    }

    fn rows_of(
        &self,
        u: &[f64; P],
        derived: impl Fn(&SampleGroup) -> bool,
    ) -> Option<(NormalEquations<P>, Rows)> {
        let mut rows = Rows::of(self.groups, P, derived);
        let mut equations = evaluate(&self.model(u), self.groups, Some(&mut rows)).ok()?;
        self.add_priors(u, 1, &mut equations);
        Some((equations, rows))
    }
}

impl<L: FreeLaw<N>, const N: usize, const W: usize, const P: usize> LeastSquares<P>
    for Estimator<'_, L, N, W, P>
{
    fn evaluate(&mut self, u: &[f64; P]) -> Option<NormalEquations<P>> {
        let found = self.evaluate_share(u, &Share::all(self.groups))?;
        Some(found.equations)
    }
}
