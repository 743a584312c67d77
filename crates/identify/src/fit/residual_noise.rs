//! What noise other than white keeps between pieces of the motion.

use crate::fit::residual_pack::Pack;
use crate::noise::whitening::{Row, Whitening, ZeroSums, row, unit_shift};
use crate::samples::{QUANTITIES, SampleGroup};
use windfall_numerics::least_squares::NormalEquations;
use windfall_numerics::real::Real;
use windfall_numerics::real_vector::{FourLanes, with_four_lanes};

/// State of every quantity's noise; each quantity is in one group.
pub(crate) struct Noise<const P: usize> {
    whitening: [Whitening<P>; QUANTITIES],
    pub(crate) zeros: [ZeroSums<P>; QUANTITIES],
    /// First rows of the piece at hand that wait for their predecessor.
    openings: [Option<Row<P>>; QUANTITIES],
    /// Rows that found their predecessor in a later piece.
    joints: NormalEquations<P>,
}

impl<const P: usize> Noise<P> {
    pub(crate) const NONE: Self = Self {
        whitening: [Whitening::NONE; QUANTITIES],
        zeros: [ZeroSums::ZERO; QUANTITIES],
        openings: [None; QUANTITIES],
        joints: NormalEquations::ZERO,
    };

    /// Begins a piece whose first sample has index `first`.
    pub(crate) fn begin(&mut self, first: usize) {
        self.openings = [None; QUANTITIES];
        for whitening in &mut self.whitening {
            whitening.begin(first);
        }
    }

    /// Makes a pack of `count` rows (weights, residuals, derivatives) of quantity `q`
    /// of `group` independent of those before, and adds them to the sums that tell
    /// the zero.
    ///
    /// Compiled by itself: in the loop over packs it would be there for every law.
    #[inline(never)]
    pub(crate) fn whiten(
        &mut self,
        (q, group): (usize, &SampleGroup),
        rows: &mut (Pack, Pack, [Pack; P]),
        count: usize,
    ) {
        with_four_lanes(WhitenPack {
            noise: self,
            q,
            group,
            rows,
            count,
        });
    }

    /// Ends a piece of `group` with indices `first..last`.
    pub(crate) fn end(&mut self, group: &SampleGroup, first: usize, last: usize) {
        for q in 0..QUANTITIES {
            let persistence = group.persistence[q];
            if persistence == 0.0 || group.values[q].is_empty() {
                continue;
            }
            let opening = self.openings[q];
            if let Some(row) = self.whitening[q].end(first, last, opening, persistence) {
                let weight = group.weights[q];
                self.joints.add(weight, row.residual, &row.jacobian);
                self.zeros[q].add_row(weight, unit_shift(persistence), &row);
            }
        }
    }

    /// Adds the rows without a predecessor and takes the zeros out.
    pub(crate) fn complete(&mut self, groups: &[SampleGroup], equations: &mut NormalEquations<P>) {
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

/// [`Noise::whiten`].
struct WhitenPack<'a, const P: usize> {
    noise: &'a mut Noise<P>,
    q: usize,
    group: &'a SampleGroup,
    rows: &'a mut (Pack, Pack, [Pack; P]),
    count: usize,
}

impl<const P: usize> FourLanes for WhitenPack<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real<Plain = Pack>>(self, zero: R) {
        let (noise, q) = (self.noise, self.q);
        let mut residual = zero.with_plain(self.rows.1);
        let mut jacobian = zero.with_each_plain(self.rows.2);
        let persistence = self.group.persistence[q];
        if persistence != 0.0 {
            let opening = row(residual, &jacobian, 0);
            let whitening = &mut noise.whitening[q];
            if whitening.whiten(persistence, &mut residual, &mut jacobian, self.count) {
                noise.openings[q] = Some(opening);
                self.rows.0.0[0] = 0.0;
            }
        }
        if self.group.zero_sd[q] > 0.0 {
            let weight = zero.with_plain(self.rows.0);
            noise.zeros[q].add(weight, unit_shift(persistence), residual, &jacobian);
        }
        self.rows.1 = residual.plain();
        self.rows.2 = zero.each_plain(jacobian);
    }
}
