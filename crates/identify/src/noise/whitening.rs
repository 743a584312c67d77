//! Successive residuals made independent on their way into the normal
//! equations, and zeros that all samples of a channel share.
//!
//! Noise that is a first-order autoregression, e_i = φ e_{i−1} + u_i of variance
//! σ², is independent after
//!
//! ```text
//! ẽ_1 = e_1,   ẽ_i = (e_i − φ e_{i−1}) / √(1 − φ²)
//! ```
//!
//! (Prais and Winsten 1954, Cowles Commission discussion paper 383). A zero that
//! all samples share and that is normal of deviation u adds u² 1 1ᵀ to their
//! covariance; its inverse follows from that without it by the formula of
//! Sherman and Morrison (1950, Ann. Math. Statist. 21:124).

use crate::samples::PACK;
use windfall_numerics::least_squares::NormalEquations;
use windfall_numerics::real::{Lanes, Real};

type Pack = Lanes<PACK>;

/// Residual of one sample with its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Row<const P: usize> {
    pub residual: f64,
    pub jacobian: [f64; P],
}

/// Where one channel of persistent noise stands: which rows still lack their
/// predecessor. Pieces of a motion come in any order, each forward in time.
#[derive(Clone, Copy)]
pub(crate) struct Whitening<const P: usize> {
    /// The latest row read, with its index.
    last: Option<(usize, Row<P>)>,
    /// The earliest row read, whose predecessor has not come yet.
    pending: Option<(usize, Row<P>)>,
    /// The row before the pack at hand.
    previous: Option<Row<P>>,
}

impl<const P: usize> Whitening<P> {
    pub(crate) const NONE: Self = Self {
        last: None,
        pending: None,
        previous: None,
    };

    /// Begins a piece whose first sample has index `first`.
    pub(crate) fn begin(&mut self, first: usize) {
        self.previous = match self.last {
            Some((index, row)) if index + 1 == first => Some(row),
            _ => None,
        };
    }

    /// Whitens a pack of `count` rows. Returns whether its first row has to wait for
    /// its predecessor; the weight of that row must then be taken out.
    #[inline(always)]
    pub(crate) fn whiten<R: Real<Plain = Pack>>(
        &mut self,
        persistence: f64,
        residual: &mut R,
        jacobian: &mut [R; P],
        count: usize,
    ) -> bool {
        let scale = 1.0 / (1.0 - persistence * persistence).sqrt();
        let before = self.previous.unwrap_or_else(|| row(*residual, jacobian, 0));
        let last = row(*residual, jacobian, count - 1);
        *residual = whitened(*residual, before.residual, persistence, scale);
        for (column, before) in jacobian.iter_mut().zip(before.jacobian) {
            *column = whitened(*column, before, persistence, scale);
        }
        let waits = self.previous.is_none();
        self.previous = Some(last);
        waits
    }

    /// Ends a piece with indices `first..last` whose first row is `opening` if it
    /// had no predecessor. Returns a row that has found its predecessor.
    pub(crate) fn end(
        &mut self,
        first: usize,
        last: usize,
        opening: Option<Row<P>>,
        persistence: f64,
    ) -> Option<Row<P>> {
        let closing = self.previous?;
        let mut found = None;
        if let Some(opening) = opening {
            if let Some((index, row)) = self.pending
                && index == last
            {
                found = Some(whitened_row(&row, &closing, persistence));
            }
            self.pending = Some((first, opening));
        }
        if self.last.is_none_or(|(index, _)| index < last) {
            self.last = Some((last - 1, closing));
        }
        found
    }

    /// The row that has no predecessor: the first of all.
    pub(crate) fn first(&self) -> Option<Row<P>> {
        self.pending.map(|(_, row)| row)
    }
}

/// Row of one lane of a pack.
#[inline(always)]
pub(crate) fn row<R: Real<Plain = Pack>, const P: usize>(
    residual: R,
    jacobian: &[R; P],
    lane: usize,
) -> Row<P> {
    let mut row = Row {
        residual: residual.plain().0[lane],
        jacobian: [0.0; P],
    };
    for (to, column) in row.jacobian.iter_mut().zip(jacobian) {
        *to = column.plain().0[lane];
    }
    row
}

/// Each lane without what persists of the one before; `before` is before the first.
#[inline(always)]
fn whitened<R: Real<Plain = Pack>>(values: R, before: f64, persistence: f64, scale: f64) -> R {
    let Lanes([a, b, c, _]) = values.plain();
    let earlier = values.with_plain(Lanes([before, a, b, c]));
    (values + earlier * -persistence) * scale
}

fn whitened_row<const P: usize>(row: &Row<P>, before: &Row<P>, persistence: f64) -> Row<P> {
    let scale = 1.0 / (1.0 - persistence * persistence).sqrt();
    let of = |value: f64, before: f64| (value - persistence * before) * scale;
    Row {
        residual: of(row.residual, before.residual),
        jacobian: std::array::from_fn(|i| of(row.jacobian[i], before.jacobian[i])),
    }
}

/// What a zero shifts by 1, as whitened residuals see it: (1 − φ)/√(1 − φ²).
pub(crate) fn unit_shift(persistence: f64) -> f64 {
    ((1.0 - persistence) / (1.0 + persistence)).sqrt()
}

/// Sums over one channel that determine its zero: Σ w o r, Σ w o J, Σ w o².
#[derive(Clone, Copy)]
pub(crate) struct ZeroSums<const P: usize> {
    residual: Pack,
    jacobian: [Pack; P],
    square: Pack,
}

impl<const P: usize> ZeroSums<P> {
    pub(crate) const ZERO: Self = Self {
        residual: Pack::ZERO,
        jacobian: [Pack::ZERO; P],
        square: Pack::ZERO,
    };

    /// Adds a pack; `shift` is what a zero of 1 does to each residual.
    #[inline(always)]
    pub(crate) fn add<R: Real<Plain = Pack>>(
        &mut self,
        weight: R,
        shift: f64,
        residual: R,
        jacobian: &[R; P],
    ) {
        let weighted = weight * shift;
        let add = weighted.mul_add(residual, weight.with_plain(self.residual));
        self.residual = add.plain();
        for (sum, column) in self.jacobian.iter_mut().zip(jacobian) {
            *sum = weighted.mul_add(*column, weight.with_plain(*sum)).plain();
        }
        self.square = (weight.with_plain(self.square) + weighted * shift).plain();
    }

    /// Adds one row.
    pub(crate) fn add_row(&mut self, weight: f64, shift: f64, row: &Row<P>) {
        let weighted = weight * shift;
        self.residual.0[0] += weighted * row.residual;
        for (sum, value) in self.jacobian.iter_mut().zip(row.jacobian) {
            sum.0[0] += weighted * value;
        }
        self.square.0[0] += weighted * shift;
    }

    /// Takes out of `equations` what the zero, normal of deviation `sd`, leaves
    /// unsaid.
    pub(crate) fn eliminate(&self, sd: f64, equations: &mut NormalEquations<P>) {
        let residual = self.residual.sum();
        let jacobian = self.jacobian.map(|column| column.sum());
        let pivot = 1.0 / (self.square.sum() + 1.0 / (sd * sd));
        equations.cost -= pivot * residual * residual;
        for i in 0..P {
            equations.gradient[i] -= pivot * residual * jacobian[i];
            for j in 0..P {
                equations.normal[i][j] -= pivot * jacobian[i] * jacobian[j];
            }
        }
    }
}
