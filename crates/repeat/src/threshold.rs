//! Distribution of critical impact energies between fruit, from intervals.

use crate::equivalence::check_level;
use crate::interval::EnergyInterval;
pub use crate::threshold_family::Family;
use crate::threshold_family::interval_terms;
use crate::turnbull::check_intervals;
use windfall_distribution::tail::{chi_squared_upper_quantile, normal_quantile};
use windfall_signal::error::Error;

/// Range of 1/σ that is searched, σ the spread of ln energy; 1.
const STEEPNESS: (f64, f64) = (0.02, 200.0);

/// Bisections of a root: to the last digits of its bracket.
const BISECTIONS: usize = 44;

/// Likelihoods this close are the same; ln.
const AS_GOOD: f64 = 1e-6;

/// Ends of intervals are looked for within this factor of the energies; ln.
const REACH: f64 = 12.0;

/// An estimate and its interval from the profile of the likelihood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfiledValue {
    /// Of largest likelihood.
    pub value: f64,
    /// Lower end; `None` where the data give none.
    pub low: Option<f64>,
    /// Upper end; `None` where the data give none.
    pub high: Option<f64>,
}

/// Fitted distribution of critical energies.
#[derive(Clone, Debug, PartialEq)]
pub struct Threshold {
    /// Its form.
    pub family: Family,
    /// Energy that half the fruit stand; J.
    pub median: ProfiledValue,
    /// Energy at which a tenth of the fruit is damaged; J.
    pub tenth: ProfiledValue,
    /// Spread σ of ln energy: log-normal deviation, or 1/shape for the Weibull; 1.
    pub spread: ProfiledValue,
    /// ln of the largest likelihood; 1.
    pub ln_likelihood: f64,
    /// Whether the spread is at an end of what is searched: all intervals share
    /// an energy, so that fruit need not differ, or nothing bounds it above.
    pub spread_at_bound: bool,
}

/// Fits a distribution to intervals of critical energies.
///
/// ln E = μ + σ Z, Z standard normal or smallest extreme value. With a = 1/σ and
/// b = −μ/σ the log-likelihood is concave, so its maximum is the only one.
/// Intervals are those of the profile likelihood at 1 − `level`.
///
/// * `level`: 0.05 for 95 % intervals
///
/// # Errors
/// [`Error::EnergyUndetermined`] where no fruit changed or all changed at the
/// least energy; [`Error::BadEnergyInterval`], [`Error::TooFewFruit`].
///
/// # Source
/// Pratt (1981), J. Am. Stat. Assoc. 76, 103, concavity; Meeker and Escobar
/// (1998), Statistical methods for reliability data, ch. 8.
pub fn fit_threshold(
    intervals: &[EnergyInterval],
    family: Family,
    level: f64,
) -> Result<Threshold, Error> {
    check(intervals, level)?;
    let data = Data::new(intervals, family);
    let best = data.maximum();
    let drop = 0.5 * chi_squared(1.0 - level);
    let quantile = |p: f64| data.quantile(&best, p, drop);
    // The spread on a logarithmic scale; σ = 0 and ∞ are its ends.
    let profile = |ln_spread: f64| data.maximum_at((-ln_spread).exp()).ln_likelihood;
    let range = (-STEEPNESS.1.ln(), -STEEPNESS.0.ln());
    let target = best.ln_likelihood - drop;
    let ln_spread = -best.a.ln();
    let at_bound = profile(range.0).max(profile(range.1)) > best.ln_likelihood - AS_GOOD;
    let low = end(ln_spread, range.0, target, &profile).map(f64::exp);
    let high = end(ln_spread, range.1, target, &profile).map(f64::exp);
    Ok(Threshold {
        family,
        median: quantile(0.5),
        tenth: quantile(0.1),
        spread: ProfiledValue {
            value: ln_spread.exp(),
            low,
            high,
        },
        ln_likelihood: best.ln_likelihood,
        spread_at_bound: at_bound,
    })
}

/// The median alone of [`fit_threshold`], in less time.
///
/// # Errors
/// Those of [`fit_threshold`].
pub fn fit_median(
    intervals: &[EnergyInterval],
    family: Family,
    level: f64,
) -> Result<ProfiledValue, Error> {
    check(intervals, level)?;
    let data = Data::counted(intervals, family);
    Ok(data.quantile(&data.maximum(), 0.5, 0.5 * chi_squared(1.0 - level)))
}

/// Errors where intervals give no distribution.
fn check(intervals: &[EnergyInterval], level: f64) -> Result<(), Error> {
    check_intervals(intervals)?;
    check_level(level)?;
    let undetermined = |problem| Err(Error::EnergyUndetermined { problem });
    if intervals.iter().all(|i| i.high.is_infinite()) {
        return undetermined(
            "no fruit changed at any energy, so it is above the largest; raise the energy",
        );
    }
    if intervals.iter().all(|i| i.low == 0.0) {
        return undetermined(
            "no fruit was seen unchanged below its first change, so it is below the least energy \
             of each; begin lower",
        );
    }
    Ok(())
}

/// Parameters and what they make of the data.
#[derive(Clone, Copy)]
struct Point {
    a: f64,
    b: f64,
    ln_likelihood: f64,
}

struct Data {
    /// ln of the ends; ∓ ∞ where there is none.
    ends: Vec<(f64, f64)>,
    /// How often each stands there.
    counts: Vec<f64>,
    family: Family,
}

impl Data {
    fn new(intervals: &[EnergyInterval], family: Family) -> Self {
        let ends = intervals.iter().map(|i| (i.low.ln(), i.high.ln()));
        Self {
            ends: ends.collect(),
            counts: vec![1.0; intervals.len()],
            family,
        }
    }

