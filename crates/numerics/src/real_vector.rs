//! Four numbers in one vector register, where the processor has such registers.
//!
//! [`Lanes`] leave it to the compiler to find the vectors, which it does in short
//! loops only; here numbers stay in vectors through formulas of any length. Every
//! operation gives the bits that [`Lanes`] give.

use crate::real::{Lanes, Real};

/// Numbers side by side, the same on every processor.
pub const LANES: usize = 4;

/// Work on [`LANES`] numbers at a time.
pub trait FourLanes {
    /// What comes out.
    type Output;

    /// Does it with numbers like `zero`.
    ///
    /// To be `#[inline(always)]`, and all that it calls in its loops too: what is
    /// compiled by itself is not compiled for the vector instructions.
    fn run<R: FourNumbers>(self, zero: R) -> Self::Output;
}

/// Numbers of [`LANES`] lanes, which go over into rows and back.
pub trait FourNumbers: Real<Plain = Lanes<LANES>> {
    /// The columns of four rows: number n holds the n-th of each row.
    fn columns(self, rows: [Lanes<LANES>; LANES]) -> [Self; LANES];
    /// The rows of four columns.
    fn rows(columns: [Self; LANES]) -> [Lanes<LANES>; LANES];
}

impl FourNumbers for Lanes<LANES> {
    #[inline(always)]
    fn columns(self, rows: [Self; LANES]) -> [Self; LANES] {
        let mut columns = [self; LANES];
        for (n, column) in columns.iter_mut().enumerate() {
            for (lane, row) in rows.iter().enumerate() {
                column.0[lane] = row.0[n];
            }
        }
        columns
    }
    #[inline(always)]
    fn rows(columns: [Self; LANES]) -> [Self; LANES] {
        columns[0].columns(columns)
    }
}

