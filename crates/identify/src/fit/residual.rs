//! Residuals of an impact and their derivatives, summed into the normal
//! equations in one pass over the samples, several samples at a time.

use crate::fit::condensed::Bends;
use crate::fit::model::Model;
use crate::fit::onset_average::{OnsetAverage, OnsetCorrection};
use crate::fit::residual_noise::Noise;
use crate::fit::residual_pack::{Pack, PackModel, PieceModel, load};
use crate::fit::residual_sums::Sums;
use crate::rig::contact_motion::{Piece, Segment, follow};
use crate::samples::{PACK, QUANTITIES, Quantity, SampleGroup};
use windfall_contact::law::ContactLaw;
use windfall_numerics::least_squares::NormalEquations;
use windfall_numerics::ode::step::StepError;
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::real_vector::{FourLanes, compiled_for_vectors, with_four_lanes};

/// Residuals and derivatives of every sample, unweighted, for diagnostics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Per sample group and quantity: model minus measured, in time order.
    pub residuals: Vec<[Vec<f64>; QUANTITIES]>,
    /// Per sample group and quantity: P derivatives per sample, in time order.
    pub jacobian: Vec<[Vec<f64>; QUANTITIES]>,
}

impl Rows {
    /// Room for the residuals of all samples, and for so many derivatives of each sample of the
    /// groups that are `chosen`.
    pub(crate) fn of(
        groups: &[SampleGroup],
        derivatives: usize,
        chosen: impl Fn(&SampleGroup) -> bool,
    ) -> Self {
        let room = |each: &dyn Fn(&SampleGroup) -> usize| -> Vec<[Vec<f64>; QUANTITIES]> {
            let of = |group: &SampleGroup, q: usize| match group.values[q].is_empty() {
                true => Vec::new(),
                false => vec![0.0; group.len * each(group)],
            };
            let all = groups.iter();
            all.map(|group| std::array::from_fn(|q| of(group, q)))
                .collect()
        };
        Self {
            residuals: room(&|_| 1),
            jacobian: room(&|group| if chosen(group) { derivatives } else { 0 }),
        }
    }

    /// Residuals over degrees of freedom, which all channels share.
    pub(crate) fn freedom_lost(&self, parameters: usize) -> f64 {
        let total: usize = self.residuals.iter().flatten().map(Vec::len).sum();
        total as f64 / total.saturating_sub(parameters).max(1) as f64
    }
}

/// Normal equations of `model` against `groups`; with `rows`, those that there is room for too
/// (all, if it is empty).
///
/// # Errors
/// [`StepError`] when the motion cannot be integrated.
///
/// # Numerics
/// One integration with sensitivities; the samples read its dense output in
/// packs. Sums run in the order of time, so they do not depend on threads.
/// Nothing is allocated (except in `rows`).
pub fn evaluate<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
    rows: Option<&mut Rows>,
) -> Result<NormalEquations<P>, StepError> {
    pass(model, groups, rows, 1).map(|found| found.equations)
}

/// What an evaluation finds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<const P: usize> {
    pub(crate) equations: NormalEquations<P>,
    /// Where the model has corners.
    pub(crate) bends: Bends,
}

/// [`evaluate`] with a share of the samples and as if their noise were white, for
/// the way to the minimum: every `stride`-th pack of them, the same ones wherever
/// the pieces of the motion end. A stride of 1 is all of them, with their noise.
///
/// # Errors
/// [`StepError`] when the motion cannot be integrated.
pub(crate) fn evaluate_some<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
    stride: usize,
) -> Result<Found<P>, StepError> {
    pass(model, groups, None, stride)
}

