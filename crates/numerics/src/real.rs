//! Numbers that a formula can be evaluated for: one `f64`, or several side by
//! side in [`Lanes`] or in a vector register (module `real_vector`).
//!
//! A force law is written once over [`Real`]. The integrator evaluates it for a
//! single state, the residual kernel for a handful of samples at a time.
//!
//! Every operation of `Lanes` is the same operation of `f64` on each lane, in
//! the same order, and multiply-add is fused only where [`Real::mul_add`] says
//! so (then on every machine), so results do not depend on how wide the
//! machine's vector registers are.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A real number, or several of them evaluated together.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Add<f64, Output = Self>
{
    /// The same numbers without what ties them to a processor's instructions: for
    /// functions that are compiled once for every processor.
    type Plain: Real;

    /// `value` in every lane of a number like this one.
    fn constant(self, value: f64) -> Self;
    /// See [`Real::Plain`].
    fn plain(self) -> Self::Plain;
    /// `plain` as a number like this one.
    fn with_plain(self, plain: Self::Plain) -> Self;
    /// [`Real::with_plain`] of each. (A closure in `array::map` would not be compiled
    /// for the processor's instructions.)
    #[inline(always)]
    fn with_each_plain<const K: usize>(self, plain: [Self::Plain; K]) -> [Self; K] {
        let mut out = [self; K];
        for i in 0..K {
            out[i] = self.with_plain(plain[i]);
        }
        out
    }
    /// [`Real::plain`] of each.
    #[inline(always)]
    fn each_plain<const K: usize>(self, numbers: [Self; K]) -> [Self::Plain; K] {
        let mut out = [self.plain(); K];
        for i in 0..K {
            out[i] = numbers[i].plain();
        }
        out
    }
    /// self · factor + summand, rounded once.
    fn mul_add(self, factor: Self, summand: Self) -> Self;
    /// Square root of each lane.
    fn sqrt(self) -> Self;
    /// Each lane raised to a fixed power.
    fn powf(self, exponent: f64) -> Self;
    /// Natural logarithm of each lane.
    fn ln(self) -> Self;
    /// Larger of two, lane by lane.
    fn max(self, other: Self) -> Self;
    /// Smaller of two, lane by lane.
    fn min(self, other: Self) -> Self;
    /// `positive` in the lanes where `self > 0`, `otherwise` in the others.
    fn select(self, positive: Self, otherwise: Self) -> Self;
    /// Whether any lane is > 0.
    fn any_above_zero(self) -> bool;
    /// A function of one number applied to each lane.
    fn map(self, function: impl Fn(f64) -> f64) -> Self;
}

/// What [`Real`] asks of numbers that are tied to no instructions.
macro_rules! plain_already {
    () => {
        type Plain = Self;

        #[inline(always)]
        fn plain(self) -> Self {
            self
        }
        #[inline(always)]
        fn with_plain(self, plain: Self) -> Self {
            plain
        }
    };
}

impl Real for f64 {
    plain_already!();

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        f64::mul_add(self, factor, summand)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        f64::powf(self, exponent)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn select(self, positive: Self, otherwise: Self) -> Self {
        if self > 0.0 { positive } else { otherwise }
    }
    #[inline(always)]
    fn any_above_zero(self) -> bool {
        self > 0.0
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }
}

/// `W` numbers side by side.
///
/// In the integrator lane 0 holds a value and the other lanes its derivatives
/// with respect to parameters; in the residual kernel each lane is a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Lanes<const W: usize>(pub [f64; W]);

impl<const W: usize> Lanes<W> {
    /// Zero in every lane.
    pub const ZERO: Self = Self([0.0; W]);

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = [0.0; W];
        for i in 0..W {
            out[i] = f(self.0[i], other.0[i]);
        }
        Self(out)
    }

    /// The same value in every lane.
    #[inline(always)]
    pub const fn splat(value: f64) -> Self {
        Self([value; W])
    }

    /// A number in lane `lane`, zero in the others.
    pub fn unit(lane: usize, value: f64) -> Self {
        let mut out = [0.0; W];
        out[lane] = value;
        Self(out)
    }

    /// Sum over the lanes, from the first to the last.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let mut total = 0.0;
        for i in 0..W {
            total += self.0[i];
        }
        total
    }
}

/// An operator lane by lane, of two numbers or of a number and a constant.
macro_rules! operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $operator b)
            }
        }
    };
    ($trait:ident, $method:ident, $operator:tt f64) => {
        impl<const W: usize> $trait<f64> for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|a| a $operator other)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);
operator!(Add, add, + f64);
operator!(Mul, mul, *f64);

impl<const W: usize> AddAssign for Lanes<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl<const W: usize> Real for Lanes<W> {
    plain_already!();

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(value)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        let mut out = [0.0; W];
        for i in 0..W {
            out[i] = self.0[i].mul_add(factor.0[i], summand.0[i]);
        }
        Self(out)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.map(|a| a.powf(exponent))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(f64::ln)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn select(self, positive: Self, otherwise: Self) -> Self {
        let mut out = [0.0; W];
        for i in 0..W {
            out[i] = if self.0[i] > 0.0 {
                positive.0[i]
            } else {
                otherwise.0[i]
            };
        }
        Self(out)
    }
    #[inline(always)]
    fn any_above_zero(self) -> bool {
        let mut any = false;
        for i in 0..W {
            any |= self.0[i] > 0.0;
        }
        any
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let mut out = [0.0; W];
        for i in 0..W {
            out[i] = function(self.0[i]);
        }
        Self(out)
    }
}
