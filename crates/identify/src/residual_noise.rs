//! What noise other than white keeps between pieces of the motion.

use crate::residual_pack::Pack;
use crate::samples::{QUANTITIES, SampleGroup};
use crate::whitening::{Row, Whitening, ZeroSums, unit_shift};
use windfall_numerics::least_squares::NormalEquations;

/// State of every quantity's noise; each quantity is in one group.
pub(crate) struct Noise<const P: usize> {
    whitening: [Whitening<P>; QUANTITIES],
    zeros: [ZeroSums<P>; QUANTITIES],
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

    /// Makes a pack of rows independent of those before, and adds them to the
    /// sums that tell the zero.
    #[inline(always)]
    pub(crate) fn whiten(
        &mut self,
        q: usize,
        group: &SampleGroup,
        weight: &mut Pack,
        residual: &mut Pack,
        jacobian: &mut [Pack; P],
        count: usize,
    ) {
        let persistence = group.persistence[q];
        if persistence != 0.0 {
            let opening = Row {
                residual: residual.0[0],
                jacobian: jacobian.map(|column| column.0[0]),
            };
            if self.whitening[q].whiten(persistence, residual, jacobian, count) {
                self.openings[q] = Some(opening);
                weight.0[0] = 0.0;
            }
        }
        if group.zero_sd[q] > 0.0 {
            self.zeros[q].add(*weight, unit_shift(persistence), *residual, jacobian);
        }
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
