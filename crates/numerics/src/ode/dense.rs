//! The dense output of a step, laid out for reading one lane at many places.

use crate::ode::step::{DENSE_COEFFICIENTS, Step, dense_at};
use crate::real::Lanes;

/// The solution over `[start, start + width]`, as [`Step`] has it, but the numbers
/// of each lane beside each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DenseStep<const D: usize, const W: usize> {
    /// Independent variable at the start.
    pub start: f64,
    /// Width; negative when integrating backwards.
    pub width: f64,
    /// Values (lane 0) at the end.
    pub to: [f64; D],
    /// Of each component and lane, as [`dense_at`] takes them.
    pub coefficients: [[[f64; DENSE_COEFFICIENTS]; W]; D],
}

impl<const D: usize, const W: usize> DenseStep<D, W> {
    /// State at `sigma`, the fraction of the step from 0 to 1.
    #[inline(always)]
    pub fn at(&self, sigma: f64) -> [Lanes<W>; D] {
        let mut out = [Lanes::ZERO; D];
        for d in 0..D {
            for w in 0..W {
                out[d].0[w] = dense_at(&self.coefficients[d][w], sigma, 1.0 - sigma);
            }
        }
        out
    }
}

impl<const D: usize, const W: usize> From<&Step<D, W>> for DenseStep<D, W> {
    #[inline(always)]
    fn from(step: &Step<D, W>) -> Self {
        let mut coefficients = [[[0.0; DENSE_COEFFICIENTS]; W]; D];
        for d in 0..D {
            for w in 0..W {
                coefficients[d][w] = step.lane(d, w);
            }
        }
        let mut to = [0.0; D];
        for d in 0..D {
            to[d] = step.to[d].0[0];
        }
        Self {
            start: step.start,
            width: step.width,
            to,
            coefficients,
        }
    }
}
