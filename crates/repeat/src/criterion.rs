//! Whether one fruit changed, by what repeats on an elastic reference scatter.

use crate::equivalence::{Verdict, check_level, t_quantile};
use windfall_signal::error::Error;

/// Blocks into which a difference curve is averaged.
const BLOCKS: usize = 14;

/// Fewest reference differences.
const LEAST_REFERENCES: usize = 3;

/// Scatter of repeats on a reference that cannot be damaged.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeatability {
    /// Reference differences.
    pub n: usize,
    /// Root mean square of each block of the curve, as a part of the peak; 1.
    pub curve: Vec<f64>,
    /// Root mean square of the changes of peak, duration and rise slope; 1.
    pub changes: [f64; 3],
}

/// One difference: curve, peak, duration and rise slope, each relative; 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// At the instants of the pair.
    pub curve: Vec<f64>,
    /// Peak, duration and rise slope.
    pub changes: [f64; 3],
}

/// What is decided on one fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Changed, unchanged or undecided.
    pub verdict: Verdict,
    /// Largest |difference| of a block over its repeatability; 1.
    pub largest: f64,
    /// Value above which it counts as a change; 1.
    pub critical: f64,
}

/// Scatter of reference differences about zero: an elastic body does not change,
/// so the mean is known and every difference is one degree of freedom.
///
/// # Errors
/// [`Error::TooFewFruit`] with fewer than three, [`Error::CurvesUnequal`].
pub fn repeatability(references: &[Difference]) -> Result<Repeatability, Error> {
    let n = references.len();
    if n < LEAST_REFERENCES {
        return Err(Error::TooFewFruit {
            fruit: n,
            least: LEAST_REFERENCES,
        });
    }
    let points = references[0].curve.len();
    if let Some(other) = references.iter().find(|d| d.curve.len() != points) {
        return Err(Error::CurvesUnequal {
            first: points,
            other: other.curve.len(),
        });
    }
    let root_mean = |of: &dyn Fn(&Difference) -> f64| {
        let squares: f64 = references.iter().map(|d| of(d).powi(2)).sum();
        (squares / n as f64).sqrt()
    };
    let blocks: Vec<Vec<f64>> = references.iter().map(|d| blocks(&d.curve)).collect();
    let curve = (0..blocks[0].len()).map(|b| {
        let squares: f64 = blocks.iter().map(|each| each[b] * each[b]).sum();
        (squares / n as f64).sqrt()
    });
    Ok(Repeatability {
        n,
        curve: curve.collect(),
        changes: [0, 1, 2].map(|i| root_mean(&|d| d.changes[i])),
    })
}

/// Decides on one fruit.
///
/// Changed: a block of its curve differs by more than the repeatability lets
/// expect of any of the blocks of any of `decisions` differences (Student's t
/// with the reference's degrees of freedom, Šidák's correction), with
/// probability `level`. Unchanged: the changes of peak, duration and rise slope,
/// each ± its 1 − 2 `level` uncertainty, are within their margins. Otherwise
/// undecided.
///
/// * `margins`: of peak, duration and rise slope; 1
/// * `decisions`: differences that are judged together, such as all energies of
///   one fruit
///
/// # Errors
/// [`Error::BadOption`], [`Error::CurvesUnequal`].
pub fn decide(
    difference: &Difference,
    reference: &Repeatability,
    margins: [f64; 3],
    decisions: usize,
    level: f64,
) -> Result<Decision, Error> {
    check_level(level)?;
    let curve = blocks(&difference.curve);
    if curve.len() != reference.curve.len() {
        return Err(Error::CurvesUnequal {
            first: reference.curve.len(),
            other: curve.len(),
        });
    }
    // Blocks in which the reference scatters by chance hardly at all must not
    // decide: half its typical scatter is the least that is believed.
    let mut sorted = reference.curve.clone();
    sorted.sort_by(f64::total_cmp);
    let floor = 0.5 * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let ratios = curve.iter().zip(&reference.curve).map(|(d, s)| {
        let s = s.max(floor);
        if s > 0.0 {
            d.abs() / s
        } else if *d == 0.0 {
            0.0
        } else {
            f64::INFINITY
        }
    });
    let largest = ratios.fold(0.0, f64::max);
    let critical = critical_ratio(reference, decisions, level);
    let half = t_quantile(1.0 - level, reference.n as f64);
    let within =
        (0..3).all(|i| difference.changes[i].abs() + half * reference.changes[i] < margins[i]);
    let verdict = match (largest > critical, within) {
        (true, _) => Verdict::Changed,
        (false, true) => Verdict::Unchanged,
        (false, false) => Verdict::Undecided,
    };
    Ok(Decision {
        verdict,
        largest,
        critical,
    })
}

