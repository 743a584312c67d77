//! Hertz's contact of bodies with two different principal curvatures.

use std::f64::consts::FRAC_PI_2;

/// Complete elliptic integrals of the first and second kind, K(e) and E(e).
///
/// * `eccentricity`: the modulus e (not its square), 0 ≤ e < 1
///
/// # Numerics
/// Arithmetic-geometric mean; relative error near 1e-15.
///
/// # Source
/// Abramowitz and Stegun (1964), 17.6.
pub fn elliptic_integrals(eccentricity: f64) -> (f64, f64) {
    let (mut a, mut b) = (1.0, (1.0 - eccentricity * eccentricity).sqrt());
    let (mut sum, mut power) = (eccentricity * eccentricity / 2.0, 0.5);
    // Quadratic convergence: six steps suffice for double precision.
    for _ in 0..12 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
        if c.abs() < 1e-17 {
            break;
        }
    }
    let first = FRAC_PI_2 / a;
    (first, first * (1.0 - sum))
}

/// Length C in d = C (F/E*)^(2/3), the approach of two bodies in contact; m^(−1/3).
///
/// * `curvature`, `other`: relative principal curvatures, sums of those of both
///   bodies, both positive; 1/m
///
/// ```text
/// A/B = [K(e) − E(e)] / [E(e)/(1 − e²) − K(e)],   A ≤ B the halves of the curvatures
/// d³ = K(e)³ (3F/(2πE*))² (1 − e²)(A + B)/E(e)
/// ```
///
/// # Source
/// Hertz (1881); Johnson (1985), Contact Mechanics, eqs. (4.24)-(4.28).
///
/// # Example
/// ```
/// use windfall_contact::hertz_elliptic::approach_length;
/// // A sphere of 40 mm: d = (9/(16 R))^(1/3) (F/E*)^(2/3).
/// let sphere = approach_length(25.0, 25.0);
/// assert!((sphere - (9.0 / 16.0 * 25.0_f64).cbrt()).abs() < 1e-12);
/// ```
pub fn approach_length(curvature: f64, other: f64) -> f64 {
    let small = 0.5 * curvature.min(other);
    let large = 0.5 * curvature.max(other);
    let e = eccentricity(small / large);
    let (first, second) = elliptic_integrals(e);
    let factor = 1.5 / std::f64::consts::PI;
    first * (factor * factor * (1.0 - e * e) * (small + large) / second).cbrt()
}

/// Eccentricity of the ellipse of contact where the ratio of the relative
/// curvatures is `ratio`, 0 < ratio ≤ 1.
fn eccentricity(ratio: f64) -> f64 {
    if ratio >= 1.0 {
        return 0.0;
    }
    let of = |e: f64| {
        let (first, second) = elliptic_integrals(e);
        // Near a circle the difference of the integrals cancels.
        if e < 1e-3 {
            return 1.0 - 1.5 * e * e;
        }
        (first - second) / (second / (1.0 - e * e) - first)
    };
    // The ratio falls from 1 to 0 as e rises.
    let (mut low, mut high) = (0.0_f64, 1.0 - 1e-12);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match of(middle) > ratio {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy 1.17, `scipy.special.ellipk(e²)` and `ellipe(e²)`.
    #[test]
    fn reference_elliptic_integrals() {
        for (e, first, second) in [
            (0.0, FRAC_PI_2, FRAC_PI_2),
            (0.5, 1.685750354812596, 1.4674622093394272),
            (0.9, 2.2805491384227703, 1.1716970527816142),
            (0.999, 4.49559639584215, 1.0039944099655078),
        ] {
            let (k, d) = elliptic_integrals(e);
            assert!((k / first - 1.0).abs() < 1e-14, "{e}: {k}");
            assert!((d / second - 1.0).abs() < 1e-14, "{e}: {d}");
        }
    }

    /// K of ASAE S368 as the standard's formula defines it,
    /// D = 0.338^(2/3) (F(1 − ν²)/E)^(2/3) K (1/R + 1/R')^(1/3), from the same
    /// angles as its table: cos θ = (1/R − 1/R')/(1/R + 1/R') for a plate.
    #[test]
    fn reference_constants_of_asae_s368() {
        for (degrees, printed) in [
            (90.0_f64, 1.351),
            (80.0, 1.342),
            (70.0, 1.314),
            (60.0, 1.267),
        ] {
            let cosine = degrees.to_radians().cos();
            let (one, other) = (1.0 + cosine, 1.0 - cosine);
            let k = approach_length(one, other) / (0.338_f64.powf(2.0 / 3.0) * 2.0_f64.cbrt());
            assert!((k - printed).abs() < 1.5e-3, "{degrees}: {k}");
        }
    }

    #[test]
    fn converges_to_a_circle() {
        let circle = approach_length(20.0, 20.0);
        assert!((approach_length(20.0, 20.0 * (1.0 + 1e-9)) / circle - 1.0).abs() < 1e-9);
        assert!((approach_length(10.0, 30.0) - approach_length(30.0, 10.0)).abs() < 1e-15);
    }
}
