//! Values with their standard uncertainty.

use windfall_distribution::tail::normal_lower;

/// A value with its standard uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertain {
    /// Value.
    pub value: f64,
    /// Standard uncertainty.
    pub sd: f64,
}

impl Uncertain {
    /// A value with its standard uncertainty.
    pub const fn new(value: f64, sd: f64) -> Self {
        Self { value, sd }
    }

    /// A value without uncertainty.
    pub const fn exact(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}

/// Mean of independent estimates of one quantity, weighted by 1/u², with the larger of the
/// standard errors from the u and from their scatter. What the estimates share must be
/// left out of the u and added to the mean. `None` of nothing.
pub fn weighted_mean(estimates: &[Uncertain]) -> Option<Uncertain> {
    let weight = |own: &Uncertain| 1.0 / (own.sd * own.sd).max(f64::MIN_POSITIVE);
    let total: f64 = estimates.iter().map(weight).sum();
    if estimates.is_empty() {
        return None;
    }
    let mean = estimates.iter().map(|m| m.value * weight(m)).sum::<f64>() / total;
    let chi_square: f64 = estimates
        .iter()
        .map(|m| weight(m) * (m.value - mean).powi(2))
        .sum();
    let freedom = estimates.len().saturating_sub(1).max(1) as f64;
    let excess = (chi_square / freedom).max(1.0);
    Some(Uncertain::new(mean, (excess / total).sqrt()))
}

/// Mean of values that differ by more than their uncertainties, as taps do: each is weighted
/// by its own variance and that [between](variance_between) them.
///
/// The uncertainty is that of the mean: between values it is estimated from their spread, and a
/// single value keeps its own. `None` without values.
pub fn mean_of_differing(values: &[Uncertain]) -> Option<Uncertain> {
    let between = variance_between(values);
    let total: f64 = values.iter().map(|own| weight(own, between)).sum();
    let parts = values.iter().map(|own| weight(own, between) * own.value);
    let value = parts.sum::<f64>() / total;
    (!values.is_empty()).then(|| Uncertain::new(value, total.sqrt().recip()))
}

/// Variance between values, beyond their uncertainties; 0 where these explain the spread, or
/// without values.
///
/// # Source
/// DerSimonian and Laird (1986), Control. Clin. Trials 7:177.
pub fn variance_between(values: &[Uncertain]) -> f64 {
    let weights = values.iter().map(|own| weight(own, 0.0));
    let total: f64 = weights.clone().sum();
    let parts = weights.clone().zip(values);
    let mean = parts.map(|(w, own)| w * own.value).sum::<f64>() / total;
    let parts = weights.clone().zip(values);
    let spread: f64 = parts.map(|(w, own)| w * (own.value - mean).powi(2)).sum();
    let below = total - weights.map(|w| w * w).sum::<f64>() / total;
    let excess = spread - (values.len() as f64 - 1.0);
    if below > 0.0 {
        (excess / below).max(0.0)
    } else {
        0.0
    }
}

/// One over the variance with that between values. A value that claims to be exact is not.
fn weight(own: &Uncertain, between: f64) -> f64 {
    let sd = own.sd.max(own.value.abs() * f64::EPSILON);
    1.0 / (sd.powi(2) + between)
}

/// Standard deviation of the largest of samples that lie on a parabola but for white noise.
///
/// The noise moves the largest sample less than a sample, since several compete for it:
///
/// ```text
/// P(max ≤ m) = Π Φ((m − fᵢ)/σ)
/// ```
///
/// * `level`: fᵢ, the samples without their noise
/// * `noise`: σ, of one sample
///
/// Zero without noise or samples.
pub(crate) fn sd_of_largest(level: &[f64], noise: f64) -> f64 {
    let top = level.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !(noise > 0.0 && top.is_finite()) {
        return 0.0;
    }
    // In units of the noise, below the top; those further down never win.
    let below: Vec<f64> = level.iter().map(|f| (top - f) / noise).collect();
    let near: Vec<f64> = below
        .into_iter()
        .filter(|own| *own < OUT_OF_REACH)
        .collect();
    let below_all = |m: f64| {
        near.iter()
            .map(|own| normal_lower(m + own))
            .product::<f64>()
    };
    // From the top of the distribution down to where nothing is left of it.
    let (mut mean, mut square, mut above) = (0.0, 0.0, 1.0);
    let mut m = OUT_OF_REACH;
    while above > NOTHING && m > -OUT_OF_REACH {
        let next = m - STEP;
        let now = below_all(next);
        let (weight, middle) = (above - now, m - 0.5 * STEP);
        mean += weight * middle;
        square += weight * middle * middle;
        (above, m) = (now, next);
    }
    // Sheppard's correction: each step is as if all of it were at its middle.
    let variance = square - mean * mean - STEP * STEP / 12.0;
    noise * variance.max(0.0).sqrt()
}

/// No sample wins that lies further below the top; standard deviations of the noise.
const OUT_OF_REACH: f64 = 8.0;
/// Of the sum over the largest sample; standard deviations of the noise. With the correction
/// the error falls like exp(−2π² s²/step²), s being the deviation of the largest (0.3 for ten
/// thousand samples).
const STEP: f64 = 0.25;
/// Probability that is left out; 1.
const NOTHING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    /// Harter, H. L. (1961), Expected values of normal order statistics, Biometrika 48, 151:
    /// the variance of the largest of 2 is 1 − 1/π, of 5 is 0.44753, of 10 is 0.34434.
    #[test]
    fn reference_deviations_of_the_largest_of_normal_samples() {
        let variance = |n: usize| (sd_of_largest(&vec![3.0; n], 0.5) / 0.5).powi(2);
        for (n, expected) in [(1, 1.0), (2, 0.681_69), (5, 0.447_53), (10, 0.344_34)] {
            assert!(
                (variance(n) / expected - 1.0).abs() < 2e-5,
                "{n}: {}",
                variance(n)
            );
        }
        // Samples far below do not compete.
        assert!((sd_of_largest(&[3.0, -30.0, -30.0], 0.5) / 0.5 - 1.0).abs() < 1e-9);
        assert_eq!(sd_of_largest(&[1.0], 0.0), 0.0);
    }

    #[test]
    fn closed_form_means_of_equal_weights() {
        // Far apart: the plain mean, with the standard error of the mean.
        let values = [100.0, 102.0, 104.0].map(|value| Uncertain::new(value, 0.01));
        let mean = mean_of_differing(&values).unwrap();
        assert!((mean.value - 102.0).abs() < 1e-9);
        assert!((mean.sd - 2.0 / 3.0_f64.sqrt()).abs() < 1e-4);
        // Equal: the weighted mean with the uncertainties alone.
        let values = [Uncertain::new(5.0, 3.0), Uncertain::new(5.0, 4.0)];
        let mean = mean_of_differing(&values).unwrap();
        assert!((mean.sd - 2.4).abs() < 1e-12 && mean.value == 5.0);
        let one = mean_of_differing(&values[..1]).unwrap();
        assert!((one.value - 5.0).abs() < 1e-14 && (one.sd - 3.0).abs() < 1e-14);
        assert_eq!(mean_of_differing(&[]), None);
    }
}