/// Compiled once for every share of the samples: it holds the whole integrator.
#[inline(never)]
fn pass<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
    mut rows: Option<&mut Rows>,
    stride: usize,
) -> Result<Found<P>, StepError> {
    if let Some(rows) = rows.as_mut().filter(|rows| rows.residuals.is_empty()) {
        **rows = Rows::of(groups, P, |_| true);
    }
    compiled_for_vectors(Pass {
        model,
        groups,
        rows,
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

impl<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize> pulp::NullaryFnOnce
    for Pass<'_, L, N, W, P>
{
    type Output = Result<Found<P>, StepError>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self {
            model,
            groups,
            rows,
            stride,
        } = self;
        let (before, after) = span(model, groups);
        let mut tally = Tally::EMPTY;
        let mut reading = Reading {
            model,
            groups,
            rows,
            end: after,
            stride,
            tally: &mut tally,
        };
        follow(&model.event, before, after, &mut |segment, piece| {
            reading.read(segment, piece);
        })?;
        Ok(tally.total(model.onset, groups, stride))
    }
}

/// First (at most 0) and last time of the samples, from first touch; s.
#[inline(always)]
pub(crate) fn span<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    groups: &[SampleGroup],
) -> (f64, f64) {
    let first = groups.iter().filter_map(|g| g.times().first()).copied();
    let last = groups.iter().filter_map(|g| g.times().last()).copied();
    let before = first.fold(f64::INFINITY, f64::min) - model.onset;
    let after = last.fold(f64::NEG_INFINITY, f64::max) - model.onset;
    (before.min(0.0), after)
}

/// What a pass over the samples has summed up so far.
pub(crate) struct Tally<const P: usize> {
    sums: Sums<Pack, P>,
    noise: Noise<P>,
    /// End of the last piece of contact; s from first touch.
    contact_end: f64,
}

impl<const P: usize> Tally<P> {
    pub(crate) const EMPTY: Self = Self {
        sums: Sums::ZERO,
        noise: Noise::NONE,
        contact_end: 0.0,
    };

    /// The normal equations, after the last piece.
    #[inline(always)]
    pub(crate) fn total(&mut self, onset: f64, groups: &[SampleGroup], stride: usize) -> Found<P> {
        let mut equations = self.sums.total();
        for group in groups {
            let parts = group.weights.iter().zip(&group.remainder);
            equations.cost += parts.map(|(weight, rest)| weight * rest).sum::<f64>();
        }
        if stride == 1 {
            self.noise.complete(groups, &mut equations);
        }
        Found {
            equations,
            bends: Bends {
                touch: onset,
                separation: Some(onset + self.contact_end),
            },
        }
    }
}

/// Adds the samples of one piece of a motion to `tally`: what [`evaluate`] does
/// with each piece, for motions that are integrated elsewhere. `end` is the last
/// time of [`span`].
pub(crate) fn read_piece<L, const N: usize, const W: usize, const P: usize>(
    model: &Model<L, N, W, P>,
    (groups, stride, end): (&[SampleGroup], usize, f64),
    (segment, piece): (&Segment<W>, Piece),
    tally: &mut Tally<P>,
) where
    L: ContactLaw<N>,
{
    let mut reading = Reading {
        model,
        groups,
        rows: None,
        end,
        stride,
        tally,
    };
    reading.read(segment, piece);
}

/// Reads the samples of each piece of the motion.
struct Reading<'a, L, const N: usize, const W: usize, const P: usize> {
    model: &'a Model<L, N, W, P>,
    groups: &'a [SampleGroup],
    rows: Option<&'a mut Rows>,
    end: f64,
    stride: usize,
    tally: &'a mut Tally<P>,
}

impl<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize> Reading<'_, L, N, W, P> {
    #[inline(never)]
    fn read(&mut self, segment: &Segment<W>, piece: Piece) {
        if piece == Piece::Contact {
            self.tally.contact_end = segment.to;
        }
        with_four_lanes(ReadPiece {
            reading: self,
            segment,
            piece,
        });
    }
}

/// The samples of one piece.
struct ReadPiece<'a, 'b, L, const N: usize, const W: usize, const P: usize> {
    reading: &'a mut Reading<'b, L, N, W, P>,
    segment: &'a Segment<W>,
    piece: Piece,
}

