//! Four or eight numbers in vector registers, where the processor has such registers.
//!
//! [`Lanes`] leave it to the compiler to find the vectors, which it does in short
//! loops only; here numbers stay in vectors through formulas of any length. Every
//! operation gives the bits that [`Lanes`] give.

#[cfg(target_arch = "x86_64")]
mod pair;
#[cfg(target_arch = "x86_64")]
mod turn;
#[cfg(target_arch = "x86_64")]
mod vector;
mod work;

use crate::real::Lanes;
#[cfg(target_arch = "x86_64")]
use {
    pulp::x86::{V3, V4},
    vector::{OnEight, OnFour, OnPairs},
};

pub use work::{EIGHT, EightLanes, EightNumbers, FourLanes, LANES, Row};

/// Does `work` on vector registers where the processor has them (AVX2 and FMA; of
/// AVX-512, twice as many), on [`Lanes`] elsewhere.
#[inline(always)]
pub fn with_four_lanes<F: FourLanes>(work: F) -> F::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(wide) = V4::try_new() {
        return wide.vectorize(OnFour { simd: *wide, work });
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = V3::try_new() {
        return simd.vectorize(OnFour { simd, work });
    }
    work.run(Lanes::ZERO)
}

/// As [`with_four_lanes`], in one register of AVX-512 or two of AVX2.
#[inline(always)]
pub fn with_eight_lanes<F: EightLanes>(work: F) -> F::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = V4::try_new() {
        return simd.vectorize(OnEight { simd, work });
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = V3::try_new() {
        return simd.vectorize(OnPairs { simd, work });
    }
    work.run(Lanes::ZERO)
}

/// Does `work`, compiled for vector registers of [`LANES`] numbers where the processor has
/// them: for loops over [`Lanes`], in which the compiler finds the vectors. (In wider
/// registers it finds fewer.)
#[inline(always)]
pub fn compiled_for_vectors<F: pulp::NullaryFnOnce>(work: F) -> F::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = V3::try_new() {
        return simd.vectorize(work);
    }
    work.call()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Real;

    /// Every operation on each pair of lanes, as bits.
    struct Operations<const K: usize> {
        a: Lanes<K>,
        b: Lanes<K>,
    }

    /// The sign of what is no number is left open by the language.
    fn bits(own: f64) -> u64 {
        if own.is_nan() {
            u64::MAX
        } else {
            own.to_bits()
        }
    }

    impl<const K: usize> Operations<K> {
        fn each<R: Real<Plain = Lanes<K>>>(&self, zero: R) -> Vec<[u64; K]> {
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
            let mut out = out.map(|value| value.plain().0.map(bits)).to_vec();
            let any = [a, b, a * 0.0, -a].map(|own| u64::from(own.any_above_zero()));
            out.extend(any.map(|own| [own; K]));
            out
        }
    }

    impl FourLanes for Operations<LANES> {
        type Output = Vec<[u64; LANES]>;

        #[inline(always)]
        fn run<R: Real<Plain = Lanes<LANES>>>(self, zero: R) -> Self::Output {
            self.each(zero)
        }
    }

    impl EightLanes for Operations<EIGHT> {
        type Output = Vec<[u64; EIGHT]>;

        #[inline(always)]
        fn run<R: EightNumbers>(self, zero: R) -> Self::Output {
            let rows = self.a.0.map(|own| Lanes([own, 1.0, -own, own * 3.0]));
            let columns = zero.columns(rows);
            let [j, k, l, m] = columns;
            let turned = R::rows([m, j, k, l], [l, l, j, k]);
            let mut out = self.each(zero);
            out.extend(zero.each_plain(columns).map(|own| own.0.map(bits)));
            out.extend(zero.each_plain(turned).map(|own| own.0.map(bits)));
            out
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
                let work = || Operations { a, b };
                assert_eq!(with_four_lanes(work()), expected, "{a:?} {b:?}");
                let (a, b) = (doubled(a), doubled(b));
                let expected = Operations { a, b }.run(Lanes::ZERO);
                let work = || Operations { a, b };
                assert_eq!(with_eight_lanes(work()), expected, "{a:?} {b:?}");
                #[cfg(target_arch = "x86_64")]
                if let Some(simd) = V3::try_new() {
                    let work = work();
                    assert_eq!(simd.vectorize(OnPairs { simd, work }), expected);
                }
            }
        }
    }

    /// The lanes and, behind them, the same in other places.
    fn doubled(Lanes([a, b, c, d]): Lanes<LANES>) -> Lanes<EIGHT> {
        Lanes([a, b, c, d, d, c, b, a])
    }
}
