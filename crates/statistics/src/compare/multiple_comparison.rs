//! p-values of several tests, adjusted for their number.

/// Bonferroni: n p, at most 1, which keeps the chance of any false finding.
pub fn bonferroni(p: &[f64]) -> Vec<f64> {
    let n = p.len() as f64;
    p.iter().map(|p| (n * p).min(1.0)).collect()
}

/// Holm: as Bonferroni, and never weaker than it.
///
/// # Source
/// Holm (1979), A simple sequentially rejective multiple test procedure, Scand.
/// J. Stat. 6.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut adjusted = vec![0.0; p.len()];
    let mut largest = 0.0_f64;
    for (rank, place) in ascending(p).into_iter().enumerate() {
        largest = largest.max((p.len() - rank) as f64 * p[place]).min(1.0);
        adjusted[place] = largest;
    }
    adjusted
}

fn ascending(p: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: R 4.2.2, p.adjust.
    #[test]
    fn reference_adjusted_p() {
        let p = [0.01, 0.04, 0.03, 0.005, 0.6, 0.02];
        let close = |found: Vec<f64>, expected: [f64; 6]| {
            for (f, e) in found.iter().zip(expected) {
                assert!((f - e).abs() < 1e-15, "{found:?} against {expected:?}");
            }
        };
        close(bonferroni(&p), [0.06, 0.24, 0.18, 0.03, 1.0, 0.12]);
        close(holm(&p), [0.05, 0.09, 0.09, 0.03, 0.6, 0.08]);
    }
}
