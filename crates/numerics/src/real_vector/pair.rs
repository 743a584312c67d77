//! Twice as many numbers as a register holds, in two of them.

use crate::real::{Lanes, Real};
use crate::real_vector::work::{EIGHT, LANES};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Numbers of which each half is one of `R`.
#[derive(Clone, Copy)]
pub(super) struct Pair<R>(pub(super) [R; 2]);

/// What is written, of each half. (Closures would be compiled by themselves.)
macro_rules! each {
    ($half:ident, $of:expr) => {
        Pair([
            {
                let $half = 0;
                $of
            },
            {
                let $half = 1;
                $of
            },
        ])
    };
}

/// An operator of two numbers.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<R: $trait<Output = R> + Copy> $trait for Pair<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                each!(i, self.0[i].$method(other.0[i]))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<R: Real> Neg for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        each!(i, -self.0[i])
    }
}
impl<R: Real> Mul<f64> for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        each!(i, self.0[i] * other)
    }
}
impl<R: Real> Add<f64> for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        each!(i, self.0[i] + other)
    }
}

impl<R: Real<Plain = Lanes<LANES>>> Real for Pair<R> {
    type Plain = Lanes<EIGHT>;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        each!(i, self.0[i].constant(value))
    }
    #[inline(always)]
    fn plain(self) -> Self::Plain {
        let mut out = [0.0; EIGHT];
        out[..LANES].copy_from_slice(&self.0[0].plain().0);
        out[LANES..].copy_from_slice(&self.0[1].plain().0);
        Lanes(out)
    }
    #[inline(always)]
    fn with_plain(self, plain: Self::Plain) -> Self {
        let mut halves = [[0.0; LANES]; 2];
        halves[0].copy_from_slice(&plain.0[..LANES]);
        halves[1].copy_from_slice(&plain.0[LANES..]);
        each!(i, self.0[i].with_plain(Lanes(halves[i])))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        each!(i, self.0[i].mul_add(factor.0[i], summand.0[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(i, self.0[i].sqrt())
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        each!(i, self.0[i].powf(exponent))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        each!(i, self.0[i].ln())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each!(i, self.0[i].max(other.0[i]))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each!(i, self.0[i].min(other.0[i]))
    }
    #[inline(always)]
    fn select(self, positive: Self, otherwise: Self) -> Self {
        each!(i, self.0[i].select(positive.0[i], otherwise.0[i]))
    }
    #[inline(always)]
    fn any_above_zero(self) -> bool {
        self.0[0].any_above_zero() | self.0[1].any_above_zero()
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        each!(i, self.0[i].map(&function))
    }
}