    /// The same with equal intervals counted, as all fruit are struck at the same energies.
    fn counted(intervals: &[EnergyInterval], family: Family) -> Self {
        let mut all = Self::new(intervals, family).ends;
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let groups = all.chunk_by(|a, b| a == b);
        let (ends, counts) = groups.map(|own| (own[0], own.len() as f64)).unzip();
        Self {
            ends,
            counts,
            family,
        }
    }

    /// Energy that a part of the fruit does not stand, with its profile interval.
    ///
    /// * `drop`: of the log-likelihood at the ends of the interval
    fn quantile(&self, best: &Point, p: f64, drop: f64) -> ProfiledValue {
        let z = standard_quantile(self.family, p);
        let value = (z - best.b) / best.a;
        let profile = |x: f64| self.maximum_through(x, z).ln_likelihood;
        let (low, high) = profile_ends(value, best.ln_likelihood - drop, self.ends(), profile);
        ProfiledValue {
            value: value.exp(),
            low: low.map(f64::exp),
            high: high.map(f64::exp),
        }
    }

    /// Least and largest finite end.
    fn ends(&self) -> (f64, f64) {
        let all = self
            .ends
            .iter()
            .flat_map(|(l, h)| [*l, *h])
            .filter(|e| e.is_finite());
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| {
            (l.min(e), h.max(e))
        })
    }

    /// Log-likelihood and its slopes by a and b.
    fn evaluate(&self, a: f64, b: f64) -> (f64, f64, f64) {
        let (mut value, mut by_a, mut by_b) = (0.0, 0.0, 0.0);
        for (&(low, high), count) in self.ends.iter().zip(&self.counts) {
            let (ln, at_low, at_high) = interval_terms(self.family, a * low + b, a * high + b);
            value += count * ln;
            by_b += count * (at_high - at_low);
            let times = |ratio: f64, end: f64| if end.is_finite() { ratio * end } else { 0.0 };
            by_a += count * (times(at_high, high) - times(at_low, low));
        }
        (value, by_a, by_b)
    }

    /// Largest likelihood for a fixed a.
    fn maximum_at(&self, a: f64) -> Point {
        let (least, largest) = self.ends();
        let range = (-a * largest - REACH, -a * least + REACH);
        let b = falling_root(range, |b| self.evaluate(a, b).2);
        let ln_likelihood = self.evaluate(a, b).0;
        Point {
            a,
            b,
            ln_likelihood,
        }
    }

    /// Largest likelihood of all: the slope by a along the best b.
    fn maximum(&self) -> Point {
        let slope = |ln_a: f64| {
            let point = self.maximum_at(ln_a.exp());
            self.evaluate(point.a, point.b).1
        };
        let range = (STEEPNESS.0.ln(), STEEPNESS.1.ln());
        self.maximum_at(falling_root(range, slope).exp())
    }

    /// Largest likelihood where ln energy `x` is at the standardised value `z`.
    fn maximum_through(&self, x: f64, z: f64) -> Point {
        let slope = |ln_a: f64| {
            let a = ln_a.exp();
            let (_, by_a, by_b) = self.evaluate(a, z - a * x);
            by_a - x * by_b
        };
        let range = (STEEPNESS.0.ln(), STEEPNESS.1.ln());
        let a = falling_root(range, slope).exp();
        let b = z - a * x;
        let ln_likelihood = self.evaluate(a, b).0;
        Point {
            a,
            b,
            ln_likelihood,
        }
    }
}

/// Root of a function that falls; an end of the range where it has none.
fn falling_root((mut low, mut high): (f64, f64), function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        match function(middle) > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

/// Where a profile falls to `target` on both sides of its maximum.
fn profile_ends(
    best: f64,
    target: f64,
    (least, largest): (f64, f64),
    profile: impl Fn(f64) -> f64,
) -> (Option<f64>, Option<f64>) {
    let low = end(best, least.min(best) - REACH, target, &profile);
    let high = end(best, largest.max(best) + REACH, target, &profile);
    (low, high)
}

/// Where a profile falls to `target` between its maximum and `far`.
fn end(best: f64, far: f64, target: f64, profile: &impl Fn(f64) -> f64) -> Option<f64> {
    let reached = |x: f64| profile(x) > target;
    if reached(far) {
        return None;
    }
    let (mut inside, mut outside) = (best, far);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        match reached(middle) {
            true => inside = middle,
            false => outside = middle,
        }
    }
    Some(0.5 * (inside + outside))
}

fn standard_quantile(family: Family, probability: f64) -> f64 {
    match family {
        Family::LogNormal => normal_quantile(probability),
        Family::Weibull => (-f64::ln_1p(-probability)).ln(),
    }
}

fn chi_squared(probability: f64) -> f64 {
    chi_squared_upper_quantile(1.0 - probability, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_median_of_counted_intervals_is_that_of_all() {
        let interval = |low, high| EnergyInterval { low, high };
        let mut intervals = vec![interval(0.1, 0.2); 7];
        intervals.extend(vec![interval(0.0, 0.1); 3]);
        intervals.extend(vec![interval(0.2, 0.4); 4]);
        intervals.push(interval(0.4, f64::INFINITY));
        for family in [Family::LogNormal, Family::Weibull] {
            let all = fit_threshold(&intervals, family, 0.05).unwrap().median;
            let counted = fit_median(&intervals, family, 0.05).unwrap();
            let pairs = [
                (all.value, counted.value),
                (all.low.unwrap(), counted.low.unwrap()),
                (all.high.unwrap(), counted.high.unwrap()),
            ];
            for (all, counted) in pairs {
                assert!((all / counted - 1.0).abs() < 1e-9, "{all} {counted}");
            }
        }
    }
}
