//! Normal equations summed up for several samples at a time.

use crate::fit::residual_pack::Pack;
use windfall_numerics::normal_equations::NormalEquations;
use windfall_numerics::real::Real;

/// Running sums, one lane per sample of a pack.
#[derive(Clone, Copy)]
pub(crate) struct Sums<R, const P: usize> {
    cost: R,
    gradient: [R; P],
    normal: [[R; P]; P],
}

impl<const P: usize> Sums<Pack, P> {
    pub(crate) const ZERO: Self = Self {
        cost: Pack::ZERO,
        gradient: [Pack::ZERO; P],
        normal: [[Pack::ZERO; P]; P],
    };

    pub(crate) fn total(&self) -> NormalEquations<P> {
        let mut normal = [[0.0; P]; P];
        for i in 0..P {
            for j in 0..=i {
                normal[i][j] = self.normal[i][j].sum();
                normal[j][i] = normal[i][j];
            }
        }
        NormalEquations {
            cost: self.cost.sum(),
            gradient: self.gradient.map(|g| g.sum()),
            normal,
        }
    }
}

impl<R: Real, const P: usize> Sums<R, P> {
    /// The sums so far, as numbers like `zero`.
    #[inline(always)]
    pub(crate) fn with_plain(sums: &Sums<R::Plain, P>, zero: R) -> Self {
        let mut normal = [[zero; P]; P];
        for i in 0..P {
            normal[i] = zero.with_each_plain(sums.normal[i]);
        }
        Self {
            cost: zero.with_plain(sums.cost),
            gradient: zero.with_each_plain(sums.gradient),
            normal,
        }
    }

    #[inline(always)]
    pub(crate) fn plain(&self) -> Sums<R::Plain, P> {
        let zero = self.cost;
        let mut normal = [[zero.plain(); P]; P];
        for i in 0..P {
            normal[i] = zero.each_plain(self.normal[i]);
        }
        Sums {
            cost: zero.plain(),
            gradient: zero.each_plain(self.gradient),
            normal,
        }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, weight: R, residual: R, jacobian: &[R; P]) {
        self.cost = (weight * residual).mul_add(residual, self.cost);
        for i in 0..P {
            let weighted = weight * jacobian[i];
            self.gradient[i] = weighted.mul_add(residual, self.gradient[i]);
            for j in 0..=i {
                self.normal[i][j] = weighted.mul_add(jacobian[j], self.normal[i][j]);
            }
        }
    }
}
