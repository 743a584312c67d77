//! Rows into columns and back, in registers of an x86 processor.

use crate::real::Real;
use crate::real_vector::pair::Pair;
use crate::real_vector::vector::Vector;
use crate::real_vector::work::{EIGHT, EightNumbers, LANES, Row};
use pulp::x86::{V3, V4};
use std::arch::x86_64::__m512d;

impl Vector<V3, LANES> {
    /// The columns of four rows, or the rows of four columns.
    #[inline(always)]
    fn turn(self, [a, b, c, d]: [Row; LANES]) -> [Self; LANES] {
        let avx = self.simd.avx;
        let [a, b] = [pulp::cast(a.0), pulp::cast(b.0)];
        let [c, d] = [pulp::cast(c.0), pulp::cast(d.0)];
        let (even, odd) = (avx._mm256_unpacklo_pd(a, b), avx._mm256_unpackhi_pd(a, b));
        let (even_later, odd_later) = (avx._mm256_unpacklo_pd(c, d), avx._mm256_unpackhi_pd(c, d));
        let first = avx._mm256_permute2f128_pd::<0x20>(even, even_later);
        let second = avx._mm256_permute2f128_pd::<0x20>(odd, odd_later);
        let third = avx._mm256_permute2f128_pd::<0x31>(even, even_later);
        let fourth = avx._mm256_permute2f128_pd::<0x31>(odd, odd_later);
        [
            self.with(pulp::cast(first)),
            self.with(pulp::cast(second)),
            self.with(pulp::cast(third)),
            self.with(pulp::cast(fourth)),
        ]
    }
}

impl EightNumbers for Pair<Vector<V3, LANES>> {
    #[inline(always)]
    fn columns(self, [a, b, c, d, e, f, g, h]: [Row; EIGHT]) -> [Self; LANES] {
        let Self([first, second]) = self;
        let ([a, b, c, d], [e, f, g, h]) = (first.turn([a, b, c, d]), second.turn([e, f, g, h]));
        [Self([a, e]), Self([b, f]), Self([c, g]), Self([d, h])]
    }
    #[inline(always)]
    fn rows(first: [Self; LANES], second: [Self; LANES]) -> [Self; EIGHT] {
        let mut rows = [first[0]; EIGHT];
        for half in 0..2 {
            let like = first[0].0[half];
            let mut columns = [[like.plain(); LANES]; 2];
            for own in 0..LANES {
                columns[0][own] = first[own].0[half].plain();
                columns[1][own] = second[own].0[half].plain();
            }
            let (fore, rear) = (like.turn(columns[0]), like.turn(columns[1]));
            for own in 0..LANES {
                rows[half * LANES + own] = Self([fore[own], rear[own]]);
            }
        }
        rows
    }
}

impl Vector<V4, EIGHT> {
    /// Two rows in one register.
    #[inline(always)]
    fn joined(self, low: Row, high: Row) -> Self {
        let wide = self.simd.avx512f;
        let low = wide._mm512_castpd256_pd512(pulp::cast(low.0));
        self.with(pulp::cast(
            wide._mm512_insertf64x4::<1>(low, pulp::cast(high.0)),
        ))
    }

    /// The even numbers of two registers, in turns, and the odd ones.
    #[inline(always)]
    fn unpacked(self, other: Self) -> [__m512d; 2] {
        let wide = self.simd.avx512f;
        let (a, b) = (pulp::cast(self.lanes), pulp::cast(other.lanes));
        [wide._mm512_unpacklo_pd(a, b), wide._mm512_unpackhi_pd(a, b)]
    }

    /// The even quarters of two registers, those of the first before, and the odd ones.
    #[inline(always)]
    fn quarters(self, a: __m512d, b: __m512d) -> [Self; 2] {
        let wide = self.simd.avx512f;
        let even = wide._mm512_shuffle_f64x2::<0x88>(a, b);
        let odd = wide._mm512_shuffle_f64x2::<0xdd>(a, b);
        [self.with(pulp::cast(even)), self.with(pulp::cast(odd))]
    }

    /// The first quarters of four registers in one, the second ones, and so on.
    #[inline(always)]
    fn all_quarters(self, [a, b, c, d]: [__m512d; LANES]) -> [Self; LANES] {
        let wide = self.simd.avx512f;
        let low_ab = wide._mm512_shuffle_f64x2::<0x44>(a, b);
        let low_cd = wide._mm512_shuffle_f64x2::<0x44>(c, d);
        let high_ab = wide._mm512_shuffle_f64x2::<0xee>(a, b);
        let high_cd = wide._mm512_shuffle_f64x2::<0xee>(c, d);
        let [first, second] = self.quarters(low_ab, low_cd);
        let [third, fourth] = self.quarters(high_ab, high_cd);
        [first, second, third, fourth]
    }
}

impl EightNumbers for Vector<V4, EIGHT> {
    #[inline(always)]
    fn columns(self, [a, b, c, d, e, f, g, h]: [Row; EIGHT]) -> [Self; LANES] {
        let [even, odd] = self.joined(a, c).unpacked(self.joined(b, d));
        let [even_later, odd_later] = self.joined(e, g).unpacked(self.joined(f, h));
        let [first, third] = self.quarters(even, even_later);
        let [second, fourth] = self.quarters(odd, odd_later);
        [first, second, third, fourth]
    }
    #[inline(always)]
    fn rows([a, b, c, d]: [Self; LANES], [e, f, g, h]: [Self; LANES]) -> [Self; EIGHT] {
        let ([even_ab, odd_ab], [even_cd, odd_cd]) = (a.unpacked(b), c.unpacked(d));
        let ([even_ef, odd_ef], [even_gh, odd_gh]) = (e.unpacked(f), g.unpacked(h));
        let [i, k, m, o] = a.all_quarters([even_ab, even_cd, even_ef, even_gh]);
        let [j, l, n, p] = a.all_quarters([odd_ab, odd_cd, odd_ef, odd_gh]);
        [i, j, k, l, m, n, o, p]
    }
}
