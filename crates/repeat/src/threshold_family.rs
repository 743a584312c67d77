//! Location-scale families of the logarithm of the critical energy.

use windfall_distribution::tail::normal_lower;

/// Form of the distribution of critical energies between fruit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Family {
    /// Their logarithm is normal.
    #[default]
    LogNormal,
    /// Weibull: their logarithm has the smallest-extreme-value distribution.
    Weibull,
}

impl Family {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::LogNormal => "log-normal",
            Self::Weibull => "Weibull",
        }
    }
}

/// ln of the probability between two standardised values, which may be infinite, and the
/// densities at both over it.
pub(crate) fn interval_terms(family: Family, low: f64, high: f64) -> (f64, f64, f64) {
    let ln_probability = match family {
        Family::LogNormal => ln_normal_between(low, high),
        Family::Weibull => ln_extreme_between(low, high),
    };
    let ratio = |z: f64| match z.is_finite() {
        true => (ln_density(family, z) - ln_probability).exp(),
        false => 0.0,
    };
    (ln_probability, ratio(low), ratio(high))
}

fn ln_density(family: Family, z: f64) -> f64 {
    match family {
        Family::LogNormal => -0.5 * z * z - 0.5 * (2.0 * std::f64::consts::PI).ln(),
        Family::Weibull => z - z.exp(),
    }
}

/// ln Φ(z), accurate far into the lower tail.
fn ln_normal_below(z: f64) -> f64 {
    if z == f64::NEG_INFINITY {
        return z;
    }
    if z > -10.0 {
        return normal_lower(z).ln();
    }
    // Asymptotic series (Abramowitz and Stegun 26.2.12).
    let square = 1.0 / (z * z);
    let series = 1.0 - square * (1.0 - 3.0 * square * (1.0 - 5.0 * square * (1.0 - 7.0 * square)));
    ln_density(Family::LogNormal, z) - (-z).ln() + series.ln()
}

fn ln_normal_between(low: f64, high: f64) -> f64 {
    // In the lower tail, where differences keep their digits.
    let (low, high) = if low > 0.0 {
        (-high, -low)
    } else {
        (low, high)
    };
    if high == f64::INFINITY {
        return ln_normal_below(-low);
    }
    let (below_low, below_high) = (ln_normal_below(low), ln_normal_below(high));
    below_high + (-(below_low - below_high).exp()).ln_1p()
}

/// F(z) = 1 − exp(−eᶻ).
fn ln_extreme_between(low: f64, high: f64) -> f64 {
    let (hazard_low, hazard_high) = (low.exp(), high.exp());
    if hazard_high == f64::INFINITY {
        return -hazard_low;
    }
    -hazard_low + (-f64::exp_m1(hazard_low - hazard_high)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_probabilities_and_slopes() {
        let inf = f64::INFINITY;
        let cases = [
            (Family::LogNormal, -1.0, 1.0, 0.682_689_492_137_085_9),
            (Family::LogNormal, 0.0, inf, 0.5),
            (Family::Weibull, -inf, 0.0, 1.0 - (-1.0_f64).exp()),
            (Family::Weibull, 0.0, inf, (-1.0_f64).exp()),
        ];
        for (family, low, high, expected) in cases {
            let (ln, _, _) = interval_terms(family, low, high);
            assert!(
                (ln.exp() - expected).abs() < 1e-10,
                "{family:?} {low} {high}"
            );
        }
        // ln Φ(−40), scipy.special.log_ndtr, SciPy 1.17.1.
        let (tail, _, _) = interval_terms(Family::LogNormal, -inf, -40.0);
        assert!(
            (tail / -804.608_442_013_753_9 - 1.0).abs() < 1e-12,
            "{tail}"
        );
    }

    #[test]
    fn derivative_of_the_logarithm() {
        for family in [Family::LogNormal, Family::Weibull] {
            for (low, high) in [
                (-1.0, 0.5),
                (2.0, 2.5),
                (-14.0, -12.0),
                (-3.0, f64::INFINITY),
            ] {
                let (_, at_low, at_high) = interval_terms(family, low, high);
                let h = 1e-5;
                let ln = |low, high| interval_terms(family, low, high).0;
                let by_low = (ln(low + h, high) - ln(low - h, high)) / (2.0 * h);
                assert!(
                    (by_low + at_low).abs() < 1e-6 * at_low.max(1.0),
                    "{family:?} {low}"
                );
                if high.is_finite() {
                    let by_high = (ln(low, high + h) - ln(low, high - h)) / (2.0 * h);
                    assert!((by_high - at_high).abs() < 1e-6 * at_high.max(1.0));
                }
            }
        }
    }
}