/// Does `work` on vector registers where the processor has them (AVX2 and FMA), on
/// [`Lanes`] elsewhere.
#[inline(always)]
pub fn with_four_lanes<F: FourLanes>(work: F) -> F::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(avx2::OnVectors { simd, work });
    }
    work.run(Lanes::ZERO)
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{FourLanes, FourNumbers, LANES};
    use crate::real::{Lanes, Real};
    use pulp::x86::V3;
    use pulp::{Simd, f64x4};
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// [`FourLanes`] on [`Vector`]s.
    pub(super) struct OnVectors<F> {
        pub(super) simd: V3,
        pub(super) work: F,
    }

    impl<F: FourLanes> pulp::NullaryFnOnce for OnVectors<F> {
        type Output = F::Output;

        #[inline(always)]
        fn call(self) -> F::Output {
            self.work.run(Vector {
                simd: self.simd,
                lanes: f64x4(0.0, 0.0, 0.0, 0.0),
            })
        }
    }

    /// Four numbers in one register of a processor that has AVX2 and FMA.
    #[derive(Clone, Copy)]
    struct Vector {
        /// Shows that the processor has the instructions.
        simd: V3,
        lanes: f64x4,
    }

    impl Vector {
        #[inline(always)]
        fn with(self, lanes: f64x4) -> Self {
            Self { lanes, ..self }
        }
    }

    /// An operator of two vectors.
    macro_rules! operator {
        ($trait:ident, $method:ident, $instruction:ident) => {
            impl $trait for Vector {
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

    impl Neg for Vector {
        type Output = Self;
        #[inline(always)]
        fn neg(self) -> Self {
            self.with(self.simd.xor_f64s(self.lanes, self.constant(-0.0).lanes))
        }
    }
    impl Mul<f64> for Vector {
        type Output = Self;
        #[inline(always)]
        fn mul(self, other: f64) -> Self {
            self * self.constant(other)
        }
    }
    impl Add<f64> for Vector {
        type Output = Self;
        #[inline(always)]
        fn add(self, other: f64) -> Self {
            self + self.constant(other)
        }
    }

    impl FourNumbers for Vector {
        #[inline(always)]
        fn columns(self, rows: [Lanes<LANES>; LANES]) -> [Self; LANES] {
            let avx = self.simd.avx;
            let [a, b, c, d] = [
                pulp::cast(rows[0].0),
                pulp::cast(rows[1].0),
                pulp::cast(rows[2].0),
                pulp::cast(rows[3].0),
            ];
            let (even_ab, odd_ab) = (avx._mm256_unpacklo_pd(a, b), avx._mm256_unpackhi_pd(a, b));
            let (even_cd, odd_cd) = (avx._mm256_unpacklo_pd(c, d), avx._mm256_unpackhi_pd(c, d));
            [
                self.with(pulp::cast(
                    avx._mm256_permute2f128_pd::<0x20>(even_ab, even_cd),
                )),
                self.with(pulp::cast(
                    avx._mm256_permute2f128_pd::<0x20>(odd_ab, odd_cd),
                )),
                self.with(pulp::cast(
                    avx._mm256_permute2f128_pd::<0x31>(even_ab, even_cd),
                )),
                self.with(pulp::cast(
                    avx._mm256_permute2f128_pd::<0x31>(odd_ab, odd_cd),
                )),
            ]
        }
        #[inline(always)]
        fn rows(columns: [Self; LANES]) -> [Lanes<LANES>; LANES] {
            let plain = [
                columns[0].plain(),
                columns[1].plain(),
                columns[2].plain(),
                columns[3].plain(),
            ];
            let rows = columns[0].columns(plain);
            [
                rows[0].plain(),
                rows[1].plain(),
                rows[2].plain(),
                rows[3].plain(),
            ]
        }
    }

    impl Real for Vector {
        type Plain = Lanes<LANES>;

        #[inline(always)]
        fn constant(self, value: f64) -> Self {
            self.with(self.simd.splat_f64s(value))
        }
        #[inline(always)]
        fn plain(self) -> Lanes<LANES> {
            Lanes(pulp::cast(self.lanes))
        }
        #[inline(always)]
        fn with_plain(self, Lanes(lanes): Lanes<LANES>) -> Self {
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
        fn map(self, function: impl Fn(f64) -> f64) -> Self {
            self.with_plain(self.plain().map(function))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on each pair of lanes, as bits.
    struct Operations {
        a: Lanes<LANES>,
        b: Lanes<LANES>,
    }

    impl FourLanes for Operations {
        type Output = Vec<[u64; LANES]>;

        #[inline(always)]
        fn run<R: FourNumbers>(self, zero: R) -> Self::Output {
            let (a, b) = (zero.with_plain(self.a), zero.with_plain(self.b));
            let c = zero.constant(0.3);
            let out = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a * 1.7,
                a + 1.7,
                a.mul_add(b, c),
                a.sqrt(),
                a.powf(1.3),
                a.ln(),
                a.max(b),
                a.min(b),
                a.select(b, c),
                a.map(|a| a.sin() + 1.0),
            ];
            let columns = zero.columns([self.a, self.b, self.b, c.plain()]);
            let rows = R::rows([a, b, a, c]);
            let numbers = out.into_iter().chain(columns).map(|value| value.plain());
            let numbers = numbers.chain(rows);
            // The sign of what is no number is left open by the language.
            let bits = |own: f64| {
                if own.is_nan() {
                    u64::MAX
                } else {
                    own.to_bits()
                }
            };
            numbers.map(|value| value.0.map(bits)).collect()
        }
    }

    /// The bits of [`Lanes`], with infinities, signed zeros and what is no number.
    #[test]
    fn repeats_lanes_to_the_bit() {
        let special = [
            0.0,
            -0.0,
            1.5,
            -2.25,
            1e-310,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
        ];
        for i in 0..special.len() {
            for j in 0..special.len() {
                let at = |k: usize| special[k % special.len()];
                let a = Lanes([at(i), at(i + 3), 0.1 * (i + 1) as f64, -1.3]);
                let b = Lanes([at(j), at(j + 5), 0.7 * (j + 1) as f64, 2.9]);
                let expected = Operations { a, b }.run(Lanes::ZERO);
                assert_eq!(
                    with_four_lanes(Operations { a, b }),
                    expected,
                    "{a:?} {b:?}"
                );
            }
        }
    }
}
