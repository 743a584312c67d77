//! What a ramp of finite duration leaves of an element that relaxes.

/// Above this many relaxation times the ramp is long, and its series is not summed.
const LONG: f64 = 500.0;

/// Part of an element's force that is left when the ramp ends, beside a sudden step.
///
/// ```text
/// r(x) = ∫₀¹ n u^(n−1) e^(−(1−u) x) du = e^(−x) Σ xʲ/j! · n/(n + j),    x = T/τ
/// ```
///
/// for a ramp of duration T whose elastic force grows as timeⁿ. For n = 1 it is
/// (1 − e^(−x))/x.
///
/// * `x`: duration of the ramp over the relaxation time; 1
/// * `exponent`: n, 1 or above; 1
///
/// # Numerics
/// All terms of the series are positive; for long ramps r = n/x (1 − (n−1)/x + (n−1)(n−2)/x²),
/// good to 1e-8.
///
/// # Source
/// Boltzmann's superposition of the ramp; Sorvari, J., and Malinen, M. (2006), Determination of
/// the relaxation modulus of a linearly viscoelastic material, Mech. Time-Depend. Mater. 10, 125,
/// doi 10.1007/s11043-006-9011-4. Differences: exact for exponentials, in place of their shift of
/// time.
pub fn left_after_ramp(x: f64, exponent: f64) -> f64 {
    if x > LONG {
        let n = exponent;
        return n / x * (1.0 - (n - 1.0) / x + (n - 1.0) * (n - 2.0) / (x * x));
    }
    let (mut term, mut sum, mut place) = ((-x).exp(), 0.0, 0.0);
    loop {
        let own = term * exponent / (exponent + place);
        sum += own;
        place += 1.0;
        term *= x / place;
        if place > x && own <= 1e-17 * sum {
            return sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.17: `hyp1f1(1, 2.5, -x)`, and (1 − e^(−x))/x by hand.
    #[test]
    fn reference_part_left() {
        for (x, n, expected) in [
            (0.0, 1.5, 1.0),
            (0.5, 1.0, 0.786_938_680_574_733_2),
            (20.0, 1.0, 0.049_999_999_896_942_32),
            (0.5, 1.5, LEFT[0]),
            (5.0, 1.5, LEFT[1]),
            (60.0, 1.5, LEFT[2]),
            (499.0, 1.5, LEFT[3]),
            (501.0, 1.5, LEFT[4]),
        ] {
            let found = left_after_ramp(x, n);
            let error = (found / expected - 1.0).abs();
            assert!(error < 2e-8, "{x} {n}: {found} against {expected}");
        }
    }

    const LEFT: [f64; 5] = [
        0.825_664_622_978_771,
        0.265_288_473_317_976_7,
        0.024_789_885_230_108_57,
        0.003_002_996_960_761_481,
        0.002_991_020_949_098_679,
    ];
}