/// Ratio that the largest of some differences exceeds with probability `level` by chance.
pub fn critical_ratio(reference: &Repeatability, decisions: usize, level: f64) -> f64 {
    let tests = (reference.curve.len() * decisions.max(1)) as f64;
    let each = -(f64::ln_1p(-level) / tests).exp_m1();
    t_quantile(1.0 - 0.5 * each, reference.n as f64)
}

/// Means of successive parts of a curve.
fn blocks(curve: &[f64]) -> Vec<f64> {
    let count = BLOCKS.min(curve.len());
    let bound = |b: usize| b * curve.len() / count.max(1);
    let mean = |b: usize| {
        let part = &curve[bound(b)..bound(b + 1)];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..count).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal};

    fn noise(source: &mut NoiseSource, sd: f64) -> Difference {
        Difference {
            curve: (0..56).map(|_| sd * normal(source)).collect(),
            changes: [0, 1, 2].map(|_| sd * normal(source)),
        }
    }

    /// Of fruit that do not change, at most 5 % may be called changed at any of
    /// six energies.
    #[test]
    fn recovers_the_family_wise_rate() {
        let (trials, energies, mut wrong) = (4000, 6, 0);
        let mut source = noise_source(11, 0);
        for _ in 0..trials {
            let references: Vec<Difference> = (0..8).map(|_| noise(&mut source, 0.01)).collect();
            let reference = repeatability(&references).unwrap();
            let changed = (0..energies).any(|_| {
                let fruit = noise(&mut source, 0.01);
                let decision = decide(&fruit, &reference, [0.1; 3], energies, 0.05).unwrap();
                decision.verdict == Verdict::Changed
            });
            wrong += usize::from(changed);
        }
        // Šidák is conservative where fruit share one reference: below 5 % plus
        // three standard errors, and not far below.
        let rate = wrong as f64 / f64::from(trials);
        assert!((0.01..0.0605).contains(&rate), "{rate}");
    }

    #[test]
    fn closed_form_verdicts() {
        let mut source = noise_source(12, 0);
        let references: Vec<Difference> = (0..12).map(|_| noise(&mut source, 0.01)).collect();
        let reference = repeatability(&references).unwrap();
        let with = |rise: f64, changes: [f64; 3], margin: f64| {
            let curve = (0..56).map(|i| rise * f64::from(i) / 56.0).collect();
            let difference = Difference { curve, changes };
            decide(&difference, &reference, [margin; 3], 4, 0.05)
                .unwrap()
                .verdict
        };
        assert_eq!(with(0.2, [0.1, -0.1, 0.2], 0.1), Verdict::Changed);
        assert_eq!(with(0.0, [0.0; 3], 0.1), Verdict::Unchanged);
        assert_eq!(with(0.0, [0.0, 0.0, 0.095], 0.1), Verdict::Undecided);
    }

    #[test]
    fn rejects_two_references() {
        let mut source = noise_source(12, 0);
        let two = [noise(&mut source, 0.01), noise(&mut source, 0.01)];
        assert!(
            repeatability(&two)
                .unwrap_err()
                .to_string()
                .contains("at least 3")
        );
    }
}
