//! Medians and quartiles.

/// The median; NaN where there are no values.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The quantile at a probability, linear between the ordered values: place
/// (n - 1) p of them, counted from zero (type 7 of Hyndman and Fan 1996, the
/// default of R and NumPy). NaN where there are no values.
pub fn quantile(values: &[f64], probability: f64) -> f64 {
    quantiles(values, [probability])[0]
}

/// [`quantile`] at several probabilities, in time linear in the values.
///
/// * `probabilities`: ascending
pub fn quantiles<const N: usize>(values: &[f64], probabilities: [f64; N]) -> [f64; N] {
    let Some(last) = values.len().checked_sub(1) else {
        return [f64::NAN; N];
    };
    let mut all = values.to_vec();
    // Values before this place are in their places or below all others.
    let mut known = 0;
    probabilities.map(|probability| {
        let place = probability.clamp(0.0, 1.0) * last as f64;
        let below = place.floor() as usize;
        let left = &mut all[known.min(below)..];
        let at = below - known.min(below);
        let (_, value, above) = left.select_nth_unstable_by(at, f64::total_cmp);
        known = below;
        let next = above
            .iter()
            .copied()
            .min_by(f64::total_cmp)
            .unwrap_or(*value);
        *value + (place - below as f64) * (next - *value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_quartiles_of_a_few() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(median(&values), 2.5);
        assert_eq!(quantile(&values, 0.25), 1.75);
        assert_eq!(quantile(&values, 1.0), 4.0);
        assert!(median(&[]).is_nan());
        let found = quantiles(&values, [0.0, 0.25, 0.25, 0.9, 1.0]);
        assert_eq!(found, [1.0, 1.75, 1.75, 3.7, 4.0]);
    }
}