impl<L: ContactLaw<N>, const N: usize, const W: usize, const P: usize> FourLanes
    for ReadPiece<'_, '_, L, N, W, P>
{
    type Output = ();

    #[inline(always)]
    fn run<R: Real<Plain = Pack>>(self, zero: R) {
        let Reading {
            model,
            groups,
            rows,
            end,
            stride,
            tally,
        } = self.reading;
        for (index, group) in groups.iter().enumerate() {
            let range = group.range(model.onset, self.segment.from, self.segment.to, *end);
            if range.0 >= range.1 {
                continue;
            }
            let mut rows = rows.as_deref_mut().map(|rows| (rows, index));
            // Only contact and the flight before touch the onset.
            let average = OnsetAverage::new(model, group).filter(|average| {
                let touched = self.piece == Piece::Contact || self.segment.to <= 0.0;
                touched && self.segment.from < average.until()
            });
            // The acceleration matters to a recorded one and to the onset's column, but
            // not to that of the displacement.
            let rests = group.holds(Quantity::Rate) || group.holds(Quantity::Force);
            let accelerated = group.holds(Quantity::Acceleration)
                || rests && model.columns.onset.iter().any(|onset| *onset != 0.0);
            let force = accelerated || group.holds(Quantity::Force);
            let share = Share {
                zero,
                piece: PieceModel::new(model, self.segment, accelerated),
                force: force && self.piece == Piece::Contact,
                places: !rests && !accelerated,
                group,
                range,
                stride: *stride,
                average: average.as_ref().map(|a| a as &dyn OnsetCorrection<P>),
            };
            share.read(tally, &mut rows);
        }
    }
}

/// The samples of one group that one piece of the motion reads.
struct Share<'a, L, R, const N: usize, const W: usize, const P: usize> {
    /// A number of the kind to calculate with.
    zero: R,
    piece: PieceModel<'a, L, N, W, P>,
    /// Whether there is a force that matters.
    force: bool,
    /// Whether there are displacements alone.
    places: bool,
    group: &'a SampleGroup,
    /// Indices of the first and behind the last.
    range: (usize, usize),
    stride: usize,
    average: Option<&'a dyn OnsetCorrection<P>>,
}

/// The samples of one pack.
#[derive(Clone, Copy)]
struct PackAt<R> {
    /// Index of the first.
    at: usize,
    /// How many there are: [`PACK`] but where the range begins or ends.
    count: usize,
    /// How often the sample in each lane counts: once, or for a stretch of samples; 0
    /// where there is none.
    counted: R,
}

