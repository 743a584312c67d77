//! Numbers in one vector register of an x86 processor.

use crate::real::{Lanes, Real};
use crate::real_vector::pair::Pair;
use crate::real_vector::work::{EIGHT, EightLanes, FourLanes, LANES};
use pulp::Simd;
use pulp::bytemuck::Pod;
use pulp::x86::{V3, V4};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// [`FourLanes`] on them.
pub(super) struct OnFour<F> {
    pub(super) simd: V3,
    pub(super) work: F,
}

impl<F: FourLanes> pulp::NullaryFnOnce for OnFour<F> {
    type Output = F::Output;

    #[inline(always)]
    fn call(self) -> F::Output {
        self.work.run(Vector::<V3, LANES>::zero(self.simd))
    }
}

/// [`EightLanes`] on one register each.
pub(super) struct OnEight<F> {
    pub(super) simd: V4,
    pub(super) work: F,
}

impl<F: EightLanes> pulp::NullaryFnOnce for OnEight<F> {
    type Output = F::Output;

    #[inline(always)]
    fn call(self) -> F::Output {
        self.work.run(Vector::<V4, EIGHT>::zero(self.simd))
    }
}

/// [`EightLanes`] on two registers each.
pub(super) struct OnPairs<F> {
    pub(super) simd: V3,
    pub(super) work: F,
}

impl<F: EightLanes> pulp::NullaryFnOnce for OnPairs<F> {
    type Output = F::Output;

    #[inline(always)]
    fn call(self) -> F::Output {
        let zero = Vector::<V3, LANES>::zero(self.simd);
        self.work.run(Pair([zero; 2]))
    }
}

/// `K` numbers in one register of a processor that has the instructions of `S`.
#[derive(Clone, Copy)]
pub(super) struct Vector<S: Simd, const K: usize> {
    /// Shows that the processor has them.
    pub(super) simd: S,
    pub(super) lanes: S::f64s,
}

impl<S: Simd, const K: usize> Vector<S, K> {
    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        self.with(self.simd.splat_f64s(value))
    }
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let lanes = simd.splat_f64s(0.0);
        Self { simd, lanes }
    }
    #[inline(always)]
    pub(super) fn with(self, lanes: S::f64s) -> Self {
        Self { lanes, ..self }
    }
}

/// An operator of two vectors.
macro_rules! operator {
    ($trait:ident, $method:ident, $instruction:ident) => {
        impl<S: Simd, const K: usize> $trait for Vector<S, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(self.simd.$instruction(self.lanes, other.lanes))
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd, const K: usize> Neg for Vector<S, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self.simd.xor_f64s(self.lanes, self.splat(-0.0).lanes))
    }
}
impl<S: Simd, const K: usize> Mul<f64> for Vector<S, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * self.splat(other)
    }
}
impl<S: Simd, const K: usize> Add<f64> for Vector<S, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + self.splat(other)
    }
}

impl<S: Simd, const K: usize> Real for Vector<S, K>
where
    [f64; K]: Pod,
{
    type Plain = Lanes<K>;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        self.splat(value)
    }
    #[inline(always)]
    fn plain(self) -> Lanes<K> {
        Lanes(pulp::cast(self.lanes))
    }
    #[inline(always)]
    fn with_plain(self, Lanes(lanes): Lanes<K>) -> Self {
        self.with(pulp::cast(lanes))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        let sum = self
            .simd
            .mul_add_f64s(self.lanes, factor.lanes, summand.lanes);
        self.with(sum)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.lanes))
    }
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        self.with_plain(self.plain().powf(exponent))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.with_plain(self.plain().ln())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(self.simd.max_f64s(self.lanes, other.lanes))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(self.simd.min_f64s(self.lanes, other.lanes))
    }
    #[inline(always)]
    fn select(self, positive: Self, otherwise: Self) -> Self {
        let zero = self.simd.splat_f64s(0.0);
        let above = self.simd.greater_than_f64s(self.lanes, zero);
        let chosen = self
            .simd
            .select_f64s(above, positive.lanes, otherwise.lanes);
        self.with(chosen)
    }
    #[inline(always)]
    fn any_above_zero(self) -> bool {
        let zero = self.simd.splat_f64s(0.0);
        let above = self.simd.greater_than_f64s(self.lanes, zero);
        self.simd.first_true_m64s(above) < K
    }
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        self.with_plain(self.plain().map(function))
    }
}