impl<L, R, const N: usize, const W: usize, const P: usize> Share<'_, L, R, N, W, P>
where
    L: ContactLaw<N>,
    R: Real<Plain = Pack>,
{
    #[inline(always)]
    fn read(&self, tally: &mut Tally<P>, rows: &mut Option<(&mut Rows, usize)>) {
        let (group, stride) = (self.group, self.stride);
        if stride == 1 {
            tally.noise.begin(self.range.0);
        }
        let persistent = group.persistence.iter().any(|own| *own != 0.0);
        let simple = (stride > 1 || !persistent) && self.average.is_none() && rows.is_none();
        match (simple, self.places) {
            (true, true) => self.read_packs::<true, true>(tally, rows),
            (true, false) => self.read_packs::<true, false>(tally, rows),
            (false, _) => self.read_packs::<false, false>(tally, rows),
        }
        if stride == 1 {
            tally.noise.end(group, self.range.0, self.range.1);
        }
    }

    /// `SIMPLE` samples have noise that does not persist, are taken at their instant,
    /// and nothing but sums is wanted. `PLACES` are displacements alone.
    #[inline(always)]
    fn read_packs<const SIMPLE: bool, const PLACES: bool>(
        &self,
        tally: &mut Tally<P>,
        rows: &mut Option<(&mut Rows, usize)>,
    ) {
        let (zero, piece) = (self.zero, &self.piece);
        let (group, stride) = (self.group, self.stride);
        let (first, last) = self.range;
        let mut sums = Sums::with_plain(&tally.sums, zero);
        let mut at = first_sample(first, stride);
        let mut times = load(&group.times, at.min(group.len));
        let mut place = piece.place(zero.with_plain(times));
        while at < last {
            let (end, next) = if stride > 1 {
                let pack = at / PACK;
                ((pack + 1) * PACK, (pack + stride) * PACK)
            } else {
                (at + PACK, at + PACK)
            };
            let count = end.min(last) - at;
            // The roots of the next pack run beside what follows from this one.
            let next_times = load(&group.times, next.min(group.len));
            let next_place = piece.place(zero.with_plain(next_times));
            let mut found = match PLACES {
                true => piece.place_at(place),
                false => piece.at(place, self.force),
            };
            if let (false, Some(average)) = (SIMPLE, self.average) {
                piece.correct_onset(&mut found, times, average);
            }
            let mut counted = zero.with_plain(COUNTED[count]);
            if !group.shares.is_empty() {
                counted = counted * zero.with_plain(load(&group.shares, at));
            }
            let pack = PackAt { at, count, counted };
            // Written out: an index known to the compiler keeps the model in registers.
            self.add::<0, SIMPLE>(&found, pack, &mut sums, &mut tally.noise);
            if !PLACES {
                self.add::<1, SIMPLE>(&found, pack, &mut sums, &mut tally.noise);
                self.add::<2, SIMPLE>(&found, pack, &mut sums, &mut tally.noise);
                self.add::<3, SIMPLE>(&found, pack, &mut sums, &mut tally.noise);
            }
            if let (false, Some((rows, index))) = (SIMPLE, rows.as_mut()) {
                store_rows(rows, *index, group, (at, count), &found.plain());
            }
            (at, times, place) = (next, next_times, next_place);
        }
        tally.sums = sums.plain();
    }

    /// Adds the rows of quantity `Q` of a pack.
    #[inline(always)]
    fn add<const Q: usize, const SIMPLE: bool>(
        &self,
        found: &PackModel<R, P>,
        pack: PackAt<R>,
        sums: &mut Sums<R, P>,
        noise: &mut Noise<P>,
    ) {
        let group = self.group;
        if group.values[Q].is_empty() {
            return;
        }
        let zero = pack.counted;
        let mut weight = pack.counted * group.weights[Q];
        if !group.relative[Q].is_empty() {
            weight = weight * zero.with_plain(load(&group.relative[Q], pack.at));
        }
        let mut residual = found.values[Q] - zero.with_plain(load(&group.values[Q], pack.at));
        let mut jacobian = found.jacobian[Q];
        if !SIMPLE && self.stride == 1 && !group.is_white(Q) {
            let mut row = (weight.plain(), residual.plain(), zero.each_plain(jacobian));
            noise.whiten((Q, group), &mut row, pack.count);
            weight = zero.with_plain(row.0);
            residual = zero.with_plain(row.1);
            jacobian = zero.with_each_plain(row.2);
        } else if SIMPLE && self.stride == 1 && group.zero_sd[Q] > 0.0 {
            noise.zeros[Q].add(weight, 1.0, residual, &jacobian);
        }
        sums.add(weight, residual, &jacobian);
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

/// 1 in the first 0, 1, … lanes.
const COUNTED: [Pack; PACK + 1] = [
    Lanes([0.0; PACK]),
    Lanes([1.0, 0.0, 0.0, 0.0]),
    Lanes([1.0, 1.0, 0.0, 0.0]),
    Lanes([1.0, 1.0, 1.0, 0.0]),
    Lanes([1.0; PACK]),
];

#[cold]
#[inline(never)]
fn store_rows<const P: usize>(
    rows: &mut Rows,
    index: usize,
    group: &SampleGroup,
    (at, count): (usize, usize),
    found: &PackModel<Pack, P>,
) {
    for q in (0..QUANTITIES).filter(|&q| !group.values[q].is_empty()) {
        // By their index: pieces of the motion do not come in the order of time.
        let measured = &group.values[q][at..at + count];
        let residuals = &mut rows.residuals[index][q][at..at + count];
        for (lane, (residual, measured)) in residuals.iter_mut().zip(measured).enumerate() {
            *residual = found.values[q].0[lane] - measured;
        }
        let derivatives = rows.jacobian[index][q].get_mut(at * P..(at + count) * P);
        let samples = derivatives
            .into_iter()
            .flat_map(|own| own.chunks_exact_mut(P));
        for (lane, row) in samples.enumerate() {
            for (to, column) in row.iter_mut().zip(&found.jacobian[q]) {
                *to = column.0[lane];
            }
        }
    }
}
